//! Every ray against every triangle: the slow, obvious answer that the tests hold backends against.

use super::{Accelerator, BuildStats, HitFilter, resolve};
use crate::geometry::{Geometry, Hit, NONE, PrimitiveId, Ray, TriangleMesh};
use crate::math::DVec3;
use std::sync::Arc;

/// No structure at all: O(rays x triangles).
#[derive(Clone, Debug)]
pub struct BruteForce {
    geometry: Arc<Geometry>,
}

impl BruteForce {
    /// Over all triangles of `geometry`.
    pub fn new(geometry: Arc<Geometry>) -> Self {
        Self { geometry }
    }

    /// Every primitive of the scene.
    fn ids(&self) -> impl Iterator<Item = PrimitiveId> {
        let primitives = |instance: u32, meshes: &[TriangleMesh]| {
            let counts: Vec<u32> = meshes.iter().map(|m| m.triangles.len() as u32).collect();
            counts.into_iter().enumerate().flat_map(move |(geometry, n)| {
                (0..n).map(move |primitive| PrimitiveId {
                    instance,
                    geometry: geometry as u32,
                    primitive,
                })
            })
        };
        let own = primitives(NONE, &self.geometry.meshes);
        let placed = self.geometry.instances.iter().enumerate().flat_map(move |(i, instance)| {
            primitives(i as u32, &self.geometry.objects[instance.object as usize].meshes)
        });
        own.chain(placed)
    }

    /// Accepted hits within the segment, in the order of their ids.
    fn hits<F: HitFilter>(&self, ray: &Ray, filter: &F) -> impl Iterator<Item = Hit> {
        self.ids().filter_map(move |id| {
            let (vertices, _) = self.geometry.world_vertices(id);
            if !crosses(ray, &vertices) {
                return None;
            }
            let hit = resolve(&self.geometry, ray, id);
            let counts = !self.geometry.mesh(id).filtered || filter.accept(ray, &hit);
            counts.then_some(hit)
        })
    }
}

impl Accelerator for BruteForce {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            // Exact ties go to the smallest id.
            let nearer = |h: &Hit, best: &Hit| h.t < best.t || (h.t == best.t && h.id < best.id);
            *hit = self
                .hits(ray, filter)
                .fold(Hit::MISS, |best, h| if nearer(&h, &best) { h } else { best });
        }
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = self.hits(ray, filter).next().is_some();
        }
    }

    fn build_stats(&self) -> BuildStats {
        BuildStats::default()
    }
}

/// Whether the segment meets the triangle, edges included, in `f64`.
fn crosses(ray: &Ray, [a, b, c]: &[DVec3; 3]) -> bool {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (a, b, c) = (*a - o, *b - o, *c - o);
    // Signed volumes of the ray with the three edges: all of one sign inside.
    let (u, v, w) = (d.dot(c.cross(b)), d.dot(a.cross(c)), d.dot(b.cross(a)));
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return false;
    }
    let n = (b - a).cross(c - a);
    let det = n.dot(d);
    if det == 0.0 {
        return false;
    }
    let t = n.dot(a) / det;
    t > f64::from(ray.t_min) && t < f64::from(ray.t_max)
}
