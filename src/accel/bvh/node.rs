//! A node of eight children, as a ray meets it, and how one refers to another.
//!
//! Knows neither how the tree came about nor what leaves hold.

use crate::geometry::Aabb;
use bytemuck::{Pod, Zeroable};

/// Children a node, at most.
pub(super) const WIDTH: usize = 8;

/// Bytes of which places in the arena are counted: no vector of a node or a leaf crosses a cache line.
pub(super) const UNIT: usize = 32;

/// What is next: a node, a leaf, an instance, or an event of the traversal. Two bits of kind, then a number: for
/// nodes and leaves the place in the arena, in units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub(super) struct Reference(pub(super) u32);

impl Reference {
    /// Below it are all numbers.
    pub(super) const NUMBERS: usize = 1 << 30;
    /// A reference to an absent child: nothing is there.
    pub(super) const NOTHING: Self = Self::new(Kind::Event, 0);
    /// The ray is done with the object that it is in.
    pub(super) const LEAVE: Self = Self::new(Kind::Event, 1);
    /// Nothing is left to be done.
    pub(super) const DONE: Self = Self::new(Kind::Event, 2);

    /// The number must be below [`Self::NUMBERS`].
    pub(super) const fn new(kind: Kind, number: usize) -> Self {
        Self((kind as u32) << 30 | number as u32)
    }

    /// The kind as a number.
    #[inline(always)]
    pub(super) fn kind(self) -> usize {
        (self.0 >> 30) as usize
    }

    /// Place in the arena, or number of the instance.
    #[inline(always)]
    pub(super) fn number(self) -> usize {
        self.0 as usize & (Self::NUMBERS - 1)
    }
}

/// What a reference refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    Leaf,
    Instance,
    Event,
}

/// Boxes as one array a plane, so that a ray meets all eight with the same instructions.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct Node {
    /// `planes[axis]`: the lower planes, then the upper ones. Those of absent children are the other way round, at
    /// infinity.
    pub(super) planes: [[f32; 2 * WIDTH]; 3],
    pub(super) children: [Reference; WIDTH],
}

const _: () = assert!(size_of::<Node>() == 7 * UNIT);

impl Node {
    /// A node without children.
    pub(super) const EMPTY: Self = Self {
        planes: {
            const NONE: f32 = f32::INFINITY;
            let mut planes = [[NONE; 2 * WIDTH]; 3];
            let mut i = 0;
            while i < 3 * WIDTH {
                planes[i / WIDTH][WIDTH + i % WIDTH] = -NONE;
                i += 1;
            }
            planes
        },
        children: [Reference::NOTHING; WIDTH],
    };

    /// Puts a child in a place.
    pub(super) fn set(&mut self, place: usize, bounds: &Aabb, child: Reference) {
        for (axis, planes) in self.planes.iter_mut().enumerate() {
            (planes[place], planes[WIDTH + place]) = (bounds.min[axis], bounds.max[axis]);
        }
        self.children[place] = child;
    }
}
