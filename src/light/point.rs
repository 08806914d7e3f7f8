//! A point that radiates equally in all directions.
//!
//! Source: pbrt 4th ed., section 12.2. A delta light: a surface facing it at distance d receives
//! intensity / d^2.

use super::{LightSample, checked_color, checked_position};
use crate::error::Result;
use crate::math::{DVec3, Rgb, Vec3};
use std::f32::consts::PI;

/// Isotropic point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: Vec3,
    intensity: Rgb,
}

impl PointLight {
    /// A light at `position`, relative to the world origin, of radiant intensity `intensity` (power per
    /// steradian). Errors when a number is not finite or the intensity is negative.
    pub fn new(position: DVec3, intensity: Rgb) -> Result<Self> {
        Ok(Self {
            position: checked_position(position, "the position of a point light")?,
            intensity: checked_color(intensity, "the intensity of a point light")?,
        })
    }

    /// The one direction to it; `None` at the light itself.
    #[inline]
    pub fn sample(&self, point: Vec3) -> Option<LightSample> {
        toward(self.position, point).map(|(direction, distance)| LightSample {
            direction,
            distance,
            radiance: self.intensity / (distance * distance),
            pdf_solid_angle: 1.0,
            is_delta: true,
        })
    }

    /// Luminance of the emitted power: 4 pi intensity.
    pub fn power_estimate(&self) -> f32 {
        4.0 * PI * self.intensity.luminance()
    }
}

/// Unit direction and distance from `point` to `position`; `None` where they cannot be told apart.
#[inline]
pub(super) fn toward(position: Vec3, point: Vec3) -> Option<(Vec3, f32)> {
    let to_light = position - point;
    let distance = to_light.length();
    (distance > 0.0).then(|| (to_light / distance, distance))
}
