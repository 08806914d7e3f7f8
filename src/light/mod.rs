//! Lights: what they emit towards a point, and how to choose a direction towards them.
//!
//! Pure functions of directions and points relative to the world origin; nothing here knows the
//! scene, traces a ray or decides visibility. The variant files never import [`Light`].
//!
//! Emissive surfaces are not a variant: their radiance is a material's, and their list belongs to the
//! world. [`triangle`] holds the geometry of sampling one. A [`Sky`] is two lights, an image and a disc.

mod constant;
mod directional;
mod image_environment;
mod kind;
mod lat_long;
mod point;
mod sky;
mod spot;
pub mod triangle;

pub use constant::ConstantEnvironment;
pub use directional::DirectionalLight;
pub use image_environment::{ImageEnvironment, orientation};
pub use kind::LightKind;
pub use point::PointLight;
pub use sky::{Sky, SkyParameters};
pub use spot::SpotLight;

use crate::error::{Error, Result};
use crate::math::{DVec3, Rgb, Vec3};

/// A direction towards a light and what comes from there if nothing is in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit, from the shading point to the light.
    pub direction: Vec3,
    /// How far the light is, in scene units; infinite for environments and directional lights.
    pub distance: f32,
    /// Radiance arriving along `direction`. When `is_delta`: the irradiance on a surface that faces the
    /// light, so that the reflected radiance is `bsdf * cos_theta * radiance` without a division.
    pub radiance: Rgb,
    /// Density per solid angle with which this light chose `direction`, > 0. When `is_delta`: 1, and
    /// meaningless.
    pub pdf_solid_angle: f32,
    /// The light is a point or a single direction: no other strategy can ever find it.
    pub is_delta: bool,
}

/// Every light without a surface.
#[derive(Clone, Debug)]
pub enum Light {
    /// A point that radiates equally in all directions.
    Point(PointLight),
    /// A point that radiates into a cone.
    Spot(SpotLight),
    /// One direction, or a disc at infinity.
    Directional(DirectionalLight),
    /// The same radiance from everywhere.
    Constant(ConstantEnvironment),
    /// A latitude-longitude image around the scene.
    Image(ImageEnvironment),
}

impl Light {
    /// What kind of light it is.
    pub fn kind(&self) -> LightKind {
        match self {
            Self::Point(_) => LightKind::Point,
            Self::Spot(_) => LightKind::Spot,
            Self::Directional(light) if light.is_delta() => LightKind::Direction,
            Self::Directional(_) => LightKind::Disc,
            Self::Constant(_) => LightKind::Constant,
            Self::Image(_) => LightKind::Image,
        }
    }

    /// A direction from `point` to the light, chosen by a uniform point of the square; `None` where the
    /// light sends nothing.
    #[inline(always)]
    pub fn sample(&self, point: Vec3, u: [f32; 2]) -> Option<LightSample> {
        match self {
            Self::Point(light) => light.sample(point),
            Self::Spot(light) => light.sample(point),
            Self::Directional(light) => light.sample(u),
            Self::Constant(light) => Some(light.sample(u)),
            Self::Image(light) => light.sample(u),
        }
    }

    /// Radiance seen by a ray that leaves the scene along the unit vector `direction`; black for lights
    /// that are at a finite distance or a delta.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Rgb {
        match self {
            Self::Point(_) | Self::Spot(_) => Rgb::BLACK,
            Self::Directional(light) => light.radiance(direction),
            Self::Constant(light) => light.radiance(direction),
            Self::Image(light) => light.radiance(direction),
        }
    }

    /// Density per solid angle with which [`Light::sample`] chooses the unit vector `direction`; 0 for
    /// delta lights.
    #[inline]
    pub fn pdf_solid_angle(&self, direction: Vec3) -> f32 {
        match self {
            Self::Point(_) | Self::Spot(_) => 0.0,
            Self::Directional(light) => light.pdf_solid_angle(direction),
            Self::Constant(light) => light.pdf_solid_angle(direction),
            Self::Image(light) => light.pdf_solid_angle(direction),
        }
    }

    /// [`Light::radiance`] and [`Light::pdf_solid_angle`], with their common part done once.
    #[inline]
    pub fn radiance_and_pdf(&self, direction: Vec3) -> (Rgb, f32) {
        match self {
            Self::Image(light) => light.radiance_and_pdf(direction),
            light => (light.radiance(direction), light.pdf_solid_angle(direction)),
        }
    }

    /// Whether only light sampling can find this light.
    pub fn is_delta(&self) -> bool {
        self.kind().is_delta()
    }

    /// Whether rays that leave the scene can see this light.
    pub fn is_seen_at_infinity(&self) -> bool {
        !self.is_delta()
    }

    /// Luminance of the power that reaches a scene of the given bounding radius, for choosing lights in
    /// proportion to it: what a local light emits in all directions; for a light at infinity, what
    /// crosses a disc of that radius, integrated over its directions.
    pub fn power_estimate(&self, scene_bounding_radius: f32) -> f32 {
        match self {
            Self::Point(light) => light.power_estimate(),
            Self::Spot(light) => light.power_estimate(),
            Self::Directional(light) => light.power_estimate(scene_bounding_radius),
            Self::Constant(light) => light.power_estimate(scene_bounding_radius),
            Self::Image(light) => light.power_estimate(scene_bounding_radius),
        }
    }
}

/// `value` if each channel is finite and at least 0; `what` names it in the error.
fn checked_color(value: Rgb, what: &str) -> Result<Rgb> {
    if value.is_finite() && value.to_array().iter().all(|&c| c >= 0.0) {
        return Ok(value);
    }
    Err(Error::Scene(format!(
        "{what} is ({}, {}, {}); give three finite numbers of at least 0",
        value.r, value.g, value.b
    )))
}

/// `direction` scaled to length 1; `what` names it in the error.
fn checked_direction(direction: DVec3, what: &str) -> Result<DVec3> {
    direction.try_normalize().ok_or_else(|| {
        Error::Scene(format!(
            "{what} is ({}, {}, {}); give three finite numbers that are not all 0",
            direction.x, direction.y, direction.z
        ))
    })
}

/// `position` in `f32`; `what` names it in the error.
fn checked_position(position: DVec3, what: &str) -> Result<Vec3> {
    let rounded = position.as_vec3();
    if rounded.is_finite() {
        return Ok(rounded);
    }
    Err(Error::Scene(format!(
        "{what} is ({}, {}, {}); give three finite numbers",
        position.x, position.y, position.z
    )))
}
