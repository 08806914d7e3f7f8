//! A binary hierarchy by the surface area heuristic, built by all threads.
//!
//! From the top: `grid` splits large ranges between cells, `range` splits what is left at planes between `bins`, and
//! `sweep` weighs the planes between the last few primitives, so that leaves come out full. Then `reinsert` moves
//! subtrees to better places. Which thread does what decides nothing: the tree is the same for any number of
//! them. Knows boxes, not what is in them; `triangles` makes them.

mod bins;
mod grid;
mod node;
mod points;
mod primitive;
mod range;
mod reinsert;
mod sweep;
mod triangles;
#[cfg(test)]
mod tests;

pub(super) use node::{BinaryNode, BinaryTree, Kind, half_area};
pub(super) use points::{Anything, Leaves, Room, Triangles};
pub(super) use primitive::PrimitiveBox;
pub(super) use triangles::boxes;

use crate::accel::Quality;
use bins::Bins;
use node::Nodes;
use primitive::{Bounds, Centers};
use range::Range;
use rayon::prelude::*;
use reinsert::Reinsertion;
use sweep::{MOST, Sweep};

/// What a quality means, and what is asked of leaves.
#[derive(Clone, Copy, Debug)]
struct Settings {
    /// What splitting counts on: a leaf of 2^this primitives.
    leaf_shift: u32,
    /// Ranges of fewer primitives have 8 bins along an axis, or 16; all others have 32.
    more_bins_from: [usize; 2],
    /// Parts of fewer primitives, or of fewer cells, are not split between cells of the grid.
    part: usize,
    min_cells: usize,
    /// What is moved in the finished tree.
    reinsertion: Reinsertion,
}

impl Settings {
    fn new(quality: Quality, leaf_size: usize) -> Self {
        let leaf_shift = leaf_size.ilog2();
        match quality {
            Quality::Fast => Self {
                leaf_shift,
                more_bins_from: [usize::MAX; 2],
                part: 1 << 12,
                min_cells: 32,
                reinsertion: Reinsertion { passes: 0, share: 1 },
            },
            // The largest nodes alone save most of what there is to be saved.
            Quality::Default => Self {
                leaf_shift,
                more_bins_from: [128, 1024],
                part: LARGE,
                min_cells: 256,
                reinsertion: Reinsertion { passes: 3, share: 64 },
            },
            Quality::High => Self {
                leaf_shift,
                more_bins_from: [0; 2],
                part: LARGE,
                min_cells: 256,
                reinsertion: Reinsertion { passes: 6, share: 4 },
            },
        }
    }

    /// Bins along an axis for a range of `n` primitives.
    #[inline(always)]
    fn bins(&self, n: usize) -> usize {
        let [some, many] = self.more_bins_from;
        if n < some {
            8
        } else if n < many {
            16
        } else {
            32
        }
    }
}

/// From this depth on primitives are halved, whatever it costs: no scene makes a tree deeper than this plus the
/// logarithm of what is left.
pub(super) const HALVE_FROM: u32 = 48;

/// Ranges of more primitives are split between the cells of a grid.
const LARGE: usize = 1 << 16;

/// Primitives that one thread measures at a time.
const CHUNK: usize = 8192;

/// Builds over `boxes` with leaves that have room for what is in them. There are fewer than 2^30 primitives. The tree is no deeper than [`HALVE_FROM`] + 30.
pub(super) fn build(
    mut boxes: Vec<PrimitiveBox>,
    leaves: &impl Leaves,
    quality: Quality,
) -> BinaryTree {
    let n = boxes.len();
    if n == 0 {
        return BinaryTree::default();
    }
    let settings = Settings::new(quality, leaves.room().primitives);
    let measure = |chunk: &[PrimitiveBox]| (Bounds::of(chunk), Centers::of(chunk));
    let measures: Vec<_> = boxes.par_chunks(CHUNK).map(measure).collect();
    let (bounds, centers) =
        measures.into_iter().fold((Bounds::EMPTY, Centers::EMPTY), |(b, c), (more_b, more_c)| {
            (b.union(more_b), c.union(more_c))
        });
    // Room to sort large ranges.
    let mut room: Vec<PrimitiveBox> = bytemuck::zeroed_vec(if n > LARGE { n } else { 0 });
    let mut order = vec![0; n];
    let mut top = Nodes::new(&bounds, 1);
    let (here, there) = (&mut *boxes, &mut *room);
    let range =
        Range { here, there, order: &mut order, first: 0, node: 0, depth: 0, bounds, centers };
    let tasks = split_large(range, &mut top, &settings);
    let subtree = |range: Range<'_>| (range.node, subtree(range, &settings, leaves));
    let subtrees: Vec<_> = tasks.into_par_iter().with_max_len(1).map(subtree).collect();
    // Nobody needs them any more; the nodes are about to be there twice.
    drop((boxes, room));
    let tree = top.join(&subtrees, order);
    drop(subtrees);
    reinsert::improve(tree, settings.reinsertion)
}

/// Splits a range until each part is small enough for one thread.
fn split_large<'a>(range: Range<'a>, top: &mut Nodes, settings: &Settings) -> Vec<Range<'a>> {
    let mut large = vec![range];
    let mut small = Vec::new();
    while let Some(range) = large.pop() {
        if range.here.len() <= LARGE {
            small.push(range);
            continue;
        }
        let mut parts = grid::split(range, top, settings);
        if parts.len() > 1 {
            large.extend(parts);
        } else if let Some(range) = parts.pop() {
            let [mut left, mut right] = range.split(settings, &mut Bins::new());
            left.node = top.split(left.node, &[left.bounds, right.bounds]);
            right.node = left.node + 1;
            large.extend([left, right]);
        }
    }
    small
}

/// The subtree over a range, by one thread.
fn subtree(range: Range<'_>, settings: &Settings, leaves: &impl Leaves) -> Nodes {
    let mut nodes = Nodes::new(&range.bounds, range.here.len());
    let (mut bins, mut sweep) = (Bins::new(), Sweep::new(leaves));
    // What is still to be split, depth first.
    let mut stack = vec![Range { node: 0, ..range }];
    while let Some(range) = stack.pop() {
        if range.here.len() <= MOST {
            sweep.build(range, &mut nodes);
            continue;
        }
        let [mut left, mut right] = range.split(settings, &mut bins);
        left.node = nodes.split(left.node, &[left.bounds, right.bounds]);
        right.node = left.node + 1;
        stack.extend([right, left]);
    }
    nodes
}
