//! The sRGB transfer function, exact and on every machine the same: 8-bit codes to linear light and back.
//!
//! Source: IEC 61966-2-1:1999, equations 3.5 to 3.8. Both directions are tables computed at compile time
//! in `f64`, so that no `pow` runs per texel. Linear means display-linear: 1 is the white of the display.

use crate::math::fun::double::pow;

/// Linear value of each 8-bit code, rounded once from `f64`.
pub static LINEAR: [f32; 256] = codes(0.0);

/// Linear value at which rounding moves from one code to the next: entry i lies between i and i + 1.
static THRESHOLDS: [f32; 256] = codes(0.5);

/// Linear values of the codes `i + offset`.
const fn codes(offset: f64) -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = decode_f64((i as f64 + offset) / 255.0) as f32;
        i += 1;
    }
    table
}

/// Equation 3.5 for `encoded` >= 0; the power 2.4 as x^2 (x^(1/5))^2, which a `const fn` can evaluate.
const fn decode_f64(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    let x = (encoded + 0.055) / 1.055;
    // Newton's method for y^5 = x from above: it converges monotonically, quadratically near the root.
    let mut y = 1.1;
    let mut i = 0;
    while i < 40 {
        let y4 = y * y * y * y;
        y -= (y * y4 - x) / (5.0 * y4);
        i += 1;
    }
    x * x * y * y
}

/// Linear value of an encoded value in [0, 1].
#[inline]
pub fn decode(encoded: f32) -> f32 {
    decode_f64(f64::from(encoded)) as f32
}

/// Encoded value, in [0, 1], of a linear one in [0, 1]: equations 3.7 and 3.8, exact to rounding.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        return 12.92 * linear;
    }
    1.055 * pow(linear, 1.0 / 2.4) - 0.055
}

/// The 8-bit code nearest to a linear value, in the encoded scale; clamps, and takes NaN for 0.
#[inline]
pub fn encode8(linear: f32) -> u8 {
    // Codes whose upper threshold has been passed. Entry 255 is above white and never counts.
    THRESHOLDS[..255].partition_point(|&threshold| threshold <= linear) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_exact_and_survives_a_round_trip() {
        for code in 0..=255_u8 {
            let exact = |encoded: f64| match encoded {
                x if x <= 0.04045 => x / 12.92,
                x => libm::pow((x + 0.055) / 1.055, 2.4),
            };
            let linear = exact(f64::from(code) / 255.0) as f32;
            assert_eq!(LINEAR[usize::from(code)], linear, "code {code}");
            assert_eq!(encode8(linear), code);
            let encoded = f32::from(code) / 255.0;
            assert_eq!(decode(encoded), exact(f64::from(encoded)) as f32, "code {code}");
        }
    }

    /// Against the definition: encode by equation 3.8 in `f64`, then round.
    #[test]
    fn encoding_rounds_the_exact_curve() {
        let n = 100_000;
        for i in 0..n {
            let linear = (f64::from(i) / f64::from(n)).powi(3) as f32;
            let exact = match f64::from(linear) {
                x if x <= 0.003_130_8 => 12.92 * x,
                x => 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055,
            };
            let scaled = 255.0 * exact;
            // The standard's two branches miss each other by 3e-8: nothing is said that close to a tie.
            if (scaled - scaled.floor() - 0.5).abs() > 1e-4 {
                assert_eq!(f64::from(encode8(linear)), scaled.round(), "at {linear}");
            }
        }
    }

    #[test]
    fn edges() {
        assert_eq!([encode8(0.0), encode8(-0.0), encode8(-1.0), encode8(f32::NAN)], [0; 4]);
        assert_eq!([encode8(1.0), encode8(7.0), encode8(f32::INFINITY)], [255; 3]);
        assert_eq!((LINEAR[0], LINEAR[255]), (0.0, 1.0));
    }
}
