//! A kernel that counts what another one is asked to do: the cost of a tree in steps, which no noise disturbs.

use super::packets::Never;
use super::{Distances, Inside, Kernel, Task};
use crate::accel::bvh::block::Block;
use crate::accel::bvh::node::Node;
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::Shear;
use std::cell::Cell;

/// What rays took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Nodes opened.
    pub nodes: u64,
    /// Children of those whose boxes were met.
    pub children: u64,
    /// Leaves whose triangles were tested.
    pub leaves: u64,
    /// Leaves with a triangle whose edges the ray is inside.
    pub distances: u64,
    /// Times that a nearer hit shortened the ray.
    pub prunes: u64,
}

/// A task whose steps are counted.
pub(in crate::accel::bvh) struct Count<'a, T> {
    pub(in crate::accel::bvh) task: T,
    pub(in crate::accel::bvh) steps: &'a Cell<Steps>,
}

impl<T: Task> Task for Count<'_, T> {
    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) {
        self.task.run(Counting { kernel, steps: self.steps });
    }
}

#[derive(Clone, Copy)]
struct Counting<'a, K> {
    kernel: K,
    steps: &'a Cell<Steps>,
}

impl<K> Counting<'_, K> {
    #[inline(always)]
    fn count(&self, change: impl FnOnce(&mut Steps)) {
        let mut steps = self.steps.get();
        change(&mut steps);
        self.steps.set(steps);
    }
}

impl<K: Kernel> Kernel for Counting<'_, K> {
    type Packets = Never;

    #[inline(always)]
    fn open<const ORDERED: bool>(self, slot: &mut Slot, node: &Node) -> usize {
        let before = slot.top as usize;
        let top = self.kernel.open::<ORDERED>(slot, node);
        self.count(|steps| {
            steps.nodes += 1;
            steps.children += (top - before) as u64;
        });
        top
    }

    #[inline(always)]
    fn prune(self, slot: &mut Slot) -> usize {
        self.count(|steps| steps.prunes += 1);
        self.kernel.prune(slot)
    }

    #[inline(always)]
    fn inside(self, shear: &Shear, block: &Block) -> Inside {
        self.count(|steps| steps.leaves += 1);
        self.kernel.inside(shear, block)
    }

    #[inline(always)]
    fn distances(self, slot: &Slot, block: &Block) -> Distances {
        self.count(|steps| steps.distances += 1);
        self.kernel.distances(slot, block)
    }
}
