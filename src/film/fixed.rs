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
        // (Subnormals have no hidden bit, and vanish anyway.)
        let bits = value.to_bits();
        let exponent = (bits >> 23 & 0xff) as i32;
        let mantissa = i128::from(bits & 0x007f_ffff | 0x0080_0000);
        let shift = exponent - 150 + 64;
        let magnitude = match shift {
            LARGEST_SHIFT.. => LARGEST,
            0.. => mantissa << shift,
            -24.. => mantissa >> -shift,
            _ => 0,
        };
        Self(if bits >> 31 == 0 { magnitude } else { -magnitude })
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

/// A quarter of the range: beyond, there would be no room for a sum.
const LARGEST: i128 = 1 << 125;
/// Shifts from which on a mantissa of 24 bits exceeds [`LARGEST`].
const LARGEST_SHIFT: i32 = 102;

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
