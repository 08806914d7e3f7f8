//! From the binary tree to nodes of sixteen children: which binary nodes become children of which.
//!
//! Source: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
//! HPG 2017, section 3.1: of all ways to leave out inner nodes, the one with the least cost by the surface area
//! heuristic, by dynamic programming from the leaves up. Knows nothing of how nodes and leaves are stored.

use super::binned::{BinaryNode, Kind, half_area};
use super::node::WIDTH;

/// A tree of wide nodes, root first.
#[derive(Debug, Default)]
pub(super) struct WideTree {
    pub(super) nodes: Vec<WideNode>,
    /// Number of leaves.
    pub(super) leaves: usize,
    /// Longest way from the root to a node, in nodes.
    pub(super) depth: usize,
    /// The most children that a depth-first walk leaves for later.
    pub(super) pending: usize,
}

/// The children of a wide node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WideNode {
    /// Nodes of the binary tree; those that stay inner first.
    children: [u32; WIDTH],
    count: u8,
    inner: u8,
    /// Number of the first inner child among the wide nodes; the others follow.
    first: u32,
    /// Leaves of all wide nodes before this one.
    pub(super) leaves_before: u32,
}

impl WideNode {
    /// Nodes of the binary tree; those that stay inner first.
    pub(super) fn children(&self) -> &[u32] {
        &self.children[..usize::from(self.count)]
    }

    /// How many of the children are leaves.
    pub(super) fn leaves(&self) -> u8 {
        self.count - self.inner
    }

    /// The wide nodes among the children, in their order.
    pub(super) fn inner(&self) -> std::ops::Range<usize> {
        self.first as usize..self.first as usize + usize::from(self.inner)
    }
}

/// The wide tree over a binary one.
pub(super) fn collapse(tree: &[BinaryNode]) -> WideTree {
    let mut wide = WideTree::default();
    if tree.is_empty() {
        return wide;
    }
    let splits = best_splits(tree);
    wide.nodes.push(WideNode::default());
    // (binary node, its wide node, depth, children left behind on the way): an explicit stack, depth first.
    let mut open = vec![(0_u32, 0_usize, 1_usize, 0_usize)];
    while let Some((binary, place, depth, behind)) = open.pop() {
        let mut node = children(tree, &splits, binary);
        node.first = wide.nodes.len() as u32;
        wide.nodes[place] = node;
        wide.nodes.resize(node.inner().end, WideNode::default());
        wide.depth = wide.depth.max(depth);
        let behind = behind + usize::from(node.count) - 1;
        wide.pending = wide.pending.max(behind + 1);
        for (&child, place) in node.children().iter().zip(node.inner()) {
            open.push((child, place, depth + 1, behind));
        }
    }
    let mut leaves = 0;
    for node in &mut wide.nodes {
        node.leaves_before = leaves;
        leaves += u32::from(node.leaves());
    }
    wide.leaves = leaves as usize;
    wide
}

/// For an inner node: `[0]` is how many of a wide node's children its left part gets, if it becomes one;
/// `[i - 1]` how many of i children, if it is left out and has i to itself, or 0 if it is better not left out.
type Splits = [u8; WIDTH];

/// Cost of a step through a wide node, and of one through a leaf, for each unit of surface.
const STEP_COST: f32 = 1.0;
const LEAF_COST: f32 = 1.0;

/// The splits of the least cost.
fn best_splits(tree: &[BinaryNode]) -> Vec<Splits> {
    let mut splits = vec![[0; WIDTH]; tree.len()];
    // Costs of subtrees whose parents are to come: `[i]` with at most i children for them.
    let mut costs: Vec<[f32; WIDTH + 1]> = Vec::new();
    // Children come after their parents, left before right: from the back, everything is ready in time.
    for (node, splits) in tree.iter().zip(&mut splits).rev() {
        let area = half_area(&node.bounds);
        match node.kind {
            Kind::Leaf { start, end } if start == end => {}
            Kind::Leaf { .. } => costs.push([area * LEAF_COST; WIDTH + 1]),
            Kind::Inner(_) => {
                let (Some(left), Some(right)) = (costs.pop(), costs.pop()) else { continue };
                let mut shared = [f32::INFINITY; WIDTH + 1];
                let mut of_left = [0; WIDTH + 1];
                for l in 1..WIDTH {
                    for r in 1..=WIDTH - l {
                        let cost = left[l] + right[r];
                        if cost < shared[l + r] {
                            (shared[l + r], of_left[l + r]) = (cost, l as u8);
                        }
                    }
                }
                let alone = area * STEP_COST + shared[WIDTH];
                splits[0] = of_left[WIDTH];
                let mut cost = [alone; WIDTH + 1];
                for i in 2..=WIDTH {
                    if shared[i] < alone {
                        (cost[i], splits[i - 1]) = (shared[i], of_left[i]);
                    }
                }
                costs.push(cost);
            }
        }
    }
    splits
}

/// The children of the wide node that begins at `root`.
fn children(tree: &[BinaryNode], splits: &[Splits], root: u32) -> WideNode {
    let (mut inner, mut leaves) = (Vec::with_capacity(WIDTH), Vec::with_capacity(WIDTH));
    // Nodes that may be left out, with how many children their left part would get then; leftmost last.
    let mut open = Vec::with_capacity(WIDTH);
    open.push((root, WIDTH, splits[root as usize][0]));
    while let Some((node, count, of_left)) = open.pop() {
        match tree[node as usize].kind {
            Kind::Leaf { .. } => leaves.push(node),
            Kind::Inner(_) if of_left == 0 => inner.push(node),
            Kind::Inner([left, right]) => {
                let left_count = usize::from(of_left);
                for (node, count) in [(right, count - left_count), (left, left_count)] {
                    let of_left = if count > 1 { splits[node as usize][count - 1] } else { 0 };
                    open.push((node, count, of_left));
                }
            }
        }
    }
    let mut node = WideNode { inner: inner.len() as u8, ..WideNode::default() };
    node.count = node.inner + leaves.len() as u8;
    for (place, child) in node.children.iter_mut().zip(inner.into_iter().chain(leaves)) {
        *place = child;
    }
    node
}
