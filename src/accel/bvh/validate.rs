//! Walks the finished hierarchy: what it is made of, and whether everything is where it must be.
//!
//! Knows how trees are stored; nothing of rays.

use super::hierarchy::{Hierarchy, Tree};
use super::node::{Kind, Node, Reference, WIDTH};
use super::{Bvh, backend_error, block};
use crate::accel::TreeShape;
use crate::error::Result;
use crate::geometry::{Aabb, TriangleMesh};
use crate::math::{DVec3, Vec3};

/// What a hierarchy is made of: the trees over triangles together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeStatistics {
    /// Nodes of up to sixteen children, leaves of up to eight triangles. The cost is that of the boxes as they are
    /// stored, a little larger than those that [`BuildStats::shape`](crate::accel::BuildStats) is about.
    pub shape: TreeShape,
    /// Triangles in leaves.
    pub triangles: usize,
    /// Bytes of everything ([`BuildStats::bytes`](crate::accel::BuildStats)) over the triangles in leaves.
    pub bytes_per_triangle: f64,
}

impl Bvh {
    /// What the hierarchy is made of, after checking that each finite triangle is in exactly one leaf, inside of the boxes
    /// on the way to it, and each instance that can be hit in one leaf.
    ///
    /// # Errors
    /// What is wrong, if anything is: a bug of the builder, or memory that was overwritten.
    pub fn validate(&self) -> Result<TreeStatistics> {
        let mut all = TreeStatistics::default();
        let geometry = &self.geometry;
        let objects = geometry.objects.iter().map(|object| &object.meshes);
        let trees = std::iter::once(&self.hierarchy.own).chain(&self.hierarchy.objects);
        for (meshes, tree) in std::iter::once(&geometry.meshes).chain(objects).zip(trees) {
            let mut walk = Walk::new(&self.hierarchy, tree, Some(meshes));
            let statistics = walk.run()?;
            all.shape.add(&statistics.shape);
            all.triangles += statistics.triangles;
        }
        let seen = Walk::new(&self.hierarchy, &self.hierarchy.instances, None).run()?.shape.leaves;
        ensure(seen == self.hierarchy.instance_count(), "an instance is missing")?;
        all.bytes_per_triangle = self.stats.bytes as f64 / all.triangles.max(1) as f64;
        Ok(all)
    }
}

/// A walk through one tree.
struct Walk<'a> {
    hierarchy: &'a Hierarchy,
    tree: &'a Tree,
    /// `None` for the tree over instances.
    meshes: Option<&'a [TriangleMesh]>,
    /// How often each triangle was seen, by mesh.
    seen: Vec<Vec<u8>>,
}

impl<'a> Walk<'a> {
    fn new(
        hierarchy: &'a Hierarchy,
        tree: &'a Tree,
        meshes: Option<&'a Vec<TriangleMesh>>,
    ) -> Self {
        let meshes = meshes.map(Vec::as_slice);
        let seen = meshes.unwrap_or(&[]).iter().map(|mesh| vec![0; mesh.triangles.len()]).collect();
        Self { hierarchy, tree, meshes, seen }
    }

    fn run(&mut self) -> Result<TreeStatistics> {
        let mut statistics = TreeStatistics::default();
        let mut surface = 0.0;
        let root_box = self.tree.bounds;
        let mut open: Vec<_> = self.tree.root.map(|root| (root, root_box, 1)).into_iter().collect();
        while let Some((reference, bounds, depth)) = open.pop() {
            surface += half_area(&bounds);
            match (reference.kind(), self.meshes) {
                (NODE, _) => {
                    let node = self.hierarchy.checked_node(reference);
                    let node = node.ok_or_else(|| backend_error("a node is out of bounds"))?;
                    statistics.shape.nodes += 1;
                    statistics.shape.depth = statistics.shape.depth.max(depth);
                    for i in (0..WIDTH).filter(|i| node.present >> i & 1 != 0) {
                        let child = child_bounds(node, i);
                        // What is in all boxes on the way.
                        let within =
                            Aabb { min: child.min.max(bounds.min), max: child.max.min(bounds.max) };
                        open.push((node.child(i), within, depth + 1));
                    }
                }
                (LEAF, Some(meshes)) => {
                    statistics.shape.leaves += 1;
                    statistics.triangles += self.leaf(reference, &bounds, meshes)?;
                }
                (INSTANCE, None) => {
                    statistics.shape.leaves += 1;
                    let is_there = self.hierarchy.instance(reference).is_some();
                    ensure(is_there, "an instance is out of bounds")?;
                }
                _ => return Err(backend_error("a reference is of the wrong kind")),
            }
        }
        for (mesh, seen) in self.meshes.unwrap_or(&[]).iter().zip(&self.seen) {
            for (triangle, &count) in (0..).zip(seen) {
                let is_finite = mesh.vertices(triangle).iter().all(|p| p.is_finite());
                ensure(count == u8::from(is_finite), "a triangle is not in exactly one leaf")?;
            }
        }
        statistics.shape.sah_cost = surface / half_area(&root_box).max(f64::MIN_POSITIVE);
        Ok(statistics)
    }

    /// Checks a leaf; returns how many triangles are in it.
    fn leaf(
        &mut self,
        reference: Reference,
        bounds: &Aabb,
        meshes: &[TriangleMesh],
    ) -> Result<usize> {
        let block = self.hierarchy.checked_block(reference, self.tree, meshes);
        let block = block.ok_or_else(|| backend_error("a leaf is out of bounds"))?;
        let mut count = 0;
        for lane in 0..block::SIZE {
            if !block.has(lane) {
                continue;
            }
            let triangle = self.hierarchy.triangle(reference, lane);
            count += 1;
            let id = self.tree.numbers.id(triangle, 0);
            let seen = self.seen[id.geometry as usize].get_mut(id.primitive as usize);
            *seen.ok_or_else(|| backend_error("a triangle is out of bounds"))? += 1;
            let corners = meshes[id.geometry as usize].vertices(id.primitive);
            ensure(block.vertices(lane) == corners, "a leaf has another triangle's corners")?;
            for corner in corners {
                let is_inside = corner.cmpge(bounds.min).all() && corner.cmple(bounds.max).all();
                ensure(is_inside, "a triangle is outside of its leaf's box")?;
            }
        }
        Ok(count)
    }
}

const NODE: usize = Kind::Node as usize;
const LEAF: usize = Kind::Leaf as usize;
const INSTANCE: usize = Kind::Instance as usize;

/// The box of child `i` of a node, exactly or a little larger.
fn child_bounds(node: &Node, i: usize) -> Aabb {
    let plane = |axis: usize, side: usize| {
        let steps = f64::from(node.planes[axis][side + i]);
        f64::from(node.origin[axis]) + steps * f64::from(node.step(axis))
    };
    let lower = [0, 1, 2].map(|axis| (plane(axis, 0) as f32).next_down());
    let upper = [0, 1, 2].map(|axis| (plane(axis, WIDTH) as f32).next_up());
    Aabb { min: Vec3::from_array(lower), max: Vec3::from_array(upper) }
}

fn half_area(bounds: &Aabb) -> f64 {
    let e = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max(DVec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}

fn ensure(condition: bool, otherwise: &str) -> Result<()> {
    if condition { Ok(()) } else { Err(backend_error(otherwise)) }
}
