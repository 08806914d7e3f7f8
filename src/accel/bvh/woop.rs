//! The watertight edge test of a ray and four triangles.
//!
//! Source: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The ray is sheared
//! onto the z axis; then a triangle is hit where the origin is inside its projection. Each edge function is
//! computed from its two vertices alone, with the same operations for both triangles at an edge (and opposite
//! signs), so no ray passes between them. Without fused multiply-add, whose single rounding would break that.

use super::blocks::{Block, SIZE};
use crate::math::Vec3;

/// What is the same for all triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    origin: [f32; 3],
    /// Axes: the last is the one along which the ray runs most.
    axes: [usize; 3],
    /// Shear along the first two axes.
    shear: [f32; 2],
}

impl Shear {
    /// For a ray of non-zero direction.
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3) -> Self {
        let size = direction.abs();
        let z = match (size.x >= size.y, size.x >= size.z, size.y >= size.z) {
            (true, true, _) => 0,
            (_, _, true) => 1,
            _ => 2,
        };
        // Which of the other two is first turns all signs over, which the test does not see.
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let shear = [direction[axes[0]] / direction[z], direction[axes[1]] / direction[z]];
        Self { origin: origin.to_array(), axes, shear }
    }

    /// Bit i: whether the ray's line meets triangle i of the block, edges included.
    #[inline(always)]
    pub(super) fn inside(&self, block: &Block) -> u32 {
        let [a, b, c] = &block.corners;
        let (a, b, c) = (self.project(a), self.project(b), self.project(c));
        let mut inside = 0;
        for i in 0..SIZE {
            let (a, b, c) = ([a[0][i], a[1][i]], [b[0][i], b[1][i]], [c[0][i], c[1][i]]);
            let edges = [edge(c, b), edge(a, c), edge(b, a)];
            inside |= u32::from(is_inside(edges)) << i;
        }
        inside
    }

    /// Corners relative to the origin, sheared: x and y.
    #[inline(always)]
    fn project(&self, corner: &[[f32; SIZE]; 3]) -> [[f32; SIZE]; 2] {
        let z = self.axes[2];
        let mut projected = [[0.0; SIZE]; 2];
        for (k, projected) in projected.iter_mut().enumerate() {
            let axis = self.axes[k];
            for (i, value) in projected.iter_mut().enumerate() {
                let depth = corner[z][i] - self.origin[z];
                *value = (corner[axis][i] - self.origin[axis]) - self.shear[k] * depth;
            }
        }
        projected
    }
}

/// The edge function of two projected corners. Products of two `f32` are exact in `f64`, so only the last
/// subtraction rounds, and the sign is right.
#[inline(always)]
fn edge(p: [f32; 2], q: [f32; 2]) -> f64 {
    f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0])
}

/// Whether all edge functions have one sign, and not all are 0. False for NaN.
#[inline(always)]
fn is_inside([u, v, w]: [f64; 3]) -> bool {
    let is_front = (u >= 0.0) & (v >= 0.0) & (w >= 0.0);
    let is_back = (u <= 0.0) & (v <= 0.0) & (w <= 0.0);
    (is_front | is_back) & (u + v + w != 0.0)
}
