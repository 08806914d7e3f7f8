//! A latitude-longitude table of colours over the sphere, interpolated bilinearly.
//!
//! Its centre is seen towards -z, its right half towards +x, its top row towards +y. Texel (i, j) is
//! centred on u = (i + 1/2) / width, v = (j + 1/2) / height, with `u = 1/2 + atan2(x, -z) / 2 pi` and
//! `v = acos(y) / pi`. It wraps around in u and is clamped in v.
//!
//! The table is spoken of in *patches*, on which the interpolation is one bilinear function: patch (i, j)
//! lies between texel columns i and i + 1 and rows j - 1 and j, so there are `width` times
//! `height + 1`; the first and the last row reach from the outermost texel centres to a pole.

use crate::math::fun::{self, double};
use crate::math::{Rgb, Vec3};
use std::f64::consts::{PI, TAU};

/// The table.
#[derive(Clone, Debug)]
pub(super) struct LatLong {
    width: usize,
    height: usize,
    /// Row-major from the top left.
    texels: Vec<Rgb>,
}

/// A patch, and where in it a direction falls.
pub(super) struct Place {
    pub(super) column: usize,
    pub(super) row: usize,
    /// Fraction of the way from the patch's left edge to its right one, in [0, 1].
    pub(super) s: f32,
    /// Fraction of the way from its upper edge to its lower one, by angle, in [0, 1].
    t: f32,
}

impl LatLong {
    /// A table of `width * height` texels, both at least 1.
    pub(super) fn new(texels: Vec<Rgb>, width: usize) -> Self {
        Self { width, height: texels.len() / width, texels }
    }

    /// Patches a row, and rows of them.
    pub(super) fn patches(&self) -> [usize; 2] {
        [self.width, self.height + 1]
    }

    /// cos(theta) of the upper and the lower edge of each row of patches.
    pub(super) fn row_edges(&self) -> Vec<[f64; 2]> {
        let edge =
            |j: usize| double::cos((PI * (j as f64 - 0.5) / self.height as f64).clamp(0.0, PI));
        (0..=self.height).map(|j| [edge(j), edge(j + 1)]).collect()
    }

    /// The texels at a patch's corners: upper left, upper right, lower left, lower right.
    #[inline]
    pub(super) fn corners(&self, column: usize, row: usize) -> [Rgb; 4] {
        let right = if column + 1 == self.width { 0 } else { column + 1 };
        let upper = row.saturating_sub(1) * self.width;
        let lower = row.min(self.height - 1) * self.width;
        [upper + column, upper + right, lower + column, lower + right].map(|i| self.texels[i])
    }

    /// Where the unit vector `d` falls.
    #[inline]
    pub(super) fn place(&self, d: Vec3) -> Place {
        let u = 0.5 + fun::atan2(d.x, -d.z) * (1.0 / TAU) as f32;
        // By the tangent: an arccosine would lose half its digits at the poles.
        let v = fun::atan2((d.x * d.x + d.z * d.z).sqrt(), d.y) * (1.0 / PI) as f32;
        let (x, y) = (u * self.width as f32 - 0.5, v * self.height as f32 - 0.5);
        let (left, above) = (x.floor(), y.floor());
        Place {
            column: if left < 0.0 { self.width - 1 } else { (left as usize).min(self.width - 1) },
            row: ((above + 1.0) as usize).min(self.height),
            s: x - left,
            t: y - above,
        }
    }

    /// Unit vector at longitude (`column` + `s`) of the patches, at the given polar angle.
    #[inline]
    pub(super) fn direction(&self, column: usize, s: f32, cos_theta: f64) -> Vec3 {
        let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt() as f32;
        // The left edge, u = 0, is seen towards +z.
        let (sin, cos) = fun::sin_cos_turns((column as f32 + 0.5 + s) / self.width as f32);
        Vec3::new(-sin_theta * sin, cos_theta as f32, sin_theta * cos)
    }

    /// The interpolated colour.
    #[inline]
    pub(super) fn lookup(&self, place: &Place) -> Rgb {
        let [a, b, c, d] = self.corners(place.column, place.row);
        a.lerp(b, place.s).lerp(c.lerp(d, place.s), place.t)
    }
}
