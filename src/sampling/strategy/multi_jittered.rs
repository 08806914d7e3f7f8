//! Multi-jittered sampling: one point in each cell of a grid, and at once one in each of n rows and n columns.
//!
//! Source: K. Chiu, P. Shirley and C. Wang, "Multi-Jittered Sampling", Graphics Gems IV, 1994. In the canonical
//! arrangement the point of cell (column, row) has sub-column `row` and sub-row `column`. Shuffling the
//! sub-columns within each column and the sub-rows within each row keeps both properties.

use super::fraction::{Fraction, in_stratum};
use super::permutation::permute;
use crate::sampling::hash::combine;

/// A grid of cells, columns times rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sampling) struct Cells {
    pub(super) columns: u32,
    pub(super) rows: u32,
}

impl Cells {
    /// The most nearly square grid of `count` cells; `None` if its sides differ by more than a factor of four.
    pub(super) fn of(count: u32) -> Option<Self> {
        let root = f64::from(count).sqrt() as u32 + 1;
        let columns = (1..=root).rev().find(|c| c * c <= count && count.is_multiple_of(*c))?;
        let rows = count / columns;
        (rows <= 4 * columns).then_some(Self { columns, rows })
    }

    /// The point at `offset` of the way through sub-column `sub[0]` and sub-row `sub[1]` of cell (column, row).
    #[inline]
    pub(super) fn point(
        self,
        [column, row]: [u32; 2],
        sub: [u32; 2],
        offset: [Fraction; 2],
    ) -> [Fraction; 2] {
        let n = self.columns * self.rows;
        let x = in_stratum(column * self.rows + sub[0], n, offset[0]);
        let y = in_stratum(row * self.columns + sub[1], n, offset[1]);
        [x, y]
    }
}

/// The point of cell `i`.
#[inline]
pub(super) fn point(i: u32, cells: Cells, seed: u64, offset: [Fraction; 2]) -> [Fraction; 2] {
    let (column, row) = (i % cells.columns, i / cells.columns);
    // Each column and each row has a permutation of its own.
    let sub_column = permute(row, cells.rows, combine(seed, u64::from(column) << 1));
    let sub_row = permute(column, cells.columns, combine(seed, u64::from(row) << 1 | 1));
    cells.point([column, row], [sub_column, sub_row], offset)
}
