//! Bins along the three axes, and the cheapest plane between them.
//!
//! Source: I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing 2007.

use super::primitive::{Bounds, Centers, PrimitiveBox};
use crate::os::Isa;
use glam::Vec4;
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::_mm256_max_ps;

/// Most bins along an axis.
pub(super) const MOST_BINS: usize = 32;

/// Equal bins over centres; their number is a power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: Vec4,
    scale: Vec4,
    /// Takes the bin to the lowest bits of a number from 1 to 2.
    shift: u32,
}

impl Grid {
    #[inline(always)]
    pub(super) fn new(centers: &Centers, bins: usize) -> Self {
        // Just below 1, so that the largest centre is in the last bin. An axis almost without extent has one bin:
        // the quotient must not overflow.
        let scale = |extent: f32| if extent > 1e-37 { (1.0 - 1e-6) / extent } else { 0.0 };
        let [x, y, z, _] = (centers.max - centers.min).to_array();
        let scale = Vec4::new(scale(x), scale(y), scale(z), 0.0);
        Self { origin: centers.min.with_w(0.0), scale, shift: 23 - bins.trailing_zeros() }
    }

    /// Bins along an axis.
    #[inline(always)]
    pub(super) fn bins(&self) -> usize {
        1 << (23 - self.shift)
    }

    /// The bin of a doubled centre along each axis. The fourth number means nothing.
    #[inline(always)]
    pub(super) fn of(&self, center2: Vec4) -> [usize; 4] {
        // The first bits of the fraction of a number from 1 to 2 are its bin; those of NaN are some bin, too.
        let along = (center2 - self.origin) * self.scale + Vec4::ONE;
        along.to_array().map(|x| (x.to_bits() >> self.shift) as usize & (self.bins() - 1))
    }

    /// What tells the sides of a plane apart.
    #[inline(always)]
    pub(super) fn side(&self, plane: &Plane) -> Side {
        let axis = plane.axis & 3;
        let first = 1.0_f32.to_bits() + ((plane.bin as u32) << self.shift);
        Side { axis, origin: self.origin[axis], scale: self.scale[axis], first }
    }
}

/// A plane between bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) axis: usize,
    /// First bin on the right.
    pub(super) bin: usize,
}

/// Tells on which side of a plane a primitive is: by one axis only, otherwise as [`Grid::of`].
pub(super) struct Side {
    axis: usize,
    origin: f32,
    scale: f32,
    /// The bits of the first number on the right.
    first: u32,
}

impl Side {
    #[inline(always)]
    pub(super) fn is_right(&self, p: &PrimitiveBox) -> bool {
        ((p.center2_along(self.axis) - self.origin) * self.scale + 1.0).to_bits() >= self.first
    }
}

/// What is in a bin; a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Bin {
    bounds: Bounds,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds::EMPTY, count: 0 };
}

/// Bins along each axis.
pub(super) struct Bins([[Bin; MOST_BINS]; 3]);

impl Bins {
    pub(super) fn new() -> Self {
        Self([[Bin::EMPTY; MOST_BINS]; 3])
    }

    /// Empties the first `bins` along each axis.
    #[inline(always)]
    pub(super) fn clear(&mut self, bins: usize) {
        for along in &mut self.0 {
            along[..bins].fill(Bin::EMPTY);
        }
    }

    /// Adds a box with its doubled centre, which stands for `count` primitives.
    #[inline(always)]
    pub(super) fn add(&mut self, grid: &Grid, bounds: Bounds, center2: Vec4, count: u32) {
        for (along, bin) in self.0.iter_mut().zip(grid.of(center2)) {
            let bin = &mut along[bin & (MOST_BINS - 1)];
            bin.bounds = bin.bounds.union(bounds);
            bin.count += count;
        }
    }

    /// Adds primitives.
    pub(super) fn add_primitives(&mut self, grid: &Grid, primitives: &[PrimitiveBox]) {
        match grid.bins() {
            8 => self.add_all::<8>(grid, primitives),
            16 => self.add_all::<16>(grid, primitives),
            _ => self.add_all::<MOST_BINS>(grid, primitives),
        }
    }

