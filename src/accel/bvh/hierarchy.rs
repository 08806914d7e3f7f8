//! All nodes and leaves of a world in one arena: a tree for the meshes that stand in it, one for each object, and one
//! over the instances.
//!
//! Each node is followed by its own leaves, and the inner children of a node lie side by side. Knows how trees are
//! stored, not how they are built or traversed.

use super::backend_error;
use super::binned::{self, BinaryNode, PrimitiveBox};
use super::block::{self, Block, Meshes, Numbers};
use super::collapse::{WideNode, WideTree, collapse};
use super::node::{Kind, Node, Reference, UNIT};
use crate::error::Result;
use crate::geometry::{Aabb, Geometry, Instance, TriangleMesh};
use crate::math::{DAffine3, Vec3};
use crate::os::Arena;
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;

/// Trees over triangles, and one over instances.
#[derive(Default)]
pub(super) struct Hierarchy {
    units: Arena<Unit>,
    /// How many of them are taken.
    used: usize,
    /// Over the meshes that stand in the world.
    pub(super) own: Tree,
    /// Over each object's meshes, in its own space.
    pub(super) objects: Vec<Tree>,
    /// Over the instances.
    pub(super) instances: Tree,
    /// Instances in the order of the leaves.
    pub(super) order: Vec<u32>,
    /// For each instance.
    pub(super) object_from_world: Vec<DAffine3>,
}

/// What nodes and leaves are made of.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, align(32))]
struct Unit([u8; UNIT]);

/// Units of a node and of a leaf.
const NODE: usize = size_of::<Node>() / UNIT;
const LEAF: usize = size_of::<Block>() / UNIT;

/// One tree in the arena.
pub(super) struct Tree {
    /// `None` without primitives.
    pub(super) root: Option<Reference>,
    pub(super) bounds: Aabb,
    /// Largest absolute coordinate of the bounds.
    pub(super) size: f32,
    /// The most references that a depth-first walk leaves for later.
    pub(super) pending: usize,
    /// From numbers in leaves to primitives.
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
    pub(super) fn build(geometry: &Geometry) -> Result<Self> {
        // Numbers of nodes, leaves and instances have 30 bits.
        let triangles = geometry.stored_triangles();
        if triangles.max(geometry.instances.len()) >= 1 << 30 {
            return Err(backend_error("more than 2^30 triangles or instances"));
        }
        // Room for the most there can be: leaves of one triangle, and as many nodes. What is not written costs
        // nothing.
        let memory = || backend_error("not enough memory for the hierarchy");
        let units = triangles * (NODE + LEAF) + geometry.instances.len() * NODE;
        let mut all = Self { units: Arena::zeroed(units).ok_or_else(memory)?, ..Self::default() };
        all.own = all.add_meshes(&geometry.meshes)?;
        for object in &geometry.objects {
            let tree = all.add_meshes(&object.meshes)?;
            all.objects.push(tree);
        }
        all.add_instances(geometry)?;
        all.units.truncate(all.used);
        Ok(all)
    }

    /// Bytes of all of it.
    pub(super) fn bytes(&self) -> usize {
        let numbers = |tree: &Tree| tree.numbers.bytes();
        size_of_val(&*self.units)
            + size_of_val(&*self.order)
            + size_of_val(&*self.object_from_world)
            + size_of_val(&*self.objects)
            + numbers(&self.own)
            + self.objects.iter().map(numbers).sum::<usize>()
    }

    /// Where the unit is that a reference to a node or a leaf names.
    #[inline(always)]
    pub(super) fn place(&self, reference: Reference) -> *const u8 {
        self.units.as_ptr().wrapping_add(reference.number()).cast()
    }

    /// The node that is referred to.
    #[inline(always)]
    pub(super) fn node(&self, reference: Reference) -> &Node {
        debug_assert!(reference.kind() == Kind::Node as usize);
        // SAFETY: references to nodes are made in `add_tree` only, where the nodes are.
        unsafe { &*self.place(reference).cast() }
    }

    /// The leaf that is referred to.
    #[inline(always)]
    pub(super) fn block(&self, reference: Reference) -> &Block {
        debug_assert!(reference.kind() == Kind::Leaf as usize);
        // SAFETY: references to leaves are made in `add_tree` only, where the leaves are.
        unsafe { &*self.place(reference).cast() }
    }

    /// The tree of an instance's object, or of the world's own meshes.
    #[inline(always)]
    pub(super) fn tree_of(&self, geometry: &Geometry, instance: u32) -> &Tree {
        match geometry.instances.get(instance as usize) {
            Some(instance) => &self.objects[instance.object as usize],
            None => &self.own,
        }
    }

    /// A tree over the triangles of some meshes.
    fn add_meshes(&mut self, meshes: &[TriangleMesh]) -> Result<Tree> {
        let meshes = Meshes::new(meshes);
        let (tree, order) = binned::build(meshes.boxes(), block::SIZE);
        let wide = collapse(&tree);
        let leaf = |start: u32, end: u32| Block::new(&meshes, &order[start as usize..end as usize]);
        let root = self.add_tree(&tree, &wide, Some(&leaf))?;
        Ok(Tree::new(root, bounds(&tree), &wide, meshes.into_numbers()))
    }

