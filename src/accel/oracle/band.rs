//! How near to an edge a ray must pass for the in-house kernel to be excused for taking the wrong side.
//!
//! The kernel of `bvh` (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013) projects corners
//! along the ray onto a plane, in `f32`, and decides the rest nearly exactly. So it judges a triangle whose projected
//! corners are slightly off. With u = 2^-24, (X, Y, Z) a corner less the origin, z the axis of
//! the largest direction, S = d_x / d_z (|S| <= 1), it computes
//! ```text
//! x = (X (1+u) - S (1+u) Z (1+u) (1+u)) (1+u)      each (1+u) a rounding: |error| <= 2u |X| + 4u |S Z| <= 6u M
//! ```
//! plus terms in u^2 and 2^-150 for a product that is subnormal; M is the corner's largest coordinate relative
//! to the origin. The same holds for y: **a projected corner is off by at most 6 ulps of M on each axis**.
//!
//! Under an instance it works in the space of the object. The ray that it uses has been rounded to `f32` after
//! a map in `f64`: the origin is off by u |o|, seen along the ray by 2u |o|; S by two more roundings, 2u |S Z|. Together
//! **8 ulps of M and 2 ulps of the largest coordinate of the origin there**. The map, its inverse and that of the
//! corners to the world round to 53 bits; that counts where a map squeezes a thousandfold or places something
//! small far away, and is bounded for the ray at hand (`KernelRay::in_object`).
//!
//! What remains is the sign of p_x q_y - p_y q_x, and that is exact.
//!
//! Now move the corners steadily from where they are to where the kernel puts them. If the ray is inside before
//! and outside after, or the other way round, some edge has passed over it. That edge's ends have moved by
//! no more than their bounds, and its points no more than the larger one: **the ray passes within
//! the bound of one of the edges**, distances taken as the larger of the two coordinates (the norm in which the bound
//! is one). Rays farther from all edges are decided rightly.

use super::placed::Placement;
use super::tree::Bounds;
use crate::geometry::Ray;
use crate::math::{DMat3, DVec3, UNIT_ROUNDOFF, Vec3};

/// How far from an edge a ray passes, projected along the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeDistance {
    /// In ulps (2^-24) of the largest coordinate of the edge's ends relative to the ray's origin, both in the space
    /// of the mesh.
    pub ulps: f64,
    /// How many of them the rounding of the in-house kernel can be worth: 6, and 8 or more under an instance.
    pub band: f64,
}

impl EdgeDistance {
    /// The distance as a part of the band: at most 1 if rounding is an excuse.
    pub fn ratio(&self) -> f64 {
        self.ulps / self.band
    }

    /// Whether rounding is an excuse.
    pub fn is_in_band(&self) -> bool {
        self.ulps <= self.band
    }
}

/// A ray as the kernel would have it if it did not round: in the space of the meshes.
pub(super) struct KernelRay {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// The bound of what a projected corner is off: `per_size` times its largest coordinate, plus `fixed`.
    per_size: f64,
    fixed: f64,
}

const U: f64 = UNIT_ROUNDOFF as f64;
/// For terms in u^2 and the rounding of the distances here, a share of the constants above.
const MORE: f64 = 1.001;
/// Smallest positive `f32`.
const SUBNORMAL: f64 = f32::from_bits(1) as f64;
/// 16 units of round-off of `f64`: twice more than four operations in a row, and the terms of second order.
const MAPPED: f64 = 8.0 * f64::EPSILON;
/// From here on the kernel's coordinates may overflow.
const LARGEST: f64 = f32::MAX as f64 / 4.0;

