//! A ray prepared for boxes.
//!
//! Boxes are made wider by more than all rounding errors of the box test and of the triangle test behind it: a
//! triangle that the edge test would accept is never missed. With u = 2^-24, origin o, and p the largest coordinate
//! of the tree, both in the largest norm: plane * r - origin * r is off by at most 3u (p + o) |r|, the reciprocal r by
//! u, and the edge test displaces a corner by at most 8u (p + o) (see `woop`). Planes are moved by 16u (p + o).

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
    /// For a tree whose largest coordinate is `size`. Of origin and direction the fourth elements mean nothing.
    #[inline(always)]
    pub(super) fn new(origin: Vec4, direction: Vec4, size: f32) -> Self {
        // Finite even along an axis: the products must not be 0 times infinity.
        const SMALLEST: Vec4 = Vec4::splat(1e-18);
        let is_small = direction.abs().cmplt(SMALLEST);
        let finite = Vec4::select(is_small, SMALLEST.copysign(direction), direction);
        let reciprocal = Vec4::ONE / finite;
        let largest = origin.with_w(0.0).abs().max_element() + size;
        let margin = reciprocal.abs() * (16.0 * UNIT_ROUNDOFF * largest);
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
