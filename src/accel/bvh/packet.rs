//! Sixteen rays that stay together, prepared to be traced at once, and what bounds them all.
//!
//! Source of the packets: I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive Rendering with Coherent Ray Tracing",
//! Eurographics 2001; of the bounds: S. Boulos, I. Wald, P. Shirley, "Geometric and Arithmetic Culling Methods for
//! Entire Ray Packets", University of Utah UUCS-06-010, 2006. Knows neither trees nor which rays stay together.

use super::kernel::PacketKernel;
use super::node::{Reference, WIDTH};
use super::slot::{Found, ROOM};
use super::woop::{LARGEST, Shear};
use crate::geometry::{NONE, Ray};
use crate::math::{UNIT_ROUNDOFF, Vec4};
use crate::os::Arena;
use bytemuck::Zeroable;

/// Rays a packet.
pub(super) const RAYS: usize = 16;

/// A number for each ray.
pub(super) type Each = [f32; RAYS];

/// Rays of a batch that are side by side, whose directions point into the same octant and run most along the same axis.
#[derive(Clone, Copy, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Packet {
    /// As in `BoxRay`, along each axis.
    pub(super) reciprocal: [Each; 3],
    pub(super) near_offset: [Each; 3],
    pub(super) far_offset: [Each; 3],
    pub(super) t_min: Each,
    /// As in `Slot`.
    pub(super) limit: Each,
    pub(super) origin: [Each; 3],
    pub(super) direction: [Each; 3],
    /// As in `Shear`, whose axes are the same for all.
    pub(super) slope: [Each; 2],
    pub(super) error: Each,
    /// The same of each ray.
    pub(super) shears: [Shear; RAYS],
    /// What bounds all rays.
    pub(super) hull: Hull,
    /// As in `BoxRay` and `Shear`.
    pub(super) near: [u32; 3],
    pub(super) axes: [u32; 3],
    /// Place of the first ray in its batch.
    pub(super) first: u32,
    /// What is hit by each ray, and the triangle's lane there.
    pub(super) leaf: [u32; RAYS],
    pub(super) lane: [u32; RAYS],
    /// Elements on the stack.
    pub(super) top: u32,
    /// What is left for later, and where each ray enters it; infinity for those that do not.
    pub(super) references: [u32; ROOM],
    pub(super) entries: [Each; ROOM],
}

/// Two rays, between whose entries into any box those of all rays are, and whose exits are about theirs. The fourth elements mean
/// nothing.
#[derive(Clone, Copy, Zeroable)]
#[repr(C, align(16))]
pub(super) struct Hull {
    pub(super) reciprocal: [[f32; 4]; 2],
    pub(super) near_offset: [[f32; 4]; 2],
    pub(super) far_offset: [[f32; 4]; 2],
    pub(super) t_min: f32,
    /// The largest of the limits.
    pub(super) limit: f32,
}

/// Packets on huge pages.
pub(super) type Packets = Arena<Packet>;

/// Whether rays can be a packet.
#[inline(always)]
pub(super) fn is_coherent(rays: &[Ray; RAYS]) -> bool {
    let octant = |ray: &Ray| ray.direction.to_array().map(|x| x.to_bits() >> 31);
    let of_first = octant(&rays[0]);
    // Most that are not are told by a few.
    if ![15, 10, 5].iter().all(|&i| octant(&rays[i]) == of_first) {
        return false;
    }
    let (_, axis) = Shear::axes(&rays[0].direction.extend(0.0).to_array());
    let mut is = true;
    for ray in rays {
        let (origin, direction) = (ray.origin.extend(0.0), ray.direction.extend(0.0));
        let is_finite = (origin * 0.0 + direction * 0.0).cmpeq(Vec4::ZERO).all();
        let is_like = octant(ray) == of_first && Shear::axes(&direction.to_array()).1 == axis;
        let is_ray = direction.cmpne(Vec4::ZERO).any() & (ray.t_min >= 0.0);
        is &= is_finite & is_like & is_ray;
    }
    is
}

