//! Cut-outs: the hit filter that looks up a surface's coverage.

use super::World;
use crate::accel::HitFilter;
use crate::geometry::{Hit, Ray};
use crate::ledger::FeatureTotals;
use crate::sampling::hash::{combine, unit_f32};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Instant;

/// Accepts a candidate where the material covers it. Fractional coverage is compared with a hash of the
/// ray's id and the primitive: a pure function, unbiased over rays, the same for either backend.
///
/// Each worker has its own, which counts how often it is asked and times some of the answers.
pub struct CutOuts<'a> {
    world: &'a World,
    calls: AtomicU64,
    timed_nanoseconds: AtomicU64,
}

/// Of so many calls, one is timed.
const TIMED: u64 = 64;

impl<'a> CutOuts<'a> {
    /// The cut-outs of `world`.
    pub fn new(world: &'a World) -> Self {
        Self { world, calls: AtomicU64::new(0), timed_nanoseconds: AtomicU64::new(0) }
    }

    fn is_there(&self, ray: &Ray, candidate: &Hit) -> bool {
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

impl HitFilter for CutOuts<'_> {
    fn accept(&self, ray: &Ray, candidate: &Hit) -> bool {
        // Not `fetch_add`: nobody else writes, and a locked instruction would cost more than the answer.
        let calls = self.calls.load(Relaxed);
        self.calls.store(calls + 1, Relaxed);
        if !calls.is_multiple_of(TIMED) {
            return self.is_there(ray, candidate);
        }
        let start = Instant::now();
        let is_there = self.is_there(ray, candidate);
        let nanoseconds = start.elapsed().as_nanos() as u64;
        self.timed_nanoseconds.store(self.timed_nanoseconds.load(Relaxed) + nanoseconds, Relaxed);
        is_there
    }

    fn cost(&self) -> FeatureTotals {
        let calls = self.calls.load(Relaxed);
        let timed = calls.div_ceil(TIMED).max(1);
        let of_each = self.timed_nanoseconds.load(Relaxed) as f64 * 1e-9 / timed as f64;
        FeatureTotals { calls, seconds: of_each * calls as f64 }
    }
}

impl Clone for CutOuts<'_> {
    /// The same decisions, and nothing counted yet.
    fn clone(&self) -> Self {
        Self::new(self.world)
    }
}
