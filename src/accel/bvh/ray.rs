//! A ray prepared for boxes.
//!
//! Boxes are made wider by more than all rounding errors of the box test and of the triangle test behind it: a
//! triangle that the edge test accepts is never missed, and is never nearer than where the ray enters the box. With
//! u = 2^-24, origin o, and p the largest coordinate of the tree, both in the largest norm: base + number * step is off
//! by at most 5u (p + o) |r|, the reciprocal r by u, the edge test displaces a corner by at most 6u (p + o) (see `woop`),
//! a ray mapped into an object is rounded twice, and the distance once. Planes are moved by 32u (p + o).

use super::node::WIDTH;
use crate::math::{UNIT_ROUNDOFF, Vec4};
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
    /// `size` is the sum of the largest coordinates of tree and origin. Of origin and direction the fourth elements mean
    /// nothing.
    #[inline(always)]
    pub(super) fn new(origin: Vec4, direction: Vec4, size: f32) -> Self {
        // Finite even along an axis: the products must not be 0 times infinity.
        const SMALLEST: Vec4 = Vec4::splat(1e-18);
        let is_small = direction.abs().cmplt(SMALLEST);
        let finite = Vec4::select(is_small, SMALLEST.copysign(direction), direction);
        let reciprocal = Vec4::ONE / finite;
        let margin = reciprocal.abs() * (32.0 * UNIT_ROUNDOFF * size);
        let offset = origin * reciprocal;
        const { assert!(WIDTH == 16) };
        // The sign of the reciprocal times the width.
        let near = reciprocal.to_array().map(|r| r.to_bits() >> 27 & WIDTH as u32);
        Self {
            reciprocal: reciprocal.to_array(),
            near_offset: (offset + margin).to_array(),
            far_offset: (offset - margin).to_array(),
            near,
        }
    }
}
