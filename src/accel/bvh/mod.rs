//! The in-house BVH: binary by binned SAH, collapsed to eight children a node, traversed one ray at a time.
//!
//! Two levels: one hierarchy for the meshes that stand in the world, one for each object, and one over the
//! instances. Which primitive is hit is decided by the conservative boxes of `traverse`, by the watertight
//! edge test of `woop`, and among those that pass by the distance that [`super::resolve()`] computes in `f64`:
//! exact ties go to the smallest id. Knows nothing but `geometry`.

mod binned;
mod blocks;
mod collapse;
mod traverse;
mod wide;
mod woop;

use super::{Accelerator, BuildStats, HitFilter};
use crate::error::{Error, Result};
use crate::geometry::{Aabb, Geometry, Hit, Instance, Ray, TriangleMesh};
use crate::math::{DAffine3, Vec3};
use crate::os::Isa;
use binned::PrimitiveBox;
use blocks::Blocks;
use std::sync::Arc;
use std::time::Instant;
use wide::WideNode;

/// The in-house hierarchy over a geometry.
pub struct Bvh {
    geometry: Arc<Geometry>,
    /// Over the meshes that stand in the world.
    own: MeshBvh,
    /// Over each object's meshes, in its own space.
    objects: Vec<MeshBvh>,
    instances: InstanceBvh,
    stats: BuildStats,
}

/// A hierarchy over the triangles of some meshes.
struct MeshBvh {
    nodes: Vec<WideNode>,
    blocks: Blocks,
}

/// A hierarchy over placed objects.
struct InstanceBvh {
    nodes: Vec<WideNode>,
    /// Instances in the order of the leaves.
    order: Vec<u32>,
    /// For each instance.
    object_from_world: Vec<DAffine3>,
}

impl Bvh {
    /// Builds with at most `threads` threads (0: all); the result does not depend on their number.
    ///
    /// # Errors
    /// When an object has 2^30 triangles or more, or there are no threads.
    pub fn build(geometry: Arc<Geometry>, threads: usize) -> Result<Self> {
        let start = Instant::now();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| backend_error(&error.to_string()))?;
        let (own, objects, instances) = pool.install(|| {
            let own = MeshBvh::build(&geometry.meshes)?;
            let objects = geometry.objects.iter().map(|object| MeshBvh::build(&object.meshes));
            let objects = objects.collect::<Result<Vec<_>>>()?;
            let instances = InstanceBvh::build(&geometry, &objects)?;
            Ok::<_, Error>((own, objects, instances))
        })?;
        let bytes = own.bytes()
            + objects.iter().map(MeshBvh::bytes).sum::<usize>()
            + size_of_val(&*instances.nodes)
            + size_of_val(&*instances.order)
            + size_of_val(&*instances.object_from_world);
        let stats = BuildStats { seconds: start.elapsed().as_secs_f64(), bytes };
        Ok(Self { geometry, own, objects, instances, stats })
    }
}

impl MeshBvh {
    fn build(meshes: &[TriangleMesh]) -> Result<Self> {
        // Numbers of triangles and nodes have 32 bits, one of which tells leaves apart.
        if meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() >= 1 << 30 {
            return Err(backend_error("more than 2^30 triangles in one object"));
        }
        let boxes = blocks::boxes(meshes);
        let (tree, order) = binned::build(boxes, blocks::SIZE);
        let nodes = collapse::collapse(&tree)?;
        Ok(Self { nodes, blocks: Blocks::new(meshes, &tree, &order) })
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + self.blocks.bytes()
    }

    /// Box around everything in it, in its own space.
    fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, WideNode::bounds)
    }
}

impl InstanceBvh {
    fn build(geometry: &Geometry, objects: &[MeshBvh]) -> Result<Self> {
        if geometry.instances.len() >= 1 << 30 {
            return Err(backend_error("more than 2^30 instances"));
        }
        let inverse = |i: &Instance| i.world_from_object.to_f64().inverse();
        let object_from_world: Vec<_> = geometry.instances.iter().map(inverse).collect();
        let mut boxes = Vec::new();
        for (instance, id) in geometry.instances.iter().zip(0..) {
            let bounds = objects[instance.object as usize].bounds();
            let corner = |p| instance.world_from_object.transform_point_f64(p).as_vec3();
            let world = bounds.corners().map(corner);
            // What an object without triangles or a singular map leaves is never hit.
            let is_regular = object_from_world[id as usize].is_finite();
            if is_regular && !bounds.is_empty() && world.iter().all(|p| p.is_finite()) {
                let around = world.into_iter().fold(Aabb::EMPTY, Aabb::with_point);
                // The ray is transformed in `f32`: room for what that loses, a few units of the largest
                // coordinate on the way.
                let largest = around.min.abs().max(around.max.abs()).max_element();
                let margin = Vec3::splat(largest * 1e-6);
                let around = Aabb { min: around.min - margin, max: around.max + margin };
                boxes.push(PrimitiveBox { bounds: around, id });
            }
        }
        let (tree, order) = binned::build(boxes, 1);
        Ok(Self { nodes: collapse::collapse(&tree)?, order, object_from_world })
    }
}

impl Accelerator for Bvh {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        Isa::current().run(traverse::Closest { bvh: self, rays, filter, hits });
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        Isa::current().run(traverse::Occluded { bvh: self, rays, filter, blocked });
    }

    fn build_stats(&self) -> BuildStats {
        self.stats
    }
}

fn backend_error(message: &str) -> Error {
    Error::Backend { backend: "bvh", message: message.into() }
}
