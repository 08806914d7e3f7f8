//! Many rays in flight: while the memory fetches what one ray needs next, the others go on.
//!
//! Each ray takes one step at a time - opens a node, tests a leaf, enters or leaves an object - and then its next
//! step is prefetched and waits in the queue of its kind. Source of the idea: software pipelining of pointer chases,
//! O. Kocberber et al., "Asynchronous Memory Access Chaining", VLDB 9(4), 2015. What a ray hits does not depend on
//! what flies beside it. Knows how steps follow each other; what they compute is in `kernel`.

use super::Bvh;
use super::block::SIZE;
use super::kernel::{Distances, Inside, Kernel, Task};
use super::node::Reference;
use super::slot::{self, Found, Slot};
use crate::accel::{HitFilter, resolve};
use crate::geometry::{NONE, PrimitiveId, Ray};
use std::cell::RefCell;

/// Rays in flight, a power of two up to 64: enough to hide the memory's latency, few enough for the first-level cache.
const IN_FLIGHT: usize = 32;

/// A batch of queries. `ANY`: the first hit is enough.
pub(super) struct Batch<'a, F, const ANY: bool> {
    pub(super) bvh: &'a Bvh,
    pub(super) rays: &'a [Ray],
    pub(super) filter: &'a F,
    /// What each ray hits, or a miss; as long as `rays`.
    pub(super) ids: &'a mut [PrimitiveId],
}

thread_local! {
    /// The slots of a thread, kept from batch to batch.
    static SLOTS: RefCell<Option<slot::Slots>> = const { RefCell::new(None) };
}

impl<F: HitFilter, const ANY: bool> Task for Batch<'_, F, ANY> {
    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        // Taken out, so that a filter that asks the accelerator from inside a query gets its own.
        let kept = SLOTS.with(|slots| slots.borrow_mut().take());
        let mut slots = kept.unwrap_or_else(|| slot::slots(IN_FLIGHT));
        if let Some(slots) = slots.first_chunk_mut() {
            Flight { batch: self, slots, begun: 0 }.run(kernel);
        }
        SLOTS.with(|kept| *kept.borrow_mut() = Some(slots));
    }
}

/// What each slot waits for: the two bits of its next reference's kind, one mask of slots for each bit. In registers,
/// and without a branch: in memory, a processor that cannot tell one queue's end from another's beginning would wait
/// for each step to end before the next.
struct Waiting {
    low: u64,
    high: u64,
}

impl Waiting {
    const NOTHING: Self = Self { low: 0, high: 0 };

    /// Says what a slot waits for, which waits for nodes, or for nothing, so far.
    #[inline(always)]
    fn push(&mut self, i: u32, next: Reference) {
        self.low |= u64::from(next.0 >> 30 & 1) << i;
        self.high |= u64::from(next.0 >> 31) << i;
    }

    /// Leaves the mask of the slots that wait for leaves, and takes them out.
    #[inline(always)]
    fn take_leaves(&mut self) -> u64 {
        let leaves = self.low & !self.high;
        self.low ^= leaves;
        leaves
    }

    /// Leaves the mask of the slots that wait for neither nodes nor leaves, and takes them out.
    #[inline(always)]
    fn take_others(&mut self) -> u64 {
        let others = std::mem::take(&mut self.high);
        self.low &= !others;
        others
    }
}

/// The numbers of a mask's bits.
#[inline(always)]
fn bits(mut mask: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let i = mask.trailing_zeros();
        (mask != 0).then(|| {
            mask &= mask - 1;
            i
        })
    })
}

/// The state of a batch.
struct Flight<'a, F, const ANY: bool> {
    batch: Batch<'a, F, ANY>,
    slots: &'a mut [Slot; IN_FLIGHT],
    /// The first ray that has not begun.
    begun: usize,
}

