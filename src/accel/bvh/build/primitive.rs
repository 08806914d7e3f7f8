//! Boxes as the builder handles them: two vectors each, so that unions and centres are few instructions.

use crate::geometry::Aabb;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// A box, or the union of some. The lower corner is negated: of either, a union takes the larger numbers. The
/// fourth numbers mean nothing.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct Bounds {
    lower: Vec4,
    upper: Vec4,
}

impl Bounds {
    /// The union of nothing. Its surface is infinite.
    pub(super) const EMPTY: Self = Self { lower: Vec4::NEG_INFINITY, upper: Vec4::NEG_INFINITY };

    /// A box.
    pub(super) fn around(aabb: &Aabb) -> Self {
        Self { lower: (-aabb.min).extend(0.0), upper: aabb.max.extend(0.0) }
    }

    /// The union of the boxes of primitives.
    #[inline(always)]
    pub(super) fn of(primitives: &[PrimitiveBox]) -> Self {
        primitives.iter().fold(Self::EMPTY, |all, p| all.union(p.bounds()))
    }

    /// The union of two.
    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.max(other.upper) }
    }

    /// Half the surfaces of three boxes. The fourth number means nothing.
    #[inline(always)]
    pub(super) fn half_areas(boxes: &[Self; 3]) -> Vec4 {
        let [a, b, c] = boxes.map(|b| b.upper + b.lower);
        // From the three extents of each box to each extent of the three boxes.
        let extents = Mat4::from_cols(a, b, c, c).transpose();
        let (x, y, z) = (extents.x_axis, extents.y_axis, extents.z_axis);
        x * (y + z) + y * z
    }

    /// The two corners.
    pub(super) fn aabb(&self) -> Aabb {
        Aabb { min: -self.lower.truncate(), max: self.upper.truncate() }
    }
}

/// A primitive for the builder: a box, and the number of what is in it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(32))]
pub(in super::super) struct PrimitiveBox {
    /// The lower corner negated, then the number.
    lower: Vec4,
    /// The upper corner, then zero.
    upper: Vec4,
}

/// Is set in a number, so that its bits are no denormal `f32`: arithmetic on those is slow, even if the result
/// does not matter.
const NORMAL: u32 = 1 << 30;

impl PrimitiveBox {
    /// In the place of one that has no box.
    pub(super) const MISSING: Self = Self { lower: Vec4::NAN, upper: Vec4::NAN };

    /// The number must be below 2^30.
    #[inline(always)]
    pub(in super::super) fn new(bounds: &Aabb, id: u32) -> Self {
        let lower = (-bounds.min).extend(f32::from_bits(id | NORMAL));
        Self { lower, upper: bounds.max.extend(0.0) }
    }

    /// Whether it is [`Self::MISSING`].
    pub(super) fn is_missing(&self) -> bool {
        self.upper.is_nan()
    }

    /// Its number.
    #[inline(always)]
    pub(super) fn id(&self) -> u32 {
        self.lower.w.to_bits() & !NORMAL
    }

    /// Its box.
    #[inline(always)]
    pub(super) fn bounds(&self) -> Bounds {
        Bounds { lower: self.lower, upper: self.upper }
    }

    /// Swaps two of some.
    #[inline(always)]
    pub(super) fn swap(primitives: &mut [Self], i: usize, j: usize) {
        // Vector by vector, so that they stay in registers.
        let Self { lower, upper } = primitives[i];
        let other = primitives[j];
        primitives[i] = Self { lower: other.lower, upper: other.upper };
        primitives[j] = Self { lower, upper };
    }

    /// Whether no edge of the box is longer than `length`.
    #[inline(always)]
    pub(super) fn is_within(&self, length: f32) -> bool {
        let is_longer = (self.upper + self.lower).cmpgt(Vec4::splat(length));
        is_longer.bitmask() & 0b111 == 0
    }

    /// Twice the centre. The fourth number means nothing.
    #[inline(always)]
    pub(super) fn center2(&self) -> Vec4 {
        self.upper - self.lower
    }

    /// Twice the centre along one axis.
    #[inline(always)]
    pub(super) fn center2_along(&self, axis: usize) -> f32 {
        let numbers: &[f32; 8] = bytemuck::must_cast_ref(self);
        numbers[4 + (axis & 3)] - numbers[axis & 3]
    }
}

/// The smallest and the largest of some centres, doubled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centers {
    pub(super) min: Vec4,
    pub(super) max: Vec4,
}

impl Centers {
    /// Those of nothing.
    pub(super) const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    /// Those of primitives.
    #[inline(always)]
    pub(super) fn of(primitives: &[PrimitiveBox]) -> Self {
        // Two at a time: a minimum waits for the one before it.
        let (mut even, mut odd) = (Self::EMPTY, Self::EMPTY);
        let (pairs, rest) = primitives.as_chunks::<2>();
        for [a, b] in pairs {
            (even, odd) = (even.with(a.center2()), odd.with(b.center2()));
        }
        rest.iter().fold(even.union(odd), |all, p| all.with(p.center2()))
    }

    /// With one more centre, doubled.
    #[inline(always)]
    pub(super) fn with(self, center2: Vec4) -> Self {
        Self { min: self.min.min(center2), max: self.max.max(center2) }
    }

    /// Of both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}
