//! Backends with one fault each, to see that the comparison finds it.

use glint::accel::{Accelerator, AcceptAll, BruteForce, BuildStats, HitFilter, resolve};
use glint::geometry::{Geometry, Hit, NONE, PrimitiveId, Ray};
use std::sync::Arc;

/// What is wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    Nothing,
    /// Hits within a thousandth of an edge are lost.
    DropsEdges,
    /// Now and then what lies behind is reported.
    WrongOrder,
    /// Now and then the next instance is reported.
    WrongInstance,
    /// Now and then the next triangle is reported.
    WrongTriangle,
    /// Now and then something is met where nothing is.
    MeetsNothing,
    /// Now and then a shadow is lost.
    LosesShadows,
    /// What is cut out is there all the same.
    IgnoresFilter,
    /// A ray that comes alone misses now and then.
    DislikesSingles,
}

pub(crate) struct Faulty {
    pub(crate) geometry: Arc<Geometry>,
    pub(crate) inner: BruteForce,
    pub(crate) fault: Fault,
}

impl Faulty {
    pub(crate) fn new(geometry: &Arc<Geometry>, fault: Fault) -> Self {
        let (geometry, inner) = (geometry.clone(), BruteForce::new(geometry.clone()));
        Self { geometry, inner, fault }
    }

    fn altered<F: HitFilter>(&self, ray: &Ray, filter: &F, hit: Hit, is_single: bool) -> Hit {
        let now_and_then = ray.id.is_multiple_of(7);
        let named = |id: PrimitiveId| resolve(&self.geometry, ray, id);
        match self.fault {
            Fault::DropsEdges if hit.u.min(hit.v).min(1.0 - hit.u - hit.v) < 1e-3 => Hit::MISS,
            Fault::WrongOrder if now_and_then && hit.is_hit() => {
                let mut second = [Hit::MISS];
                self.inner.closest(&[Ray { t_min: hit.t * 1.001, ..*ray }], filter, &mut second);
                if second[0].is_hit() { named(second[0].id) } else { hit }
            }
            Fault::WrongInstance if now_and_then && hit.id.instance < NONE => {
                named(PrimitiveId { instance: 1 - hit.id.instance, ..hit.id })
            }
            Fault::WrongTriangle if now_and_then && hit.is_hit() => {
                named(PrimitiveId { primitive: hit.id.primitive ^ 1, ..hit.id })
            }
            Fault::MeetsNothing if now_and_then && !hit.is_hit() => {
                named(PrimitiveId { instance: NONE, geometry: 0, primitive: 0 })
            }
            Fault::DislikesSingles if now_and_then && is_single => Hit::MISS,
            _ => hit,
        }
    }
}

impl Accelerator for Faulty {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        match self.fault {
            Fault::IgnoresFilter => self.inner.closest(rays, &AcceptAll, hits),
            _ => self.inner.closest(rays, filter, hits),
        }
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.altered(ray, filter, *hit, rays.len() == 1);
        }
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        let mut hits = vec![Hit::MISS; rays.len()];
        self.closest(rays, filter, &mut hits);
        for ((ray, blocked), hit) in rays.iter().zip(blocked).zip(hits) {
            let is_lost = self.fault == Fault::LosesShadows && ray.id.is_multiple_of(7);
            *blocked = hit.is_hit() && !is_lost;
        }
    }

    fn build_stats(&self) -> BuildStats {
        self.inner.build_stats()
    }
}
