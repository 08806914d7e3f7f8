//! From the binary tree to nodes with eight children.
//!
//! Source: I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray Tracing
//! 2008: of a node's children, the inner one of the largest surface is replaced by its own two, until eight
//! are there.

use super::backend_error;
use super::binned::{BinaryNode, Kind, half_area};
use super::wide::{Child, WIDTH, WideNode};
use crate::error::Result;

/// Deepest tree that a traversal's stack has room for, in wide nodes.
pub(super) const MAX_DEPTH: usize = 80;

/// The wide nodes, root first; none if the tree is empty. Leaf number i of a tree with `leaf_size` above 1 is
/// block i: leaves are numbered in the order of their primitives.
///
/// # Errors
/// When the tree is deeper than [`MAX_DEPTH`], which the builder's own limit on depth rules out.
pub(super) fn collapse(tree: &[BinaryNode], leaf_size: u32) -> Result<Vec<WideNode>> {
    let Some(root) = tree.first() else { return Ok(Vec::new()) };
    let leaf_index = leaf_numbers(tree, leaf_size);
    let mut nodes = vec![WideNode::EMPTY];
    if let Kind::Leaf { start, .. } = root.kind {
        nodes[0].set(0, &root.bounds, Child::leaf(leaf_index(start)));
        return Ok(nodes);
    }
    // (binary node, its wide node, depth): an explicit stack, depth first, so that children lie near parents.
    let mut open = vec![(0_u32, 0_u32, 1_usize)];
    while let Some((binary, wide, depth)) = open.pop() {
        if depth > MAX_DEPTH {
            return Err(backend_error("the hierarchy is too deep"));
        }
        let mut children = Vec::with_capacity(WIDTH);
        children.push(binary);
        while children.len() < WIDTH {
            let area = |&node: &u32| half_area(&tree[node as usize].bounds);
            let largest = (0..children.len())
                .filter(|&i| matches!(tree[children[i] as usize].kind, Kind::Inner(_)))
                .max_by(|&a, &b| area(&children[a]).total_cmp(&area(&children[b])));
            let Some(i) = largest else { break };
            let Kind::Inner([left, right]) = tree[children[i] as usize].kind else { break };
            children[i] = left;
            children.push(right);
        }
        for (place, child) in children.into_iter().enumerate() {
            let BinaryNode { bounds, kind } = &tree[child as usize];
            let reference = match kind {
                Kind::Leaf { start, .. } => Child::leaf(leaf_index(*start)),
                Kind::Inner(_) => {
                    nodes.push(WideNode::EMPTY);
                    let index = nodes.len() as u32 - 1;
                    open.push((child, index, depth + 1));
                    Child::node(index)
                }
            };
            nodes[wide as usize].set(place, bounds, reference);
        }
    }
    Ok(nodes)
}

/// The number of the leaf that starts with a primitive.
fn leaf_numbers(tree: &[BinaryNode], leaf_size: u32) -> impl Fn(u32) -> u32 {
    let mut starts = Vec::new();
    if leaf_size > 1 {
        starts = leaf_starts(tree);
    }
    move |start| match starts.binary_search(&start) {
        Ok(i) => i as u32,
        // Leaves of one primitive are numbered like their primitives.
        Err(_) => start,
    }
}

/// First primitives of all leaves, in order.
pub(super) fn leaf_starts(tree: &[BinaryNode]) -> Vec<u32> {
    let leaves = tree.iter().filter_map(|node| match node.kind {
        Kind::Leaf { start, end } if start < end => Some(start),
        _ => None,
    });
    let mut starts: Vec<u32> = leaves.collect();
    starts.sort_unstable();
    starts
}
