//! A binary hierarchy by the surface area heuristic over bins.
//!
//! Source: I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing 2007. Subtrees are built in parallel into places that depend on the number of
//! primitives alone, so the result does not depend on the number of threads.

use crate::geometry::Aabb;
use crate::math::Vec3;

/// A primitive for the builder.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimitiveBox {
    pub(super) bounds: Aabb,
    pub(super) id: u32,
}

/// A node of the binary tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Aabb,
    pub(super) kind: Kind,
}

/// What is below a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// Places of the two children.
    Inner([u32; 2]),
    /// Range of the primitives, in the builder's order.
    Leaf { start: u32, end: u32 },
}

/// Bins along each axis.
const BINS: usize = 16;
/// From this depth on primitives are halved, whatever it costs: no scene makes a tree deeper than
/// this plus the logarithm of what is left.
pub(super) const HALVE_FROM: u32 = 48;
/// Ranges smaller than this are built by one thread.
const PARALLEL: usize = 4096;
/// Builds over `boxes` with leaves of at most `leaf_size`. Returns the nodes, root first (none without
/// primitives; some places stay unused), and the primitives' ids in the order of the leaves. There are fewer
/// than 2^30 primitives.
pub(super) fn build(mut boxes: Vec<PrimitiveBox>, leaf_size: usize) -> (Vec<BinaryNode>, Vec<u32>) {
    if boxes.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let unused = BinaryNode { bounds: Aabb::EMPTY, kind: Kind::Leaf { start: 0, end: 0 } };
    let mut nodes = vec![unused; 2 * boxes.len() - 1];
    subtree(&mut boxes, &mut nodes, Place { first: 0, node: 0, depth: 0 }, leaf_size);
    (nodes, boxes.iter().map(|b| b.id).collect())
}

/// Where a subtree lies: its first primitive and its root in the whole, and how deep it is.
#[derive(Clone, Copy)]
struct Place {
    first: u32,
    node: u32,
    depth: u32,
}

