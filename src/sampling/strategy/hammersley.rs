//! The Hammersley set: i/n beside the radical inverse of i in base 2. Deterministic.
//!
//! Source: J. M. Hammersley, "Monte Carlo Methods for Solving Multivariable Problems", Annals of the New York Academy of
//! Sciences 86, 1960.

use super::fraction::{Fraction, in_stratum};

/// Point `i` of `n`.
pub(super) fn point(i: u32, n: u32) -> [Fraction; 2] {
    [in_stratum(i, n, 0), i.reverse_bits()]
}
