//! What the tests share: scenes built in code, and ways to render them.

pub(crate) mod scenes;
pub(crate) mod reference_obj;
