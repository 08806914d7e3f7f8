//! What the tests share: scenes built in code, ways to render them, and statistical tests.

pub(crate) mod chi_square;
pub(crate) mod program;
pub(crate) mod reference_obj;
pub(crate) mod scene_files;
pub(crate) mod scenes;
pub(crate) mod schema;
pub(crate) mod shot;
pub(crate) mod z_test;

/// How much more the thorough tier does than the quick one: `GLINT_FULL=1` and no other value, as in `x`.
pub(crate) fn effort(quick: usize, full: usize) -> usize {
    if std::env::var_os("GLINT_FULL").is_some_and(|v| v == "1") { full } else { quick }
}
