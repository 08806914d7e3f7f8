//! A ray prepared for boxes.
//!
//! Boxes are made wider by more than all rounding errors of the box test and of the triangle test behind it: a
//! triangle that the edge test would accept is never missed. With u = 2^-24, origin o, and p the largest coordinate
//! of the tree, both in the largest norm: plane * r - origin * r is off by at most 3u (p + o) |r|, the reciprocal r by
//! u, and the edge test displaces a corner by at most 8u (p + o) (see `woop`). Planes are moved by 16u (p + o).

use super::node::WIDTH;
use crate::math::{UNIT_ROUNDOFF, Vec3};
use bytemuck::{Pod, Zeroable};

/// What boxes need. The fourth elements mean nothing.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(16))]
pub(super) struct BoxRay {
    /// Reciprocal of the direction, finite.
    pub(super) reciprocal: [f32; 4],
    /// Origin times reciprocal, more for the planes where it enters, and less for those where it leaves.
    pub(super) near_offset: [f32; 4],
    pub(super) far_offset: [f32; 4],
    /// Where a node has the planes, along each axis, that the ray enters first: 0 or [`WIDTH`] floats on.
    pub(super) near: [u32; 4],
}

impl BoxRay {
    /// For a tree whose largest coordinate is `size`.
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3, size: f32) -> Self {
        // Finite even along an axis: the products must not be 0 times infinity.
        const SMALLEST: f32 = 1e-18;
        let (o, d) = (origin.extend(0.0).to_array(), direction.extend(1.0).to_array());
        let margin = 16.0 * UNIT_ROUNDOFF * (origin.abs().max_element() + size);
        let mut ray = Self::zeroed();
        for i in 0..4 {
            let finite = if d[i].abs() < SMALLEST { SMALLEST.copysign(d[i]) } else { d[i] };
            let reciprocal = 1.0 / finite;
            let (offset, margin) = (o[i] * reciprocal, margin * reciprocal.abs());
            ray.reciprocal[i] = reciprocal;
            ray.near_offset[i] = offset + margin;
            ray.far_offset[i] = offset - margin;
            ray.near[i] = if reciprocal < 0.0 { WIDTH as u32 } else { 0 };
        }
        ray
    }
}
