//! Light from one direction, or from a uniform disc at infinity around it.
//!
//! A disc of half-angle a and radiance L gives a surface that faces it the irradiance
//! `integral of L cos(theta) = pi L sin^2(a)`; the radiance follows from the irradiance that was asked for.

use super::spot::one_minus_cos;
use super::{LightSample, checked_color, checked_direction};
use crate::error::{Error, Result};
use crate::math::fun::double;
use crate::math::{DVec3, Frame, Rgb, Vec3};
use crate::sampling::warp;
use std::f32::consts::PI;

/// Distant light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Its normal is the unit vector to the centre of the disc.
    frame: Frame,
    irradiance: Rgb,
    /// 1 - cos of the half-angle; 0 for a single direction.
    one_minus_cos: f32,
    /// Of the disc; black for a single direction.
    radiance: Rgb,
}

impl DirectionalLight {
    /// Light that travels along `direction` (any length) and gives a surface that faces it
    /// `irradiance`. `angular_diameter` in degrees, [0, 180]; 0 is a single direction, and so is anything
    /// below 0.001, which `f32` directions do not resolve. Errors when a number is out of range or not
    /// finite.
    pub fn new(direction: DVec3, irradiance: Rgb, angular_diameter: f64) -> Result<Self> {
        if !(0.0..=180.0).contains(&angular_diameter) {
            return Err(Error::Scene(format!(
                "a directional light has angular_diameter {angular_diameter}; give degrees from 0 \
                 (hard shadows) to 180; the sun's is 0.53"
            )));
        }
        let irradiance = checked_color(irradiance, "the irradiance of a directional light")?;
        let axis = -checked_direction(direction, "the direction of a directional light")?;
        let frame = Frame::from_normal(axis.as_vec3());
        if angular_diameter < 1e-3 {
            return Ok(Self { frame, irradiance, one_minus_cos: 0.0, radiance: Rgb::BLACK });
        }
        let half_angle = 0.5 * angular_diameter.to_radians();
        let sin = double::sin(half_angle);
        let projected_solid_angle = (std::f64::consts::PI * sin * sin) as f32;
        Ok(Self {
            frame,
            irradiance,
            one_minus_cos: one_minus_cos(half_angle) as f32,
            radiance: irradiance / projected_solid_angle,
        })
    }

    /// Whether the light comes from a single direction.
    #[inline]
    pub fn is_delta(&self) -> bool {
        self.one_minus_cos == 0.0
    }

    /// Irradiance on a surface that faces the light.
    pub fn irradiance(&self) -> Rgb {
        self.irradiance
    }

    /// A uniform direction to the disc. `None` when rounding carried it over the rim (one in 10^5 for the
    /// sun), so that a sample always agrees with [`DirectionalLight::radiance`].
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        if self.is_delta() {
            return Some(LightSample {
                direction: self.frame.normal,
                distance: f32::INFINITY,
                radiance: self.irradiance,
                pdf_solid_angle: 1.0,
                is_delta: true,
            });
        }
        let direction = self.frame.world_from_local(warp::cone(u, self.one_minus_cos)).normalize();
        self.contains(direction).then(|| LightSample {
            direction,
            distance: f32::INFINITY,
            radiance: self.radiance,
            pdf_solid_angle: warp::cone_pdf(self.one_minus_cos),
            is_delta: false,
        })
    }

    /// Radiance seen along the unit vector `direction`; black for a delta light.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Rgb {
        if self.contains(direction) { self.radiance } else { Rgb::BLACK }
    }

    /// Density of [`DirectionalLight::sample`] per solid angle; 0 for a delta light.
    #[inline]
    pub fn pdf_solid_angle(&self, direction: Vec3) -> f32 {
        if self.contains(direction) { warp::cone_pdf(self.one_minus_cos) } else { 0.0 }
    }

    /// Whether the unit vector `direction` points into the disc: half the squared chord is 1 - cos, and
    /// keeps its digits where a dot product would have lost them.
    #[inline]
    fn contains(&self, direction: Vec3) -> bool {
        !self.is_delta()
            && 0.5 * (direction - self.frame.normal).length_squared() <= self.one_minus_cos
    }

    /// Luminance of the power through a disc of the scene's radius that faces the light:
    /// pi r^2 irradiance.
    pub fn power_estimate(&self, scene_bounding_radius: f32) -> f32 {
        PI * scene_bounding_radius * scene_bounding_radius * self.irradiance.luminance()
    }
}
