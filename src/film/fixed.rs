//! Fixed-point sums: 128-bit integers on a grid of 2^-64.
//!
//! An `f32` of at least 2^-40 lies on the grid, so its addition is exact; smaller ones are rounded once.
//! The sum holds magnitudes up to 2^61 a sample and 2^63 in all; beyond, it saturates.

/// A number on the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fixed(i128);

const GRID: f64 = 18_446_744_073_709_551_616.0;

impl Fixed {
    /// The grid point next to `value`, which is finite, in the direction of zero.
    #[inline]
    pub(super) fn from_f32(value: f32) -> Self {
        // value = mantissa 2^(exponent - 150): shift the mantissa to its place on the grid of 2^-64.
        // (Subnormals have no hidden bit, and vanish anyway.) Without branches: zeros and ones, small and
        // large numbers follow each other at random.
        let bits = value.to_bits();
        let exponent = (bits >> 23 & 0xff) as i32;
        let mantissa = bits & 0x007f_ffff | 0x0080_0000;
        let shift = exponent - 150 + 64;
        let left = shift.clamp(0, LARGEST_SHIFT);
        let right = (-shift).clamp(0, 31);
        let magnitude = i128::from(mantissa >> right) << left;
        let sign = i128::from(bits as i32 >> 31);
        Self((magnitude ^ sign) - sign)
    }

    /// Adds, saturating.
    #[inline]
    pub(super) fn add(&mut self, other: Self) {
        self.0 = match self.0.checked_add(other.0) {
            Some(sum) => sum,
            None => self.0.saturating_add(other.0),
        };
    }

    /// The nearest `f64`.
    pub(super) fn to_f64(self) -> f64 {
        self.0 as f64 / GRID
    }
}

/// The shift of the largest numbers: beyond 2^61 or so, there would be no room for a sum.
const LARGEST_SHIFT: i32 = 101;

#[cfg(test)]
mod tests {
    use super::*;

    /// 2^-64.
    const STEP: f32 = 5.421_011e-20;

    #[test]
    fn exact_for_every_ordinary_value() {
        for value in [1.0_f32, -0.1, 1e-12, 3.5e12, f32::MIN_POSITIVE * 0.0, 0.333_333_34] {
            assert_eq!(Fixed::from_f32(value).to_f64(), f64::from(value));
        }
        for (tiny, rounded) in [(1e-30_f32, 0.0), (-1e-20, 0.0), (-1.5 * STEP, -f64::from(STEP))] {
            assert_eq!(Fixed::from_f32(tiny).to_f64(), rounded);
        }
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
