//! What is done to packets: a ray in each lane.

use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::node::Node;
use crate::accel::bvh::packet::{Each, Packet};
use crate::accel::bvh::slot::Found;

/// The operations on packets, for machines that have them.
pub(in crate::accel::bvh) trait PacketKernel: Copy {
    /// The smallest and the largest of some numbers.
    fn range(self, values: &Each) -> [f32; 2];

    /// The rays that are entered at these distances before their limit.
    fn active(self, packet: &Packet, entries: &Each) -> u16;

    /// Pushes the children of a node that any active ray meets up to its limit, if `ORDERED` nearest last; returns the new
    /// height of the stack.
    fn open<const ORDERED: bool>(self, packet: &mut Packet, node: &Node, active: u16) -> usize;

    /// Which triangles of a block any active ray's line meets, a bit for each; and of those, which rays.
    fn inside(
        self,
        packet: &Packet,
        block: &Block,
        active: u16,
        touched: &mut [Touched; SIZE],
    ) -> u32;

    /// Distances of a triangle along all rays, as [`super::Kernel::distances`] has them.
    fn distances(self, packet: &Packet, block: &Block, lane: usize) -> PacketDistances;

    /// Notes a triangle at these distances as the best so far of some rays; if `ANY`, they are done.
    fn take<const ANY: bool>(self, packet: &mut Packet, t: &Each, rays: u16, found: Found);
}

/// How far a triangle is along each ray.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel::bvh) struct PacketDistances {
    pub(in crate::accel::bvh) t: Each,
    /// Rays that reach it after their start and before their limit, a bit for each, and at their limit.
    pub(in crate::accel::bvh) nearer: u16,
    pub(in crate::accel::bvh) level: u16,
}

/// Rays whose line meets a triangle, a bit for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::accel::bvh) struct Touched {
    /// As in [`super::Inside`].
    pub(in crate::accel::bvh) inside: u16,
    pub(in crate::accel::bvh) unsure: u16,
}

/// The operations of machines that have none.
#[derive(Clone, Copy)]
pub(in crate::accel::bvh) enum Never {}

impl PacketKernel for Never {
    fn range(self, _: &Each) -> [f32; 2] {
        match self {}
    }

    fn active(self, _: &Packet, _: &Each) -> u16 {
        match self {}
    }

    fn open<const ORDERED: bool>(self, _: &mut Packet, _: &Node, _: u16) -> usize {
        match self {}
    }

    fn inside(self, _: &Packet, _: &Block, _: u16, _: &mut [Touched; SIZE]) -> u32 {
        match self {}
    }

    fn distances(self, _: &Packet, _: &Block, _: usize) -> PacketDistances {
        match self {}
    }

    fn take<const ANY: bool>(self, _: &mut Packet, _: &Each, _: u16, _: Found) {
        match self {}
    }
}
