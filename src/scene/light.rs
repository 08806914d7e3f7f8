//! Lights that are not surfaces, and what surrounds the scene.

use super::ImageId;
use crate::math::{DVec3, Rgb};

/// A light without a surface. Positions and directions are in scene-file coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Radiates equally in all directions from a point.
    Point {
        /// Where.
        position: DVec3,
        /// Radiant intensity (W/sr in whatever unit of power the scene uses).
        intensity: Rgb,
    },
    /// A point light within a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// Axis of the cone, away from the light; any length.
        direction: DVec3,
        /// Radiant intensity within the inner cone.
        intensity: Rgb,
        /// Half-angle beyond which it is dark, degrees.
        outer_angle: f64,
        /// Half-angle up to which it is fully bright, degrees; a smooth step lies between.
        inner_angle: f64,
    },
    /// Light from one direction, or from a disc at infinity around it.
    Directional {
        /// The way the light travels; any length.
        direction: DVec3,
        /// Irradiance on a surface that faces it.
        irradiance: Rgb,
        /// Angular diameter in degrees; 0 gives hard shadows (the sun's is 0.53).
        angular_diameter: f64,
    },
}

/// What rays that leave the scene see, written for a scene whose up is +y ([`super::Scene::up`] turns it):
/// azimuth turns from +z towards +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Environment {
    /// The same radiance everywhere.
    Constant {
        /// Radiance.
        radiance: Rgb,
    },
    /// A latitude-longitude image: its centre is seen towards -z, its top row towards +y.
    Image {
        /// The image.
        image: ImageId,
        /// Multiplies it.
        scale: Rgb,
        /// Rotation about +y, degrees.
        rotation: f64,
    },
    /// Analytic clear sky with a sun disc.
    Sky {
        /// Of the sun above the horizon, degrees.
        elevation: f64,
        /// Of the sun, degrees from +z towards +x.
        azimuth: f64,
        /// Haziness: 2 very clear, 10 hazy.
        turbidity: f64,
        /// Reflectance of the ground seen below the horizon.
        ground_albedo: Rgb,
        /// Multiplies everything.
        scale: f64,
    },
}
