//! Loops over arrays, which the compiler turns into whatever vectors the machine has.

use super::{Distances, Inside, Kernel};
use crate::accel::bvh::block::{ABSENT, Block, SIZE};
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::slot::{SPARE, Slot};
use crate::accel::bvh::woop::{LARGEST, SMALLEST, Shear};

/// No instructions of its own.
#[derive(Clone, Copy)]
pub(in crate::accel::bvh) struct Plain;

impl Kernel for Plain {
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
    let mut flat = [[[0.0; SIZE]; 2]; 3];
    for (flat, corner) in flat.iter_mut().zip(&block.corners) {
        let depths = shear.along(corner, 2);
        for (k, flat) in flat.iter_mut().enumerate() {
            let places = shear.along(corner, k);
            for i in 0..SIZE {
                let depth = depths[i] - shear.origin[2];
                flat[i] = (places[i] - shear.origin[k]) - shear.shear[k] * depth;
            }
        }
    }
    let [a, b, c] = &flat;
    let (mut inside, mut sure) = (0, 0);
    for i in 0..SIZE {
        let u = c[0][i] * b[1][i] - c[1][i] * b[0][i];
        let v = a[0][i] * c[1][i] - a[1][i] * c[0][i];
        let w = b[0][i] * a[1][i] - b[1][i] * a[0][i];
        // What is not a number has no sign, and is not trusted either.
        let is_front = !((u < 0.0) | (v < 0.0) | (w < 0.0));
        let is_back = !((u > 0.0) | (v > 0.0) | (w > 0.0));
        let corners: f32 = flat.iter().map(|[x, y]| x[i].abs() + y[i].abs()).sum();
        // Certain are edges larger than their error, and none that may have left the range of `f32`.
        let error = (corners * shear.error).max(SMALLEST);
        let is_certain = (u.abs() > error) & (v.abs() > error) & (w.abs() > error);
        let sum = u.abs() + v.abs() + w.abs();
        let is_present = block.triangles[i] & ABSENT == 0;
        inside |= u32::from((is_front | is_back) & is_present) << i;
        sure |= u32::from(is_certain & (sum < LARGEST)) << i;
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
        let corner = |vertex: usize, axis: usize| f64::from(block.corners[vertex][axis][i]);
        let a = [corner(0, 0), corner(0, 1), corner(0, 2)];
        let ab = [corner(1, 0) - a[0], corner(1, 1) - a[1], corner(1, 2) - a[2]];
        let ac = [corner(2, 0) - a[0], corner(2, 1) - a[1], corner(2, 2) - a[2]];
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