    /// Adds primitives to so many bins, a constant.
    fn add_all<const BINS: usize>(&mut self, grid: &Grid, primitives: &[PrimitiveBox]) {
        #[cfg(target_arch = "x86_64")]
        if Isa::current() >= Isa::Avx2 {
            // SAFETY: the processor has AVX2, says `Isa`.
            return unsafe { self.add_all_avx2::<BINS>(grid, primitives) };
        }
        self.add_by::<BINS>(grid, primitives, Bounds::union);
    }

    /// With boxes as one vector, not two.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn add_all_avx2<const BINS: usize>(&mut self, grid: &Grid, primitives: &[PrimitiveBox]) {
        use bytemuck::must_cast as cast;
        self.add_by::<BINS>(grid, primitives, |a, b| cast(_mm256_max_ps(cast(a), cast(b))));
    }

    #[inline(always)]
    fn add_by<const BINS: usize>(
        &mut self,
        grid: &Grid,
        primitives: &[PrimitiveBox],
        union: impl Fn(Bounds, Bounds) -> Bounds,
    ) {
        let grid = Grid { shift: 23 - BINS.trailing_zeros(), ..*grid };
        for p in primitives {
            for (along, bin) in self.0.iter_mut().zip(grid.of(p.center2())) {
                let bin = &mut along[bin & (MOST_BINS - 1)];
                bin.bounds = union(bin.bounds, p.bounds());
                bin.count += 1;
            }
        }
    }

    /// The cheapest plane, where a side costs its surface times the leaves of 2^`leaf_shift` primitives that it
    /// fills; none if no plane has primitives on both sides. The first `bins` along each axis are in use.
    #[inline(always)]
    pub(super) fn cheapest(&self, bins: usize, leaf_shift: u32) -> Option<Plane> {
        let bins = bins.min(MOST_BINS);
        let up = (1 << leaf_shift) - 1;
        // Of nothing, the surface is infinite.
        let leaves = |n: u32| ((n.max(1) + up) >> leaf_shift) as i32 as f32;
        let leaves = |n: &[u32; 3]| Vec4::new(leaves(n[0]), leaves(n[1]), leaves(n[2]), 0.0);
        // From the right: what each plane leaves there. All axes at once, one in each lane.
        let mut right = [Vec4::ZERO; MOST_BINS];
        let (mut union, mut count) = ([Bounds::EMPTY; 3], [0; 3]);
        for bin in (1..bins).rev() {
            self.add_bins(bin, &mut union, &mut count);
            right[bin] = Bounds::half_areas(&union) * leaves(&count);
        }
        let (mut union, mut count) = ([Bounds::EMPTY; 3], [0; 3]);
        let (mut least, mut best) = (Vec4::INFINITY, Vec4::ZERO);
        for (bin, right) in right.iter().enumerate().take(bins).skip(1) {
            self.add_bins(bin - 1, &mut union, &mut count);
            let cost = Bounds::half_areas(&union) * leaves(&count) + right;
            let is_less = cost.cmplt(least);
            least = Vec4::select(is_less, cost, least);
            best = Vec4::select(is_less, Vec4::splat(bin as f32), best);
        }
        let axis = cheapest_axis(least);
        (least[axis] < f32::INFINITY).then_some(Plane { axis, bin: best[axis] as usize })
    }

    #[inline(always)]
    fn add_bins(&self, bin: usize, union: &mut [Bounds; 3], count: &mut [u32; 3]) {
        for axis in 0..3 {
            let bin = &self.0[axis][bin];
            union[axis] = union[axis].union(bin.bounds);
            count[axis] += bin.count;
        }
    }

    /// The boxes around what is on the left and on the right of a plane.
    #[inline(always)]
    pub(super) fn sides(&self, plane: &Plane, bins: usize) -> [Bounds; 2] {
        let along = &self.0[plane.axis][..bins];
        let (left, right) = along.split_at(plane.bin);
        let union = |bins: &[Bin]| bins.iter().fold(Bounds::EMPTY, |u, bin| u.union(bin.bounds));
        [union(left), union(right)]
    }
}

/// The axis of the least of the first three costs, the first of equal ones.
#[inline(always)]
pub(super) fn cheapest_axis(cost: Vec4) -> usize {
    let [x, y, z, _] = cost.to_array();
    let first = usize::from(y < x);
    if z < [x, y][first] { 2 } else { first }
}
