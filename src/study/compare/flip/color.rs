//! Colours: an opponent space that is linear in light, for filters, and one in which distances are seen.
//!
//! Source: sections 4.1.1 to 4.1.3 of the paper. The primaries are those of Rec. 709, white is D65.

use crate::math::{Rgb, fun};
use crate::study::compare::field::Field;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Exponent of colour distances, and how the part of them below `KNEE` of the largest is stretched to `STRETCHED`.
const EXPONENT: f32 = 0.7;
const KNEE: f64 = 0.4;
const STRETCHED: f64 = 0.95;

/// The way from linear sRGB to XYZ relative to white, and back.
pub(super) struct Space {
    xyz_from_rgb: DMat3,
    rgb_from_xyz: DMat3,
    /// Between blue and green, the largest distance.
    farthest: f64,
}

impl Space {
    pub(super) fn new() -> Self {
        let color = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
        let primaries = DMat3::from_cols(color(0.64, 0.33), color(0.30, 0.60), color(0.15, 0.06));
        let white = color(0.3127, 0.3290);
        // The primaries' shares add up to white, whose coordinates are the unit.
        let shares = primaries.inverse() * white;
        let to_xyz = primaries * DMat3::from_diagonal(shares);
        let xyz_from_rgb = DMat3::from_diagonal(white.recip()) * to_xyz;
        let mut space = Self { xyz_from_rgb, rgb_from_xyz: xyz_from_rgb.inverse(), farthest: 0.0 };
        let [green, blue] = [DVec3::Y, DVec3::Z].map(|rgb| space.seen(rgb));
        space.farthest = distance(green, blue);
        space
    }

    /// Luminance and two differences of colours, all linear in light, of pixels in [0, 1].
    ///
    /// (The paper's Y, Cx and Cz but for constant factors and offsets, which the filters keep.)
    pub(super) fn opponent(&self, pixels: &[Rgb], size: [u32; 2]) -> [Field; 3] {
        let plane = |component: fn(DVec3) -> f64| {
            let xyz = |pixel: &Rgb| {
                self.xyz_from_rgb * DVec3::from_array(pixel.to_array().map(f64::from))
            };
            Field::new(size, pixels.par_iter().map(|pixel| component(xyz(pixel))).collect())
        };
        [plane(|xyz| xyz.y), plane(|xyz| xyz.x - xyz.y), plane(|xyz| xyz.y - xyz.z)]
    }

    /// How far the colours of two pictures in the opponent space are from each other, 0 to 1.
    pub(super) fn differences(&self, a: &[Field; 3], b: &[Field; 3], size: [u32; 2]) -> Field {
        let seen = |planes: &[Field; 3], i: usize| {
            let [y, red_green, yellow_blue] = planes.each_ref().map(|plane| plane.values()[i]);
            let xyz = DVec3::new(y + red_green, y, y - yellow_blue);
            self.seen((self.rgb_from_xyz * xyz).clamp(DVec3::ZERO, DVec3::ONE))
        };
        let difference = |i| self.stretched(distance(seen(a, i), seen(b, i)));
        let pixels = 0..a[0].values().len();
        Field::new(size, pixels.into_par_iter().map(difference).collect())
    }

    /// CIE L*a*b* of linear sRGB in [0, 1], with colours the weaker the darker they are (Hunt's effect).
    fn seen(&self, rgb: DVec3) -> DVec3 {
        const DELTA: f64 = 6.0 / 29.0;
        let lightness = |t: f64| match t > DELTA * DELTA * DELTA {
            true => f64::from(fun::pow(t as f32, 1.0 / 3.0)),
            false => t / (3.0 * DELTA * DELTA) + 4.0 / 29.0,
        };
        let [x, y, z] = (self.xyz_from_rgb * rgb).to_array().map(lightness);
        let l = 116.0 * y - 16.0;
        DVec3::new(l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z))
    }

    /// A distance between 0 and the farthest as one between 0 and 1.
    fn stretched(&self, distance: f64) -> f64 {
        let knee = KNEE * self.farthest;
        if distance < knee {
            return distance * STRETCHED / knee;
        }
        STRETCHED + (1.0 - STRETCHED) * (distance - knee) / (self.farthest - knee)
    }
}

/// City blocks in lightness and a straight line in colour (HyAB), compressed.
fn distance(a: DVec3, b: DVec3) -> f64 {
    let d = a - b;
    f64::from(fun::pow((d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()) as f32, EXPONENT))
}
