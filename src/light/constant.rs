//! The same radiance from every direction.

use super::{LightSample, checked_color};
use crate::error::Result;
use crate::math::{Rgb, Vec3};
use crate::sampling::warp;
use std::f32::consts::PI;

/// Uniform environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantEnvironment {
    radiance: Rgb,
}

impl ConstantEnvironment {
    /// An environment of this radiance; an error when it is negative or not finite.
    pub fn new(radiance: Rgb) -> Result<Self> {
        Ok(Self { radiance: checked_color(radiance, "the radiance of the environment")? })
    }

    /// A uniform direction of the sphere.
    #[inline(always)]
    pub fn sample(&self, u: [f32; 2]) -> LightSample {
        let direction = warp::sphere(u);
        LightSample {
            direction,
            distance: f32::INFINITY,
            radiance: self.radiance(direction),
            pdf_solid_angle: self.pdf_solid_angle(direction),
            is_delta: false,
        }
    }

    /// Radiance seen along a unit vector.
    #[inline]
    pub fn radiance(&self, _direction: Vec3) -> Rgb {
        self.radiance
    }

    /// Density of [`ConstantEnvironment::sample`] per solid angle: 1 / (4 pi).
    #[inline]
    pub fn pdf_solid_angle(&self, _direction: Vec3) -> f32 {
        1.0 / (4.0 * PI)
    }

    /// Luminance of the power through a disc of the scene's radius, over all directions:
    /// 4 pi * pi r^2 radiance.
    pub fn power_estimate(&self, scene_bounding_radius: f32) -> f32 {
        let area = PI * scene_bounding_radius * scene_bounding_radius;
        4.0 * PI * area * self.radiance.luminance()
    }
}