impl<F: HitFilter, const ANY: bool> Flight<'_, F, ANY> {
    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K) {
        let mut waiting = Waiting::NOTHING;
        // All slots begin as if they had just ended a ray, though none of the batch.
        let count = IN_FLIGHT.min(self.batch.rays.len());
        let mut flying = u64::MAX >> (64 - count.max(1));
        for i in bits(flying) {
            let slot = self.slot(i);
            slot.next = Reference::DONE;
            slot.ray = u32::MAX;
            waiting.push(i, Reference::DONE);
        }
        while flying != 0 {
            // Open a node each.
            for i in bits(flying & !(waiting.low | waiting.high)) {
                let hierarchy = &self.batch.bvh.hierarchy;
                let slot = self.slot(i);
                let node = hierarchy.node(slot.next);
                let top = match ANY {
                    true => kernel.open::<false>(slot, node),
                    false => kernel.open::<true>(slot, node),
                };
                self.advance(i, top, &mut waiting);
            }
            // Test a leaf each.
            for i in bits(waiting.take_leaves()) {
                let top = self.test(kernel, i);
                self.advance(i, top, &mut waiting);
            }
            // Enter or leave an object, or end a ray and begin another.
            for i in bits(waiting.take_others()) {
                match self.turn(i) {
                    Some(top) => self.advance(i, top, &mut waiting),
                    None => flying &= !(1 << i),
                }
            }
        }
    }

    #[inline(always)]
    fn slot(&mut self, i: u32) -> &mut Slot {
        &mut self.slots[i as usize & (IN_FLIGHT - 1)]
    }

    /// Takes the next reference off the stack, asks the memory for it and queues the slot.
    #[inline(always)]
    fn advance(&mut self, i: u32, top: usize, waiting: &mut Waiting) {
        let next = self.slot(i).pop(top);
        prefetch(self.batch.bvh.hierarchy.place(next));
        waiting.push(i, next);
    }

    /// Tests the triangles of a leaf; returns the height of the stack.
    #[inline(always)]
    fn test<K: Kernel>(&mut self, kernel: K, i: u32) -> usize {
        let hierarchy = &self.batch.bvh.hierarchy;
        let slot = self.slot(i);
        let block = hierarchy.block(slot.next);
        let Inside { inside, unsure } = kernel.inside(&slot.shear, block);
        let top = slot.top as usize;
        if inside == 0 {
            return top;
        }
        let is_better = if slot.instance == NONE && unsure == 0 {
            let Distances { t, within, edge_on } = kernel.distances(slot, block);
            match inside & (within | edge_on) {
                0 => return top,
                nearer if edge_on & nearer == 0 => self.consider(i, nearer, &t),
                _ => self.consider_with_care(i, inside, unsure),
            }
        } else {
            self.consider_with_care(i, inside, unsure)
        };
        match is_better {
            false => top,
            // Down to the reference that ends it.
            true if ANY => 1,
            true => kernel.prune(self.slot(i)),
        }
    }

    /// Takes those triangles of a leaf, at these distances, that are not beyond the best so far; whether there
    /// were any.
    #[inline(always)]
    fn consider(&mut self, i: u32, mut nearer: u32, distances: &[f32; SIZE]) -> bool {
        let Batch { bvh, rays, filter, .. } = &self.batch;
        let (bvh, rays, filter) = (*bvh, *rays, *filter);
        let slot = self.slot(i);
        let mut is_better = false;
        while nearer != 0 {
            let lane = nearer.trailing_zeros() as usize & (SIZE - 1);
            nearer &= nearer - 1;
            let t = distances[lane];
            let found = Found { leaf: slot.next, lane: lane as u32, instance: slot.instance };
            if t > slot.limit {
                continue;
            }
            // Ties go to the smallest id.
            if t == slot.limit && bvh.id(slot.best) < bvh.id(found) {
                continue;
            }
            if bvh.has_filters {
                let id = bvh.id(found);
                let ray = &rays[slot.ray as usize];
                let asked = bvh.geometry.mesh(id).filtered;
                if asked && !filter.accept(ray, &resolve(&bvh.geometry, ray, id)) {
                    continue;
                }
            }
            (slot.limit, slot.best) = (t, found);
            is_better = true;
        }
        is_better
    }

    /// [`Self::consider`] where it is not as simple: in instances, where products leave the range of `f32`, and
    /// edge-on.
    #[inline(never)]
    fn consider_with_care(&mut self, i: u32, inside: u32, unsure: u32) -> bool {
        let (bvh, rays) = (self.batch.bvh, self.batch.rays);
        let slot = self.slot(i);
        let block = bvh.hierarchy.block(slot.next);
        let mut t = [0.0; SIZE];
        let mut nearer = 0;
        for lane in (0..SIZE).filter(|lane| inside >> lane & 1 != 0) {
            if unsure >> lane & 1 == 0 || slot.shear.is_inside(block, lane) {
                let id =
                    bvh.id(Found { leaf: slot.next, lane: lane as u32, instance: slot.instance });
                t[lane] = resolve(&bvh.geometry, &rays[slot.ray as usize], id).t;
                nearer |= u32::from(t[lane] > slot.t_min && t[lane] <= slot.limit) << lane;
            }
        }
        self.consider(i, nearer, &t)
    }

    /// What is neither node nor leaf. Returns the height of the stack, or nothing if the slot is no longer needed.
    #[inline(always)]
    fn turn(&mut self, i: u32) -> Option<usize> {
        let Batch { bvh, rays, ids, .. } = &mut self.batch;
        let (hierarchy, geometry) = (&bvh.hierarchy, &bvh.geometry);
        let slot = &mut self.slots[i as usize & (IN_FLIGHT - 1)];
        match slot.next {
            Reference::DONE => {
                if let Some(id) = ids.get_mut(slot.ray as usize) {
                    *id = bvh.id(slot.best);
                }
                let ray = rays.get(self.begun)?;
                slot.begin(ray, self.begun as u32, hierarchy);
                self.begun += 1;
            }
            Reference::LEAVE => slot.leave(&rays[slot.ray as usize], hierarchy),
            reference => {
                if let Some(instance) = hierarchy.instance(reference) {
                    slot.enter(&rays[slot.ray as usize], instance, hierarchy, geometry);
                }
            }
        }
        Some(slot.top as usize)
    }
}

/// Asks for the three cache lines that a leaf has; a node has two.
#[inline(always)]
fn prefetch(start: *const u8) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in 0..3 {
            let address = start.wrapping_add(64 * line).cast::<i8>();
            // SAFETY: a prefetch reads nothing, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(address) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = start;
}
