//! Triangle meshes, objects made of them, and one level of instances: what an accelerator is built from.

use super::{Aabb, Buffer, NONE, PrimitiveId};
use crate::math::{Affine, DVec3, Vec3};

/// An indexed triangle mesh. Every index is below the number of positions (checked at construction).
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    /// Vertex positions.
    pub positions: Buffer<[f32; 3]>,
    /// Three vertex indices a triangle.
    pub triangles: Buffer<[u32; 3]>,
    /// Whether hit filters must be asked about it (cut-outs).
    pub filtered: bool,
}

impl TriangleMesh {
    /// A mesh of these arrays.
    ///
    /// # Panics
    /// When an index is out of range: loaders check user input before this.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>, filtered: bool) -> Self {
        let n = positions.len();
        assert!(
            triangles.iter().flatten().all(|&i| (i as usize) < n),
            "a triangle names a vertex that does not exist"
        );
        Self { positions: Buffer::new(positions), triangles: Buffer::new(triangles), filtered }
    }

    /// The three corners of `primitive`, in object space.
    #[inline(always)]
    pub fn vertices(&self, primitive: u32) -> [Vec3; 3] {
        self.triangles[primitive as usize].map(|i| Vec3::from_array(self.positions[i as usize]))
    }

    /// Box around the vertices that triangles use.
    pub fn bounds(&self) -> Aabb {
        self.triangles
            .iter()
            .flatten()
            .fold(Aabb::EMPTY, |b, &i| b.with_point(Vec3::from_array(self.positions[i as usize])))
    }
}

/// Meshes that are placed together by instances.
#[derive(Clone, Debug, Default)]
pub struct Object {
    /// The meshes; `PrimitiveId::geometry` indexes them.
    pub meshes: Vec<TriangleMesh>,
}

/// A placed copy of an object.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// Index into [`Geometry::objects`].
    pub object: u32,
    /// Places it.
    pub world_from_object: Affine,
    /// What an `f32` transformation to object space and back can lose, as a multiple of the round-off
    /// of world coordinates: the condition number of the linear part.
    condition: f32,
    /// Largest absolute coordinate of the translation.
    translation_magnitude: f32,
}

impl Instance {
    /// Places `object` by `world_from_object`, which must be invertible.
    pub fn new(object: u32, world_from_object: Affine) -> Self {
        let linear = world_from_object.to_f64().matrix3;
        let norm = |m: glam::DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        // Frobenius norms: 3 for any rotation with uniform scale, larger for skewed maps.
        let condition = (norm(linear) * norm(linear.inverse())) as f32;
        let [x, y, z] = world_from_object.columns[3];
        let translation_magnitude = x.abs().max(y.abs()).max(z.abs());
        Self { object, world_from_object, condition, translation_magnitude }
    }
}

/// All triangles of a world: the root's own meshes, and instances of objects.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Meshes placed once, already in world space.
    pub meshes: Vec<TriangleMesh>,
    /// Meshes placed by instances, in object space.
    pub objects: Vec<Object>,
    /// The placements.
    pub instances: Vec<Instance>,
}

impl Geometry {
    /// The mesh that a hit is in.
    #[inline(always)]
    pub fn mesh(&self, id: PrimitiveId) -> &TriangleMesh {
        if id.instance == NONE {
            &self.meshes[id.geometry as usize]
        } else {
            let object = self.instances[id.instance as usize].object;
            &self.objects[object as usize].meshes[id.geometry as usize]
        }
    }

    /// The corners of a primitive in world space, exact to `f64` round-off, and the magnitude (in world
    /// units) by whose `f32` round-off a backend may have misplaced it, beyond the corners' own.
    #[inline(always)]
    pub fn world_vertices(&self, id: PrimitiveId) -> ([DVec3; 3], f32) {
        self.placed_vertices(self.mesh(id).vertices(id.primitive), id.instance)
    }

