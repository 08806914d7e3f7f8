//! Orthographic projection: parallel rays from the plane of the camera's position.

use super::CameraRay;
use super::view::{Basis, checked_size};
use crate::error::{Error, Result};
use crate::geometry::Ray;

/// Orthographic camera without its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orthographic {
    /// Middle of the film, pixels.
    center: [f32; 2],
    /// Edge of a pixel, scene units.
    pixel: f32,
}

impl Orthographic {
    pub(super) fn new(size: [u32; 2], picture_height: f64) -> Result<Self> {
        let [width, height] = checked_size(size)?;
        if !(picture_height > 0.0 && (picture_height as f32).is_finite()) {
            return Err(Error::Scene(format!(
                "the height of the orthographic picture is {picture_height}; give more than 0 scene units"
            )));
        }
        Ok(Self {
            center: [(0.5 * width) as f32, (0.5 * height) as f32],
            pixel: (picture_height / height) as f32,
        })
    }

    #[inline(always)]
    pub(super) fn ray(&self, basis: &Basis, film: [f32; 2]) -> CameraRay {
        let x = (film[0] - self.center[0]) * self.pixel;
        let y = (self.center[1] - film[1]) * self.pixel;
        let origin = basis.origin + basis.right * x + basis.up * y;
        CameraRay { ray: Ray::new(origin, basis.forward), spread: 0.0, initial_width: self.pixel }
    }
}
