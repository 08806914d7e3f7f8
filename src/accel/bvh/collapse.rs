//! From the binary tree to nodes of eight children: which binary nodes become children of which.
//!
//! Source: I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray Tracing
//! 2008: of a node's children, the inner one of the largest surface is replaced by its own two, until the node
//! is full. Knows nothing of how nodes and leaves are stored.

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
    wide.nodes.push(WideNode::default());
    // (binary node, its wide node, depth, children left behind on the way): an explicit stack, depth first.
    let mut open = vec![(0_u32, 0_usize, 1_usize, 0_usize)];
    while let Some((binary, place, depth, behind)) = open.pop() {
        let mut node = choose(tree, binary);
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

/// The children of the wide node that begins at `root`.
fn choose(tree: &[BinaryNode], root: u32) -> WideNode {
    let mut node = WideNode::default();
    // Candidates with the surface that opening each would save; leaves are not to be opened.
    let surface = |child: u32| match tree[child as usize].kind {
        Kind::Inner(_) => half_area(&tree[child as usize].bounds),
        Kind::Leaf { .. } => -1.0,
    };
    let mut surfaces = [0.0; WIDTH];
    (node.children[0], surfaces[0]) = (root, surface(root));
    let mut count = 1;
    while count < WIDTH {
        let mut largest = 0;
        for i in 1..count {
            if surfaces[i] > surfaces[largest] {
                largest = i;
            }
        }
        let Kind::Inner([left, right]) = tree[node.children[largest] as usize].kind else { break };
        (node.children[largest], surfaces[largest]) = (left, surface(left));
        (node.children[count], surfaces[count]) = (right, surface(right));
        count += 1;
    }
    // Inner ones first; otherwise in the order in which they came.
    node.children[..count].sort_by_key(|&child| is_leaf(tree, child));
    node.count = count as u8;
    let inner = node.children().iter().filter(|&&child| !is_leaf(tree, child)).count();
    node.inner = inner as u8;
    node
}

fn is_leaf(tree: &[BinaryNode], node: u32) -> bool {
    matches!(tree[node as usize].kind, Kind::Leaf { .. })
}
