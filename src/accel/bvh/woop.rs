//! The watertight edge test of a ray and some triangles.
//!
//! Source: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The ray is sheared
//! onto the z axis; then a triangle is hit where the origin is inside its projection. A corner's projection depends on
//! that corner alone, and an edge function is, with exact products, the same for both triangles at an edge but for the sign:
//! no ray passes between two triangles. 0 counts as inside.
//!
//! Edge functions are computed in `f32` first. Rounding is monotonic, so the sign of the difference of two rounded
//! products is that of the exact ones, or the difference is 0 (without fused multiply-add, which would break that).
//! Where they are certain, the ray is inside of the true triangle too: with u = 2^-24, and D the largest
//! coordinate of tree and origin together, a projected corner is off by 6u D in each coordinate, 8u D if the ray was mapped into an
//! object. So p_x q_y - p_y q_x is off by 8u D (|p_x| + |p_y| + |q_x| + |q_y|), and by 4u D of the same sum for its own
//! rounding. The rest, edges nearer than 16u D of the sum over all corners, is asked again with exact products;
//! and so is what leaves the range of `f32`.

use super::block::Block;
use crate::math::UNIT_ROUNDOFF;
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
    /// An edge function is certain beyond this times the sum of the sizes of all projected coordinates of its triangle.
    pub(super) error: f32,
}

/// An edge function that is not larger may have lost more to underflow.
pub(super) const SMALLEST: f32 = 1e-36;

/// Beyond it edge functions may overflow.
pub(super) const LARGEST: f32 = 1e36;

impl Shear {
    /// For a ray of non-zero direction. `size` is the sum of the largest coordinates of tree and origin. Of origin and
    /// direction the fourth elements mean nothing.
    #[inline(always)]
    pub(super) fn new(origin: &[f32; 4], direction: &[f32; 4], size: f32) -> Self {
        let (axes, _) = Self::axes(direction);
        let along = |values: &[f32; 4], i: usize| values[axes[i] as usize % 4];
        let depth = along(direction, 2);
        Self {
            origin: [along(origin, 0), along(origin, 1), along(origin, 2)],
            shear: [along(direction, 0) / depth, along(direction, 1) / depth],
            axes,
            error: Self::error(size),
        }
    }

    /// The axes for a direction, and the one along which it is largest.
    #[inline(always)]
    pub(super) fn axes(direction: &[f32; 4]) -> ([u32; 3], usize) {
        let [x, y, z, _] = direction.map(f32::abs);
        let largest = if z > x.max(y) { 2 } else { usize::from(y > x) };
        // Which of the other two is first turns all signs over, which the test does not see.
        const AXES: [[u32; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];
        (AXES[largest], largest)
    }

    /// See the field.
    #[inline(always)]
    pub(super) fn error(size: f32) -> f32 {
        16.0 * UNIT_ROUNDOFF * size
    }

    /// A vertex relative to the origin, sheared.
    #[inline(always)]
    pub(super) fn project(&self, block: &Block, vertex: usize) -> [f32; 2] {
        let along = |i: usize| block.along(self.axes[i] as usize, vertex) - self.origin[i];
        let depth = along(2);
        [0, 1].map(|i| along(i) - self.shear[i] * depth)
    }

    /// Whether the ray's line meets the triangle in that lane, with exact products.
    #[cold]
    pub(super) fn is_inside(&self, block: &Block, lane: usize) -> bool {
        let [a, b, c] = block.numbers(lane).map(|v| self.project(block, v).map(f64::from));
        // Products of two `f32` are exact in `f64`, so only the last subtraction rounds.
        let edge = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let is_front = u >= 0.0 && v >= 0.0 && w >= 0.0;
        let is_back = u <= 0.0 && v <= 0.0 && w <= 0.0;
        (is_front || is_back) && u + v + w != 0.0
    }
}
