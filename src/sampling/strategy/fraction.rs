//! Coordinates as 32-bit fractions: `x` stands for x / 2^32, so that every value is in [0, 1) and a torus is what
//! wrapping arithmetic makes of it.

/// A number in [0, 1), in units of 2^-32.
pub type Fraction = u32;

/// A half.
pub(super) const HALF: Fraction = 1 << 31;

/// As a floating-point number, exactly.
#[inline(always)]
pub fn to_f64(x: Fraction) -> f64 {
    f64::from(x) * (1.0 / 4_294_967_296.0)
}

/// The largest fraction that is not above `x`, for `x` in [0, 1).
pub(super) fn from_f64(x: f64) -> Fraction {
    (x * 4_294_967_296.0) as u32
}

/// The point at `offset` of the way through interval `i` of [0, 1) cut into `n` equal ones, `i < n`: with exact bounds,
/// `i = floor(n x)`.
#[inline(always)]
pub(in crate::sampling) fn in_stratum(i: u32, n: u32, offset: Fraction) -> Fraction {
    within([i, i + 1], n, offset)
}

/// The point at `offset` of the way from `start / n` to `end / n`, `start < end <= n`.
#[inline(always)]
pub(super) fn within([start, end]: [u32; 2], n: u32, offset: Fraction) -> Fraction {
    let bound = |i: u32| (u64::from(i) << 32).div_ceil(u64::from(n));
    let (start, end) = (bound(start), bound(end));
    (start + ((u64::from(offset) * (end - start)) >> 32)) as u32
}

/// Squared distance on the torus, in units of 2^-64.
#[inline(always)]
pub(super) fn distance_squared(a: [Fraction; 2], b: [Fraction; 2]) -> u64 {
    // The difference as a signed number is the shorter way around.
    let square = |k: usize| {
        let d = u64::from((a[k].wrapping_sub(b[k]) as i32).unsigned_abs());
        d * d
    };
    square(0) + square(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_have_exact_bounds() {
        for n in [1, 2, 3, 5, 7, 12, 100, 999, 65_537] {
            for i in [0, n / 3, n / 2, n - 1] {
                for offset in [0, 1, HALF, u32::MAX] {
                    let x = in_stratum(i, n, offset);
                    assert_eq!(
                        (u64::from(x) * u64::from(n)) >> 32,
                        u64::from(i),
                        "{i}/{n} {offset}"
                    );
                }
            }
        }
    }

    #[test]
    fn distances_go_the_shorter_way_around() {
        let quarter = 1 << 30;
        assert_eq!(distance_squared([0, 0], [3 * quarter, 0]), 1 << 60);
        assert_eq!(distance_squared([0, quarter], [HALF, 3 * quarter]), 1 << 63);
        assert_eq!(distance_squared([5, 5], [5, 5]), 0);
    }
}
