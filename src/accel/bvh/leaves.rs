//! Where the triangles of a leaf come from: kept as blocks beside the nodes, or gathered when a ray visits the leaf.
//!
//! A type each, so that the loops of traversal are compiled for one and for the other: a branch there would cost a
//! fifth of the speed, as blocks could no longer stay in registers. Knows how leaves are kept, not who asks.

use super::Bvh;
use super::block::{Block, Meshes};
use super::gather::Recipe;
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

    /// Steps in which a leaf is fetched, each of which must have been given time to arrive before the next.
    const STEPS: usize;

    /// Asks the memory for what the block of a leaf is made of.
    fn fetch(bvh: &Bvh, leaf: Reference, instance: u32, step: usize);

    /// Where the number of a triangle in a leaf is in memory.
    fn triangle_address(hierarchy: &Hierarchy, leaf: Reference, lane: usize) -> *const u32;
}

/// As blocks.
pub(super) struct Kept;

impl Leaves for Kept {
    #[inline(always)]
    fn block<'a>(bvh: &'a Bvh, leaf: Reference, _: u32, _: &'a mut Option<Block>) -> &'a Block {
        // SAFETY: who makes a `Batch` answers for it that the hierarchy is not compact.
        unsafe { bvh.hierarchy.block(leaf) }
    }

    #[inline(always)]
    fn address(hierarchy: &Hierarchy, reference: Reference) -> *const u8 {
        hierarchy.unit(reference)
    }

    const STEPS: usize = 0;

    #[inline(always)]
    fn fetch(_: &Bvh, _: Reference, _: u32, _: usize) {}

    #[inline(always)]
    fn triangle_address(hierarchy: &Hierarchy, leaf: Reference, lane: usize) -> *const u32 {
        // SAFETY: as above.
        let first = unsafe { hierarchy.block(leaf) }.first;
        hierarchy.triangle_address(first as usize + lane)
    }
}

/// As recipes.
pub(super) struct Gathered;

impl Leaves for Gathered {
    #[inline(always)]
    fn block<'a>(
        bvh: &'a Bvh,
        leaf: Reference,
        instance: u32,
        made: &'a mut Option<Block>,
    ) -> &'a Block {
        let (recipe, meshes) = bvh.recipe(leaf, instance);
        made.insert(recipe.gather(&meshes))
    }

    #[inline(always)]
    fn address(hierarchy: &Hierarchy, reference: Reference) -> *const u8 {
        if reference.kind() == Kind::Leaf as usize {
            hierarchy.recipe_address(reference).cast()
        } else {
            hierarchy.unit(reference)
        }
    }

    const STEPS: usize = 2;

    #[inline(always)]
    fn fetch(bvh: &Bvh, leaf: Reference, instance: u32, step: usize) {
        let (recipe, meshes) = bvh.recipe(leaf, instance);
        match step {
            0 => recipe.fetch_numbers(&meshes),
            _ => recipe.fetch_vertices(&meshes),
        }
    }

    #[inline(always)]
    fn triangle_address(hierarchy: &Hierarchy, leaf: Reference, lane: usize) -> *const u32 {
        // In the recipe, which has been read just now.
        hierarchy.recipe_address(leaf).cast::<u32>().wrapping_add(lane)
    }
}

impl Bvh {
    /// How to gather a leaf, and from what.
    #[inline(always)]
    fn recipe(&self, leaf: Reference, instance: u32) -> (&Recipe, Meshes<'_>) {
        let (hierarchy, geometry) = (&self.hierarchy, &self.geometry);
        let meshes = match geometry.instances.get(instance as usize) {
            Some(instance) => &geometry.objects[instance.object as usize].meshes,
            None => &geometry.meshes,
        };
        let numbers = &hierarchy.tree_of(geometry, instance).numbers;
        // SAFETY: who makes a `Batch` answers for it that the hierarchy is compact.
        (unsafe { hierarchy.recipe(leaf) }, Meshes::new(meshes, numbers))
    }
}
