//! Trees into the arena: nodes, and leaves as blocks beside them or as recipes by themselves. By all threads; which does
//! what changes no byte. Knows neither how trees are split nor how rays walk through them.

use super::super::backend_error;
use super::super::block::{self, Block, Meshes, Numbers};
use super::super::build::{self, Anything, BinaryNode, PrimitiveBox, Room, Triangles, build};
use super::super::collapse::{WideTree, collapse};
use super::super::gather::Recipe;
use super::super::node::{Kind, Node, Reference, WIDTH};
use super::{Hierarchy, Tree};
use crate::accel::BuildOptions;
use crate::error::Result;
use crate::geometry::{Aabb, Geometry, Instance, TriangleMesh};
use crate::math::Vec3;
use rayon::prelude::*;

/// How the leaves of a tree are kept.
enum Leaves<'a> {
    /// As blocks, made of their ranges of primitives, behind the inner children of their parent.
    Blocks(&'a (dyn Fn(u32, u32) -> Block + Sync)),
    /// By numbers, in the order of the tree; this is the first.
    Elsewhere(Reference),
}

impl Hierarchy {
    /// A tree over the triangles of some meshes.
    pub(super) fn add_meshes(
        &mut self,
        meshes: &[TriangleMesh],
        options: &BuildOptions,
    ) -> Result<Tree> {
        let boxes = build::boxes(meshes);
        let numbers = Numbers::new(meshes);
        let meshes = Meshes::new(meshes, &numbers);
        let room = Room { primitives: block::SIZE, points: block::VERTICES };
        let leaves = Triangles { room, corners: |triangle| meshes.vertices(triangle) };
        let tree = build(boxes, &leaves, options.quality);
        let wide = collapse(&tree);
        let (order, first) = (&tree.order, self.places);
        let root = if self.is_compact {
            let leaves = Reference::new(Kind::Leaf, first);
            self.places += wide.leaves;
            let ranges: Vec<_> = wide.leaf_ranges(&tree.nodes).collect();
            let recipes = self.recipes[first..self.places].par_iter_mut();
            recipes.zip(&ranges).for_each(|(recipe, &(start, end))| {
                *recipe = Recipe::new(&meshes, &order[start as usize..end as usize]);
            });
            self.add_tree(&tree.nodes, &wide, &Leaves::Elsewhere(leaves))?
        } else {
            self.triangles[first..first + order.len()].copy_from_slice(order);
            self.places += order.len();
            let block = |start: u32, end: u32| {
                Block::new(&meshes, &order[start as usize..end as usize], first as u32 + start)
            };
            self.add_tree(&tree.nodes, &wide, &Leaves::Blocks(&block))?
        };
        self.shape.add(&wide.shape(&tree.nodes));
        Ok(Tree::new(root, bounds(&tree.nodes), &wide, numbers))
    }

    /// The tree over the instances.
    pub(super) fn add_instances(
        &mut self,
        geometry: &Geometry,
        options: &BuildOptions,
    ) -> Result<()> {
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
                boxes.push(PrimitiveBox::new(&bounds, id));
            }
        }
        let tree = build(boxes, &Anything(1), options.quality);
        let wide = collapse(&tree);
        let leaves = Leaves::Elsewhere(Reference::new(Kind::Instance, 0));
        let root = self.add_tree(&tree.nodes, &wide, &leaves)?;
        let ranges = wide.leaf_ranges(&tree.nodes);
        self.order = ranges.map(|(start, _)| tree.order[start as usize]).collect();
        self.instances = Tree::new(root, bounds(&tree.nodes), &wide, Numbers::new(&[]));
        Ok(())
    }

    /// Stores a tree.
    fn add_tree(
        &mut self,
        tree: &[BinaryNode],
        wide: &WideTree,
        leaves: &Leaves<'_>,
    ) -> Result<Option<Reference>> {
        if wide.nodes.is_empty() {
            return Ok(None);
        }
        // The root, then the children of each node, in the order of the nodes.
        let root = self.used;
        let mut places = Vec::with_capacity(wide.nodes.len());
        let mut end = root + 1;
        for node in &wide.nodes {
            places.push(end);
            end += match leaves {
                Leaves::Blocks(_) => node.children().len(),
                Leaves::Elsewhere(_) => node.inner().len(),
            };
        }
        self.used = end;
        if end > Reference::NUMBERS.min(self.units.len()) {
            return Err(backend_error("the hierarchy would be larger than 128 GiB"));
        }
        let new_node = |i: usize| {
            let source = &wide.nodes[i];
            let mut boxes = [Aabb::EMPTY; WIDTH];
            for (bounds, &child) in boxes.iter_mut().zip(source.children()) {
                *bounds = tree[child as usize].bounds();
            }
            let boxes = &boxes[..source.children().len()];
            let first_leaf = match leaves {
                Leaves::Blocks(_) => Reference::new(Kind::Leaf, places[i] + source.inner().len()),
                Leaves::Elsewhere(first) => Reference(first.0 + source.leaves_before),
            };
            Node::new(boxes, source.inner().len(), places[i], first_leaf)
        };
        let (of_root, mut rest) = self.units[root..end].split_at_mut(1);
        of_root[0] = bytemuck::must_cast(new_node(0));
        // The children of many nodes at a time, and the units that they fill.
        const CHUNK: usize = 256;
        let mut chunks = Vec::with_capacity(wide.nodes.len() / CHUNK + 1);
        let mut begin = root + 1;
        for first in (0..wide.nodes.len()).step_by(CHUNK) {
            let last = (first + CHUNK).min(wide.nodes.len());
            let end = places.get(last).copied().unwrap_or(end);
            let (units, behind) = rest.split_at_mut(end - begin);
            chunks.push((first..last, begin, units));
            (begin, rest) = (end, behind);
        }
        chunks.into_par_iter().for_each(|(range, begin, units)| {
            for i in range {
                let source = &wide.nodes[i];
                let mut place = places[i] - begin;
                for child in source.inner() {
                    units[place] = bytemuck::must_cast(new_node(child));
                    place += 1;
                }
                let Leaves::Blocks(block) = leaves else { continue };
                for (start, end) in source.leaf_ranges(tree) {
                    units[place] = bytemuck::must_cast(block(start, end));
                    place += 1;
                }
            }
        });
        Ok(Some(Reference::new(Kind::Node, root)))
    }
}

fn bounds(tree: &[BinaryNode]) -> Aabb {
    tree.first().map_or(Aabb::EMPTY, BinaryNode::bounds)
}
