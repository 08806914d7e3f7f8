//! From linear radiance to the pixels of a display: exposure, tone map, sRGB.
//!
//! Only pictures for people are developed; EXR and HDR files keep radiance as it is. Rounding is plain:
//! dithering would hide from a viewer what the numbers are.

use super::srgb;
use crate::error::{Error, Result};
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
    #[default]
    Aces,
    /// A sigmoid of log exposure that lets bright colours go to white, after Troy Sobotka's AgX.
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

    /// The tone map called `name`.
    ///
    /// # Errors
    /// A usage error that lists the names.
    pub fn parse(name: &str) -> Result<Self> {
        let found = Self::ALL.iter().find(|(known, _)| *known == name);
        found.map(|&(_, tonemap)| tonemap).ok_or_else(|| {
            let names = Self::ALL.map(|(name, _)| name).join(", ");
            Error::Usage(format!("there is no tone map `{name}`; there are: {names}"))
        })
    }

    /// Display-linear colour in [0, 1] of an exposed colour. Negative channels and NaN count as 0.
    pub fn apply(self, exposed: Rgb) -> Rgb {
        // Beyond 16 stops every map is at its white; the bound keeps infinity out of the arithmetic.
        let exposed = exposed.map(|c| c.max(0.0).min(65536.0));
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
