//! From the binary tree to nodes of many children, by all threads.
//!
//! Which binary nodes become children of which is what `cut` has chosen. Knows nothing of how nodes and leaves are
//! stored.

use super::build::{BinaryNode, BinaryTree, Kind, half_area};
use super::cut::Cuts;
use super::node::WIDTH;
use crate::accel::TreeShape;
use rayon::prelude::*;

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

impl WideTree {
    /// What it is made of; `nodes` are those of the binary tree.
    pub(super) fn shape(&self, nodes: &[BinaryNode]) -> TreeShape {
        let area = |&child: &u32| f64::from(half_area(&nodes[child as usize].bounds()));
        let of_children =
            |part: &[WideNode]| part.iter().flat_map(WideNode::children).map(area).sum::<f64>();
        // Summed in one order, whatever thread does what.
        let parts: Vec<_> = self.nodes.par_chunks(4096).map(of_children).collect();
        let whole = nodes.first().map_or(0.0, |root| f64::from(half_area(&root.bounds())));
        TreeShape {
            nodes: self.nodes.len(),
            leaves: self.leaves,
            depth: self.depth,
            sah_cost: (whole + parts.iter().sum::<f64>()) / whole.max(f64::MIN_POSITIVE),
        }
    }

    /// The ranges of primitives of all leaves, in the order of the nodes.
    pub(super) fn leaf_ranges(&self, nodes: &[BinaryNode]) -> impl Iterator<Item = (u32, u32)> {
        self.nodes.iter().flat_map(|node| node.leaf_ranges(nodes))
    }
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

    /// The ranges of primitives of the leaves among the children, in their order.
    pub(super) fn leaf_ranges(&self, nodes: &[BinaryNode]) -> impl Iterator<Item = (u32, u32)> {
        let leaves = self.children()[usize::from(self.inner)..].iter();
        leaves.filter_map(|&child| match nodes[child as usize].kind() {
            Kind::Leaf { start, end } => Some((start, end)),
            Kind::Inner(_) => None,
        })
    }

    /// The wide nodes among the children, in their order.
    pub(super) fn inner(&self) -> std::ops::Range<usize> {
        self.first as usize..self.first as usize + usize::from(self.inner)
    }

    /// The wide node that begins at a binary one; its inner children have no number yet.
    fn new(nodes: &[BinaryNode], cuts: &Cuts, binary: u32) -> Self {
        let (chosen, count) = cuts.children(nodes, binary);
        let is_inner = |child: &&u32| matches!(nodes[**child as usize].kind(), Kind::Inner(_));
        let chosen = &chosen[..count];
        let mut node = Self { count: count as u8, ..Self::default() };
        let (inner, leaves) =
            (chosen.iter().filter(is_inner), chosen.iter().filter(|c| !is_inner(c)));
        for (place, child) in node.children.iter_mut().zip(inner.clone().chain(leaves)) {
            *place = *child;
        }
        node.inner = inner.count() as u8;
        node
    }
}

/// A wide node that is still to be made.
#[derive(Clone, Copy)]
struct Open {
    binary: u32,
    /// Its number.
    place: usize,
    depth: usize,
    /// Children left behind on the way from the root.
    behind: usize,
}

/// The wide tree over a binary one.
pub(super) fn collapse(tree: &BinaryTree) -> WideTree {
    if tree.nodes.is_empty() {
        return WideTree::default();
    }
    let cuts = Cuts::new(tree);
    // The top first; then what begins in the parts of the binary tree, by all threads.
    let top = tree.parts.first().map_or(0, |(_, range)| range.start);
    let mut is_root = vec![false; top];
    for (root, _) in &tree.parts {
        is_root[*root as usize] = true;
    }
    let is_elsewhere = |binary: u32| is_root.get(binary as usize).is_none_or(|is_root| *is_root);
    let root = Open { binary: 0, place: 0, depth: 1, behind: 0 };
    let (mut wide, elsewhere) = grow(&tree.nodes, &cuts, root, is_elsewhere);
    let subtree = |open: &Open| grow(&tree.nodes, &cuts, Open { place: 0, ..*open }, |_| false).0;
    let subtrees: Vec<WideTree> = elsewhere.par_iter().map(subtree).collect();
    for (open, mut subtree) in elsewhere.into_iter().zip(subtrees) {
        // The root takes the place that is kept for it; the rest goes behind.
        let by = wide.nodes.len() as u32 - 1;
        subtree.nodes.iter_mut().for_each(|node| node.first += by);
        wide.nodes[open.place] = subtree.nodes[0];
        wide.nodes.extend_from_slice(&subtree.nodes[1..]);
        wide.depth = wide.depth.max(subtree.depth);
        wide.pending = wide.pending.max(subtree.pending);
    }
    let mut leaves = 0;
    for node in &mut wide.nodes {
        node.leaves_before = leaves;
        leaves += u32::from(node.leaves());
    }
    wide.leaves = leaves as usize;
    wide
}

/// The tree below an open node, without what is elsewhere: that comes back open, its place is kept. The numbers
/// of leaves are not there yet.
fn grow(
    nodes: &[BinaryNode],
    cuts: &Cuts,
    root: Open,
    is_elsewhere: impl Fn(u32) -> bool,
) -> (WideTree, Vec<Open>) {
    let mut wide = WideTree { nodes: vec![WideNode::default()], ..WideTree::default() };
    let mut elsewhere = Vec::new();
    // An explicit stack, depth first.
    let mut stack = vec![root];
    while let Some(open) = stack.pop() {
        if is_elsewhere(open.binary) {
            elsewhere.push(open);
            continue;
        }
        let mut node = WideNode::new(nodes, cuts, open.binary);
        node.first = wide.nodes.len() as u32;
        wide.nodes[open.place] = node;
        wide.nodes.resize(node.inner().end, WideNode::default());
        wide.depth = wide.depth.max(open.depth);
        let behind = open.behind + usize::from(node.count) - 1;
        wide.pending = wide.pending.max(behind + 1);
        for (&binary, place) in node.children().iter().zip(node.inner()) {
            stack.push(Open { binary, place, depth: open.depth + 1, behind });
        }
    }
    (wide, elsewhere)
}
