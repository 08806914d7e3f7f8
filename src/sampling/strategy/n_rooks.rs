//! n-rooks sampling: n points, one in each of n rows and one in each of n columns.
//!
//! Source: P. Shirley, "Discrepancy as a Quality Measure for Sample Distributions", Eurographics 1991; the same as
//! Latin hypercube sampling in two dimensions (McKay, Beckman and Conover, Technometrics 21(2), 1979).

use super::fraction::{Fraction, in_stratum};
use super::permutation::permute;
use crate::sampling::hash::combine;

/// Point `i` of `n`, with `offset` in its own row and column.
#[inline]
pub(super) fn point(i: u32, n: u32, seed: u64, offset: [Fraction; 2]) -> [Fraction; 2] {
    [0, 1].map(|axis| in_stratum(permute(i, n, combine(seed, axis as u64)), n, offset[axis]))
}
