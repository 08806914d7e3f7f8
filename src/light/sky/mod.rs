//! A clear sky with a sun disc, computed from the atmosphere once and stored as a table.
//!
//! The table is a latitude-longitude image of the sky without the sun's disc, which is a directional light
//! of its own; what is seen is their sum. Below the horizon lies a ground of constant radiance.

mod atmosphere;
mod scattering;
mod spectrum;

use super::{DirectionalLight, ImageEnvironment, checked_color, orientation};
use crate::error::{Error, Result};
use crate::math::fun::double;
use crate::math::{DVec3, Rgb};
use atmosphere::{Atmosphere, GROUND, Path};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use scattering::Scattering;
use spectrum::Bands;
use std::f64::consts::PI;

/// Luminance of the sun's irradiance above the atmosphere, in the units of the sky's radiance. With
/// turbidity 3 and the sun at 60 degrees, a white diffuse horizontal surface then has radiance 1.
const SOLAR_CONSTANT: f32 = 4.0;
/// Of the sun, degrees.
const ANGULAR_DIAMETER: f64 = 0.53;
/// Size of the table: the radiance varies faster with height than with azimuth.
const WIDTH: usize = 128;
const HEIGHT: usize = 256;

/// What a sky depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyParameters {
    /// Of the sun above the horizon, degrees in [-90, 90]; dusk below 0.
    pub elevation: f64,
    /// Of the sun, degrees about `up`; with `up` = +y, from +z towards +x.
    pub azimuth: f64,
    /// Haziness, in [1, 10]: 2 very clear, 10 hazy.
    pub turbidity: f64,
    /// Reflectance of the ground below the horizon.
    pub ground_albedo: Rgb,
    /// Multiplies everything; at 1, a white diffuse horizontal surface has a radiance of order 1 at noon.
    pub scale: f64,
    /// Towards the zenith.
    pub up: DVec3,
}

/// The sky without the sun, and the sun.
#[derive(Clone, Debug)]
pub struct Sky {
    /// Sky and ground.
    pub environment: ImageEnvironment,
    /// A disc of 0.53 degrees, reddened and dimmed by the air before it; black when below the horizon.
    pub sun: DirectionalLight,
}

impl Sky {
    /// The sky of these parameters; an error says which is out of range.
    pub fn new(parameters: &SkyParameters) -> Result<Self> {
        let &SkyParameters { elevation, azimuth, turbidity, ground_albedo, scale, up } = parameters;
        let ground_albedo = checked_color(ground_albedo, "the ground albedo of the sky")?;
        let in_range = (-90.0..=90.0).contains(&elevation)
            && azimuth.is_finite()
            && (1.0..=10.0).contains(&turbidity)
            && ground_albedo.max_channel() <= 1.0
            && (0.0..1e9).contains(&scale);
        if !in_range {
            return Err(Error::Scene(format!(
                "the sky has elevation {elevation}, azimuth {azimuth}, turbidity {turbidity}, ground \
                 albedo up to {} and scale {scale}; give an elevation from -90 to 90 degrees, any \
                 azimuth, a turbidity from 1 to 10, an albedo from 0 to 1 and a scale from 0 to 1e9",
                ground_albedo.max_channel()
            )));
        }
        let atmosphere = Atmosphere::new(turbidity);
        let elevation = elevation.to_radians();
        let (sin_elevation, cos_elevation) = (double::sin(elevation), double::cos(elevation));
        let sunlight = spectrum::sunlight();
        let color = |bands: Bands| {
            let sum = bands.iter().zip(sunlight).fold(Rgb::BLACK, |sum, (b, c)| sum + c * *b);
            // A saturated red lies outside of Rec. 709.
            sum.map(|c| c.max(0.0)) * (SOLAR_CONSTANT * scale as f32)
        };

        // Rows from the zenith to the horizon, with the sun in the middle of each. Its two sides are mirror
        // images: one is computed, from the sun outwards.
        let scattering = Scattering::new(&atmosphere, ground_albedo.luminance(), elevation);
        let half_row = |row: usize| -> Vec<Rgb> {
            let theta = (row as f64 + 0.5) / HEIGHT as f64 * PI;
            let (sin_theta, cos_theta) = (double::sin(theta), double::cos(theta));
            let radiance = |column: usize| {
                let azimuth = (column as f64 + 0.5) / WIDTH as f64 * 2.0 * PI;
                let across = sin_theta * cos_elevation * double::cos(azimuth);
                color(scattering.radiance(&Path {
                    radius: GROUND,
                    cos_zenith: cos_theta,
                    cos_sun: sin_elevation,
                    cos_between: cos_theta * sin_elevation + across,
                }))
            };
            (0..WIDTH / 2).map(radiance).collect()
        };
        let rows: Vec<Vec<Rgb>> = (0..HEIGHT / 2).into_par_iter().map(half_row).collect();

        // The ground, lit by both.
        let sun_irradiance = if sin_elevation > 0.0 {
            color(atmosphere.sun_transmittance(GROUND, sin_elevation))
        } else {
            Rgb::BLACK
        };
        let irradiance = sun_irradiance * sin_elevation as f32 + horizontal_irradiance(&rows);
        let ground = ground_albedo.zip(irradiance, |albedo, e| albedo * e / PI as f32);

        let mut texels: Vec<Rgb> =
            rows.iter().flat_map(|row| row.iter().rev().chain(row)).copied().collect();
        texels.resize(WIDTH * HEIGHT, ground);
        // The middle of an unrotated image is seen at azimuth 180.
        let world_from_image = orientation(up, azimuth + 180.0);
        let to_sun = world_from_image * DVec3::new(0.0, sin_elevation, -cos_elevation);
        Ok(Self {
            environment: ImageEnvironment::new(texels, WIDTH, world_from_image)?,
            sun: DirectionalLight::new(-to_sun, sun_irradiance, ANGULAR_DIAMETER)?,
        })
    }
}

/// Irradiance on the ground of a sky given by one half of each of its rows.
fn horizontal_irradiance(rows: &[Vec<Rgb>]) -> Rgb {
    rows.iter().enumerate().fold(Rgb::BLACK, |irradiance, (row, half)| {
        let theta = (row as f64 + 0.5) / HEIGHT as f64 * PI;
        let solid_angle = 2.0 * PI * PI / (WIDTH * HEIGHT) as f64 * double::sin(theta);
        let sum = half.iter().fold(Rgb::BLACK, |sum, &radiance| sum + radiance);
        irradiance + sum * (2.0 * solid_angle * double::cos(theta)) as f32
    })
}
