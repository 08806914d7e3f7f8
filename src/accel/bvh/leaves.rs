//! Where the triangles of a leaf come from: kept as blocks beside the nodes, or gathered when a ray visits the leaf.
//!
//! A type each, so that the loops of traversal are compiled for one and for the other: a branch there would cost a
//! fifth of the speed, as blocks could no longer stay in registers. Knows how leaves are kept, not who asks.

use super::Bvh;
use super::block::{Block, SIZE};
use super::hierarchy::Hierarchy;
use super::node::{Kind, Reference};

/// How leaves are read. Only for hierarchies that keep them so.
pub(super) trait Leaves {
    /// The leaf that is referred to, in an instance or none; what must be made is put there.
    fn block<'a>(
        bvh: &'a Bvh,
        leaf: Reference,
        instance: u32,
        made: &'a mut Option<Block>,
    ) -> &'a Block;

    /// Where what a reference to a node or a leaf names is kept, in two cache lines at most.
    fn address(hierarchy: &Hierarchy, reference: Reference) -> *const u8;

    /// Place of the number of a triangle in a leaf.
    fn place(hierarchy: &Hierarchy, leaf: Reference, lane: usize) -> usize;
}

/// As blocks.
pub(super) struct Kept;

impl Leaves for Kept {
    #[inline(always)]
    fn block<'a>(bvh: &'a Bvh, leaf: Reference, _: u32, _: &'a mut Option<Block>) -> &'a Block {
        // SAFETY: `Bvh::is_compact` has been asked before it was chosen to read leaves so.
        unsafe { bvh.hierarchy.block(leaf) }
    }

    #[inline(always)]
    fn address(hierarchy: &Hierarchy, reference: Reference) -> *const u8 {
        hierarchy.unit(reference)
    }

    #[inline(always)]
    fn place(hierarchy: &Hierarchy, leaf: Reference, lane: usize) -> usize {
        // SAFETY: as above.
        unsafe { hierarchy.block(leaf) }.first as usize + lane
    }
}

/// As the numbers of their triangles, [`SIZE`] places a leaf.
pub(super) struct Gathered;

impl Leaves for Gathered {
    #[inline(always)]
    fn block<'a>(
        bvh: &'a Bvh,
        leaf: Reference,
        instance: u32,
        made: &'a mut Option<Block>,
    ) -> &'a Block {
        made.insert(bvh.gather(leaf, instance))
    }

    #[inline(always)]
    fn address(hierarchy: &Hierarchy, reference: Reference) -> *const u8 {
        if reference.kind() == Kind::Leaf as usize {
            hierarchy.triangle_address(SIZE * reference.number()).cast()
        } else {
            hierarchy.unit(reference)
        }
    }

    #[inline(always)]
    fn place(_: &Hierarchy, leaf: Reference, lane: usize) -> usize {
        SIZE * leaf.number() + lane
    }
}

impl Bvh {
    /// The triangles of a leaf of which only their numbers are kept.
    #[inline(never)]
    fn gather(&self, leaf: Reference, instance: u32) -> Block {
        let (hierarchy, geometry) = (&self.hierarchy, &self.geometry);
        let meshes = match geometry.instances.get(instance as usize) {
            Some(instance) => &geometry.objects[instance.object as usize].meshes,
            None => &geometry.meshes,
        };
        hierarchy.gather(leaf, hierarchy.tree_of(geometry, instance), meshes)
    }
}
