//! From linear radiance to the pixels of a display: exposure, tone map, sRGB.
//!
//! Only pictures for people are developed; EXR and HDR files keep radiance as it is. Rounding is plain:
//! dithering would hide from a viewer what the numbers are.

use super::srgb;
use crate::math::{Rgb, fun};
use rayon::prelude::*;
use std::f32::consts::LN_2;

/// How radiance beyond the display's range is brought into it. Each is monotonic in every channel's
/// exposure and maps 0 to 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ToneMap {
    /// Clipped at 1: exact below.
    None,
    /// A curve like that of ACES, for each channel.
    Aces,
    /// A sigmoid of log exposure that lets bright colours go to white, after Troy Sobotka's AgX.
    #[default]
    Agx,
    /// `L / (1 + L)` on luminance.
    Reinhard,
}

impl ToneMap {
    /// Every tone map with the name that the command line knows it by.
    pub const ALL: [(&'static str, Self); 4] = [
        ("none", Self::None),
        ("aces", Self::Aces),
        ("agx", Self::Agx),
        ("reinhard", Self::Reinhard),
    ];

    /// Display-linear colour in [0, 1] of an exposed colour. Negative channels and NaN count as 0.
    pub fn apply(self, exposed: Rgb) -> Rgb {
        // The upper bound, 50 stops above white, keeps infinity out of the arithmetic.
        let exposed = exposed.map(|c| if c > 0.0 { c.min(1e15) } else { 0.0 });
        let mapped = match self {
            Self::None => exposed,
            Self::Aces => exposed.map(aces),
            Self::Agx => agx(exposed),
            Self::Reinhard => reinhard(exposed),
        };
        mapped.map(|c| c.clamp(0.0, 1.0))
    }
}

/// Source: K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016 (a fit to the ACES reference and output
/// transforms for Rec. 709 at 100 nits), with the factor 0.6 that the fit needs to agree with ACES in exposure.
fn aces(x: f32) -> f32 {
    let x = 0.6 * x;
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}

/// Source: Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equation 3.
fn reinhard(color: Rgb) -> Rgb {
    color / (1.0 + color.luminance())
}

/// AgX as Troy Sobotka described it (2022), with parameters stated here: inset, logarithm, sigmoid.
fn agx(color: Rgb) -> Rgb {
    // 1. Inset: colours of 20 % less chroma about white. In coordinates of primaries moved outward along
    //    their lines through white, so that the old ones lie at 80 % of the way, a colour c is 0.8 c + 0.2 s,
    //    where s weights its channels by their share of X + Y + Z of white (Rec. 709: 0.212, 0.392, 0.396).
    const INSET: f32 = 0.2;
    let shared = INSET * (0.212 * color.r + 0.392 * color.g + 0.396 * color.b);
    // 2. Position among the 16.5 stops from 10 below middle grey to 6.5 above it.
    const MIDDLE_GREY: f32 = 0.18;
    const STOPS_BELOW: f32 = 10.0;
    const STOPS: f32 = 16.5;
    color.map(|c| {
        let inset = (1.0 - INSET) * c + shared;
        let stops = fun::ln(inset / MIDDLE_GREY) / LN_2;
        let position = ((stops + STOPS_BELOW) / STOPS).clamp(0.0, 1.0);
        // 3. Sigmoid, and the display's power of 2.2.
        fun::pow(sigmoid(position, STOPS_BELOW / STOPS, 0.4587), 2.2)
    })
}

/// A curve from (0, 0) through (`x`, `y`), where its slope is 2.4, to (1, 1): on each side of the pivot
/// t / sqrt(1 + t^2), which is straight at the pivot, scaled to end at its corner.
fn sigmoid(position: f32, x: f32, y: f32) -> f32 {
    const SLOPE: f32 = 2.4;
    // `reach` saturates towards `scale`, such that it is `rise` at `run`, the corner seen from the pivot.
    let reach = |distance: f32, run: f32, rise: f32| {
        let scale = 1.0 / (1.0 / (rise * rise) - 1.0 / (SLOPE * SLOPE * run * run)).sqrt();
        let t = SLOPE * distance / scale;
        scale * t / (1.0 + t * t).sqrt()
    };
    if position < x {
        (y - reach(x - position, x, y)).max(0.0)
    } else {
        (y + reach(position - x, 1.0 - x, 1.0 - y)).min(1.0)
    }
}

/// sRGB pixels of linear `pixels` (Rec. 709) at `exposure` stops. NaN and negative channels come out black.
pub fn develop(pixels: &[Rgb], exposure: f32, tonemap: ToneMap) -> Vec<[u8; 3]> {
    let scale = fun::pow(2.0, exposure);
    pixels.par_iter().map(|&p| tonemap.apply(p * scale).to_array().map(srgb::encode8)).collect()
}

/// The exposure in stops that brings the middle of a picture to middle grey (0.18); 0 for a black picture.
///
/// The middle is the log-average luminance (Reinhard et al. 2002, equation 1) of the pixels between the
/// 10th and the 90th percentile of those that are finite and not black: neither a lamp in view nor a few
/// pixels just off black move it. Scaling the pixels by k shifts the result by -log2 k. Leave pixels that
/// show only background out of `pixels`.
pub fn auto_exposure(pixels: impl IntoIterator<Item = Rgb>) -> f32 {
    let mut luminances: Vec<f32> =
        pixels.into_iter().map(Rgb::luminance).filter(|&l| l > 0.0 && l < f32::INFINITY).collect();
    if luminances.is_empty() {
        return 0.0;
    }
    luminances.par_sort_unstable_by(f32::total_cmp);
    let cut = luminances.len() / 10;
    let middle = &luminances[cut..luminances.len() - cut];
    let sum: f64 = middle.iter().map(|&l| f64::from(fun::ln(l))).sum();
    let log_average = (sum / middle.len() as f64) as f32;
    (fun::ln(0.18) - log_average) / LN_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    /// Every channel of every colour grows with exposure, from 0 at black to at most 1.
    #[test]
    fn monotonic_from_black_to_white() {
        let mut rng = CounterRng::new(0);
        for (name, tonemap) in ToneMap::ALL {
            assert_eq!(tonemap.apply(Rgb::BLACK), Rgb::BLACK, "{name}");
            for _ in 0..100 {
                let color = Rgb::new(rng.unit(), rng.unit(), rng.unit());
                let mut before = Rgb::BLACK;
                for step in -200..=200 {
                    let exposed = color * fun::pow(2.0, step as f32 * 0.1);
                    let mapped = tonemap.apply(exposed);
                    for channel in 0..3 {
                        assert!(mapped[channel] <= 1.0);
                        // The rounding of the curves is far below a step of 8 bits.
                        assert!(mapped[channel] >= before[channel] - 1e-6, "{name} {exposed:?}");
                    }
                    before = mapped;
                }
            }
        }
    }

    #[test]
    fn known_points() {
        let grey = |tonemap: ToneMap, v: f32| tonemap.apply(Rgb::splat(v)).g;
        let near = |a: f32, b: f32| assert!((a - b).abs() < 2e-3, "{a} {b}");
        assert_eq!(grey(ToneMap::None, 0.18), 0.18);
        assert_eq!(grey(ToneMap::None, 5.0), 1.0);
        near(grey(ToneMap::Reinhard, 1.0), 0.5);
        // AgX keeps middle grey, and takes white and black from the ends of its 16.5 stops.
        near(grey(ToneMap::Agx, 0.18), 0.18);
        near(grey(ToneMap::Agx, 0.18 * fun::pow(2.0, 6.5)), 1.0);
        near(grey(ToneMap::Agx, 0.18 * fun::pow(2.0, -10.0)), 0.0);
        // Far beyond white every channel of a colour clips or goes to white, as the map says.
        let red = Rgb::new(1000.0, 1.0, 1.0);
        assert_eq!(ToneMap::None.apply(red), Rgb::WHITE);
        assert!(ToneMap::Agx.apply(red).g > 0.5);
        assert!(ToneMap::Reinhard.apply(red).g < 0.01);
    }

    #[test]
    fn what_is_no_light_is_black_or_white() {
        for (name, tonemap) in ToneMap::ALL {
            let pixels =
                [f32::NAN, -1.0, f32::NEG_INFINITY, f32::INFINITY, f32::MAX].map(Rgb::splat);
            let developed = develop(&pixels, 0.0, tonemap);
            assert_eq!(developed[..3], [[0; 3]; 3], "{name}");
            assert!(developed[3..].iter().flatten().all(|&v| v >= 254), "{name} {developed:?}");
        }
    }

    #[test]
    fn without_a_map_development_is_the_srgb_curve() {
        for code in 0..=255_u8 {
            let linear = Rgb::splat(srgb::LINEAR[usize::from(code)]);
            assert_eq!(develop(&[linear], 0.0, ToneMap::None), [[code; 3]]);
            assert_eq!(develop(&[linear * 0.25], 2.0, ToneMap::None), [[code; 3]]);
        }
    }

    /// Radiance over six powers of ten, some of it black, some of it not finite.
    fn picture(scale: f32) -> Vec<Rgb> {
        let mut rng = CounterRng::new(0);
        let pixel = |i: usize| match i % 10 {
            0 => Rgb::BLACK,
            1 => Rgb::splat(f32::NAN),
            _ => Rgb::splat(scale * fun::pow(10.0, 6.0 * rng.unit() - 3.0)),
        };
        (0..10_000).map(pixel).collect()
    }

    #[test]
    fn exposure_follows_the_scale_of_light() {
        let base = auto_exposure(picture(1.0));
        // The median of the picture is 1.
        assert!((base - fun::ln(0.18) / LN_2).abs() < 0.2, "{base}");
        for scale in [1e-6, 1e-3, 1e6] {
            let shifted = auto_exposure(picture(scale)) + fun::ln(scale) / LN_2;
            assert!((shifted - base).abs() < 1e-4, "{scale}: {shifted} {base}");
        }
    }

    #[test]
    fn exposure_ignores_black_lamps_and_order() {
        let base = auto_exposure(picture(1.0));
        let mut pixels = picture(1.0);
        pixels.reverse();
        assert_eq!(auto_exposure(pixels.iter().copied()), base);
        // Half of the picture black; a lamp in one of fifty pixels.
        pixels.extend([Rgb::BLACK; 10_000]);
        assert_eq!(auto_exposure(pixels.iter().copied()), base);
        pixels.extend([Rgb::splat(1e6); 200]);
        assert!((auto_exposure(pixels) - base).abs() < 0.3);
        assert_eq!(auto_exposure([Rgb::BLACK; 9]), 0.0);
        assert_eq!(auto_exposure([Rgb::splat(0.18)]), 0.0);
    }
}
