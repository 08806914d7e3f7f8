//! A latitude-longitude image around the scene, sampled in proportion to its luminance.
//!
//! Follows pbrt 4th ed., section 12.5, with two refinements. The cells of the density are not the texels
//! but the patches between texel centres, on which the lookup is bilinear; within a patch the luminance
//! is sampled bilinearly too (ibid., section A.5.3), so a single bright texel is sampled without variance,
//! and the density vanishes only where the radiance does. And the second coordinate within a patch is
//! cos(theta), not theta: a density per solid angle then needs no division by sin(theta), and the poles
//! are not special.

use super::LightSample;
use super::lat_long::{LatLong, Place};
use crate::error::{Error, Result};
use crate::math::fun::double;
use crate::math::{DMat3, DVec3, Rgb, Vec3};
use crate::sampling::PiecewiseConstant2d;
use std::f64::consts::{PI, TAU};

/// Environment given by an image.
#[derive(Clone, Debug)]
pub struct ImageEnvironment {
    image: LatLong,
    /// The image's axes in world space, as columns.
    world_from_image: [Vec3; 3],
    /// Over the patches of the image.
    density: PiecewiseConstant2d,
    /// cos(theta) of the upper and the lower edge of each row of patches.
    edges: Vec<[f64; 2]>,
    /// Integral of the luminance over the sphere.
    luminance_integral: f32,
    repaired_texels: usize,
}

impl ImageEnvironment {
    /// An environment of `texels`, row-major from the top left, `width` a row: the centre of the image is
    /// seen towards the image's -z, its right half towards +x, its top row towards +y. `world_from_image`
    /// must be a rotation; [`orientation`] gives it. Texels that are negative, not finite or above 1e30
    /// become black, channel by channel, and are counted. An error when there is no whole row.
    pub fn new(mut texels: Vec<Rgb>, width: usize, world_from_image: DMat3) -> Result<Self> {
        if width == 0 || texels.is_empty() || !texels.len().is_multiple_of(width) {
            return Err(Error::Scene(format!(
                "an environment image of {} texels, {width} a row, is not a rectangle; give an image \
                 of at least one pixel",
                texels.len()
            )));
        }
        let mut repaired_texels = 0;
        for texel in &mut texels {
            let repaired = texel.map(|c| if (0.0..=1e30).contains(&c) { c } else { 0.0 });
            repaired_texels += usize::from(repaired != *texel);
            *texel = repaired;
        }
        let image = LatLong::new(texels, width);
        let edges = image.row_edges();
        let weights = patch_weights(&image, &edges);
        Ok(Self {
            image,
            world_from_image: [
                world_from_image.x_axis.as_vec3(),
                world_from_image.y_axis.as_vec3(),
                world_from_image.z_axis.as_vec3(),
            ],
            density: PiecewiseConstant2d::new(&weights, width),
            edges,
            luminance_integral: weights.iter().sum::<f64>() as f32,
            repaired_texels,
        })
    }

    /// How many texels were negative, not finite or above 1e30, and became black.
    pub fn repaired_texels(&self) -> usize {
        self.repaired_texels
    }

