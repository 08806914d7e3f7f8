//! Cut-outs: the hit filter that looks up a surface's coverage.

use super::World;
use crate::accel::HitFilter;
use crate::geometry::{Hit, Ray};
use crate::sampling::hash::{combine, unit_f32};

/// Accepts a candidate where the material covers it. Fractional coverage is compared with a hash of the
/// ray's id and the primitive: a pure function, unbiased over rays, the same for either backend.
#[derive(Clone, Copy)]
pub struct CutOuts<'a> {
    world: &'a World,
}

impl<'a> CutOuts<'a> {
    /// The cut-outs of `world`.
    pub fn new(world: &'a World) -> Self {
        Self { world }
    }
}

impl HitFilter for CutOuts<'_> {
    fn accept(&self, ray: &Ray, candidate: &Hit) -> bool {
        let id = candidate.id;
        let material = self.world.material_id(id);
        let opacity = self.world.opacity(material, self.world.uv(id, candidate.u, candidate.v));
        if opacity >= 1.0 {
            return true;
        }
        if opacity <= 0.0 {
            return false;
        }
        let place = u64::from(id.instance) << 32 | u64::from(id.geometry);
        let hash = combine(combine(u64::from(ray.id), place), u64::from(id.primitive));
        unit_f32((hash >> 32) as u32) < opacity
    }
}
