//! Latitude-longitude projection: every direction once.
//!
//! Columns turn by equal angles about `up`, the middle one towards the view; rows descend by equal angles
//! from `up`, made perpendicular to the view, to its opposite.

use super::CameraRay;
use super::view::{Basis, checked_size};
use crate::error::Result;
use crate::geometry::Ray;
use crate::math::fun;
use std::f64::consts::PI;

/// Panoramic camera without its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panoramic {
    /// Pixels for a full turn.
    width: f32,
    /// Pixels for a half turn.
    height: f32,
    /// Solid angle of a pixel on the horizon.
    solid_angle: f32,
}

impl Panoramic {
    pub(super) fn new(size: [u32; 2]) -> Result<Self> {
        let [width, height] = checked_size(size)?;
        let solid_angle = (2.0 * PI / width) * (PI / height);
        Ok(Self { width: width as f32, height: height as f32, solid_angle: solid_angle as f32 })
    }

    #[inline(always)]
    pub(super) fn ray(&self, basis: &Basis, [x, y]: [f32; 2]) -> CameraRay {
        // Beyond the left and right edges the panorama goes on around; beyond a pole, on its other side.
        let (sin_azimuth, cos_azimuth) = fun::sin_cos_turns(x / self.width - 0.5);
        let (sin_theta, cos_theta) = fun::sin_cos_turns(0.5 * y / self.height);
        let direction = (basis.right * sin_azimuth + basis.forward * cos_azimuth) * sin_theta
            + basis.up * cos_theta;
        CameraRay {
            ray: Ray::new(basis.origin, direction.normalize()),
            spread: (self.solid_angle * sin_theta.abs()).sqrt(),
            initial_width: 0.0,
        }
    }
}
