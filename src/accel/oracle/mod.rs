//! The exact oracle: what a ray hits, decided without rounding, to judge the backends by.
//!
//! A ray is its `f32` numbers, a triangle the corners that [`Geometry::world_vertices`] gives (`f32` where a mesh
//! stands in the world, `f64` under an instance), and both are taken as they are: no tolerance, no rounding.
//! [`Oracle::closest`] finds every triangle at the smallest parameter; two are equally near only if
//! the quotients are equal as rational numbers. [`Oracle::judge`] says of a backend's answer whether it is
//! right, and if not, whether the rounding of the in-house kernel excuses it (`band`).
//!
//! Every number is a multiple of a power of two, so whole numbers (`dyadic`) decide all; an `f64` filter with a
//! proven bound (`triple`) decides nearly all of it first. Its own tree (`tree`, `walk`) leaves out nothing that
//! the exact test would accept. It shares no code with the backends but [`crate::accel::resolve()`], whose
//! distances are part of the rule that they keep. Instances whose map has no inverse are never hit.

mod band;
mod crossing;
mod dyadic;
mod judge;
mod patch;
mod placed;
mod tree;
mod triple;
mod walk;

pub use band::EdgeDistance;
pub use crossing::Place;
pub use judge::{Class, Judgement, Overlooked};

use super::{HitFilter, resolve};
use crate::geometry::{Geometry, NONE, PrimitiveId, Ray};
use crossing::Crossing;
use placed::{MeshTree, Placement};
use std::cmp::Ordering;
use std::sync::Arc;
use tree::BoxTree;
use walk::Line;

/// Answers exactly; a hundred times slower than a backend, and fit for scenes of millions of triangles.
pub struct Oracle {
    geometry: Arc<Geometry>,
    /// The meshes that stand in the world.
    own: MeshTree,
    objects: Vec<MeshTree>,
    /// For each instance; none if its map has no inverse.
    placements: Vec<Option<Placement>>,
    /// Over the instances, in world space.
    instances: BoxTree,
}

/// What a ray meets first.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Every triangle at the smallest parameter, by id, and where the ray passes through it. Nothing if the ray
    /// meets nothing; more than one at shared edges and corners, and where triangles coincide.
    pub nearest: Vec<(PrimitiveId, Place)>,
    /// Bounds of that parameter, at most 2^-35 of it apart; infinite if nothing is met.
    pub t: [f64; 2],
    /// Triangles without area or seen edge-on that the ray meets before that or there, by id: nobody's fault if
    /// they are reported or not.
    pub grazed: Vec<PrimitiveId>,
}

impl Oracle {
    /// Over all triangles of `geometry`. Objects have fewer than 2^32 triangles.
    pub fn build(geometry: Arc<Geometry>) -> Self {
        let own = MeshTree::new(&geometry.meshes);
        let objects: Vec<_> = geometry.objects.iter().map(|o| MeshTree::new(&o.meshes)).collect();
        let placements: Vec<_> = geometry.instances.iter().map(Placement::new).collect();
        let boxes = placements.iter().zip(0..).filter_map(|(placement, id)| {
            let placement = placement.as_ref()?;
            let bounds = objects[placement.object as usize].bounds()?;
            Some((placement.world_bounds(bounds), id))
        });
        let instances = BoxTree::new(boxes.collect());
        Self { geometry, own, objects, placements, instances }
    }

    /// The triangles that `ray` meets first among those that `filter` accepts, exactly. A ray that is not finite
    /// (`t_max` excepted) or has no direction meets nothing.
    pub fn closest<F: HitFilter>(&self, ray: &Ray, filter: &F) -> Verdict {
        let mut nearest =
            Nearest { oracle: self, ray, filter, met: Vec::new(), grazed: Vec::new() };
        if is_regular(ray) {
            let line = Line::new(ray.origin.as_dvec3(), ray.direction.as_dvec3());
            let start = f64::from(ray.t_min);
            line.walk(
                &self.own.tree,
                [start, nearest.end()],
                |bounds| *bounds,
                |triangle| nearest.consider(self.own_id(triangle)),
            );
            let range = [start, nearest.end()];
            line.walk(
                &self.instances,
                range,
                |bounds| *bounds,
                |instance| nearest.enter(&line, instance),
            );
        }
        nearest.verdict()
    }