impl Packet {
    /// Takes rays over, the first of which is at `first` in its batch, for a tree whose largest coordinate is `size`.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        kernel: impl PacketKernel,
        rays: &[Ray; RAYS],
        first: u32,
        size: f32,
        root: Reference,
    ) {
        self.first = first;
        self.leaf = [Found::NONE.leaf.0; RAYS];
        for (i, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                self.origin[axis][i] = ray.origin[axis];
                self.direction[axis][i] = ray.direction[axis];
            }
            self.t_min[i] = ray.t_min;
            self.limit[i] = ray.t_max;
        }
        let mut sizes = [0.0; RAYS];
        for (i, all) in sizes.iter_mut().enumerate() {
            // As `Slot::begin` has it.
            self.t_min[i] += 0.0;
            let before = f32::from_bits(self.limit[i].to_bits().wrapping_sub(1));
            self.limit[i] = if self.limit[i] > 0.0 { before } else { f32::NEG_INFINITY };
            let [x, y, z] = [0, 1, 2].map(|axis| self.origin[axis][i].abs());
            *all = x.max(y).max(z) + size;
        }
        self.near = [0, 1, 2].map(|axis| self.direction[axis][0].to_bits() >> 27 & WIDTH as u32);
        for axis in 0..3 {
            self.prepare_axis(kernel, axis, &sizes);
        }
        let (axes, _) = Shear::axes(&rays[0].direction.extend(0.0).to_array());
        self.axes = axes;
        let along = |values: &[Each; 3], i: usize| values[axes[i].min(2) as usize];
        let (depth, across) =
            (along(&self.direction, 2), [0, 1].map(|i| along(&self.direction, i)));
        for i in 0..RAYS {
            self.slope[0][i] = across[0][i] / depth[i];
            self.slope[1][i] = across[1][i] / depth[i];
            self.error[i] = Shear::error(sizes[i]);
        }
        let origin = [0, 1, 2].map(|k| along(&self.origin, k));
        for (i, shear) in self.shears.iter_mut().enumerate() {
            *shear = Shear {
                origin: [origin[0][i], origin[1][i], origin[2][i]],
                shear: [self.slope[0][i], self.slope[1][i]],
                axes,
                error: self.error[i],
            };
        }
        [self.hull.t_min, _] = kernel.range(&self.t_min);
        self.shorten_hull(kernel);
        self.references[0] = root.0;
        self.entries[0] = self.t_min;
        self.top = 1;
    }

    /// What boxes need along an axis, of the rays as in `BoxRay::new`, and of the hull.
    #[inline(always)]
    fn prepare_axis(&mut self, kernel: impl PacketKernel, axis: usize, sizes: &Each) {
        let (origin, direction) = (&self.origin[axis], &self.direction[axis]);
        let reciprocal = &mut self.reciprocal[axis];
        const MARGIN: f32 = 32.0 * UNIT_ROUNDOFF;
        for i in 0..RAYS {
            let d = direction[i];
            let finite = if d.abs() < 1e-18 { 1e-18_f32.copysign(d) } else { d };
            reciprocal[i] = 1.0 / finite;
            let margin = reciprocal[i].abs() * (MARGIN * sizes[i]);
            self.near_offset[axis][i] = origin[i] * reciprocal[i] + margin;
            self.far_offset[axis][i] = origin[i] * reciprocal[i] - margin;
        }
        // A plane is reached at (plane - origin) * reciprocal, which is monotonic in either: no sooner than from the origin
        // that is farthest on the way, by one of the extreme reciprocals.
        let [first, last] = kernel.range(origin);
        let (ahead, behind) = if self.near[axis] == 0 { (last, first) } else { (first, last) };
        let [_, size] = kernel.range(sizes);
        for (k, r) in kernel.range(reciprocal).into_iter().enumerate() {
            let margin = MARGIN * size * r.abs();
            // Where products might overflow nothing is known: entered at once, and never left.
            let is_known = size * r.abs() < LARGEST;
            let [r, near, far] = match is_known {
                true => [r, ahead * r + margin, behind * r - margin],
                false => [0.0, f32::INFINITY, f32::NEG_INFINITY],
            };
            self.hull.reciprocal[k][axis] = r;
            self.hull.near_offset[k][axis] = near;
            self.hull.far_offset[k][axis] = far;
        }
    }

    /// What a ray has found so far.
    #[inline(always)]
    pub(super) fn best(&self, i: usize) -> Found {
        Found { leaf: Reference(self.leaf[i]), lane: self.lane[i], instance: NONE }
    }

    /// After limits have become smaller.
    #[inline(always)]
    pub(super) fn shorten_hull(&mut self, kernel: impl PacketKernel) {
        [_, self.hull.limit] = kernel.range(&self.limit);
    }
}
