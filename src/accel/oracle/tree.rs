//! Boxes in a binary tree by halving: nothing to tune, and nothing that input could make slow.
//!
//! Every node halves its boxes at the median of their centres along its longest axis, so a tree over n boxes is
//! log2(n) deep and built in O(n log n), whatever they are. It shares no code with `bvh`, which it helps to
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

impl BoxTree {
    /// Over boxes of finite corners, each with its id.
    pub(super) fn new(mut boxes: Vec<(Bounds, u32)>) -> Self {
        let mut nodes = Vec::new();
        // Ranges of boxes, each with its place among the nodes.
        let mut open = Vec::new();
        if !boxes.is_empty() {
            nodes.push(unfinished());
            open.push((0, 0..boxes.len()));
        }
        while let Some((place, range)) = open.pop() {
            let inside = &mut boxes[range.clone()];
            let bounds = Bounds::around(inside.iter().flat_map(|(b, _)| [b.low, b.high]));
            if inside.len() <= LEAF {
                let content = Content::Ids(range.start as u32, range.end as u32);
                nodes[place] = Node { bounds, content };
                continue;
            }
            let centers = Bounds::around(inside.iter().map(|(b, _)| center(b)));
            let axis = longest_axis(&centers);
            let half = inside.len() / 2;
            inside.select_nth_unstable_by(half, |(p, _), (q, _)| {
                center(p)[axis].total_cmp(&center(q)[axis])
            });
            let first = nodes.len();
            nodes[place] = Node { bounds, content: Content::Children(first as u32) };
            nodes.extend([unfinished(), unfinished()]);
            let middle = range.start + half;
            open.push((first, range.start..middle));
            open.push((first + 1, middle..range.end));
        }
        Self { nodes, ids: boxes.iter().map(|&(_, id)| id).collect() }
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
