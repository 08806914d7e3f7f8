//! sin, cos, exp, ln, pow, atan and friends: one definition for every machine.
//!
//! std's transcendental functions call the C library, whose results differ between versions and
//! CPUs; these are plain Rust without fused multiply-add, so an image does not depend on either.
//! The `f32` functions evaluate a polynomial in `f64` and round once: their error is below 0.501 units
//! in the last place (`tests` measures it), they are branch-light, and the compiler may vectorise
//! them. [`double`] holds the rarely used `f64` ones (set-up of cameras and transforms).

/// `f64` functions for set-up code, from the `libm` crate (a port of musl's; pure Rust).
pub mod double {
    pub use libm::{acos, asin, atan, atan2, cbrt, cos, exp, log as ln, pow, sin, tan};
}

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI};

/// Adding and subtracting it rounds an `f64` below 2^51 to the nearest integer, ties to even.
const ROUND: f64 = 6_755_399_441_055_744.0;

#[inline(always)]
fn round(x: f64) -> f64 {
    (x + ROUND) - ROUND
}

/// sin and cos of `quarters` quarter turns, |quarters| < 2^50.
#[inline(always)]
fn sin_cos_quarters(quarters: f64) -> (f64, f64) {
    let rounded = quarters + ROUND;
    let k = rounded - ROUND;
    // |x| <= pi/4: Taylor to degree 13, truncation below 2e-12.
    let x = (quarters - k) * FRAC_PI_2;
    let x2 = x * x;
    let sin = x
        * (1.0
            + x2 * (-1.0 / 6.0
                + x2 * (1.0 / 120.0
                    + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0 + x2 * (-1.0 / 39_916_800.0))))));
    let cos = 1.0
        + x2 * (-0.5
            + x2 * (1.0 / 24.0
                + x2 * (-1.0 / 720.0
                    + x2 * (1.0 / 40_320.0
                        + x2 * (-1.0 / 3_628_800.0 + x2 * (1.0 / 479_001_600.0))))));
    // Odd quadrants swap the two, and bits of the quadrant are their signs: by masks, because the
    // quadrant of a random angle is a branch that no predictor learns.
    // (The lowest bits of `rounded` are those of k.)
    let quadrant = rounded.to_bits();
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let swap = (sin ^ cos) & (quadrant & 1).wrapping_neg();
    let sin_sign = (quadrant & 2) << 62;
    let cos_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (f64::from_bits(sin ^ swap ^ sin_sign), f64::from_bits(cos ^ swap ^ cos_sign))
}

/// (sin, cos) of `x` eighth turns (pi/4 each), |x| <= 1: no range reduction. Taylor in `f32`; the error is
/// below 1.5 units in the last place.
#[inline(always)]
pub fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x = x * std::f32::consts::FRAC_PI_4;
    let x2 = x * x;
    let sin = x - x
        * x2
        * (1.0 / 6.0 - x2 * (1.0 / 120.0 - x2 * (1.0 / 5040.0 - x2 * (1.0 / 362_880.0))));
    let cos = 1.0
        - x2 * (0.5
            - x2 * (1.0 / 24.0
                - x2 * (1.0 / 720.0 - x2 * (1.0 / 40_320.0 - x2 * (1.0 / 3_628_800.0)))));
    (sin, cos)
}

/// (sin, cos) of `turn` full turns, 0 <= turn <= 1, in `f32` alone: the range reduction is exact, and the error
/// that of [`sin_cos_eighth`]. For random angles.
#[inline(always)]
pub fn sin_cos_turn(turn: f32) -> (f32, f32) {
    // The nearest quarter, in the lowest bits of the sum; two eighths make a quarter.
    const ROUND: f32 = 12_582_912.0;
    let quarters = 4.0 * turn;
    let rounded = quarters + ROUND;
    let (sin, cos) = sin_cos_eighth(2.0 * (quarters - (rounded - ROUND)));
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let quadrant = rounded.to_bits();
    let swap = (sin ^ cos) & (quadrant & 1).wrapping_neg();
    let sin_sign = (quadrant & 2) << 30;
    let cos_sign = (quadrant.wrapping_add(1) & 2) << 30;
    (f32::from_bits(sin ^ swap ^ sin_sign), f32::from_bits(cos ^ swap ^ cos_sign))
}

/// (sin, cos) of `turns` full turns (2 pi each): the range reduction is exact.
#[inline(always)]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let (s, c) = sin_cos_quarters(f64::from(turns) * 4.0);
    (s as f32, c as f32)
}

/// (sin, cos) of an angle in radians, |x| < 1e8.
#[inline(always)]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (s, c) = sin_cos_quarters(f64::from(x) * (1.0 / FRAC_PI_2));
    (s as f32, c as f32)
}

