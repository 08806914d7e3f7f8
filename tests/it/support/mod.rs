//! What the tests share: scenes built in code, and ways to render them.

pub(crate) mod scenes;
