//! The top of large trees: primitives are sorted into the cells of a grid, and splits go between cells.
//!
//! Source of the idea: K. Garanzha et al., "Grid-based SAH BVH construction on a GPU", The Visual Computer 27,
//! 2011. A few passes over the primitives, shared by all threads, take the place of one for each level. Primitives
//! much larger than a cell are cells of their own, so that they do not spoil others.

use super::bins::{Bins, Grid, MOST_BINS};
use super::node::Nodes;
use super::primitive::{Bounds, Centers, PrimitiveBox};
use super::range::Range;
use super::{HALVE_FROM, Settings};
use glam::Vec4;
use rayon::prelude::*;
use std::marker::PhantomData;
use std::ops;

/// Most bits of a cell's number.
const MOST_BITS: u32 = 15;
/// Most bits of a cell's place along an axis.
const BITS_ALONG: u32 = 10;
/// Runs of primitives that are counted and moved each on its own.
const CHUNKS: usize = 16;

/// Splits a range between cells, until the parts are small or made of few cells; its node in `nodes` gets the
/// nodes above them. Gives the range back as the only part if there is nothing to split.
pub(super) fn split<'a>(
    range: Range<'a>,
    nodes: &mut Nodes,
    settings: &Settings,
) -> Vec<Range<'a>> {
    let n = range.here.len();
    let grid = CellGrid::new(&range.centers, (n.ilog2() - 4).min(MOST_BITS));
    let mut cells = sort(range.here, range.there, &grid);
    if cells.len() > n / 4 {
        // Hardly anything fits into a cell.
        return vec![range];
    }
    let parts = split_cells(&mut cells, &range, nodes, settings);
    if parts.len() < 2 {
        return vec![range];
    }
    // Each part in one piece, where the whole has been.
    let sorted = &*range.there;
    let mut places = &mut *range.here;
    let mut jobs = Vec::with_capacity(parts.len());
    for part in &parts {
        let (own, behind) = places.split_at_mut(part.count);
        places = behind;
        jobs.push((&cells[part.cells.clone()], own));
    }
    let centers: Vec<Centers> =
        jobs.into_par_iter().map(|(cells, places)| gather(cells, sorted, places)).collect();
    let mut rest = range;
    let mut ranges = Vec::with_capacity(parts.len());
    for (Part { count, node, depth, bounds, .. }, centers) in parts.into_iter().zip(centers) {
        let [own, behind] = rest.split_at(count);
        rest = behind;
        ranges.push(Range { node, depth, bounds, centers, ..own });
    }
    ranges
}

/// A grid of cells over centres, about as long as wide.
struct CellGrid {
    fine: Grid,
    /// Bits of a cell's place along each axis.
    bits: [u32; 3],
    /// The longest edge of primitives that share a cell.
    longest: f32,
}

impl CellGrid {
    /// A grid of at most 2^`bits` cells.
    fn new(centers: &Centers, bits: u32) -> Self {
        let [x, y, z, _] = (centers.max - centers.min).to_array();
        let mut size = [x, y, z];
        let mut of_axis = [0; 3];
        for _ in 0..bits {
            let mut axis = 0;
            for other in [1, 2] {
                axis = if size[other] > size[axis] { other } else { axis };
            }
            if of_axis[axis] < BITS_ALONG {
                of_axis[axis] += 1;
                size[axis] *= 0.5;
            }
        }
        // Twice the largest cell, whose sizes are double because the centres are.
        let longest = size[0].max(size[1]).max(size[2]);
        Self { fine: Grid::new(centers, 1 << BITS_ALONG), bits: of_axis, longest }
    }

    /// Number of cells.
    fn len(&self) -> usize {
        1 << self.bits.iter().sum::<u32>()
    }

    /// The cell of a primitive; large ones are behind all cells.
    #[inline(always)]
    fn of(&self, p: &PrimitiveBox) -> usize {
        let [x, y, z, _] = self.fine.of(p.center2());
        let [x_bits, y_bits, z_bits] = self.bits;
        let (x, y) = (x >> (BITS_ALONG - x_bits), y >> (BITS_ALONG - y_bits));
        let cell = ((x << y_bits | y) << z_bits) | z >> (BITS_ALONG - z_bits);
        if p.is_within(self.longest) { cell } else { self.len() }
    }
}

/// Primitives that stay together, in the order by cells.
struct Cell {
    bounds: Bounds,
    /// Twice the middle of their centres.
    center2: Vec4,
    start: usize,
    count: usize,
}

