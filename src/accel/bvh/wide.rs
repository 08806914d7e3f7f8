//! A node with eight children, as a ray meets it. Knows neither how it came about nor what leaves hold.

use crate::geometry::Aabb;
use crate::math::Vec3;

/// Children a node.
pub(super) const WIDTH: usize = 8;

/// Boxes as one array a plane, so that a ray meets all eight with the same instructions; four cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct WideNode {
    /// `planes[axis]` is the lower planes, `planes[3 + axis]` the upper ones; those of absent children mean
    /// nothing.
    pub(super) planes: [[f32; WIDTH]; 6],
    pub(super) children: [Child; WIDTH],
    /// A bit for each child that is there.
    pub(super) present: u32,
}

/// A node by its index, or a leaf: a run of blocks (or instances) with the highest bit set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub(super) u32);

const LEAF: u32 = 1 << 31;

impl Child {
    /// The node of that index.
    pub(super) fn node(index: u32) -> Self {
        Self(index)
    }

    /// The leaf of that index.
    pub(super) fn leaf(index: u32) -> Self {
        Self(index | LEAF)
    }

    /// Index of the leaf, if it is one.
    #[inline(always)]
    pub(super) fn as_leaf(self) -> Option<u32> {
        (self.0 & LEAF != 0).then_some(self.0 & !LEAF)
    }
}

impl WideNode {
    /// Without children: boxes that contain nothing.
    pub(super) const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Child(0); WIDTH],
        present: 0,
    };

    /// Puts a child in a place.
    pub(super) fn set(&mut self, place: usize, bounds: &Aabb, child: Child) {
        for axis in 0..3 {
            self.planes[axis][place] = bounds.min[axis];
            self.planes[3 + axis][place] = bounds.max[axis];
        }
        self.children[place] = child;
        self.present |= 1 << place;
    }

    /// Box around all children.
    pub(super) fn bounds(&self) -> Aabb {
        let lowest = |axis: usize| self.planes[axis].iter().copied().fold(f32::INFINITY, f32::min);
        let highest =
            |axis: usize| self.planes[axis].iter().copied().fold(f32::NEG_INFINITY, f32::max);
        Aabb {
            min: Vec3::new(lowest(0), lowest(1), lowest(2)),
            max: Vec3::new(highest(3), highest(4), highest(5)),
        }
    }
}

const _: () = assert!(size_of::<WideNode>() == 256);
