//! What the tests share: scenes built in code, ways to render them, a slow OBJ parser, and the test for means.

pub(crate) mod reference_obj;
pub(crate) mod scenes;
pub(crate) mod z_test;
