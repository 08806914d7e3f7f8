//! Correlated multi-jittered sampling: multi-jittered, with one and the same shuffle for all columns, and one for all
//! rows. Neighbouring points then cluster less.
//!
//! Source: A. Kensler, "Correlated Multi-Jittered Sampling", Pixar Technical Memo 13-01, 2013.

use super::fraction::Fraction;
use super::multi_jittered::Cells;
use super::permutation::permute;
use crate::sampling::hash::combine;

/// The point of cell `i`.
#[inline]
pub(super) fn point(i: u32, cells: Cells, seed: u64, offset: [Fraction; 2]) -> [Fraction; 2] {
    let (column, row) = (i % cells.columns, i / cells.columns);
    let sub_column = permute(row, cells.rows, combine(seed, 0));
    let sub_row = permute(column, cells.columns, combine(seed, 1));
    cells.point([column, row], [sub_column, sub_row], offset)
}