/// sin of an angle in radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    sin_cos(x).0
}

/// cos of an angle in radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    sin_cos(x).1
}

/// tan of an angle in radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    let (s, c) = sin_cos_quarters(f64::from(x) * (1.0 / FRAC_PI_2));
    (s / c) as f32
}

#[inline]
fn exp_f64(x: f64) -> f64 {
    // 2^k e^r, |r| <= ln2/2: Taylor to degree 10, truncation below 3e-13 relative.
    let x = x.clamp(-700.0, 700.0);
    let k = round(x * LOG2_E);
    let r = x - k * LN_2;
    let mut p = 1.0 / 3_628_800.0;
    for c in [
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ] {
        p = p * r + c;
    }
    p * f64::from_bits(((k as i64 + 1023) as u64) << 52)
}

/// e to the `x`; 0 below the range, infinity above it, NaN for NaN.
#[inline]
pub fn exp(x: f32) -> f32 {
    exp_f64(f64::from(x)) as f32
}

/// Natural logarithm of a positive normal `f64`.
#[inline]
fn ln_f64(x: f64) -> f64 {
    // x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 atanh((m-1)/(m+1)), series to s^15.
    let bits = x.to_bits() as i64;
    let offset = bits - 0x3fe6_a09e_667f_3bcd;
    let k = offset >> 52;
    let m = f64::from_bits((bits - (k << 52)) as u64);
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let mut p = 1.0 / 15.0;
    for n in [13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        p = p * s2 + 1.0 / n;
    }
    k as f64 * LN_2 + 2.0 * s * p
}

/// Natural logarithm; -infinity at 0, NaN below 0.
#[inline]
pub fn ln(x: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY {
        ln_f64(f64::from(x)) as f32
    } else if x == 0.0 {
        f32::NEG_INFINITY
    } else if x == f32::INFINITY {
        x
    } else {
        f32::NAN
    }
}

/// `x` to the power `y` for `x >= 0`; 0^0 = 1, 0^y = 0 for y > 0; NaN for negative `x`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY {
        exp_f64(f64::from(y) * ln_f64(f64::from(x))) as f32
    } else if y == 0.0 {
        1.0
    } else if x == 0.0 {
        if y > 0.0 { 0.0 } else { f32::INFINITY }
    } else if x == f32::INFINITY {
        if y > 0.0 { x } else { 0.0 }
    } else {
        f32::NAN
    }
}

/// arctangent of `t`, |t| <= tan(pi/8): series to t^21, truncation below 8e-11.
#[inline]
fn atan_small(t: f64) -> f64 {
    let t2 = t * t;
    let mut p = 1.0 / 21.0;
    for n in [-19.0, 17.0, -15.0, 13.0, -11.0, 9.0, -7.0, 5.0, -3.0, 1.0] {
        p = p * t2 + 1.0 / n;
    }
    t * p
}

/// Angle of the point (x, y) in (-pi, pi]; 0 at the origin.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ay, ax) = (f64::from(y).abs(), f64::from(x).abs());
    let (small, large) = if ay < ax { (ay, ax) } else { (ay.min(ax), ay.max(ax)) };
    if large == 0.0 {
        return if x.is_sign_negative() { (PI as f32).copysign(y) } else { 0.0_f32.copysign(y) };
    }
    // First octant: t = small/large in [0, 1], reduced to |t| <= tan(pi/8).
    let t = small / large;
    const TAN_PI_8: f64 = 0.414_213_562_373_095_03;
    let octant =
        if t > TAN_PI_8 { FRAC_PI_4 + atan_small((t - 1.0) / (t + 1.0)) } else { atan_small(t) };
    let first_quadrant = if ay > ax { FRAC_PI_2 - octant } else { octant };
    let half_plane = if x.is_sign_negative() { PI - first_quadrant } else { first_quadrant };
    (half_plane as f32).copysign(y)
}

/// arctangent.
#[inline]
pub fn atan(x: f32) -> f32 {
    atan2(x, 1.0)
}

/// arccosine; the argument is clamped to [-1, 1].
#[inline]
pub fn acos(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    atan2(((1.0 - x) * (1.0 + x)).sqrt(), x)
}

