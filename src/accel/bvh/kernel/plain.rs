//! Loops over arrays, which the compiler turns into whatever vectors the machine has.

use super::packets::Never;
use super::{Distances, Inside, Kernel};
use crate::accel::bvh::block::{Block, SIZE, VERTICES};
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::slot::{SPARE, Slot};
use crate::accel::bvh::woop::{LARGEST, SMALLEST, Shear};

/// No instructions of its own.
#[derive(Clone, Copy)]
pub(in crate::accel::bvh) struct Plain;

impl Kernel for Plain {
    type Packets = Never;

    #[inline(always)]
    fn open<const ORDERED: bool>(self, slot: &mut Slot, node: &Node) -> usize {
        let (entries, mut met) = meet(slot, node);
        let top = slot.top as usize;
        let places = &mut slot.references[top..top + SPARE];
        let distances = &mut slot.entries[top..top + SPARE];
        let mut count = 0;
        while met != 0 {
            let i = met.trailing_zeros() as usize & (WIDTH - 1);
            met &= met - 1;
            let mut place = count;
            if ORDERED {
                // Insertion: few children are met, and often only one.
                while place > 0 && distances[place - 1] < entries[i] {
                    distances[place] = distances[place - 1];
                    places[place] = places[place - 1];
                    place -= 1;
                }
                distances[place] = entries[i];
            }
            places[place] = node.child(i).0;
            count += 1;
        }
        top + count
    }

    #[inline(always)]
    fn prune(self, slot: &mut Slot) -> usize {
        prune(slot)
    }
}

/// See [`Kernel::prune`].
#[inline(always)]
pub(super) fn prune(slot: &mut Slot) -> usize {
    let mut kept = 0;
    for i in 0..slot.top as usize {
        let (entry, reference) = (slot.entries[i], slot.references[i]);
        slot.entries[kept] = entry;
        slot.references[kept] = reference;
        kept += usize::from(entry <= slot.limit);
    }
    kept
}

/// Where the ray enters each child, and a bit for each child that it meets up to its limit.
#[inline(always)]
fn meet(slot: &Slot, node: &Node) -> ([f32; WIDTH], u32) {
    let ray = &slot.boxes;
    let mut entries = [slot.t_min; WIDTH];
    let mut exits = [slot.limit; WIDTH];
    for (axis, planes) in node.planes.iter().enumerate() {
        let near = ray.near[axis] as usize & WIDTH;
        let far = near ^ WIDTH;
        let (near, far) = (&planes[near..near + WIDTH], &planes[far..far + WIDTH]);
        let r = ray.reciprocal[axis];
        let step = node.step(axis) * r;
        let near_base = node.origin[axis] * r - ray.near_offset[axis];
        let far_base = node.origin[axis] * r - ray.far_offset[axis];
        for i in 0..WIDTH {
            let entry = f32::from(near[i]) * step + near_base;
            let exit = f32::from(far[i]) * step + far_base;
            entries[i] = if entry > entries[i] { entry } else { entries[i] };
            exits[i] = if exit < exits[i] { exit } else { exits[i] };
        }
    }
    let mut met = 0;
    for i in 0..WIDTH {
        met |= u32::from(entries[i] <= exits[i]) << i;
    }
    (entries, met & u32::from(node.present))
}

/// See [`Kernel::inside`].
#[inline(always)]
pub(super) fn inside(shear: &Shear, block: &Block) -> Inside {
    // Vertices relative to the origin, sheared, and the sums of their sizes.
    let flat: [[f32; 2]; VERTICES] = std::array::from_fn(|vertex| shear.project(block, vertex));
    let size = |i: usize| flat[i][0].abs() + flat[i][1].abs();
    let edge = |p: usize, q: usize| flat[p][0] * flat[q][1] - flat[p][1] * flat[q][0];
    // As vectors do it: the second where one is not a number.
    let least = |a: f32, b: f32| if a < b { a } else { b };
    let most = |a: f32, b: f32| if a > b { a } else { b };
    let (mut inside, mut sure) = (0, 0);
    for lane in 0..SIZE {
        let [a, b, c] = block.numbers(lane);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let (lowest, highest) = (least(least(u, v), w), most(most(u, v), w));
        // What is not a number has no sign, and is not trusted either.
        let (is_below, is_above) = (lowest < 0.0, highest > 0.0);
        let is_one_sided = !is_below | !is_above;
        // Certain are edges larger than their error, and none that may have left the range of `f32`.
        let error = most((size(a) + size(b) + size(c)) * shear.error, SMALLEST);
        let is_certain = (lowest > error) | (highest < -error);
        let is_small = (u + v + w).abs() < LARGEST;
        inside |= u32::from(is_one_sided & block.has(lane)) << lane;
        sure |= u32::from(is_certain & is_small) << lane;
    }
    Inside { inside, unsure: inside & !sure }
}

/// See [`Kernel::distances`]. The operations of [`crate::geometry::intersect_triangle`], in its order.
#[inline(always)]
pub(super) fn distances(slot: &Slot, block: &Block) -> Distances {
    let (o, d) = (slot.origin.map(f64::from), slot.direction.map(f64::from));
    let mut t = [0.0; SIZE];
    let mut within = 0;
    for (i, t) in t.iter_mut().enumerate() {
        let [a, b, c] = block.vertices(i).map(|p| p.as_dvec3().to_array());
        let ab = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let ac = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        let normal = [
            ab[1] * ac[2] - ac[1] * ab[2],
            ab[2] * ac[0] - ac[2] * ab[0],
            ab[0] * ac[1] - ac[0] * ab[1],
        ];
        let s = [o[0] - a[0], o[1] - a[1], o[2] - a[2]];
        let det = -(d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]);
        let height = s[0] * normal[0] + s[1] * normal[1] + s[2] * normal[2];
        *t = (height * (1.0 / det)) as f32;
        within |= u32::from((*t > slot.t_min) & (*t <= slot.limit)) << i;
    }
    Distances { t, within }
}