/// n primitives have a tree of at most 2n - 1 nodes: root, those of the left part, those of the right part.
fn subtree(boxes: &mut [PrimitiveBox], nodes: &mut [BinaryNode], place: Place, leaf_size: usize) {
    let n = boxes.len();
    let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(b.bounds));
    let leaf = Kind::Leaf { start: place.first, end: place.first + n as u32 };
    let Some(middle) = split(boxes, &bounds, place.depth, leaf_size) else {
        nodes[0] = BinaryNode { bounds, kind: leaf };
        return;
    };
    let (left_boxes, right_boxes) = boxes.split_at_mut(middle);
    let (root, below) = nodes.split_at_mut(1);
    let (left_nodes, right_nodes) = below.split_at_mut(2 * middle - 1);
    let depth = place.depth + 1;
    let left = Place { first: place.first, node: place.node + 1, depth };
    let right =
        Place { first: place.first + middle as u32, node: place.node + 2 * middle as u32, depth };
    root[0] = BinaryNode { bounds, kind: Kind::Inner([left.node, right.node]) };
    let mut build_left = || subtree(left_boxes, left_nodes, left, leaf_size);
    let mut build_right = || subtree(right_boxes, right_nodes, right, leaf_size);
    if n >= PARALLEL {
        rayon::join(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}

/// Reorders the primitives and says how many go to the left; `None` where they fit a leaf.
fn split(boxes: &mut [PrimitiveBox], bounds: &Aabb, depth: u32, leaf_size: usize) -> Option<usize> {
    let n = boxes.len();
    if n <= leaf_size {
        return None;
    }
    let halves = Some(n / 2);
    if depth >= HALVE_FROM {
        return halves;
    }
    let Some(best) = best_split(boxes, bounds, leaf_size) else {
        // All centres in one point (or not even numbers): no plane tells them apart.
        return halves;
    };
    let middle = partition(boxes, |b| best.bins.of(b.center2(), best.axis) < best.bin);
    (0 < middle && middle < n).then_some(middle).or(halves)
}

impl PrimitiveBox {
    /// Twice the centre of the box.
    #[inline]
    fn center2(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

/// Equal bins over the centres.
#[derive(Clone, Copy)]
struct Bins {
    origin: Vec3,
    scale: Vec3,
}

impl Bins {
    fn new(centers: &Aabb) -> Self {
        let extent = centers.extent();
        // Just below BINS, so that the largest centre is in the last bin; an axis without extent has one bin.
        let scale = |e: f32| if e > 0.0 { BINS as f32 * (1.0 - 1e-6) / e } else { 0.0 };
        let scale = Vec3::new(scale(extent.x), scale(extent.y), scale(extent.z));
        Self { origin: centers.min, scale }
    }

    #[inline]
    fn of(&self, center2: Vec3, axis: usize) -> usize {
        // A cast takes NaN to 0 and large numbers to the largest.
        (((center2[axis] - self.origin[axis]) * self.scale[axis]) as usize).min(BINS - 1)
    }
}

struct Split {
    axis: usize,
    /// First bin on the right.
    bin: usize,
    cost: f32,
    bins: Bins,
}

/// The cheapest plane between bins, in units of one step.
fn best_split(boxes: &[PrimitiveBox], bounds: &Aabb, leaf_size: usize) -> Option<Split> {
    let centers = boxes.iter().fold(Aabb::EMPTY, |all, b| all.with_point(b.center2()));
    let bins = Bins::new(&centers);
    let mut counts = [[0_u32; BINS]; 3];
    let mut unions = [[Aabb::EMPTY; BINS]; 3];
    for b in boxes {
        let center2 = b.center2();
        for axis in 0..3 {
            let bin = bins.of(center2, axis);
            counts[axis][bin] += 1;
            unions[axis][bin] = unions[axis][bin].union(b.bounds);
        }
    }
    // cost = 1 + sum over sides of area / area of the node * leaves that its primitives fill: a leaf costs the
    // same however full it is.
    let leaf = |bounds: &Aabb, n: u32| half_area(bounds) * n.div_ceil(leaf_size as u32) as f32;
    let inverse_area = 1.0 / half_area(bounds).max(f32::MIN_POSITIVE);
    let mut best: Option<Split> = None;
    for axis in (0..3).filter(|&axis| bins.scale[axis] > 0.0) {
        // From the right: what each plane leaves there.
        let mut right_cost = [0.0; BINS];
        let (mut union, mut count) = (Aabb::EMPTY, 0);
        for bin in (1..BINS).rev() {
            union = union.union(unions[axis][bin]);
            count += counts[axis][bin];
            right_cost[bin] = if count > 0 { leaf(&union, count) } else { f32::INFINITY };
        }
        let (mut union, mut count) = (Aabb::EMPTY, 0);
        for bin in 1..BINS {
            union = union.union(unions[axis][bin - 1]);
            count += counts[axis][bin - 1];
            if count == 0 {
                continue;
            }
            let cost = 1.0 + (leaf(&union, count) + right_cost[bin]) * inverse_area;
            if cost < best.as_ref().map_or(f32::INFINITY, |b| b.cost) {
                best = Some(Split { axis, bin, cost, bins });
            }
        }
    }
    best
}

/// Half the surface of a box; 0 of an empty one.
#[inline]
pub(super) fn half_area(bounds: &Aabb) -> f32 {
    let e = bounds.extent().max(Vec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// Moves those that `is_left` says to the front; returns how many. The same order every time.
fn partition(boxes: &mut [PrimitiveBox], is_left: impl Fn(&PrimitiveBox) -> bool) -> usize {
    let mut left = 0;
    for i in 0..boxes.len() {
        if is_left(&boxes[i]) {
            boxes.swap(left, i);
            left += 1;
        }
    }
    left
}