    /// The tree over the instances.
    fn add_instances(&mut self, geometry: &Geometry) -> Result<()> {
        let inverse = |i: &Instance| i.world_from_object.to_f64().inverse();
        self.object_from_world = geometry.instances.iter().map(inverse).collect();
        let mut boxes = Vec::new();
        for (instance, id) in geometry.instances.iter().zip(0..) {
            let bounds = self.objects[instance.object as usize].bounds;
            let corner = |p| instance.world_from_object.transform_point_f64(p).as_vec3();
            let world = bounds.corners().map(corner);
            // What an object without triangles or a singular map leaves is never hit.
            let is_regular = self.object_from_world[id as usize].is_finite();
            if is_regular && !bounds.is_empty() && world.iter().all(|p| p.is_finite()) {
                let around = world.into_iter().fold(Aabb::EMPTY, Aabb::with_point);
                // The ray is transformed in `f32`: room for what that loses, a few units of the largest
                // coordinate on the way.
                let largest = around.min.abs().max(around.max.abs()).max_element();
                let margin = Vec3::splat(largest * 1e-6);
                let bounds = Aabb { min: around.min - margin, max: around.max + margin };
                boxes.push(PrimitiveBox { bounds, id });
            }
        }
        let (tree, order) = binned::build(boxes, 1);
        let wide = collapse(&tree);
        let root = self.add_tree(&tree, &wide, None::<&fn(u32, u32) -> Block>)?;
        let children = wide.nodes.iter().flat_map(WideNode::children);
        let leaves = children.filter_map(|&child| leaf_range(&tree[child as usize]));
        self.order = leaves.map(|(start, _)| order[start as usize]).collect();
        self.instances = Tree::new(root, bounds(&tree), &wide, Numbers::new(&[]));
        Ok(())
    }

    /// Stores a tree. Leaves are made by `leaf` from their range of primitives; without it they are instances, by
    /// their number.
    fn add_tree(
        &mut self,
        tree: &[BinaryNode],
        wide: &WideTree,
        leaf: Option<&(impl Fn(u32, u32) -> Block + Sync)>,
    ) -> Result<Option<Reference>> {
        let first = self.used;
        let leaf_units = if leaf.is_some() { LEAF } else { 0 };
        // Each node is followed by its leaves.
        let place = |i: usize| match wide.nodes.get(i) {
            Some(node) => first + i * NODE + node.leaves_before as usize * leaf_units,
            None => first + i * NODE + wide.leaves * leaf_units,
        };
        self.used = place(wide.nodes.len());
        if self.used > Reference::NUMBERS {
            return Err(backend_error("the hierarchy would be larger than 32 GiB"));
        }
        // Chunks of nodes, with the units that they and their leaves fill.
        const CHUNK: usize = 256;
        let mut rest = &mut self.units[first..self.used];
        let mut chunks = Vec::with_capacity(wide.nodes.len() / CHUNK + 1);
        for start in (0..wide.nodes.len()).step_by(CHUNK) {
            let end = (start + CHUNK).min(wide.nodes.len());
            let (units, behind) = rest.split_at_mut(place(end) - place(start));
            chunks.push((start..end, units));
            rest = behind;
        }
        chunks.into_par_iter().for_each(|(range, mut units)| {
            for i in range {
                let source = &wide.nodes[i];
                let taken = NODE + usize::from(source.leaves()) * leaf_units;
                let (of_this, behind) = units.split_at_mut(taken);
                units = behind;
                let (of_node, of_leaves) = of_this.split_at_mut(NODE);
                let mut inner = source.inner();
                let mut node = Node::EMPTY;
                let mut leaves = 0;
                for (slot, &child) in source.children().iter().enumerate() {
                    let child = &tree[child as usize];
                    let reference = match (leaf_range(child), leaf) {
                        (None, _) => Reference::new(Kind::Node, place(inner.next().unwrap_or(0))),
                        (Some((start, end)), Some(leaf)) => {
                            let at = leaves * LEAF;
                            let block = leaf(start, end);
                            of_leaves[at..at + LEAF]
                                .copy_from_slice(bytemuck::cast_slice(&[block]));
                            leaves += 1;
                            Reference::new(Kind::Leaf, place(i) + NODE + at)
                        }
                        (Some(_), None) => {
                            leaves += 1;
                            let number = source.leaves_before as usize + leaves - 1;
                            Reference::new(Kind::Instance, number)
                        }
                    };
                    node.set(slot, &child.bounds, reference);
                }
                of_node.copy_from_slice(bytemuck::cast_slice(&[node]));
            }
        });
        Ok((!wide.nodes.is_empty()).then(|| Reference::new(Kind::Node, first)))
    }
}

/// The range of primitives of a leaf.
fn leaf_range(node: &BinaryNode) -> Option<(u32, u32)> {
    match node.kind {
        binned::Kind::Leaf { start, end } => Some((start, end)),
        binned::Kind::Inner(_) => None,
    }
}

fn bounds(tree: &[BinaryNode]) -> Aabb {
    tree.first().map_or(Aabb::EMPTY, |root| root.bounds)
}
