//! Rays of every kind that a renderer traces, and those that are out to find gaps.

use glint::accel::resolve;
use glint::geometry::{Aabb, Geometry, NONE, PrimitiveId, Ray};
use glint::math::Vec3;
use glint::sampling::{CounterRng, warp};

/// Where rays come from and go to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// From one point outside towards a grid.
    Camera,
    /// From a point of a surface, off it as renderers do, in any direction.
    Bounce,
    /// From a point of a surface to another, and no further.
    Shadow,
    /// From anywhere to a corner, or to a point of an edge: the middle, or any.
    Aimed,
    /// Along an axis or a plane of two, through a corner or past one by little.
    AlongAxes,
    /// From anywhere in the scene's box to anywhere in it.
    Random,
}

impl Kind {
    pub(crate) const ALL: [Self; 6] =
        [Self::Camera, Self::Bounce, Self::Shadow, Self::Aimed, Self::AlongAxes, Self::Random];

    /// About `n` rays, always the same.
    pub(crate) fn rays(self, geometry: &Geometry, n: usize) -> Vec<Ray> {
        let bounds = geometry.bounds();
        let mut draw = Draw { geometry, rng: CounterRng::new(self as u64), bounds };
        let wide = (n as f32).sqrt().ceil() as usize;
        let rays = (0..n).map(|i| match self {
            Self::Camera => draw.camera([i % wide, i / wide].map(|k| k as f32 / wide as f32)),
            Self::Bounce => Ray::new(draw.surface(), draw.direction()),
            Self::Shadow => Ray::between(draw.surface(), draw.surface()),
            Self::Aimed => {
                let (origin, [a, b]) = (draw.anywhere(), draw.edge());
                let along = [0.0, 0.5, draw.rng.unit()][i % 3];
                Ray::new(origin, a + (b - a) * along - origin)
            }
            Self::AlongAxes => draw.along_axes(i),
            Self::Random => {
                let (from, to) = (draw.anywhere(), draw.anywhere());
                Ray::new(from, to - from)
            }
        });
        let rays = rays.filter(|ray| ray.direction != Vec3::ZERO).zip(0..);
        rays.map(|(ray, id)| Ray { id, ..ray }).collect()
    }
}

struct Draw<'a> {
    geometry: &'a Geometry,
    /// Of the geometry: worked out once.
    bounds: Aabb,
    rng: CounterRng,
}

impl Draw<'_> {
    fn direction(&mut self) -> Vec3 {
        warp::sphere([self.rng.unit(), self.rng.unit()])
    }

    fn anywhere(&mut self) -> Vec3 {
        let (bounds, rng) = (&self.bounds, &mut self.rng);
        bounds.min + bounds.extent() * Vec3::new(rng.unit(), rng.unit(), rng.unit())
    }

    fn camera(&self, [x, y]: [f32; 2]) -> Ray {
        let bounds = &self.bounds;
        let eye = bounds.center() + bounds.extent() * Vec3::new(0.9, 0.8, 1.1);
        let target = bounds.min + bounds.extent() * Vec3::new(x, y, 0.5);
        Ray::new(eye, target - eye)
    }

    /// Some triangle.
    fn triangle(&mut self) -> PrimitiveId {
        let Geometry { meshes, instances, objects } = self.geometry;
        let mut below = |n: usize| ((self.rng.unit() * n as f32) as usize).min(n - 1) as u32;
        let place = below(instances.len() + meshes.len());
        let (instance, meshes) = match instances.get(place as usize) {
            Some(instance) => (place, &objects[instance.object as usize].meshes),
            None => (NONE, meshes),
        };
        let geometry = below(meshes.len());
        let primitive = below(meshes[geometry as usize].triangles.len());
        PrimitiveId { instance, geometry, primitive }
    }

    /// Ends of an edge.
    fn edge(&mut self) -> [Vec3; 2] {
        let id = self.triangle();
        let [a, b, c] = self.geometry.world_vertices(id).0.map(|p| p.as_vec3());
        [[a, b], [b, c], [c, a]][(self.rng.unit() * 3.0) as usize]
    }

    /// A point off a surface, on either side.
    fn surface(&mut self) -> Vec3 {
        let id = self.triangle();
        let [a, b, c] = self.geometry.world_vertices(id).0.map(|p| p.as_vec3());
        let (s, t) = (self.rng.unit(), self.rng.unit());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let from = self.anywhere();
        let hit = resolve(self.geometry, &Ray::new(from, a + (b - a) * s + (c - a) * t - from), id);
        hit.point + hit.normal * hit.offset * if self.rng.unit() < 0.5 { 1.0 } else { -1.0 }
    }

    fn along_axes(&mut self, i: usize) -> Ray {
        let (mut origin, [corner, _]) = (self.anywhere(), self.edge());
        let mut direction = Vec3::ZERO;
        direction[i % 3] = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        if i.is_multiple_of(4) {
            direction[(i + 1) % 3] = self.rng.unit() - 0.5;
        }
        if !i.is_multiple_of(5) {
            // The origin is where the line through the corner begins: exactly so along one axis.
            let back = (origin - corner)[i % 3].abs();
            origin = corner - direction * back;
        }
        if i % 5 == 1 {
            origin[(i + 2) % 3] = origin[(i + 2) % 3].next_up();
        }
        Ray::new(origin, direction)
    }
}
