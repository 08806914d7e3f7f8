//! Rays that stay together travel as packets: what they meet is fetched and unpacked once for sixteen of them.
//!
//! A few packets take turns, so that the memory has time to fetch what each needs next. Where rays turn out to go different
//! ways, the next ones are left to `flight`, and tried again later. What a ray hits does not depend on that. Knows how packets
//! step; what steps compute is in `kernel`.

use super::answers::Answers;
use super::block::{self, Block};
use super::kernel::{Kernel, PacketKernel, Touched};
use super::leaves::Leaves;
use super::node::{Kind, Reference};
use super::packet::{Packet, Packets, RAYS, is_coherent};
use super::slot::Found;
use super::walk::Batch;
use crate::accel::HitFilter;
use crate::geometry::{NONE, triangle_distance};
use crate::os::prefetch;
use std::cell::RefCell;

/// Packets that take turns.
const TURNS: usize = 4;

/// With fewer active rays on average, a packet costs more than its rays alone.
const WORTHWHILE: u32 = 5;

/// So many active rays are tested one by one in a leaf.
const ALONE: u32 = 3;

/// Visits to nodes and leaves after which that is known for the first time, and again.
const FEW: u32 = 24;
const MANY: u32 = 256;

/// Packets that are passed over before another one is tried.
const PAUSE: u32 = 128;

/// Groups of sixteen rays that are handled at a time.
pub(super) const GROUPS: usize = 256;

/// Groups that are still to be traced, a bit for each.
pub(super) type Left = [u64; GROUPS / 64];

thread_local! {
    /// The packets of a thread, kept from batch to batch.
    static PACKETS: RefCell<Option<Packets>> = const { RefCell::new(None) };
}

/// Traces what travels together of up to [`GROUPS`] groups of a batch, which begin at ray `first`; returns what is left.
#[inline(always)]
pub(super) fn run<K: Kernel, F: HitFilter, A: Answers, L: Leaves, const ANY: bool>(
    batch: &mut Batch<'_, F, A, L, ANY>,
    kernel: K,
    packets: K::Packets,
    first: usize,
) -> Left {
    let rays = &batch.rays[first..];
    let count = rays.len().div_ceil(RAYS).min(GROUPS);
    let mut left: Left = std::array::from_fn(|word| match count.saturating_sub(64 * word) {
        0 => 0,
        n => u64::MAX >> (64 - n.min(64)),
    });
    let Some(root) = batch.bvh.hierarchy.own.root else { return left };
    // Instances are left to `flight`; and so is all of it where not even the first rays stay together, at no cost.
    if batch.bvh.hierarchy.instances.root.is_some() || !rays.first_chunk().is_some_and(is_coherent)
    {
        return left;
    }
    let kept = PACKETS.with(|packets| packets.borrow_mut().take());
    let Some(mut travellers) = kept.or_else(|| Packets::zeroed(TURNS)) else { return left };
    let mut convoy =
        Convoy { batch, kernel, packets, pause: 0, is_on_trial: true, visits: 0, active: 0 };
    let mut groups = rays.as_chunks::<RAYS>().0.iter().take(count).enumerate();
    // Idle at first.
    travellers.iter_mut().for_each(|packet| (packet.top, packet.first) = (0, u32::MAX));
    let mut is_travelling = true;
    while is_travelling {
        is_travelling = false;
        for (turn, packet) in travellers.iter_mut().enumerate() {
            if convoy.step(packet) {
                is_travelling = true;
                continue;
            }
            convoy.end(packet);
            if turn > 0 && convoy.is_on_trial {
                continue;
            }
            if let Some((group, rays)) = groups.find(|(_, rays)| convoy.takes(rays)) {
                left[group / 64] &= !(1 << (group % 64));
                let place = (first + group * RAYS) as u32;
                packet.begin(packets, rays, place, convoy.batch.bvh.hierarchy.world_size, root);
                is_travelling = true;
            }
        }
    }
    PACKETS.with(|kept| *kept.borrow_mut() = Some(travellers));
    left
}

/// The places of the rays of the groups that are left, in a batch of `end` rays.
#[inline(always)]
pub(super) fn rays(left: &Left, first: usize, end: usize) -> impl Iterator<Item = u32> {
    let is_left = move |ray: &u32| {
        let group = (*ray as usize - first) / RAYS;
        left[group / 64 % left.len()] >> (group % 64) & 1 != 0
    };
    (first as u32..end.min(first + GROUPS * RAYS) as u32).filter(is_left)
}

/// What packets of a batch share.
struct Convoy<'a, 'b, K: Kernel, F, A, L, const ANY: bool> {
    batch: &'a mut Batch<'b, F, A, L, ANY>,
    kernel: K,
    packets: K::Packets,
    /// Packets still to be passed over.
    pause: u32,
    /// Whether it is not known yet if packets pay: one at a time.
    is_on_trial: bool,
    /// Nodes and leaves that packets have come to since the last pause, and active rays there in all.
    visits: u32,
    active: u32,
}

