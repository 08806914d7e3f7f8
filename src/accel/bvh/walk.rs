//! What a ray does in each of its steps: opens a node, tests a leaf, enters or leaves an object.
//!
//! Which triangle is hit is decided here, by edges and distances alone: neither the order of the steps nor the rays
//! beside it can change that. Knows neither how many rays are under way nor in which order they take their steps.

use super::Bvh;
use super::block::SIZE;
use super::kernel::{Distances, Inside, Kernel};
use super::leaves::Leaves;
use super::node::Reference;
use super::slot::{Found, Slot};
use crate::accel::{HitFilter, resolve};
use crate::geometry::{NONE, Ray, triangle_distance, within_box};
use crate::math::Vec3;
use crate::os::prefetch;
use std::hint::select_unpredictable;
use std::marker::PhantomData;

/// A batch of queries, of a hierarchy whose leaves are read as by `L`. `ANY`: the first hit is enough.
pub(super) struct Batch<'a, F, A, L, const ANY: bool> {
    pub(super) bvh: &'a Bvh,
    pub(super) rays: &'a [Ray],
    pub(super) filter: &'a F,
    pub(super) answers: &'a mut A,
    leaves: PhantomData<L>,
}

impl<'a, F: HitFilter, A, L: Leaves, const ANY: bool> Batch<'a, F, A, L, ANY> {
    /// # Safety
    /// `L` must be the way in which this hierarchy's leaves are kept.
    pub(super) unsafe fn new(
        bvh: &'a Bvh,
        rays: &'a [Ray],
        filter: &'a F,
        answers: &'a mut A,
    ) -> Self {
        Self { bvh, rays, filter, answers, leaves: PhantomData }
    }

    /// Opens the node that is next; returns the height of the stack.
    #[inline(always)]
    pub(super) fn open<K: Kernel>(&self, kernel: K, slot: &mut Slot) -> usize {
        let node = self.bvh.hierarchy.node(slot.next);
        match ANY {
            true => kernel.open::<false>(slot, node),
            false => kernel.open::<true>(slot, node),
        }
    }

    /// Tests the edges of the leaf that is next; whether the ray is inside those of any triangle.
    #[inline(always)]
    pub(super) fn test<K: Kernel>(&self, kernel: K, slot: &mut Slot) -> bool {
        let mut made = None;
        let block = L::block(self.bvh, slot.next, slot.instance, &mut made);
        slot.inside = kernel.inside(&slot.shear, block);
        slot.inside.inside != 0
    }

    /// Measures how far the triangles are whose edges the ray is inside; returns the height of the stack.
    #[inline(always)]
    pub(super) fn measure<K: Kernel>(&self, kernel: K, slot: &mut Slot) -> usize {
        let bvh = self.bvh;
        let Inside { inside, unsure } = slot.inside;
        let top = slot.top as usize;
        let is_better = if slot.instance == NONE && unsure == 0 {
            let mut made = None;
            let block = L::block(bvh, slot.next, NONE, &mut made);
            let Distances { t, within } = kernel.distances(slot, block);
            let nearer = inside & within;
            let lane = nearer.trailing_zeros() & (SIZE as u32 - 1);
            let distance = t[lane as usize];
            // One at most, and not at the same distance as the best.
            let is_simple = nearer & nearer.wrapping_sub(1) == 0 && distance != slot.limit;
            if is_simple && !(F::REFUSES && bvh.has_filters) {
                let found = Found { leaf: slot.next, lane, instance: NONE };
                // Whether it is nearer than the best is as likely as not: without a branch.
                let is_better = nearer != 0;
                slot.limit = select_unpredictable(is_better, distance, slot.limit);
                slot.best = found.or(slot.best, is_better);
                if !ANY {
                    // Its number will be asked for when the ray is done.
                    prefetch(L::triangle_address(&bvh.hierarchy, found.leaf, lane as usize));
                }
                is_better
            } else {
                self.consider(slot, nearer, &t)
            }
        } else {
            self.consider_with_care(slot, inside, unsure)
        };
        match ANY {
            // Down to the reference that ends it.
            true => select_unpredictable(is_better, 1, top),
            false => kernel.prune(slot),
        }
    }

    /// Takes those triangles of a leaf, at these distances, that are not beyond the best so far; whether there
    /// were any.
    #[inline(never)]
    fn consider(&self, slot: &mut Slot, mut nearer: u32, distances: &[f32; SIZE]) -> bool {
        let mut is_better = false;
        while nearer != 0 {
            let lane = nearer.trailing_zeros() as usize & (SIZE - 1);
            nearer &= nearer - 1;
            let t = distances[lane];
            let found = Found { leaf: slot.next, lane: lane as u32, instance: slot.instance };
            if self.is_better(slot.ray as usize, found, t, slot.limit, slot.best) {
                (slot.limit, slot.best) = (t, found);
                is_better = true;
            }
        }
        is_better
    }

    /// Whether a triangle at distance `t` is to be taken by the ray of that place instead of the best so far, at its limit.
    #[inline(always)]
    pub(super) fn is_better(
        &self,
        place: usize,
        found: Found,
        t: f32,
        limit: f32,
        best: Found,
    ) -> bool {
        let (bvh, ray) = (self.bvh, &self.rays[place]);
        // Ties go to the smallest id.
        if t > limit || t == limit && bvh.id(best) < bvh.id(found) {
            return false;
        }
        if F::REFUSES && bvh.has_filters {
            let id = bvh.id(found);
            let asked = bvh.geometry.mesh(id).filtered;
            return !asked || self.filter.accept(ray, &resolve(&bvh.geometry, ray, id));
        }
        true
    }

    /// [`Self::consider`] where it is not as simple: in instances, and at edges, where exact products decide.
    #[inline(never)]
    fn consider_with_care(&self, slot: &mut Slot, inside: u32, unsure: u32) -> bool {
        let (bvh, rays) = (self.bvh, self.rays);
        let mut made = None;
        let block = L::block(bvh, slot.next, slot.instance, &mut made);
        let mut t = [0.0; SIZE];
        let mut nearer = 0;
        for lane in (0..SIZE).filter(|lane| inside >> lane & 1 != 0) {
            if unsure >> lane & 1 == 0 || slot.shear.is_inside(block, lane) {
                let found = Found { leaf: slot.next, lane: lane as u32, instance: slot.instance };
                let (vertices, _) = bvh.vertices(found);
                // Seen edge-on it has no place where it is hit.
                let Some(at) = triangle_distance(&rays[slot.ray as usize], &vertices) else {
                    continue;
                };
                // Nor is it nearer than its box, as the boxes of the hierarchy are seen.
                let is_placed = slot.instance != NONE;
                let at = if is_placed {
                    within_box(at, &slot.mapped(), &block.vertices(lane).map(Vec3::as_dvec3))
                } else {
                    at
                };
                t[lane] = at as f32;
                nearer |= u32::from(t[lane] > slot.t_min && t[lane] <= slot.limit) << lane;
            }
        }
        self.consider(slot, nearer, &t)
    }

    /// What is neither node nor leaf, nor the end.
    #[inline(always)]
    pub(super) fn change_space(&self, slot: &mut Slot) {
        let (hierarchy, geometry) = (&self.bvh.hierarchy, &self.bvh.geometry);
        let ray = &self.rays[slot.ray as usize];
        if slot.next == Reference::LEAVE {
            slot.leave(ray, hierarchy);
        } else if let Some(instance) = hierarchy.instance(slot.next) {
            slot.enter(ray, instance, hierarchy, geometry);
        }
    }
}