/// arcsine; the argument is clamped to [-1, 1].
#[inline]
pub fn asin(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    atan2(x, ((1.0 - x) * (1.0 + x)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of `f` against `reference` in units of the last place of the true value.
    fn worst_ulps(
        range: std::ops::Range<f32>,
        f: impl Fn(f32) -> f32,
        reference: impl Fn(f64) -> f64,
    ) -> f64 {
        let n = 200_000;
        let mut worst = 0.0_f64;
        for i in 0..n {
            let x = range.start + (range.end - range.start) * (i as f32 / n as f32);
            let truth = reference(f64::from(x));
            let nearest = truth as f32;
            let ulp =
                f64::from(f32::from_bits(nearest.abs().to_bits() + 1)) - f64::from(nearest.abs());
            worst = worst.max((f64::from(f(x)) - truth).abs() / ulp);
        }
        worst
    }

    #[test]
    fn within_half_a_unit_in_the_last_place() {
        let check = |name: &str, error: f64| assert!(error < 0.501, "{name}: {error} ulp");
        check("sin", worst_ulps(-3.0..3.0, sin, libm::sin));
        check("cos", worst_ulps(-50.0..50.0, cos, libm::cos));
        check("tan", worst_ulps(-1.5..1.5, tan, libm::tan));
        check("exp", worst_ulps(-80.0..80.0, exp, libm::exp));
        check("ln", worst_ulps(1e-6..1e-3, ln, libm::log));
        check("ln", worst_ulps(1.5..1e6, ln, libm::log));
        check("ln near 1", worst_ulps(0.9..1.1, ln, libm::log));
        check("atan", worst_ulps(-9.0..9.0, atan, libm::atan));
        check("pow", worst_ulps(1e-4..40.0, |x| pow(x, 2.4), |x| libm::pow(x, f64::from(2.4_f32))));
        check(
            "turns",
            worst_ulps(
                0.0..0.2,
                |x| sin_cos_turns(x + 3.0).1,
                |x| libm::cos(2.0 * PI * f64::from(x as f32 + 3.0)),
            ),
        );
    }

    #[test]
    fn eighth_turns_are_good_to_a_unit_and_a_half() {
        let angle = |x: f64| x * f64::from(std::f32::consts::FRAC_PI_4);
        let sin = worst_ulps(-1.0..1.0, |x| sin_cos_eighth(x).0, |x| libm::sin(angle(x)));
        let cos = worst_ulps(-1.0..1.0, |x| sin_cos_eighth(x).1, |x| libm::cos(angle(x)));
        assert!(sin < 1.5 && cos < 1.5, "{sin} {cos}");
    }

    /// Against the one in `f64`: two units in the last place of numbers up to 1, and exact at the quarters.
    #[test]
    fn a_random_turn_is_as_good_as_an_exact_one() {
        let worst = (0..=1_000_000).fold(0.0_f32, |worst, i| {
            let turn = i as f32 / 1e6;
            let ((sin, cos), (s, c)) = (sin_cos_turn(turn), sin_cos_turns(turn));
            worst.max((sin - s).abs()).max((cos - c).abs())
        });
        assert!(worst <= f32::EPSILON, "{worst}");
        for (turn, expected) in [
            (0.0, (0.0, 1.0)),
            (0.25, (1.0, 0.0)),
            (0.5, (0.0, -1.0)),
            (0.75, (-1.0, 0.0)),
            (1.0, (0.0, 1.0)),
        ] {
            assert_eq!(sin_cos_turn(turn), expected);
        }
    }

    #[test]
    fn edges() {
        assert_eq!(exp(f32::NEG_INFINITY), 0.0);
        assert_eq!(exp(1e9), f32::INFINITY);
        assert_eq!(exp(0.0), 1.0);
        assert!(exp(f32::NAN).is_nan() && ln(-1.0).is_nan() && pow(-1.0, 2.0).is_nan());
        assert_eq!(ln(1.0), 0.0);
        assert_eq!((pow(0.0, 0.0), pow(0.0, 2.0), pow(7.0, 0.0)), (1.0, 0.0, 1.0));
        assert_eq!(atan2(0.0, -1.0), std::f32::consts::PI);
        assert_eq!((acos(2.0), asin(2.0)), (0.0, std::f32::consts::FRAC_PI_2));
        assert_eq!(sin_cos_turns(0.25), (1.0, 0.0));
        assert_eq!(sin_cos_turns(-0.5).1, -1.0);
    }

    /// Pinned bits: any change of machine, compiler or library that changed an image would fail here.
    #[test]
    fn same_bits_everywhere() {
        let mut hash = 0_u64;
        for i in 1..20_000 {
            let x = i as f32 * 0.001_37;
            for y in [sin(x), cos(x), exp(-x), ln(x), atan(x), pow(x, 0.45), acos(x - 13.0)] {
                hash = (hash ^ u64::from(y.to_bits())).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
        assert_eq!(hash, 13_461_062_895_838_245_861);
    }
}