impl KernelRay {
    /// Towards meshes that stand in the world.
    pub(super) fn in_world(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.as_dvec3(),
            direction: ray.direction.as_dvec3(),
            per_size: 6.0 * MORE * U,
            fixed: SUBNORMAL,
        }
    }

    /// Towards the object of an instance.
    ///
    /// How far the mapped origin and direction are off is measured: with L the linear part of the map, T its translation
    /// and L' the inverse as computed, the direction d' = L' d is off by L^-1 (d - L d'), and the origin likewise. That
    /// residual, and what its own rounding hides, is bounded here coordinate by coordinate.
    pub(super) fn in_object(ray: &Ray, placement: &Placement) -> Self {
        let Placement { world_from_object: map, object_from_world: inverse, .. } = placement;
        let (world, towards) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let origin = inverse.transform_point3(world);
        let direction = inverse.transform_vector3(towards);
        let (linear, back) = (absolute(&map.matrix3), absolute(&inverse.matrix3));
        // Twice, since L^-1 itself is known as L' only.
        let off = |residual: DVec3, terms: DVec3| {
            2.0 * (back * (residual.abs() + terms * MAPPED)).max_element()
        };
        let translation = map.translation.abs();
        let origin_off = off(
            world - map.transform_point3(origin),
            linear * origin.abs() + translation + world.abs(),
        );
        let direction_off = off(
            towards - map.transform_vector3(direction),
            linear * direction.abs() + towards.abs(),
        );
        // Corners in the world are off by `MAPPED` of |L p| + |T|, where |p| is at most |o| + M.
        let size = origin.abs().max_element();
        let stretch = MAPPED * (back * (linear * DVec3::ONE)).max_element();
        let translated = MAPPED * (back * translation).max_element();
        let turned = (direction_off + SUBNORMAL) / direction.abs().max_element();
        Self {
            origin,
            direction,
            per_size: 8.0 * MORE * U + 2.0 * MORE * turned + 2.0 * stretch,
            fixed: 3.0 * SUBNORMAL
                + 2.0 * MORE * (U * size + origin_off)
                + 2.0 * (stretch * size + translated),
        }
    }

    /// How far the line passes from each edge of a triangle: from that opposite of its first corner, and so on.
    pub(super) fn edge_distances(&self, corners: [Vec3; 3]) -> [EdgeDistance; 3] {
        let [a, b, c] = corners.map(|p| p.as_dvec3() - self.origin);
        [(b, c), (c, a), (a, b)].map(|(p, q)| {
            let size = p.abs().max(q.abs()).max_element();
            // Not 0 where both ends are the origin.
            let ulp = (U * size).max(SUBNORMAL);
            let ulps = self.segment_distance(p, q) / ulp;
            let band = (self.per_size * size + self.fixed) / ulp;
            EdgeDistance { ulps, band: if size < LARGEST { band } else { f64::INFINITY } }
        })
    }

    /// A box around all points whose edges the line passes in the band, if it was one around the corners.
    pub(super) fn padded(&self, bounds: &Bounds) -> Bounds {
        let size = (bounds.low - self.origin).abs().max((bounds.high - self.origin).abs());
        bounds.padded(DVec3::splat(self.per_size * size.max_element() + self.fixed))
    }

    /// The distance of the line from the segment between two points relative to the origin, seen along the line.
    fn segment_distance(&self, p: DVec3, q: DVec3) -> f64 {
        let d = self.direction;
        // Where two axes are as large as each other, rounding decides along which one the kernel looks.
        let least = d.abs().max_element() * (1.0 - 8.0 * U);
        (0..3)
            .filter(|&z| d[z].abs() >= least)
            .map(|z| {
                let project = |v: DVec3| {
                    let axis = |k: usize| v[k % 3] - d[k % 3] / d[z] * v[z];
                    [axis(z + 1), axis(z + 2)]
                };
                distance_from_zero(project(p), project(q))
            })
            .fold(f64::INFINITY, f64::min)
    }
}

/// The same map of absolute values.
fn absolute(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// The distance of (0, 0) from a segment, as the larger of the two coordinates.
///
/// Along the segment that is a convex function of straight pieces, so it is smallest at an end or where pieces
/// meet: where a coordinate is 0 or both are as large as each other.
fn distance_from_zero(p: [f64; 2], q: [f64; 2]) -> f64 {
    let at = |s: f64| {
        let s = s.clamp(0.0, 1.0);
        let coordinate = |k: usize| (p[k] + (q[k] - p[k]) * s).abs();
        coordinate(0).max(coordinate(1))
    };
    let root = |from: f64, to: f64| if from == to { 0.0 } else { from / (from - to) };
    let meeting = [
        root(p[0], q[0]),
        root(p[1], q[1]),
        root(p[0] - p[1], q[0] - q[1]),
        root(p[0] + p[1], q[0] + q[1]),
    ];
    let ends = p[0].abs().max(p[1].abs()).min(q[0].abs().max(q[1].abs()));
    meeting.into_iter().map(at).fold(ends, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_a_segment() {
        for (p, q, expected) in [
            ([1.0, 0.0], [3.0, 0.0], 1.0),
            ([-1.0, 0.5], [3.0, 0.5], 0.5),
            ([2.0, 0.0], [0.0, 2.0], 1.0),
            ([3.0, -1.0], [-1.0, 3.0], 1.0),
            ([3.0, -5.0], [3.0, -7.0], 5.0),
            ([4.0, 1.0], [2.0, 1.0], 2.0),
            ([-1.0, -2.0], [1.0, 2.0], 0.0),
            ([0.0, 0.0], [0.0, 0.0], 0.0),
            ([6.0, 0.0], [0.0, 3.0], 2.0),
        ] {
            for (p, q) in [(p, q), (q, p)] {
                let swapped = |[x, y]: [f64; 2]| [-y, x];
                assert_eq!(distance_from_zero(p, q), expected, "{p:?} {q:?}");
                assert_eq!(distance_from_zero(swapped(p), swapped(q)), expected, "{p:?} {q:?}");
            }
        }
    }
}
