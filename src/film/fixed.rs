//! Fixed-point sums: 128-bit integers on a grid of 2^-64.
//!
//! An `f32` of at least 2^-40 lies on the grid, so its addition is exact; smaller ones are rounded once.
//! The sum holds magnitudes up to 2^62; beyond, it saturates.

/// A number on the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fixed(i128);

const GRID: f64 = 18_446_744_073_709_551_616.0;

impl Fixed {
    /// The grid point nearest to zero from `value`, which is finite.
    #[inline]
    pub(super) fn from_f32(value: f32) -> Self {
        // Exact: a power of two. Magnitudes beyond a quarter of the range would leave no room for a sum.
        Self((f64::from(value) * GRID).clamp(-LARGEST, LARGEST) as i128)
    }

    /// Adds, saturating.
    #[inline]
    pub(super) fn add(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }

    /// The nearest `f64`.
    pub(super) fn to_f64(self) -> f64 {
        self.0 as f64 / GRID
    }
}

/// 2^126 grid steps: 4.6e18.
const LARGEST: f64 = 85_070_591_730_234_615_865_843_651_857_942_052_864.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_for_every_ordinary_value() {
        for value in [1.0_f32, -0.1, 1e-12, 3.5e12, f32::MIN_POSITIVE * 0.0, 0.333_333_34] {
            assert_eq!(Fixed::from_f32(value).to_f64(), f64::from(value));
        }
        assert_eq!(Fixed::from_f32(1e-30).to_f64(), 0.0);
    }

    #[test]
    fn saturates_instead_of_wrapping() {
        let mut sum = Fixed::default();
        for _ in 0..10 {
            sum.add(Fixed::from_f32(f32::MAX));
        }
        assert!(sum.to_f64() > 9e18);
    }
}