    /// Radiance seen along the unit vector `direction`.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Rgb {
        self.image.lookup(&self.image.place(self.image_from_world(direction)))
    }

    /// Density of [`ImageEnvironment::sample`] per solid angle.
    #[inline]
    pub fn pdf_solid_angle(&self, direction: Vec3) -> f32 {
        self.radiance_and_pdf(direction).1
    }

    /// [`ImageEnvironment::radiance`] and [`ImageEnvironment::pdf_solid_angle`] for the price of one.
    #[inline]
    pub fn radiance_and_pdf(&self, direction: Vec3) -> (Rgb, f32) {
        let direction = self.image_from_world(direction);
        let place = self.image.place(direction);
        (self.image.lookup(&place), self.pdf_at(direction, &place))
    }

    /// A direction in proportion to the luminance; `None` from a black image.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        // Choose a patch, then a point of it in proportion to the bilinear luminance.
        let [columns, rows] = self.image.patches();
        let ([x, y], _) = self.density.sample(u);
        let (x, y) = (x * columns as f32, y * rows as f32);
        let (column, row) = ((x as usize).min(columns - 1), (y as usize).min(rows - 1));
        let [a, b, c, d] = self.image.corners(column, row).map(Rgb::luminance);
        let t = sample_linear(y - row as f32, a + b, c + d);
        let s = sample_linear(x - column as f32, lerp(a, c, t), lerp(b, d, t));
        let [upper, lower] = self.edges[row];
        let cos_theta = upper + (lower - upper) * f64::from(t);
        let direction = self.world_from_image(self.image.direction(column, s, cos_theta));

        // The rest follows from the direction alone, as it does for a ray that happens to take it.
        let (radiance, pdf_solid_angle) = self.radiance_and_pdf(direction);
        (!radiance.is_black() && pdf_solid_angle > 0.0).then_some(LightSample {
            direction,
            distance: f32::INFINITY,
            radiance,
            pdf_solid_angle,
            is_delta: false,
        })
    }

    /// Luminance of the power through a disc of the scene's radius, over all directions:
    /// pi r^2 times the integral of the radiance over the sphere.
    pub fn power_estimate(&self, scene_bounding_radius: f32) -> f32 {
        PI as f32 * scene_bounding_radius * scene_bounding_radius * self.luminance_integral
    }

    /// The density at `direction`, in image space, which falls on `place`.
    #[inline]
    fn pdf_at(&self, direction: Vec3, place: &Place) -> f32 {
        let &Place { column, row, s, .. } = place;
        let [columns, rows] = self.image.patches().map(|n| n as f32);
        let cell = [(column as f32 + 0.5) / columns, (row as f32 + 0.5) / rows];
        // The patch's probability over its solid angle ...
        let [upper, lower] = self.edges[row];
        let mean = self.density.pdf(cell) / (rows * (TAU * (upper - lower)) as f32);
        // ... times the shape within it. In f64: near a pole, an f32 cosine takes few values.
        let d = direction.as_dvec3();
        let t = ((upper - d.y / d.length()) / (upper - lower)).clamp(0.0, 1.0) as f32;
        let [a, b, c, d] = self.image.corners(column, row).map(Rgb::luminance);
        let sum = a + b + c + d;
        if sum > 0.0 { mean * 4.0 * lerp(lerp(a, b, s), lerp(c, d, s), t) / sum } else { mean }
    }

    #[inline]
    fn world_from_image(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.world_from_image;
        (x * v.x + y * v.y + z * v.z).normalize()
    }

    #[inline]
    fn image_from_world(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.world_from_image;
        Vec3::new(x.dot(v), y.dot(v), z.dot(v))
    }
}

/// The rotation that turns an image whose top is +y so that its top is `up`, and then by `rotation`
/// degrees about `up` (for `up` = +y: from +z towards +x). With `up` = +z the unrotated centre is seen
/// towards +y. A vanishing `up` counts as +y.
pub fn orientation(up: DVec3, rotation: f64) -> DMat3 {
    let y = up.try_normalize().unwrap_or(DVec3::Y);
    let z = DVec3::X.cross(y).try_normalize().unwrap_or(DVec3::Z);
    let tilt = DMat3::from_cols(y.cross(z), y, z);
    let (sin, cos) = (double::sin(rotation.to_radians()), double::cos(rotation.to_radians()));
    tilt * DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos))
}

/// Mean luminance of each patch's corners times its solid angle, row-major: with the shape within the
/// patches, a density that is continuous.
///
/// Where there is any light, a weight is at least 2^-22 of its row's sum, and a row's sum 2^-22 of the
/// whole: no patch vanishes beside the sun when the cumulative distribution is rounded.
fn patch_weights(image: &LatLong, edges: &[[f64; 2]]) -> Vec<f64> {
    let [columns, _] = image.patches();
    let rows: Vec<Vec<f64>> = edges
        .iter()
        .enumerate()
        .map(|(row, [upper, lower])| {
            let solid_angle = TAU * (upper - lower) / columns as f64;
            let weight = |column| {
                let corners = image.corners(column, row).map(|c| f64::from(c.luminance()));
                0.25 * corners.iter().sum::<f64>() * solid_angle
            };
            raised((0..columns).map(weight).collect())
        })
        .collect();
    let sums: Vec<f64> = rows.iter().map(|row| row.iter().sum()).collect();
    let factors: Vec<f64> = raised(sums.clone())
        .into_iter()
        .zip(sums)
        .map(|(raised, sum)| if sum > 0.0 { raised / sum } else { 0.0 })
        .collect();
    rows.into_iter().zip(factors).flat_map(|(row, f)| row.into_iter().map(move |w| w * f)).collect()
}

/// `values`, the positive ones raised to at least 2^-22 of the sum.
fn raised(mut values: Vec<f64>) -> Vec<f64> {
    let floor = values.iter().sum::<f64>() / 4_194_304.0;
    values.iter_mut().filter(|v| **v > 0.0).for_each(|v| *v = v.max(floor));
    values
}

#[inline]
fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

/// A number in [0, 1] whose density runs linearly from `a` at 0 to `b` at 1, up to a factor (pbrt 4th
/// ed., equation A.6); uniform when both are 0.
#[inline]
fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    let sum = a + b;
    if u <= 0.0 || sum <= 0.0 {
        return u;
    }
    let (a, b) = (a / sum, b / sum);
    (u / (a + lerp(a * a, b * b, u).sqrt())).min(1.0)
}
