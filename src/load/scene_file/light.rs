//! `[[light.KIND]]` and `[environment.KIND]`: light that does not come from surfaces.

use super::source::{Source, exactly_one};
use super::value::{
    Color, ConeAngle, Degrees, Direction, Elevation, Factor, Fraction, NonNegative, OuterAngle,
    Point, Turbidity,
};
use crate::error::{Location, Result};
use crate::load::Surroundings;
use crate::math::Rgb;
use crate::scene::{Environment, Light};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// `[light]`: lists by kind.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct LightTables {
    point: Vec<Spanned<PointLight>>,
    spot: Vec<Spanned<Spot>>,
    directional: Vec<Spanned<Directional>>,
}

/// `[[light.point]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointLight {
    position: Point,
    intensity: Color<NonNegative>,
}

/// `[[light.spot]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Spot {
    position: Point,
    direction: Direction,
    intensity: Color<NonNegative>,
    outer_angle: OuterAngle,
    inner_angle: Spanned<ConeAngle>,
}

/// `[[light.directional]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Directional {
    direction: Direction,
    irradiance: Color<NonNegative>,
    #[serde(default = "point_like")]
    angular_diameter: ConeAngle,
}

/// `[environment]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentTable {
    constant: Option<Constant>,
    image: Option<ImageTable>,
    sky: Option<Sky>,
}

/// `[environment.constant]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Constant {
    radiance: Color<NonNegative>,
}

/// `[environment.image]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImageTable {
    file: Spanned<String>,
    #[serde(default = "one")]
    scale: Color<NonNegative>,
    #[serde(default = "unturned")]
    rotation: Degrees,
}

/// `[environment.sky]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Sky {
    elevation: Elevation,
    azimuth: Degrees,
    #[serde(default = "clear_day")]
    turbidity: Turbidity,
    #[serde(default = "dark_ground")]
    ground_albedo: Color<Fraction>,
    #[serde(default = "unscaled")]
    scale: Factor,
}

const fn point_like() -> ConeAngle {
    ConeAngle(0.0)
}

const fn one() -> Color<NonNegative> {
    Color::new(Rgb::WHITE)
}

const fn unturned() -> Degrees {
    Degrees(0.0)
}

const fn clear_day() -> Turbidity {
    Turbidity(3.0)
}

const fn dark_ground() -> Color<Fraction> {
    Color::new(Rgb::splat(0.2))
}

const fn unscaled() -> Factor {
    Factor(1.0)
}

impl LightTables {
    /// The lights for `scene` and where each is defined: points, then spots, then directional ones, each in the
    /// order of the file.
    ///
    /// # Errors
    /// For a spot whose inner cone is wider than its outer one.
    pub(super) fn lights(&self, source: Source) -> Result<Vec<(Light, Location)>> {
        let at = |span| source.location(&span);
        let points = self.point.iter().map(|l| Ok((l.get_ref().light(), at(l.span()))));
        let spots = self.spot.iter().map(|l| Ok((l.get_ref().light(source)?, at(l.span()))));
        let directional = self.directional.iter().map(|l| Ok((l.get_ref().light(), at(l.span()))));
        points.chain(spots).chain(directional).collect()
    }
}

impl PointLight {
    fn light(&self) -> Light {
        Light::Point { position: self.position.vector(), intensity: self.intensity.rgb }
    }
}

impl Spot {
    fn light(&self, source: Source) -> Result<Light> {
        let (outer_angle, inner_angle) = (self.outer_angle.0, self.inner_angle.get_ref().0);
        if inner_angle > outer_angle {
            let message = format!(
                "`inner_angle` {inner_angle} is larger than `outer_angle` {outer_angle}: swap them"
            );
            return Err(source.error(self.inner_angle.span(), message));
        }
        Ok(Light::Spot {
            position: self.position.vector(),
            direction: self.direction.0,
            intensity: self.intensity.rgb,
            outer_angle,
            inner_angle,
        })
    }
}

impl Directional {
    fn light(&self) -> Light {
        Light::Directional {
            direction: self.direction.0,
            irradiance: self.irradiance.rgb,
            angular_diameter: self.angular_diameter.0,
        }
    }
}

/// The kinds of environment.
enum Kind<'t> {
    Constant(&'t Constant),
    Image(&'t ImageTable),
    Sky(&'t Sky),
}

impl EnvironmentTable {
    /// What surrounds the scene; `None` where something else is to take its place: its image is not read.
    ///
    /// # Errors
    /// When there is not exactly one kind, and when the image cannot be read.
    pub(super) fn surroundings(
        &self,
        span: Range<usize>,
        source: Source,
        replaced: bool,
    ) -> Result<Option<Surroundings>> {
        let kind = exactly_one([
            ("constant", self.constant.as_ref().map(Kind::Constant)),
            ("image", self.image.as_ref().map(Kind::Image)),
            ("sky", self.sky.as_ref().map(Kind::Sky)),
        ]);
        let location = source.location(&span);
        let kind =
            kind.map_err(|message| source.error(span, format!("`environment` {message}")))?;
        if replaced {
            return Ok(None);
        }
        let surroundings = match kind {
            Kind::Constant(table) => Surroundings::computed(table.environment()),
            Kind::Image(table) => table.surroundings(source)?,
            Kind::Sky(table) => Surroundings::computed(table.environment()),
        };
        Ok(Some(surroundings.defined_at(location)))
    }
}

impl Constant {
    fn environment(&self) -> Environment {
        Environment::Constant { radiance: self.radiance.rgb }
    }
}

impl ImageTable {
    fn surroundings(&self, source: Source) -> Result<Surroundings> {
        let path = source.resolve(self.file.get_ref());
        Surroundings::image(&path, self.scale.rgb, self.rotation.0)
            .map_err(|error| source.error(self.file.span(), error.to_string()))
    }
}

impl Sky {
    fn environment(&self) -> Environment {
        Environment::Sky {
            elevation: self.elevation.0,
            azimuth: self.azimuth.0,
            turbidity: self.turbidity.0,
            ground_albedo: self.ground_albedo.rgb,
            scale: self.scale.0,
        }
    }
}
