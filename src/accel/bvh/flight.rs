//! Many rays in flight: while the memory fetches what one ray needs next, the others go on.
//!
//! Each ray takes one step at a time - opens a node, tests a leaf, enters or leaves an object - and then its next
//! step is prefetched and waits in the queue of its kind. Source of the idea: software pipelining of pointer chases,
//! O. Kocberber et al., "Asynchronous Memory Access Chaining", VLDB 9(4), 2015. What a ray hits does not depend on
//! what flies beside it. Knows how steps follow each other; what they compute is in `kernel`.

use super::answers::Answers;
use super::convoy;
use super::hierarchy::Hierarchy;
use super::kernel::{Kernel, Task};
use super::leaves::Leaves;
use super::node::{Kind, Reference};
use super::packet::RAYS;
use super::slot::{self, Slot};
use super::walk::Batch;
use crate::accel::HitFilter;
use crate::os::prefetch;
use std::cell::RefCell;
use std::hint::select_unpredictable;

/// Rays in flight, a power of two up to 64: enough to hide the memory's latency, few enough for the first-level cache.
const IN_FLIGHT: usize = 64;

/// Fewer rays are traced one after the other.
pub(super) const FEW: usize = 4;

thread_local! {
    /// The slots of a thread, kept from batch to batch.
    static SLOTS: RefCell<Option<slot::Slots>> = const { RefCell::new(None) };
}

