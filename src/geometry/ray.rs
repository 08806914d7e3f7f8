//! What is asked of an accelerator, and what it answers.

use crate::math::Vec3;

/// "No such index": the instance of a hit that is not inside one, the geometry of a miss.
pub const NONE: u32 = u32::MAX;

/// A ray segment `origin + t direction`, `t_min < t < t_max`. The default is no ray yet, for arrays to come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Start, in world space.
    pub origin: Vec3,
    /// Smallest parameter at which a surface counts; at least 0.
    pub t_min: f32,
    /// Direction; need not be normalised, must not be zero or NaN.
    pub direction: Vec3,
    /// Largest parameter; may be infinite.
    pub t_max: f32,
    /// What hit filters know this ray by: the path's own number, never its place in a batch.
    pub id: u32,
}

impl Ray {
    /// The unbounded ray from `origin` along `direction`.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, t_min: 0.0, direction, t_max: f32::INFINITY, id: 0 }
    }

    /// The segment strictly between two points, both already offset from their surfaces.
    #[inline]
    pub fn between(from: Vec3, to: Vec3) -> Self {
        // Three round-offs below 1: the end point itself is not reached.
        Self { t_max: 1.0 - 4.0 * f32::EPSILON, ..Self::new(from, to - from) }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Which primitive: this triple is all that a backend decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Zeroable)]
pub struct PrimitiveId {
    /// Index into [`super::Geometry::instances`], or [`NONE`] for the root's own meshes.
    pub instance: u32,
    /// Index of the mesh in the instance's object, or in [`super::Geometry::meshes`].
    pub geometry: u32,
    /// Index of the triangle in the mesh.
    pub primitive: u32,
}

impl Default for PrimitiveId {
    fn default() -> Self {
        Self::MISS
    }
}

impl PrimitiveId {
    /// The id of a miss.
    pub const MISS: Self = Self { instance: NONE, geometry: NONE, primitive: NONE };
}

/// The closest surface along a ray, or a miss.
///
/// All but `id` is recomputed from the ray and the three vertices by
/// [`super::intersect_triangle`], so that it has the same bits for every backend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter; infinite for a miss.
    pub t: f32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// How far along the geometric normal a ray must start to be past the surface for sure.
    pub offset: f32,
    /// The point at (u, v).
    pub point: Vec3,
    /// Unit normal of the triangle in world space, on the side its transformed winding faces. (Kept with
    /// the point, because fetching the vertices a second time costs more than carrying both.)
    pub normal: Vec3,
    /// Which primitive.
    pub id: PrimitiveId,
}

impl Hit {
    /// The ray left the scene.
    pub const MISS: Self = Self {
        t: f32::INFINITY,
        u: 0.0,
        v: 0.0,
        offset: 0.0,
        point: Vec3::ZERO,
        normal: Vec3::ZERO,
        id: PrimitiveId::MISS,
    };

    /// Whether anything was hit.
    #[inline]
    pub fn is_hit(&self) -> bool {
        self.id.geometry != NONE
    }
}
