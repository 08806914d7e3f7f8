//! What several test files share.

pub(crate) mod chi_square;

/// How much more the thorough tier (`GLINT_FULL=1`) does than the quick one.
pub(crate) fn effort(quick: usize, full: usize) -> usize {
    if std::env::var_os("GLINT_FULL").is_some_and(|v| v == "1") { full } else { quick }
}
