//! From the primitive that a backend named to the hit: the same bits for every backend.
//!
//! [`resolve`] does it for one ray; [`resolve_all`] for many, in vector instructions, by the same functions.

use crate::geometry::{
    Geometry, Hit, PrimitiveId, Ray, TriangleHit, intersect_triangle, offset_distance,
};
use crate::math::{DVec3, Vec3};
use crate::os::{Isa, Kernel};

/// The hit of `ray` on the primitive that a backend named.
#[inline]
pub fn resolve(geometry: &Geometry, ray: &Ray, id: PrimitiveId) -> Hit {
    resolve_at(ray, id, geometry.world_vertices(id))
}

/// [`resolve`] with what [`Geometry::world_vertices`] says of the primitive.
#[inline]
pub(super) fn resolve_at(
    ray: &Ray,
    id: PrimitiveId,
    (vertices, instance_magnitude): ([DVec3; 3], f32),
) -> Hit {
    let TriangleHit { t, u, v, point, normal } = intersect_triangle(ray, &vertices);
    let offset = offset_distance(point, &vertices, instance_magnitude);
    Hit { t, u, v, offset, point, normal, id }
}

/// [`resolve`] for each ray with its id; misses stay misses.
pub fn resolve_all(geometry: &Geometry, rays: &[Ray], ids: &[PrimitiveId], hits: &mut [Hit]) {
    let mut lanes = Lanes::new();
    for ((rays, ids), hits) in rays.chunks(LANES).zip(ids.chunks(LANES)).zip(hits.chunks_mut(LANES))
    {
        // Which rays hit is random: told apart without a branch.
        let mut places = [0; LANES];
        let mut count = 0;
        for (place, &id) in ids.iter().enumerate() {
            hits[place] = Hit::MISS;
            places[count] = place;
            count += usize::from(id != PrimitiveId::MISS);
        }
        if count == 0 {
            continue;
        }
        // Vertex fetches of neighbouring rays overlap.
        for (lane, &place) in places[..count].iter().enumerate() {
            lanes.set(lane, &rays[place], geometry.world_vertices(ids[place]));
        }
        lanes.resolve();
        for (lane, &place) in places[..count].iter().enumerate() {
            hits[place] = lanes.hit(lane, ids[place]);
        }
    }
}

/// Hits that are resolved together.
pub(super) const LANES: usize = 32;

/// Rays, vertices and results, as one array a number.
pub(super) struct Lanes {
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    t_min: [f32; LANES],
    vertices: [[[f64; LANES]; 3]; 3],
    instance_magnitude: [f32; LANES],
    /// t, u, v and offset.
    numbers: [[f32; LANES]; 4],
    point: [[f32; LANES]; 3],
    normal: [[f32; LANES]; 3],
}

impl Lanes {
    pub(super) fn new() -> Self {
        Self {
            origin: [[0.0; LANES]; 3],
            direction: [[0.0; LANES]; 3],
            t_min: [0.0; LANES],
            vertices: [[[0.0; LANES]; 3]; 3],
            instance_magnitude: [0.0; LANES],
            numbers: [[0.0; LANES]; 4],
            point: [[0.0; LANES]; 3],
            normal: [[0.0; LANES]; 3],
        }
    }

    /// Puts a ray and a triangle in a lane.
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, ray: &Ray, (vertices, magnitude): ([DVec3; 3], f32)) {
        for k in 0..3 {
            self.origin[k][i] = ray.origin[k];
            self.direction[k][i] = ray.direction[k];
            for (lanes, vertex) in self.vertices.iter_mut().zip(&vertices) {
                lanes[k][i] = vertex[k];
            }
        }
        self.t_min[i] = ray.t_min;
        self.instance_magnitude[i] = magnitude;
    }

    /// Intersects the rays and triangles of all lanes.
    #[inline]
    pub(super) fn resolve(&mut self) {
        Isa::current().run(ResolveKernel { lanes: self });
    }

    /// The hit in a lane.
    #[inline(always)]
    pub(super) fn hit(&self, i: usize, id: PrimitiveId) -> Hit {
        // One by one: `map` would move the whole arrays.
        let [t, u, v, offset] = &self.numbers;
        let (t, u, v, offset) = (t[i], u[i], v[i], offset[i]);
        let vector = |v: &[[f32; LANES]; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
        Hit { t, u, v, offset, point: vector(&self.point), normal: vector(&self.normal), id }
    }
}

struct ResolveKernel<'a> {
    lanes: &'a mut Lanes,
}

impl Kernel for ResolveKernel<'_> {
    #[inline(always)]
    fn run(self) {
        let Lanes {
            origin,
            direction,
            t_min,
            vertices,
            instance_magnitude,
            numbers,
            point: points,
            normal: normals,
        } = self.lanes;
        for i in 0..LANES {
            let vector = |v: &[[f32; LANES]; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
            let vertex = |v: &[[f64; LANES]; 3]| DVec3::new(v[0][i], v[1][i], v[2][i]);
            let [a, b, c] = &*vertices;
            let triangle = [vertex(a), vertex(b), vertex(c)];
            let ray = Ray { t_min: t_min[i], ..Ray::new(vector(origin), vector(direction)) };
            let TriangleHit { t, u, v, point, normal } = intersect_triangle(&ray, &triangle);
            let offset = offset_distance(point, &triangle, instance_magnitude[i]);
            for (lanes, value) in numbers.iter_mut().zip([t, u, v, offset]) {
                lanes[i] = value;
            }
            for k in 0..3 {
                points[k][i] = point[k];
                normals[k][i] = normal[k];
            }
        }
    }
}