/// Sorts primitives by cells, in their order within each; returns the cells that are not empty.
fn sort(from: &[PrimitiveBox], to: &mut [PrimitiveBox], grid: &CellGrid) -> Vec<Cell> {
    let chunk = from.len().div_ceil(CHUNKS);
    let count = |chunk: &[PrimitiveBox]| {
        let mut counts = vec![0_u32; grid.len() + 1];
        for p in chunk {
            counts[grid.of(p)] += 1;
        }
        counts
    };
    let mut next: Vec<Vec<u32>> = from.par_chunks(chunk).map(count).collect();
    // The first place of each cell, and in it that of each chunk.
    let mut place = 0;
    let mut starts = Vec::with_capacity(grid.len() + 1);
    for cell in 0..=grid.len() {
        starts.push(place as usize);
        for next in &mut next {
            place += std::mem::replace(&mut next[cell], place);
        }
    }
    let places = Places { first: to.as_mut_ptr(), len: to.len(), lifetime: PhantomData };
    from.par_chunks(chunk).zip(next).for_each(|(chunk, mut next)| {
        for p in chunk {
            let next = &mut next[grid.of(p)];
            // SAFETY: each place belongs to one cell of one chunk, which has as many as it has primitives.
            unsafe { places.write(*next as usize, *p) };
            *next += 1;
        }
    });
    let sorted = &*to;
    let cell = |range: ops::Range<usize>| {
        let (start, count) = (range.start, range.len());
        let primitives = &sorted[range];
        let centers = Centers::of(primitives);
        let center2 = (centers.min + centers.max) * 0.5;
        Cell { bounds: Bounds::of(primitives), center2, start, count }
    };
    let shared = starts.par_windows(2).with_min_len(512).map(|ends| ends[0]..ends[1]);
    let mut cells: Vec<Cell> = shared.filter(|range| !range.is_empty()).map(cell).collect();
    cells.extend((starts[grid.len()]..from.len()).map(|i| cell(i..i + 1)));
    cells
}

/// Places that several threads write to, each to its own.
struct Places<'a> {
    first: *mut PrimitiveBox,
    len: usize,
    lifetime: PhantomData<&'a mut [PrimitiveBox]>,
}

// SAFETY: who writes sees to it that nobody else writes to the same place.
unsafe impl Sync for Places<'_> {}

impl Places<'_> {
    /// # Safety
    /// No two threads write to the same place, and nobody reads before they are done.
    #[inline(always)]
    unsafe fn write(&self, i: usize, p: PrimitiveBox) {
        assert!(i < self.len, "a place outside");
        // SAFETY: it is one of the places, which are exclusively borrowed; the caller sees to the rest.
        unsafe { self.first.wrapping_add(i).write(p) };
    }
}

/// Cells that are to be split or to become a range.
struct Part {
    cells: ops::Range<usize>,
    /// Primitives in them.
    count: usize,
    node: usize,
    depth: u32,
    bounds: Bounds,
}

/// Splits cells until the parts are small, and puts the nodes above them down. The parts in the order of their
/// cells.
fn split_cells(
    cells: &mut [Cell],
    range: &Range<'_>,
    nodes: &mut Nodes,
    settings: &Settings,
) -> Vec<Part> {
    let &Range { node, depth, bounds, .. } = range;
    let mut bins = Bins::new();
    let mut parts = Vec::new();
    let mut stack =
        vec![Part { cells: 0..cells.len(), count: range.here.len(), node, depth, bounds }];
    while let Some(part) = stack.pop() {
        let is_whole = part.count <= settings.part
            || part.cells.len() < settings.min_cells
            || part.depth >= HALVE_FROM;
        let sides = if is_whole {
            None
        } else {
            move_to_sides(&mut cells[part.cells.clone()], &mut bins, settings)
        };
        let Some((middle, count, bounds)) = sides else {
            parts.push(part);
            continue;
        };
        let node = nodes.split(part.node, &bounds);
        let ops::Range { start, end } = part.cells;
        let middle = start + middle;
        let depth = part.depth + 1;
        let right = part.count - count;
        stack.push(Part {
            cells: middle..end,
            count: right,
            node: node + 1,
            depth,
            bounds: bounds[1],
        });
        stack.push(Part { cells: start..middle, count, node, depth, bounds: bounds[0] });
    }
    parts
}

/// Moves cells to the sides of the cheapest plane between bins; returns how many cells and primitives are on the
/// left, and the boxes of both sides.
fn move_to_sides(
    cells: &mut [Cell],
    bins: &mut Bins,
    settings: &Settings,
) -> Option<(usize, usize, [Bounds; 2])> {
    let centers = cells.iter().fold(Centers::EMPTY, |all, cell| all.with(cell.center2));
    let grid = Grid::new(&centers, MOST_BINS);
    bins.clear(MOST_BINS);
    for cell in &*cells {
        bins.add(&grid, cell.bounds, cell.center2, cell.count as u32);
    }
    let plane = bins.cheapest(MOST_BINS, settings.leaf_shift)?;
    let (mut left, mut count) = (0, 0);
    for i in 0..cells.len() {
        if grid.of(cells[i].center2)[plane.axis] < plane.bin {
            count += cells[i].count;
            cells.swap(left, i);
            left += 1;
        }
    }
    Some((left, count, bins.sides(&plane, MOST_BINS)))
}

/// Copies the primitives of cells from where they are sorted, one cell after the other; returns the bounds of
/// their centres.
fn gather(cells: &[Cell], sorted: &[PrimitiveBox], mut places: &mut [PrimitiveBox]) -> Centers {
    let mut centers = Centers::EMPTY;
    for cell in cells {
        let (own, behind) = places.split_at_mut(cell.count);
        places = behind;
        own.copy_from_slice(&sorted[cell.start..cell.start + cell.count]);
        centers = centers.union(Centers::of(own));
    }
    centers
}
