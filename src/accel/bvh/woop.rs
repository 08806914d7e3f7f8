//! The watertight edge test of a ray and four triangles.
//!
//! Source: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The ray is sheared
//! onto the z axis; then a triangle is hit where the origin is inside its projection. A corner's projection depends on
//! that corner alone, and an edge function has the same bits for both triangles at an edge, but for the sign. Rounding
//! is monotonic, so the sign of the difference of two rounded products is right or the difference is 0 (without fused
//! multiply-add, which would break that); and 0 counts as inside: no ray passes between two triangles.
//! Their second test, in double precision, is needed only where products leave the range of `f32`.

use super::block::{Block, SIZE};
use crate::math::Vec3;
use bytemuck::{Pod, Zeroable};

/// What is the same for all triangles.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Shear {
    /// Along the axes below.
    pub(super) origin: [f32; 3],
    /// Shear along the first two axes.
    pub(super) shear: [f32; 2],
    /// Axes: the last is the one along which the ray runs most.
    pub(super) axes: [u32; 3],
}

/// Edge functions whose sum is outside of this range may have lost their signs.
pub(super) const TRUSTED: std::ops::RangeInclusive<f32> = 1e-24..=1e36;

impl Shear {
    /// For a ray of non-zero direction.
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        let size = direction.abs();
        let y = u32::from(size.y > size.x);
        let z = if size.z > size.x.max(size.y) { 2 } else { y };
        // Which of the other two is first turns all signs over, which the test does not see.
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][z as usize];
        let along = |values: Vec3, i: usize| values.to_array()[axes[i] as usize];
        let depth = along(direction, 2);
        Self {
            origin: [along(origin, 0), along(origin, 1), along(origin, 2)],
            shear: [along(direction, 0) / depth, along(direction, 1) / depth],
            axes,
        }
    }

    /// The corners of the block along axis `i` of the shear.
    #[inline(always)]
    pub(super) fn along<'a>(&self, corner: &'a [[f32; SIZE]; 3], i: usize) -> &'a [f32; SIZE] {
        &corner[self.axes[i].min(2) as usize]
    }

    /// Whether the ray's line meets the triangle in that lane, whatever its size: with exact products.
    #[cold]
    pub(super) fn is_inside(&self, block: &Block, lane: usize) -> bool {
        let [a, b, c] = &block.corners;
        let project = |corner: &[[f32; SIZE]; 3]| {
            let depth = self.along(corner, 2)[lane] - self.origin[2];
            let flat = |i: usize| {
                f64::from((self.along(corner, i)[lane] - self.origin[i]) - self.shear[i] * depth)
            };
            [flat(0), flat(1)]
        };
        let (a, b, c) = (project(a), project(b), project(c));
        // Products of two `f32` are exact in `f64`, so only the last subtraction rounds.
        let edge = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let is_front = u >= 0.0 && v >= 0.0 && w >= 0.0;
        let is_back = u <= 0.0 && v <= 0.0 && w <= 0.0;
        (is_front || is_back) && u + v + w != 0.0
    }
}