    /// [`Self::world_vertices`] of a triangle with these corners in its mesh, in an instance or in [`NONE`].
    #[inline]
    pub fn placed_vertices(&self, local: [Vec3; 3], instance: u32) -> ([DVec3; 3], f32) {
        if instance == NONE {
            return (local.map(Vec3::as_dvec3), 0.0);
        }
        let instance = &self.instances[instance as usize];
        let world = local.map(|p| instance.world_from_object.transform_point_f64(p));
        let largest = world.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element())) as f32;
        (world, instance.condition * (largest + instance.translation_magnitude))
    }

    /// Whether there is any mesh that hit filters must be asked about.
    pub fn has_filtered_meshes(&self) -> bool {
        self.all_meshes().any(|m| m.filtered)
    }

    /// Has hit filters asked about every mesh.
    pub fn filter_everything(&mut self) {
        let objects = self.objects.iter_mut().flat_map(|object| &mut object.meshes);
        self.meshes.iter_mut().chain(objects).for_each(|mesh| mesh.filtered = true);
    }

    /// Number of triangles stored (instances not multiplied).
    pub fn stored_triangles(&self) -> usize {
        self.all_meshes().map(|m| m.triangles.len()).sum()
    }

    /// Number of triangles a ray can meet (each instance counted).
    pub fn placed_triangles(&self) -> usize {
        let per_object: Vec<usize> =
            self.objects.iter().map(|o| o.meshes.iter().map(|m| m.triangles.len()).sum()).collect();
        self.meshes.iter().map(|m| m.triangles.len()).sum::<usize>()
            + self.instances.iter().map(|i| per_object[i.object as usize]).sum::<usize>()
    }

    /// Bytes of vertex and index buffers.
    pub fn bytes(&self) -> usize {
        self.all_meshes().map(|m| m.positions.bytes() + m.triangles.bytes()).sum()
    }

    /// Points whose convex hull holds everything: the vertices of own meshes, the boxes of instances.
    pub fn hull_points(&self) -> impl Iterator<Item = Vec3> {
        let own = self.meshes.iter().flat_map(|m| m.positions.iter().map(|p| Vec3::from_array(*p)));
        let objects = self.object_bounds();
        own.chain(self.instances.iter().flat_map(move |instance| {
            let b = objects[instance.object as usize];
            let used = if b.is_empty() { 0 } else { 8 };
            b.corners()
                .into_iter()
                .take(used)
                .map(|corner| instance.world_from_object.transform_point_f64(corner).as_vec3())
        }))
    }

    /// Area of the triangles that lie flat on the lower side of `bounds` along `axis`: what the scene
    /// would stand on if that axis were up. Own meshes only.
    pub fn resting_area(&self, bounds: &Aabb, axis: usize) -> f32 {
        let height = bounds.min[axis] + 0.01 * bounds.extent()[axis];
        let flat = |t: &[Vec3; 3]| t.iter().all(|p| p[axis] <= height);
        let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
        self.meshes
            .iter()
            .flat_map(|m| (0..m.triangles.len() as u32).map(|i| m.vertices(i)))
            .filter(flat)
            .map(area)
            .sum()
    }

    /// Box around everything, in world space.
    pub fn bounds(&self) -> Aabb {
        let own = self.meshes.iter().fold(Aabb::EMPTY, |b, m| b.union(m.bounds()));
        let objects = self.object_bounds();
        self.instances.iter().fold(own, |all, instance| {
            let b = objects[instance.object as usize];
            if b.is_empty() {
                return all;
            }
            b.corners().into_iter().fold(all, |all, corner| {
                let p = instance.world_from_object.transform_point_f64(corner);
                all.with_point(p.as_vec3())
            })
        })
    }

    /// Box around each object, in its own space.
    fn object_bounds(&self) -> Vec<Aabb> {
        let bounds = |o: &Object| o.meshes.iter().fold(Aabb::EMPTY, |b, m| b.union(m.bounds()));
        self.objects.iter().map(bounds).collect()
    }

    fn all_meshes(&self) -> impl Iterator<Item = &TriangleMesh> {
        self.meshes.iter().chain(self.objects.iter().flat_map(|o| &o.meshes))
    }
}
