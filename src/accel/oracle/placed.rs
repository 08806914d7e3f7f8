//! The triangles of some meshes in a tree, and where an instance puts them. Knows no rays.

use super::tree::{Bounds, BoxTree};
use crate::geometry::{Instance, TriangleMesh};
use crate::math::{DAffine3, Vec3};

/// A tree over the triangles of some meshes, in their own space.
pub(super) struct MeshTree {
    pub(super) tree: BoxTree,
    /// Number of each mesh's first triangle; the tree numbers triangles through all meshes.
    first: Vec<u32>,
}

impl MeshTree {
    /// Leaves out triangles with a corner that is not finite: no ray meets them.
    pub(super) fn new(meshes: &[TriangleMesh]) -> Self {
        let all = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        let mut boxes = Vec::with_capacity(all);
        let mut first = Vec::with_capacity(meshes.len());
        let mut next = 0_u32;
        for mesh in meshes {
            first.push(next);
            for primitive in 0..mesh.triangles.len() as u32 {
                let corners = mesh.vertices(primitive);
                if corners.iter().all(|p| p.is_finite()) {
                    boxes.push((Bounds::around(corners.map(Vec3::as_dvec3)), next + primitive));
                }
            }
            next += mesh.triangles.len() as u32;
        }
        Self { tree: BoxTree::new(boxes), first }
    }

    /// Mesh of a triangle, and its place in there.
    pub(super) fn locate(&self, triangle: u32) -> (u32, u32) {
        // The last mesh that begins at or before it: empty meshes share their start with the next.
        let mesh = self.first.partition_point(|&first| first <= triangle) - 1;
        (mesh as u32, triangle - self.first[mesh])
    }

    /// Box around everything in it.
    pub(super) fn bounds(&self) -> Option<&Bounds> {
        self.tree.nodes.first().map(|root| &root.bounds)
    }
}

/// Where an instance stands.
pub(super) struct Placement {
    pub(super) object: u32,
    pub(super) world_from_object: DAffine3,
    pub(super) object_from_world: DAffine3,
}

impl Placement {
    /// `None` if the map has no inverse: what it places is never hit.
    pub(super) fn new(instance: &Instance) -> Option<Self> {
        let world_from_object = instance.world_from_object.to_f64();
        let object_from_world = world_from_object.inverse();
        let is_regular = world_from_object.is_finite() && object_from_world.is_finite();
        is_regular.then_some(Self { object: instance.object, world_from_object, object_from_world })
    }

    /// A box in world space around all that lies in `bounds`: around the very numbers that
    /// [`crate::geometry::Geometry::world_vertices`] gives.
    ///
    /// Those, and the planes here, are sums of four terms. The terms are exact (`f32` times `f32`), each of three
    /// sums is rounded once: both are off by at most 4 u of the sum of absolute values, u = 2^-53, which is itself
    /// as large here but for as much. 32 u of it makes up for all.
    pub(super) fn world_bounds(&self, bounds: &Bounds) -> Bounds {
        const PAD: f64 = 16.0 * f64::EPSILON;
        let DAffine3 { matrix3, translation } = self.world_from_object;
        let (mut low, mut high, mut size) = (translation, translation, translation.abs());
        for (k, column) in [matrix3.x_axis, matrix3.y_axis, matrix3.z_axis].into_iter().enumerate()
        {
            let (p, q) = (column * bounds.low[k], column * bounds.high[k]);
            low += p.min(q);
            high += p.max(q);
            size += p.abs().max(q.abs());
        }
        Bounds { low, high }.padded(size * PAD)
    }
}
