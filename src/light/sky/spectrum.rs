//! Eight spectral bands of sunlight, and their colour.
//!
//! The sun is a black body of 5772 K (IAU 2015 nominal effective temperature). Colour matching functions:
//! Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
//! JCGT 2(2), 2013, the multi-lobe fit. Primaries: ITU-R BT.709.

use crate::math::Rgb;
use crate::math::fun::double;

/// How many bands there are. With 32 instead, no channel of the sky's irradiance changes by 2 %, with the
/// sun anywhere from 0 to 90 degrees.
pub(super) const BANDS: usize = 8;

/// One number a band, from violet to red.
pub(super) type Bands = [f32; BANDS];

/// Where the first band begins, and how wide each is, nanometres.
const SHORTEST: f64 = 390.0;
const WIDTH: f64 = 320.0 / BANDS as f64;

/// Middle of band `k`, nanometres.
pub(super) fn wavelength(k: usize) -> f64 {
    SHORTEST + (k as f64 + 0.5) * WIDTH
}

/// Colours of the bands of unattenuated sunlight; their sum has luminance 1.
pub(super) fn sunlight() -> [Rgb; BANDS] {
    const STEPS: usize = 40;
    let xyz: [[f64; 3]; BANDS] = std::array::from_fn(|k| {
        (0..STEPS).fold([0.0; 3], |sum, i| {
            let w = wavelength(k) + ((i as f64 + 0.5) / STEPS as f64 - 0.5) * WIDTH;
            let emitted = planck(w);
            let matched = color_matching(w);
            std::array::from_fn(|c| sum[c] + matched[c] * emitted)
        })
    });
    let luminance: f64 = xyz.iter().map(|[_, y, _]| y).sum();
    xyz.map(|v| {
        let [x, y, z] = v.map(|c| c / luminance);
        Rgb::new(
            (3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z) as f32,
            (-0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z) as f32,
            (0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z) as f32,
        )
    })
}

/// Planck's law for the sun, up to a factor.
fn planck(nanometres: f64) -> f64 {
    const TEMPERATURE: f64 = 5772.0;
    /// Second radiation constant h c / k, nanometre kelvin.
    const SECOND: f64 = 1.438_777e7;
    let micrometres = nanometres * 1e-3;
    1.0 / (micrometres.powi(5) * (double::exp(SECOND / (nanometres * TEMPERATURE)) - 1.0))
}

/// CIE 1931 x, y, z (Wyman et al., equation 4 and table 1).
fn color_matching(w: f64) -> [f64; 3] {
    let lobe = |height: f64, peak: f64, below: f64, above: f64| {
        let deviation = (w - peak) / if w < peak { below } else { above };
        height * double::exp(-0.5 * deviation * deviation)
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0)
            + lobe(0.362, 442.0, 16.0, 26.7)
            + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}
