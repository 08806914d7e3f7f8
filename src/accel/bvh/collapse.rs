//! From the binary tree to nodes with eight children.
//!
//! Source: I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray Tracing
//! 2008: of a node's children, the inner one of the largest surface is replaced by its own two, until eight
//! are there.

use super::backend_error;
use super::binned::{BinaryNode, Kind, half_area, leaves};
use super::wide::{Child, WIDTH, WideNode};
use crate::error::Result;

/// Deepest tree that a traversal's stack has room for, in wide nodes.
pub(super) const MAX_DEPTH: usize = 80;

/// The wide nodes, root first; none if the tree is empty. Leaves go by their numbers in [`leaves`].
///
/// # Errors
/// When the tree is deeper than [`MAX_DEPTH`], which the builder's own limit on depth rules out.
pub(super) fn collapse(tree: &[BinaryNode]) -> Result<Vec<WideNode>> {
    let Some(root) = tree.first() else { return Ok(Vec::new()) };
    let leaves = leaves(tree);
    let leaf_index = |start: u32| leaves.partition_point(|leaf| leaf.0 < start) as u32;
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
