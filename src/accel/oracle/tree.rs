//! Boxes in a binary tree by halving: nothing to tune, and nothing that input could make slow.
//!
//! Every node halves its boxes at the median of their centres along its longest axis, so a tree over n boxes is
//! log2(n) deep and built in O(n log n), whatever they are; the same whatever the number of threads. It shares no code with `bvh`, which it helps to
//! judge, and knows no rays.

use crate::math::DVec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bounds {
    /// The smallest box around `points`.
    pub(super) fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        let nothing = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        points.into_iter().fold(nothing, |b, p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    /// As much larger on every side.
    pub(super) fn padded(&self, by: DVec3) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }
}

/// The tree; without nodes if there are no boxes.
pub(super) struct BoxTree {
    /// Root first.
    pub(super) nodes: Vec<Node>,
    /// The ids of the boxes, in the order of the leaves.
    pub(super) ids: Vec<u32>,
}

/// A node and what is in it.
pub(super) struct Node {
    pub(super) bounds: Bounds,
    pub(super) content: Content,
}

/// What is in a node.
pub(super) enum Content {
    /// Index of the first child; the second one follows.
    Children(u32),
    /// Range of [`BoxTree::ids`].
    Ids(u32, u32),
}

/// Most boxes of a leaf.
const LEAF: usize = 4;

/// The halves of a node over more boxes than this may be built at once.
const PARALLEL: usize = 16_384;

impl BoxTree {
    /// Over boxes of finite corners, each with its id.
    pub(super) fn new(mut boxes: Vec<(Bounds, u32)>) -> Self {
        let count = if boxes.is_empty() { 0 } else { 1 + nodes_below(boxes.len()) };
        let mut nodes: Vec<_> = std::iter::repeat_with(unfinished).take(count).collect();
        if let Some((root, below)) = nodes.split_first_mut() {
            fill(root, Part { boxes: &mut boxes, first_box: 0, below, first_below: 1 });
        }
        Self { nodes, ids: boxes.iter().map(|&(_, id)| id).collect() }
    }
}

/// Nodes below the one that holds so many boxes: halving leaves no choice.
fn nodes_below(boxes: usize) -> usize {
    let half = boxes / 2;
    if boxes <= LEAF { 0 } else { 2 + nodes_below(half) + nodes_below(boxes - half) }
}

/// What a node is made from.
struct Part<'a> {
    boxes: &'a mut [(Bounds, u32)],
    /// Place of the first one among all boxes.
    first_box: usize,
    /// The nodes below it, yet to be filled: its children, all below the first one, all below the second.
    below: &'a mut [Node],
    /// Place of the first one among all nodes.
    first_below: usize,
}

/// Makes a node and all below it.
fn fill(node: &mut Node, part: Part<'_>) {
    let Part { boxes, first_box, below, first_below } = part;
    let bounds = Bounds::around(boxes.iter().flat_map(|(b, _)| [b.low, b.high]));
    let ([left, right, below @ ..], false) = (below, boxes.len() <= LEAF) else {
        let content = Content::Ids(first_box as u32, (first_box + boxes.len()) as u32);
        *node = Node { bounds, content };
        return;
    };
    *node = Node { bounds, content: Content::Children(first_below as u32) };
    let centers = Bounds::around(boxes.iter().map(|(b, _)| center(b)));
    let axis = longest_axis(&centers);
    let (all, half) = (boxes.len(), boxes.len() / 2);
    boxes
        .select_nth_unstable_by(half, |(p, _), (q, _)| center(p)[axis].total_cmp(&center(q)[axis]));
    let (lower, upper) = boxes.split_at_mut(half);
    let below_left = nodes_below(half);
    let (first, second) = below.split_at_mut(below_left);
    let first_below = first_below + 2;
    let lower = Part { boxes: lower, first_box, below: first, first_below };
    let upper = Part {
        boxes: upper,
        first_box: first_box + half,
        below: second,
        first_below: first_below + below_left,
    };
    if all > PARALLEL {
        rayon::join(|| fill(left, lower), || fill(right, upper));
    } else {
        fill(left, lower);
        fill(right, upper);
    }
}

fn unfinished() -> Node {
    Node { bounds: Bounds::around([]), content: Content::Ids(0, 0) }
}

fn center(bounds: &Bounds) -> DVec3 {
    (bounds.low + bounds.high) * 0.5
}

fn longest_axis(bounds: &Bounds) -> usize {
    let extent = bounds.high - bounds.low;
    (0..3).max_by(|&i, &j| extent[i].total_cmp(&extent[j])).unwrap_or(0)
}