impl<K: Kernel, F: HitFilter, A: Answers, L: Leaves, const ANY: bool>
    Convoy<'_, '_, K, F, A, L, ANY>
{
    /// Whether a packet is to be made of these rays.
    #[inline(always)]
    fn takes(&mut self, rays: &[crate::geometry::Ray; RAYS]) -> bool {
        if self.pause > 0 {
            self.pause -= 1;
            return false;
        }
        is_coherent(rays)
    }

    /// Takes the next thing off a packet's stack; whether there was any.
    #[inline(always)]
    fn step(&mut self, packet: &mut Packet) -> bool {
        while packet.top > 0 {
            packet.top -= 1;
            let top = packet.top as usize;
            let active = self.packets.active(packet, &packet.entries[top]);
            if active == 0 {
                continue;
            }
            self.visits += 1;
            self.active += active.count_ones();
            let next = Reference(packet.references[top]);
            if next.kind() == Kind::Node as usize {
                self.open(packet, next, active);
            } else {
                self.test(packet, next, active);
            }
            return true;
        }
        false
    }

    #[inline(always)]
    fn open(&self, packet: &mut Packet, next: Reference, active: u16) {
        let hierarchy = &self.batch.bvh.hierarchy;
        let node = hierarchy.node(next);
        let before = packet.top as usize;
        let top = match ANY {
            true => self.packets.open::<false>(packet, node, active),
            false => self.packets.open::<true>(packet, node, active),
        };
        packet.top = top as u32;
        for &reference in &packet.references[before..top] {
            let place = L::address(hierarchy, Reference(reference));
            prefetch(place);
            prefetch(place.wrapping_add(64));
        }
    }

    #[inline(always)]
    fn test(&self, packet: &mut Packet, leaf: Reference, active: u16) {
        let mut made = None;
        let block = L::block(self.batch.bvh, leaf, NONE, &mut made);
        let mut touched = [Touched::default(); block::SIZE];
        let mut any = match active.count_ones() {
            ..=ALONE => self.one_by_one(packet, block, active, &mut touched),
            _ => self.packets.inside(packet, block, active, &mut touched),
        };
        if any == 0 {
            return;
        }
        while any != 0 {
            let lane = any.trailing_zeros();
            any &= any - 1;
            let found = Found { leaf, lane, instance: NONE };
            self.settle(packet, block, found, touched[lane as usize % block::SIZE]);
        }
        packet.shorten_hull(self.packets);
    }

    /// What the lines of few rays meet.
    #[inline(always)]
    fn one_by_one(
        &self,
        packet: &Packet,
        block: &Block,
        active: u16,
        touched: &mut [Touched; block::SIZE],
    ) -> u32 {
        let mut any = 0;
        for i in bits(active) {
            let met = self.kernel.inside(&packet.shears[i], block);
            any |= met.inside;
            for (touched, lane) in touched.iter_mut().zip(0..) {
                touched.inside |= ((met.inside >> lane & 1) << i) as u16;
                touched.unsure |= ((met.unsure >> lane & 1) << i) as u16;
            }
        }
        any
    }

    /// Takes a triangle for those rays that hit it no later than what they have hit so far.
    #[inline(always)]
    fn settle(&self, packet: &mut Packet, block: &Block, found: Found, touched: Touched) {
        let bvh = self.batch.bvh;
        let distances = self.packets.distances(packet, block, found.lane as usize);
        let sure = touched.inside & !touched.unsure;
        let (nearer, level) = (sure & distances.nearer, sure & distances.level);
        if F::REFUSES && bvh.has_filters {
            bits(nearer | level).for_each(|i| self.consider(packet, i, found, distances.t[i]));
        } else {
            self.packets.take::<ANY>(packet, &distances.t, nearer, found);
            bits(level).for_each(|i| self.consider(packet, i, found, distances.t[i]));
        }
        bits(touched.unsure).for_each(|i| self.consider_with_care(packet, block, i, found));
    }

    #[inline(never)]
    fn consider(&self, packet: &mut Packet, i: usize, found: Found, t: f32) {
        let place = packet.first as usize + i;
        if self.batch.is_better(place, found, t, packet.limit[i], packet.best(i)) {
            (packet.leaf[i], packet.lane[i]) = (found.leaf.0, found.lane);
            packet.limit[i] = if ANY { f32::NEG_INFINITY } else { t };
        }
    }

    /// [`Self::consider`] at an edge, where exact products decide.
    #[inline(never)]
    fn consider_with_care(&self, packet: &mut Packet, block: &Block, i: usize, found: Found) {
        let bvh = self.batch.bvh;
        let ray = &self.batch.rays[packet.first as usize + i];
        if !packet.shears[i].is_inside(block, found.lane as usize) {
            return;
        }
        if let Some(at) = triangle_distance(ray, &bvh.vertices(found).0) {
            let t = at as f32;
            if t > packet.t_min[i] && t <= packet.limit[i] {
                self.consider(packet, i, found, t);
            }
        }
    }

    /// Hands over what the rays of a packet have found.
    #[inline(always)]
    fn end(&mut self, packet: &mut Packet) {
        let first = std::mem::replace(&mut packet.first, u32::MAX);
        if first == u32::MAX {
            return;
        }
        let Batch { bvh, rays, answers, .. } = &mut *self.batch;
        for i in 0..RAYS {
            answers.take(bvh, rays, first + i as u32, packet.best(i));
        }
        if self.visits >= if self.is_on_trial { FEW } else { MANY } {
            self.is_on_trial = self.active < WORTHWHILE * self.visits;
            self.pause = if self.is_on_trial { PAUSE } else { 0 };
            (self.visits, self.active) = (0, 0);
        }
    }
}

/// The numbers of a mask's bits.
#[inline(always)]
fn bits(mut mask: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let i = mask.trailing_zeros() as usize;
        (mask != 0).then(|| {
            mask &= mask - 1;
            i % RAYS
        })
    })
}
