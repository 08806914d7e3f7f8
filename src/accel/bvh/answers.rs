//! What becomes of a ray that is done: a hit record, a yes or no.
//!
//! Hits are resolved some at a time, soon after they were found: the leaves that hold their corners are still
//! near, where the buffers of the meshes would be two more misses of the cache, one after the other.

use super::Bvh;
use super::slot::Found;
use crate::accel::resolve::{LANES, Lanes, resolve_at};
use crate::geometry::{Hit, Ray};
use crate::math::DVec3;

impl Bvh {
    /// The corners of a triangle in a leaf, as [`crate::geometry::Geometry::world_vertices()`] gives them.
    #[inline(always)]
    pub(super) fn vertices(&self, found: Found) -> ([DVec3; 3], f32) {
        let corners = if self.hierarchy.is_compact {
            let id = self.id(found);
            self.geometry.mesh(id).vertices(id.primitive)
        } else {
            // SAFETY: the hierarchy is not compact.
            unsafe { self.hierarchy.block(found.leaf) }.vertices(found.lane as usize)
        };
        self.geometry.placed_vertices(corners, found.instance)
    }
}

/// Takes the answers of a batch.
pub(super) trait Answers {
    /// The ray of that place in the batch is done with. Places beyond the batch have found nothing.
    fn take(&mut self, bvh: &Bvh, rays: &[Ray], place: u32, found: Found);
}

/// Whether there was a hit.
pub(super) struct Blocked<'a>(pub(super) &'a mut [bool]);

impl Answers for Blocked<'_> {
    #[inline(always)]
    fn take(&mut self, _: &Bvh, _: &[Ray], place: u32, found: Found) {
        if let Some(blocked) = self.0.get_mut(place as usize) {
            *blocked = found.is_hit();
        }
    }
}

/// Nothing.
pub(super) struct Ignored;

impl Answers for Ignored {
    #[inline(always)]
    fn take(&mut self, _: &Bvh, _: &[Ray], _: u32, _: Found) {}
}

/// Hit records, each resolved at once: where there are few.
pub(super) struct FewHits<'a>(pub(super) &'a mut [Hit]);

impl Answers for FewHits<'_> {
    #[inline(always)]
    fn take(&mut self, bvh: &Bvh, rays: &[Ray], place: u32, found: Found) {
        self.0[place as usize] = match found.is_hit() {
            true => resolve_at(&rays[place as usize], bvh.id(found), bvh.vertices(found)),
            false => Hit::MISS,
        };
    }
}

/// Hit records.
pub(super) struct Hits<'a> {
    hits: &'a mut [Hit],
    /// What was found, not yet resolved, and for which places of the batch.
    found: [Found; LANES],
    places: [u32; LANES],
    count: usize,
    lanes: Lanes,
}

impl<'a> Hits<'a> {
    /// To go where a batch's hits go.
    pub(super) fn new(hits: &'a mut [Hit]) -> Self {
        hits.fill(Hit::MISS);
        let (found, places) = ([Found::NONE; LANES], [0; LANES]);
        Self { hits, found, places, count: 0, lanes: Lanes::new() }
    }

    /// Resolves what there is.
    #[inline(never)]
    pub(super) fn finish(&mut self, bvh: &Bvh, rays: &[Ray]) {
        let found = &self.found[..self.count];
        for (lane, (found, &place)) in found.iter().zip(&self.places).enumerate() {
            self.lanes.set(lane, &rays[place as usize], bvh.vertices(*found));
        }
        self.lanes.resolve();
        for (lane, (found, &place)) in found.iter().zip(&self.places).enumerate() {
            self.hits[place as usize] = self.lanes.hit(lane, bvh.id(*found));
        }
        self.count = 0;
    }
}

impl Answers for Hits<'_> {
    #[inline(always)]
    fn take(&mut self, bvh: &Bvh, rays: &[Ray], place: u32, found: Found) {
        // Which rays hit is random: without a branch.
        let end = self.count % LANES;
        (self.found[end], self.places[end]) = (found, place);
        self.count += usize::from(found.is_hit());
        if self.count == LANES {
            self.finish(bvh, rays);
        }
    }
}