    fn own_id(&self, triangle: u32) -> PrimitiveId {
        let (geometry, primitive) = self.own.locate(triangle);
        PrimitiveId { instance: NONE, geometry, primitive }
    }

    fn placed_id(&self, instance: u32, meshes: &MeshTree, triangle: u32) -> PrimitiveId {
        let (geometry, primitive) = meshes.locate(triangle);
        PrimitiveId { instance, geometry, primitive }
    }

    /// Where and whether the line of `ray` meets a triangle.
    fn cross(&self, ray: &Ray, id: PrimitiveId) -> Option<Crossing> {
        let vertices = self.geometry.world_vertices(id).0;
        let is_finite = vertices.iter().all(|v| v.is_finite());
        if is_finite { Crossing::new(ray, &vertices) } else { None }
    }

    /// Whether the triangle is there for this ray.
    fn accepts<F: HitFilter>(&self, ray: &Ray, filter: &F, id: PrimitiveId) -> bool {
        !self.geometry.mesh(id).filtered || filter.accept(ray, &resolve(&self.geometry, ray, id))
    }
}

fn is_regular(ray: &Ray) -> bool {
    let finite = ray.origin.is_finite() && ray.direction.is_finite() && ray.t_min.is_finite();
    finite && !ray.t_max.is_nan() && ray.direction != crate::math::Vec3::ZERO
}

/// The search of one ray for what it meets first.
struct Nearest<'a, F> {
    oracle: &'a Oracle,
    ray: &'a Ray,
    filter: &'a F,
    /// All at the same, smallest parameter so far.
    met: Vec<(PrimitiveId, Crossing)>,
    grazed: Vec<(PrimitiveId, Crossing)>,
}

impl<F: HitFilter> Nearest<'_, F> {
    /// The parameter beyond which nothing is of interest.
    fn end(&self) -> f64 {
        self.met.first().map_or(f64::from(self.ray.t_max), |(_, crossing)| crossing.t[1])
    }

    /// Searches the object of an instance. The ray stays in the world; boxes come to it.
    fn enter(&mut self, line: &Line, instance: u32) -> f64 {
        let oracle = self.oracle;
        if let Some(placement) = &oracle.placements[instance as usize] {
            let meshes = &oracle.objects[placement.object as usize];
            let range = [f64::from(self.ray.t_min), self.end()];
            line.walk(
                &meshes.tree,
                range,
                |bounds| placement.world_bounds(bounds),
                |triangle| self.consider(oracle.placed_id(instance, meshes, triangle)),
            );
        }
        self.end()
    }

    fn consider(&mut self, id: PrimitiveId) -> f64 {
        let Some(crossing) = self.oracle.cross(self.ray, id) else { return self.end() };
        let order = match self.met.first() {
            Some((_, first)) if crossing.place.is_proper() => crossing.compare(first),
            _ => Ordering::Less,
        };
        let counts =
            order.is_le() && crossing.is_within() && self.oracle.accepts(self.ray, self.filter, id);
        if counts && !crossing.place.is_proper() {
            self.grazed.push((id, crossing));
        } else if counts {
            if order.is_lt() {
                self.met.clear();
            }
            self.met.push((id, crossing));
        }
        self.end()
    }

    fn verdict(self) -> Verdict {
        let t = self.met.first().map_or([f64::INFINITY; 2], |(_, crossing)| crossing.t);
        let mut nearest: Vec<_> = self.met.iter().map(|(id, c)| (*id, c.place)).collect();
        let before =
            |(id, crossing): &(PrimitiveId, Crossing)| (crossing.t[0] <= t[1]).then_some(*id);
        let mut grazed: Vec<_> = self.grazed.iter().filter_map(before).collect();
        nearest.sort_unstable_by_key(|met| met.0);
        grazed.sort_unstable();
        Verdict { nearest, t, grazed }
    }
}
