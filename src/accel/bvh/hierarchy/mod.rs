//! All nodes and leaves of a world in one arena: a tree for the meshes that stand in it, one for each object, and one
//! over the instances.
//!
//! A node's children lie side by side, its inner ones and then its leaves. Knows how trees are read, not how they are
//! built or traversed; `store` puts them here.

mod store;

use super::backend_error;
use super::block::{Block, Meshes, Numbers};
use super::collapse::WideTree;
use super::gather::Recipe;
use super::node::{Kind, Node, Reference, UNIT};
use crate::accel::{BuildOptions, TreeShape};
use crate::error::Result;
use crate::geometry::{Aabb, Geometry, TriangleMesh};
use crate::math::DAffine3;
use crate::os::Arena;
use bytemuck::{Pod, Zeroable};

/// Trees over triangles, and one over instances.
#[derive(Default)]
pub(super) struct Hierarchy {
    units: Arena<Unit>,
    /// How many of them are taken.
    used: usize,
    /// Triangles of all trees in the order of the leaves, as their tree numbers them; where leaves are gathered, they
    /// are in the recipes instead.
    triangles: Arena<u32>,
    recipes: Arena<Recipe>,
    /// How many of one or the other are taken.
    places: usize,
    /// Whether leaves are gathered when they are visited, instead of being kept as blocks.
    pub(super) is_compact: bool,
    /// Over the meshes that stand in the world.
    pub(super) own: Tree,
    /// Over each object's meshes, in its own space.
    pub(super) objects: Vec<Tree>,
    /// Over the instances.
    pub(super) instances: Tree,
    /// What the trees over triangles are made of.
    pub(super) shape: TreeShape,
    /// Largest coordinate of both that stand in the world.
    pub(super) world_size: f32,
    /// Instances in the order of the leaves.
    order: Vec<u32>,
    /// For each instance.
    pub(super) object_from_world: Vec<DAffine3>,
}

/// What nodes and leaves are made of.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, align(128))]
struct Unit([u8; UNIT]);

/// One tree in the arena.
pub(super) struct Tree {
    /// `None` without primitives.
    pub(super) root: Option<Reference>,
    pub(super) bounds: Aabb,
    /// Largest absolute coordinate of the bounds.
    pub(super) size: f32,
    /// The most references that a depth-first walk leaves for later.
    pub(super) pending: usize,
    /// From numbers of triangles to primitives.
    pub(super) numbers: Numbers,
}

impl Default for Tree {
    fn default() -> Self {
        Self::new(None, Aabb::EMPTY, &WideTree::default(), Numbers::new(&[]))
    }
}

impl Tree {
    fn new(root: Option<Reference>, bounds: Aabb, wide: &WideTree, numbers: Numbers) -> Self {
        let size = bounds.min.abs().max(bounds.max.abs()).max_element();
        let size = if root.is_some() { size } else { 0.0 };
        Self { root, bounds, size, pending: wide.pending, numbers }
    }
}

impl Hierarchy {
    /// Builds all trees.
    ///
    /// # Errors
    /// When there are 2^30 triangles or instances or more, or not enough memory.
    pub(super) fn build(geometry: &Geometry, options: &BuildOptions) -> Result<Self> {
        // References have 30 bits.
        let triangles = geometry.stored_triangles();
        let instances = geometry.instances.len();
        if triangles.max(instances) >= Reference::NUMBERS {
            return Err(backend_error("more than 2^30 triangles or instances"));
        }
        // Room for the most there can be: leaves of one triangle, and as many nodes. What is not written costs
        // nothing.
        let memory = || backend_error("not enough memory for the hierarchy");
        let trees = geometry.objects.len() + 2;
        let per_triangle = if options.is_compact { 1 } else { 2 };
        let units = per_triangle * triangles + instances + trees;
        let [kept, gathered] = if options.is_compact { [0, triangles] } else { [triangles, 0] };
        let mut all = Self {
            units: Arena::zeroed(units).ok_or_else(memory)?,
            triangles: Arena::zeroed(kept).ok_or_else(memory)?,
            recipes: Arena::zeroed(gathered).ok_or_else(memory)?,
            is_compact: options.is_compact,
            ..Self::default()
        };
        all.own = all.add_meshes(&geometry.meshes, options)?;
        for object in &geometry.objects {
            let tree = all.add_meshes(&object.meshes, options)?;
            all.objects.push(tree);
        }
        all.add_instances(geometry, options)?;
        all.world_size = all.own.size.max(all.instances.size);
        all.units.truncate(all.used);
        all.triangles.truncate(all.places);
        all.recipes.truncate(all.places);
        Ok(all)
    }

    /// How many instances can be hit.
    pub(super) fn instance_count(&self) -> usize {
        self.order.len()
    }

    /// References that the deepest walk leaves for later.
    pub(super) fn pending(&self) -> usize {
        // The end, both roots, and in an instance the way back and the object.
        let deepest = self.objects.iter().map(|tree| tree.pending).max().unwrap_or(0);
        3 + self.own.pending.max(self.instances.pending + 2 + deepest)
    }

