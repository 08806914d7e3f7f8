//! How far one picture is from another: errors of its numbers, and differences that one can see.
//!
//! Numbers are compared as their files mean them: radiance of EXR and HDR files, and the encoded values, 0 to 1, of all
//! others. What is seen of radiance depends on an exposure, which is the reference's. Knows no renderer.

mod difference;
mod field;
mod flip;
mod picture;
mod ssim;

pub use difference::relative_rmse;
pub use field::Field;
pub use picture::{Picture, Values};

use crate::error::{Error, Result};
use serde::Serialize;

/// Pixels a degree of what FLIP assumes: a screen of 3840 pixels on 0.7 m, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// A comparison takes some 250 bytes a pixel.
const MOST_PIXELS: u64 = 1 << 25;

/// The differences of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Metrics {
    /// Root mean square error, over pixels and channels.
    pub rmse: f64,
    /// [`relative_rmse`]; `None` where it is infinite: the reference is black, and the picture is not.
    pub relative_rmse: Option<f64>,
    /// Mean absolute error.
    pub mae: f64,
    /// Peak signal-to-noise ratio of the encoded pictures, dB; `None` where they are equal.
    pub psnr: Option<f64>,
    /// Structural similarity of the encoded pictures, at most 1; `None` for pictures of fewer than 11 pixels a side.
    pub ssim: Option<f64>,
    /// Mean of FLIP, 0 to 1: what an observer notices who switches between the pictures.
    pub flip: f64,
    /// Mean of the picture, over pixels and channels.
    pub mean_a: f64,
    /// Mean of the reference.
    pub mean_b: f64,
}

/// What a comparison finds.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// In numbers.
    pub metrics: Metrics,
    /// FLIP of every pixel, 0 to 1.
    pub map: Field,
}

/// Compares a picture with what it should be. `progress` is told steps done, and steps in all.
///
/// # Errors
/// A usage error for pictures of different sizes or of more than 33 million pixels, and for radiance against encoded values.
pub fn compare(
    picture: &Picture,
    reference: &Picture,
    progress: &dyn Fn(usize, usize),
) -> Result<Comparison> {
    let ([w, h], [w2, h2]) = (picture.size(), reference.size());
    if [w, h] != [w2, h2] {
        let message = format!(
            "the pictures have different sizes, {w}x{h} and {w2}x{h2}: render both with the same --size"
        );
        return Err(Error::Usage(message));
    }
    if u64::from(w) * u64::from(h) > MOST_PIXELS {
        let message =
            format!("{w}x{h}: pictures of at most {MOST_PIXELS} pixels are compared: crop them");
        return Err(Error::Usage(message));
    }
    if picture.values() != reference.values() {
        let message = "one picture is radiance (EXR, HDR), the other is encoded for a screen: compare two of a kind";
        return Err(Error::Usage(message.into()));
    }
    let (a, b) = (picture.numbers(), reference.numbers());
    let of_numbers = Metrics {
        rmse: difference::rmse(&a, &b),
        relative_rmse: Some(relative_rmse(&a, &b)).filter(|error| error.is_finite()),
        mae: difference::mae(&a, &b),
        mean_a: difference::mean(&a),
        mean_b: difference::mean(&b),
        psnr: None,
        ssim: None,
        flip: 0.0,
    };
    let (a, b) = match reference.values() {
        Values::Encoded => (a, b),
        // The same exposure for both: a picture that is too bright shall be seen to be.
        Values::Radiance => {
            let exposure = reference.exposure();
            (picture.encoded(exposure), reference.encoded(exposure))
        }
    };
    let psnr = difference::psnr(&a, &b);
    let ssim = ssim::ssim(&a, &b, [w, h]);
    drop((a, b));
    let map = match reference.values() {
        Values::Encoded => flip::ldr(picture.linear(), reference.linear(), [w, h]),
        Values::Radiance => flip::hdr(picture.linear(), reference.linear(), [w, h], progress),
    };
    let metrics = Metrics { psnr, ssim, flip: map.mean(), ..of_numbers };
    Ok(Comparison { metrics, map })
}