impl<F: HitFilter, A: Answers, L: Leaves, const ANY: bool> Task for Batch<'_, F, A, L, ANY> {
    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K) {
        // Taken out, so that a filter that asks the accelerator from inside a query gets its own.
        let kept = SLOTS.with(|slots| slots.borrow_mut().take());
        let mut slots = kept.unwrap_or_else(|| slot::slots(IN_FLIGHT));
        if self.rays.len() < FEW {
            if let Some(slot) = slots.first_mut() {
                one_by_one(self, kernel, slot);
            }
        } else if let Some(slots) = slots.first_chunk_mut() {
            match kernel.packets() {
                None => {
                    let rays = 0..self.rays.len() as u32;
                    Flight { batch: &mut self, slots, rays }.run(kernel);
                }
                Some(packets) => {
                    for first in (0..self.rays.len()).step_by(convoy::GROUPS * RAYS) {
                        let left = convoy::run(&mut self, kernel, packets, first);
                        let rays = convoy::rays(&left, first, self.rays.len());
                        Flight { batch: &mut self, slots, rays }.run(kernel);
                    }
                }
            }
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

/// Traces rays one after the other, each to its end: for those that have no company.
#[inline(always)]
fn one_by_one<K: Kernel, F: HitFilter, A: Answers, L: Leaves, const ANY: bool>(
    batch: Batch<'_, F, A, L, ANY>,
    kernel: K,
    slot: &mut Slot,
) {
    slot.reset();
    for (ray, place) in batch.rays.iter().zip(0..) {
        slot.begin(ray, place, &batch.bvh.hierarchy);
        let mut top = slot.top as usize;
        loop {
            let next = slot.pop(top);
            top = if next.kind() == Kind::Node as usize {
                batch.open(kernel, slot)
            } else if next.kind() == Kind::Leaf as usize {
                match batch.test(kernel, slot) {
                    true => batch.measure(kernel, slot),
                    false => slot.top as usize,
                }
            } else if next == Reference::DONE {
                break;
            } else {
                batch.change_space(slot);
                slot.top as usize
            };
        }
        batch.answers.take(batch.bvh, batch.rays, slot.ray, slot.best);
    }
}

/// The state of a batch.
struct Flight<'a, 'b, R, F, A, L, const ANY: bool> {
    batch: &'a mut Batch<'b, F, A, L, ANY>,
    slots: &'a mut [Slot; IN_FLIGHT],
    /// Places of the rays that have not begun.
    rays: R,
}

impl<R: Iterator<Item = u32>, F: HitFilter, A: Answers, L: Leaves, const ANY: bool>
    Flight<'_, '_, R, F, A, L, ANY>
{
    #[inline(always)]
    fn run<K: Kernel>(mut self, kernel: K) {
        let mut waiting = Waiting::NOTHING;
        // All slots begin as if they had just ended a ray, though none of the batch.
        let count = IN_FLIGHT.min(self.batch.rays.len());
        let mut flying = u64::MAX >> (64 - count.max(1));
        for i in bits(flying) {
            self.slots[i as usize].reset();
            waiting.push(i, Reference::DONE);
        }
        while flying != 0 {
            // Open a node each.
            for i in bits(flying & !(waiting.low | waiting.high)) {
                let top = self.batch.open(kernel, &mut self.slots[i as usize & (IN_FLIGHT - 1)]);
                self.advance(i, top, &mut waiting);
            }
            // Test the edges of a leaf each: most are missed, and their rays go on at once.
            let mut hit = 0;
            let leaves = waiting.take_leaves();
            for step in 0..L::STEPS {
                bits(leaves).for_each(|i| self.fetch(i, step));
            }
            for i in bits(leaves) {
                hit |= self.test(kernel, i, &mut waiting);
            }
            // Measure the distances of the others.
            for i in bits(hit) {
                let top = self.batch.measure(kernel, &mut self.slots[i as usize & (IN_FLIGHT - 1)]);
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

    /// Takes the next reference off the stack, asks the memory for it and queues the slot.
    #[inline(always)]
    fn advance(&mut self, i: u32, top: usize, waiting: &mut Waiting) {
        let next = self.slots[i as usize & (IN_FLIGHT - 1)].pop(top);
        ask::<L>(&self.batch.bvh.hierarchy, next);
        waiting.push(i, next);
    }

    /// Asks the memory for what a leaf is made of.
    #[inline(always)]
    fn fetch(&self, i: u32, step: usize) {
        let slot = &self.slots[i as usize & (IN_FLIGHT - 1)];
        L::fetch(self.batch.bvh, slot.next, slot.instance, step);
    }

    /// Tests a leaf. If the ray is inside of any triangle's edges, returns the slot's bit; otherwise advances. Which it is
    /// cannot be predicted: without a branch.
    #[inline(always)]
    fn test<K: Kernel>(&mut self, kernel: K, i: u32, waiting: &mut Waiting) -> u64 {
        let hierarchy = &self.batch.bvh.hierarchy;
        let slot = &mut self.slots[i as usize & (IN_FLIGHT - 1)];
        let hit = self.batch.test(kernel, slot);
        // What follows would be taken off the stack; a leaf that is hit stays, and waits for nothing.
        let leaf = slot.next;
        let follows = slot.pop(slot.top as usize);
        slot.top += u32::from(hit);
        slot.next = select_unpredictable(hit, leaf, follows);
        ask::<L>(hierarchy, follows);
        waiting.push(i, select_unpredictable(hit, Reference::new(Kind::Node, 0), follows));
        u64::from(hit) << i
    }

    /// What is neither node nor leaf. Returns the height of the stack, or nothing if the slot is no longer needed.
    #[inline(always)]
    fn turn(&mut self, i: u32) -> Option<usize> {
        let slot = &mut self.slots[i as usize & (IN_FLIGHT - 1)];
        if slot.next == Reference::DONE {
            let Batch { bvh, rays, answers, .. } = &mut *self.batch;
            answers.take(bvh, rays, slot.ray, slot.best);
            let place = self.rays.next()?;
            let ray = rays.get(place as usize)?;
            slot.begin(ray, place, &bvh.hierarchy);
        } else {
            self.batch.change_space(slot);
        }
        Some(slot.top as usize)
    }
}

/// Asks the memory for the two cache lines of a node or a leaf.
#[inline(always)]
fn ask<L: Leaves>(hierarchy: &Hierarchy, reference: Reference) {
    let start = L::address(hierarchy, reference);
    prefetch(start);
    prefetch(start.wrapping_add(64));
}
