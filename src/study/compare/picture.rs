//! A picture to compare: linear pixels, and what the numbers of its file meant.

use crate::error::{Error, Result};
use crate::image::{Image, auto_exposure, srgb};
use crate::math::{Rgb, fun};
use rayon::prelude::*;
use std::path::Path;

/// What the numbers of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Light, from 0 without an end.
    Radiance,
    /// sRGB for a screen, 0 to 1.
    Encoded,
}

/// A picture without holes: all its numbers are finite.
#[derive(Clone, Debug)]
pub struct Picture {
    size: [u32; 2],
    values: Values,
    linear: Vec<Rgb>,
}

impl Picture {
    /// The picture of an image that was read from `path`; alpha is ignored.
    ///
    /// # Errors
    /// An image error that names the first pixel that is NaN or infinite.
    pub fn new(image: &Image, values: Values, path: &Path) -> Result<Self> {
        let size @ [width, height] = [image.width(), image.height()];
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let linear: Vec<Rgb> = places.map(|[x, y]| image.texel(x, y).0).collect();
        if let Some(i) = linear.iter().position(|pixel| !pixel.is_finite()) {
            let [x, y] = [i as u32 % width, i as u32 / width];
            let message = format!("pixel {x},{y} is no number: there is no distance from it");
            return Err(Error::image(path, message));
        }
        Ok(Self { size, values, linear })
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What its numbers are.
    pub fn values(&self) -> Values {
        self.values
    }

    pub(super) fn linear(&self) -> &[Rgb] {
        &self.linear
    }

    /// The numbers of the file.
    pub(super) fn numbers(&self) -> Vec<f64> {
        match self.values {
            Values::Radiance => self.channels(f64::from),
            Values::Encoded => self.encoded(0.0),
        }
    }

    /// The exposure in stops that it is seen with.
    pub(super) fn exposure(&self) -> f32 {
        match self.values {
            Values::Radiance => auto_exposure(self.linear.iter().copied()),
            Values::Encoded => 0.0,
        }
    }

    /// What a screen gets: exposed, clipped, encoded to [0, 1].
    pub(super) fn encoded(&self, exposure: f32) -> Vec<f64> {
        let scale = fun::pow(2.0, exposure);
        self.channels(|channel| srgb::encode(f64::from((channel * scale).clamp(0.0, 1.0))))
    }

    /// Something of every channel of every pixel.
    fn channels(&self, f: impl Fn(f32) -> f64 + Sync) -> Vec<f64> {
        let channels: &[f32] = bytemuck::cast_slice(&self.linear);
        channels.par_iter().map(|channel| f(*channel)).collect()
    }
}