    /// Bytes of all of it.
    pub(super) fn bytes(&self) -> usize {
        let numbers = |tree: &Tree| tree.numbers.bytes();
        size_of_val(&*self.units)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.recipes)
            + size_of_val(&*self.order)
            + size_of_val(&*self.object_from_world)
            + size_of_val(&*self.objects)
            + numbers(&self.own)
            + self.objects.iter().map(numbers).sum::<usize>()
    }

    /// Where the unit is that a reference to a node or a block names.
    #[inline(always)]
    pub(super) fn unit(&self, reference: Reference) -> *const u8 {
        // The kind falls off the upper end.
        const { assert!(UNIT == 4 * 32) };
        let offset = (reference.0 << 2) as usize * 32;
        self.units.as_ptr().cast::<u8>().wrapping_add(offset)
    }

    /// The node that is referred to.
    #[inline(always)]
    pub(super) fn node(&self, reference: Reference) -> &Node {
        debug_assert!(reference.kind() == Kind::Node as usize);
        // SAFETY: references to nodes are made in `store` only, where the nodes are.
        unsafe { &*self.unit(reference).cast() }
    }

    /// The block of the leaf that is referred to.
    ///
    /// # Safety
    /// Only where blocks are kept: where the hierarchy is not compact.
    #[inline(always)]
    pub(super) unsafe fn block(&self, reference: Reference) -> &Block {
        debug_assert!(!self.is_compact && reference.kind() == Kind::Leaf as usize);
        // SAFETY: references to leaves are then made in `store` only, where the blocks are.
        unsafe { &*self.unit(reference).cast() }
    }

    /// How to gather the leaf that is referred to.
    ///
    /// # Safety
    /// Only where leaves are gathered: where the hierarchy is compact.
    #[inline(always)]
    pub(super) unsafe fn recipe(&self, reference: Reference) -> &Recipe {
        debug_assert!(self.is_compact && reference.kind() == Kind::Leaf as usize);
        // SAFETY: references to leaves are then made in `store` only, where the recipes are.
        unsafe { &*self.recipe_address(reference) }
    }

    /// Where that is in memory.
    #[inline(always)]
    pub(super) fn recipe_address(&self, reference: Reference) -> *const Recipe {
        self.recipes.as_ptr().wrapping_add(reference.number())
    }

    /// The number in its tree of a triangle in a leaf.
    #[inline(always)]
    pub(super) fn triangle(&self, leaf: Reference, lane: usize) -> u32 {
        if self.is_compact {
            // SAFETY: the hierarchy is compact.
            unsafe { self.recipe(leaf) }.triangles[lane]
        } else {
            // SAFETY: the hierarchy is not compact.
            self.triangles[unsafe { self.block(leaf) }.first as usize + lane]
        }
    }

    /// Where the number that is kept at a place is in memory.
    #[inline(always)]
    pub(super) fn triangle_address(&self, place: usize) -> *const u32 {
        self.triangles.as_ptr().wrapping_add(place)
    }

    /// [`Self::node`], if it lies in the arena.
    pub(super) fn checked_node(&self, reference: Reference) -> Option<&Node> {
        (reference.number() < self.units.len()).then(|| self.node(reference))
    }

    /// The leaf that is referred to, kept or made, if it is there.
    pub(super) fn checked_block(
        &self,
        reference: Reference,
        tree: &Tree,
        meshes: &[TriangleMesh],
    ) -> Option<Block> {
        if self.is_compact {
            let recipe = self.recipes.get(reference.number())?;
            Some(recipe.gather(&Meshes::new(meshes, &tree.numbers)))
        } else {
            let is_there = reference.number() < self.units.len();
            // SAFETY: the hierarchy is not compact.
            is_there.then(|| unsafe { *self.block(reference) })
        }
    }

    /// The instance that is referred to.
    #[inline]
    pub(super) fn instance(&self, reference: Reference) -> Option<u32> {
        self.order.get(reference.number()).copied()
    }

    /// The tree of an instance's object, or of the world's own meshes.
    #[inline(always)]
    pub(super) fn tree_of(&self, geometry: &Geometry, instance: u32) -> &Tree {
        match geometry.instances.get(instance as usize) {
            Some(instance) => &self.objects[instance.object as usize],
            None => &self.own,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Quality;
    use crate::sampling::CounterRng;

    /// More triangles than one thread builds over alone.
    #[test]
    fn the_number_of_threads_changes_no_byte() {
        let mut rng = CounterRng::new(0);
        let mut number = || rng.unit() * rng.unit();
        let positions: Vec<_> = (0..90_002).map(|_| [number(), number(), number()]).collect();
        let triangles = (0..90_000).map(|i| [i, i + 1, i + 2]).collect();
        let meshes = vec![TriangleMesh::new(positions, triangles, false)];
        let geometry = Geometry { meshes, ..Geometry::default() };
        let compact = (Quality::Default, true);
        for (quality, is_compact) in
            Quality::ALL.map(|(_, quality)| (quality, false)).into_iter().chain([compact])
        {
            let options = BuildOptions { quality, is_compact, ..BuildOptions::default() };
            let bytes = [1, 2, 3, 8].map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                let hierarchy =
                    pool.expect("threads").install(|| Hierarchy::build(&geometry, &options));
                let hierarchy = hierarchy.expect("it builds");
                let units = bytemuck::cast_slice::<_, u8>(&hierarchy.units);
                let triangles = bytemuck::cast_slice(&hierarchy.triangles);
                [units, triangles, bytemuck::cast_slice(&hierarchy.recipes)].concat()
            });
            let least = if is_compact { 8 } else { 15 };
            assert!(bytes[0].len() > 90_000 * least);
            assert!(bytes.iter().all(|other| *other == bytes[0]), "{quality:?}");
        }
    }
}
