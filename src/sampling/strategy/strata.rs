//! The unit square cut into n parts of equal area, nearly square ones: what the regular grid and jittered sampling
//! share.
//!
//! A square number gives a square grid. Any other count gives round(sqrt n) columns whose numbers of cells differ by
//! one, and whose widths are in proportion, so that every cell has the area 1/n and sampling stays unbiased.

use super::fraction::{Fraction, HALF, in_stratum, within};

/// The cells for a count.
#[derive(Clone, Copy, Debug)]
pub(in crate::sampling) struct Strata {
    count: u32,
    columns: u32,
}

impl Strata {
    pub(super) fn new(count: u32) -> Self {
        Self { count, columns: (f64::from(count).sqrt() + 0.5) as u32 }
    }

    /// The point at `offset` of the way through cell `i`.
    #[inline]
    pub(super) fn point(&self, i: u32, offset: [Fraction; 2]) -> [Fraction; 2] {
        let (count, columns) = (u64::from(self.count), u64::from(self.columns));
        // Column c holds the cells from floor(c count / columns) on; this inverts that.
        let column = ((u64::from(i) + 1) * columns - 1) / count;
        let [start, end] = [column, column + 1].map(|c| (c * count / columns) as u32);
        let x = within([start, end], self.count, offset[0]);
        [x, in_stratum(i - start, end - start, offset[1])]
    }

    /// The middle of cell `i`: a regular grid.
    #[inline]
    pub(super) fn middle(&self, i: u32) -> [Fraction; 2] {
        self.point(i, [HALF; 2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::strategy::fraction::to_f64;

    #[test]
    fn a_square_number_gives_the_square_grid() {
        let strata = Strata::new(16);
        for i in 0..16 {
            let point = strata.middle(i).map(to_f64);
            let (column, row) = (f64::from(i / 4), f64::from(i % 4));
            assert_eq!(point, [(column + 0.5) / 4.0, (row + 0.5) / 4.0]);
        }
    }

    /// Corners of the cells tell their areas, which are equal and add up to 1.
    #[test]
    fn cells_have_equal_areas_for_any_count() {
        for count in 1..=300 {
            let strata = Strata::new(count);
            for i in 0..count {
                let [low, high] = [0, u32::MAX].map(|o| strata.point(i, [o; 2]).map(to_f64));
                let area = (high[0] - low[0]) * (high[1] - low[1]);
                assert!(
                    (area * f64::from(count) - 1.0).abs() < 1e-5,
                    "cell {i} of {count}: {area}"
                );
            }
        }
    }

    #[test]
    fn cells_are_nearly_square() {
        for count in 4..=300 {
            let strata = Strata::new(count);
            for i in 0..count {
                let [low, high] = [0, u32::MAX].map(|o| strata.point(i, [o; 2]).map(to_f64));
                let aspect = (high[0] - low[0]) / (high[1] - low[1]);
                assert!((0.39..2.6).contains(&aspect), "cell {i} of {count}: {aspect}");
            }
        }
    }
}
