//! A point that radiates into a cone with a soft rim.
//!
//! Source: pbrt 4th ed., section 12.2.1: the falloff is a smooth step in the cosine of the angle, so
//! the power has a closed form. A delta light.

use super::point::toward;
use super::{LightSample, checked_color, checked_direction, checked_position};
use crate::error::{Error, Result};
use crate::math::fun::double;
use crate::math::{DVec3, Rgb, Vec3};
use std::f32::consts::PI;

/// Spotlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    position: Vec3,
    /// Unit, away from the light.
    axis: Vec3,
    intensity: Rgb,
    /// 1 - cos of the half-angle up to which it is fully bright.
    inner: f32,
    /// 1 - cos of the half-angle beyond which it is dark.
    outer: f32,
}

impl SpotLight {
    /// A light at `position`, relative to the world origin, shining along `direction` (any length) with
    /// radiant intensity `intensity` on its axis. `[inner, outer]` are half-angles in degrees, 0 <=
    /// inner <= outer <= 180, outer > 0; anything else is an error.
    pub fn new(
        position: DVec3,
        direction: DVec3,
        intensity: Rgb,
        [inner, outer]: [f64; 2],
    ) -> Result<Self> {
        if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= 180.0) {
            return Err(Error::Scene(format!(
                "a spot light has inner_angle {inner} and outer_angle {outer}; give half-angles in \
                 degrees with 0 <= inner_angle <= outer_angle <= 180 and outer_angle > 0"
            )));
        }
        Ok(Self {
            position: checked_position(position, "the position of a spot light")?,
            axis: checked_direction(direction, "the direction of a spot light")?.as_vec3(),
            intensity: checked_color(intensity, "the intensity of a spot light")?,
            inner: one_minus_cos(inner.to_radians()) as f32,
            outer: one_minus_cos(outer.to_radians()) as f32,
        })
    }

    /// The one direction to it; `None` outside of the cone and at the light itself.
    #[inline]
    pub fn sample(&self, point: Vec3) -> Option<LightSample> {
        let (direction, distance) = toward(self.position, point)?;
        let falloff = self.falloff(-direction);
        (falloff > 0.0).then(|| LightSample {
            direction,
            distance,
            radiance: self.intensity * (falloff / (distance * distance)),
            pdf_solid_angle: 1.0,
            is_delta: true,
        })
    }

    /// Fraction of the intensity that leaves along the unit vector `direction`: 1 within the inner cone,
    /// 0 outside of the outer one.
    #[inline]
    fn falloff(&self, direction: Vec3) -> f32 {
        // Half the squared chord is 1 - cos, and keeps its digits in narrow cones.
        let height = 0.5 * (direction - self.axis).length_squared();
        if height <= self.inner {
            return 1.0;
        }
        if height >= self.outer {
            return 0.0;
        }
        let t = (self.outer - height) / (self.outer - self.inner);
        t * t * (3.0 - 2.0 * t)
    }

    /// Luminance of the emitted power. The smooth step is symmetric, so that its zone counts half:
    /// 2 pi intensity (h_inner + (h_outer - h_inner) / 2), with h = 1 - cos.
    pub fn power_estimate(&self) -> f32 {
        PI * (self.inner + self.outer) * self.intensity.luminance()
    }
}

/// 1 - cos of an angle in radians, without cancellation.
pub(super) fn one_minus_cos(angle: f64) -> f64 {
    let sin = double::sin(0.5 * angle);
    2.0 * sin * sin
}
