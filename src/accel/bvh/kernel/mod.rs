//! What is done to many numbers at once: boxes, edges, distances, stacks. One idea of it in plain loops, which
//! every machine has; others in the vector instructions of one.
//!
//! Knows nodes, leaves and prepared rays; neither trees nor batches. Which boxes are met may differ between kernels
//! within the margins of `ray`, which hit is found does not.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_leaf;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod avx512_leaf;
#[cfg(target_arch = "x86_64")]
mod avx512_packet;
mod counting;
mod packets;
mod plain;
#[cfg(test)]
#[cfg(target_arch = "x86_64")]
mod packet_tests;
#[cfg(test)]
mod tests;

#[cfg(target_arch = "x86_64")]
use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use avx512::Avx512;
use plain::Plain;

pub(super) use counting::Count;
pub use counting::Steps;
pub(super) use packets::{PacketKernel, Touched};

use super::block::{Block, SIZE};
use super::node::Node;
use super::slot::Slot;
use super::woop::Shear;
use crate::os::Isa;
use bytemuck::Zeroable;

/// Work to be done with some kernel.
pub(super) trait Task {
    /// Does it. Must be `#[inline(always)]`, so that it is compiled for the kernel's instructions.
    fn run<K: Kernel>(self, kernel: K);
}

/// Does a task with the widest kernel that the machine has and [`Isa::limit`] allows.
#[inline]
pub(super) fn dispatch<T: Task>(task: T) {
    let isa = Isa::current();
    #[cfg(target_arch = "x86_64")]
    {
        if let (Isa::Avx512, Some(kernel)) = (isa, Avx512::detect()) {
            return kernel.run(task);
        }
        if let (Isa::Avx512 | Isa::Avx2, Some(kernel)) = (isa, Avx2::detect()) {
            return kernel.run(task);
        }
    }
    let _ = isa;
    task.run(Plain);
}

/// The operations on vectors.
pub(super) trait Kernel: Copy {
    /// Those on packets.
    type Packets: PacketKernel;

    /// If it has any.
    #[inline(always)]
    fn packets(self) -> Option<Self::Packets> {
        None
    }

    /// Pushes the children of `node` that the ray meets up to its limit; returns the new height of its stack. If
    /// `ORDERED`, nearest last, with their entries; otherwise leaves last, without.
    fn open<const ORDERED: bool>(self, slot: &mut Slot, node: &Node) -> usize;

    /// Removes what is entered beyond the limit from the stack; returns how many are left.
    fn prune(self, slot: &mut Slot) -> usize;

    /// Which triangles of a block the ray's line meets.
    #[inline(always)]
    fn inside(self, shear: &Shear, block: &Block) -> Inside {
        plain::inside(shear, block)
    }

    /// Distances of triangles whose edges the ray is certainly inside, as [`crate::accel::resolve()`] has them, and which
    /// of them could be the hit.
    #[inline(always)]
    fn distances(self, slot: &Slot, block: &Block) -> Distances {
        plain::distances(slot, block)
    }
}

/// Triangles of a block, a bit for each lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Zeroable)]
#[repr(C)]
pub(super) struct Inside {
    /// Whether the ray's line meets it, edges included.
    pub(super) inside: u32,
    /// Those of them of which that is not certain: to be asked of [`Shear::is_inside`].
    pub(super) unsure: u32,
}

/// How far the triangles of a block are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distances {
    pub(super) t: [f32; SIZE],
    /// A bit for each that is beyond the ray's start and not beyond its limit.
    pub(super) within: u32,
}
