//! Which nodes of the binary tree become the children of a wide one: the choice of the least cost.
//!
//! Source: H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on GPUs through compressed wide
//! BVHs", High Performance Graphics 2017, section 3.1. From the leaves up, each node learns what it costs to make
//! all that is below it at most 1, 2, ... children of some wide node; only the choices are kept. A wide node
//! costs its surface; what leaves cost is the same whatever is chosen. Knows nothing of how wide nodes are stored.

use super::build::{BinaryNode, BinaryTree, Kind, half_area};
use super::node::WIDTH;
use rayon::prelude::*;

const _: () = assert!(2 <= WIDTH && WIDTH <= 16, "a choice has four bits");

/// The choices for a binary tree.
pub(super) struct Cuts {
    /// For each pair of siblings, at half the place of the left one: four bits for each number of children that
    /// their parent may become, from 1: how many of them the left one is, or 0 where one is best. The last four
    /// bits are for a parent that is a wide node.
    choices: Vec<u64>,
}

/// What it costs to make all that is below a node at most 1, 2, ... children.
#[derive(Clone, Copy)]
struct Costs([f32; WIDTH]);

impl Costs {
    /// A leaf is one child.
    const LEAF: Self = Self([0.0; WIDTH]);
}

impl Cuts {
    /// The cheapest choices.
    pub(super) fn new(tree: &BinaryTree) -> Self {
        let BinaryTree { nodes, parts, .. } = tree;
        let mut choices = vec![0; nodes.len() / 2];
        let Some(root) = nodes.first() else { return Self { choices } };
        let whole = half_area(&root.bounds());
        // Each part by itself, then what is above them.
        let top = parts.first().map_or(nodes.len(), |(_, range)| range.start);
        let (of_top, mut behind) = choices.split_at_mut(top / 2);
        let mut jobs = Vec::with_capacity(parts.len());
        for (_, range) in parts {
            let (own, rest) = behind.split_at_mut(range.len() / 2);
            behind = rest;
            jobs.push((&nodes[range.clone()], own));
        }
        let solve = |(nodes, choices): (_, _)| solve(nodes, choices, whole);
        let costs: Vec<Costs> = jobs.into_par_iter().map(solve).collect();
        let mut of_roots = vec![Costs::LEAF; top];
        for ((root, _), costs) in parts.iter().zip(costs) {
            of_roots[*root as usize] = costs;
        }
        let mut of_pairs = vec![Costs::LEAF; top / 2];
        for pair in (0..top / 2).rev() {
            let siblings = &nodes[2 * pair + 1..][..2];
            let costs = [0, 1].map(|side| match siblings[side].kind() {
                Kind::Inner([left, _]) if (left as usize) < top => of_pairs[left as usize / 2],
                _ => of_roots[2 * pair + 1 + side],
            });
            (of_pairs[pair], of_top[pair]) = join(&costs, area(siblings, whole));
        }
        Self { choices }
    }

    /// The children of the wide node that begins at `root`, and how many they are.
    pub(super) fn children(&self, nodes: &[BinaryNode], root: u32) -> ([u32; WIDTH], usize) {
        let mut children = [root; WIDTH];
        let mut count = 0;
        // Nodes with the number of children that they may become, the next one last.
        let mut open = [(root, WIDTH); WIDTH];
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let (node, most) = open[len];
            let choice = |left: u32| self.choices[left as usize / 2] >> (4 * (most - 1)) & 0b1111;
            match nodes[node as usize].kind() {
                Kind::Inner([left, right]) if most > 1 && choice(left) > 0 => {
                    let on_left = choice(left) as usize;
                    (open[len], open[len + 1]) = ((right, most - on_left), (left, on_left));
                    len += 2;
                }
                _ => {
                    children[count] = node;
                    count += 1;
                }
            }
        }
        (children, count)
    }
}

/// Finds the choices for a part, whose nodes are these; what its root costs.
fn solve(nodes: &[BinaryNode], choices: &mut [u64], whole: f32) -> Costs {
    // Backward, parents come after their children: those of the right child, then those of the left one. So
    // what inner nodes cost is found on a stack.
    let mut stack = Vec::with_capacity(64);
    for (siblings, choice) in nodes.chunks_exact(2).zip(choices).rev() {
        let costs = [0, 1].map(|side| match siblings[side].kind() {
            Kind::Inner(_) => stack.pop().unwrap_or(Costs::LEAF),
            Kind::Leaf { .. } => Costs::LEAF,
        });
        let (costs, of_pair) = join(&costs, area(siblings, whole));
        stack.push(costs);
        *choice = of_pair;
    }
    stack.pop().unwrap_or(Costs::LEAF)
}

/// The surface of the parent of two siblings against that of all; finite whatever they are.
fn area(siblings: &[BinaryNode], whole: f32) -> f32 {
    let parent = siblings.iter().map(BinaryNode::bounds).reduce(|a, b| a.union(b));
    let area = parent.map_or(0.0, |parent| half_area(&parent)) / whole;
    if area <= 1.0 { area } else { 1.0 }
}

/// What the parent of two siblings costs, and the choices.
#[inline(always)]
fn join([left, right]: &[Costs; 2], area: f32) -> (Costs, u64) {
    const TAG: u32 = 0b1111;
    // Far more than anything costs. Padded in front, so that each step below has the same number of lanes.
    const NEVER: f32 = 1e30;
    let mut padded = [NEVER; 2 * WIDTH];
    padded[WIDTH..].copy_from_slice(&right.0);
    // least[j]: as j + 1 children, the number on the left in the lowest bits of the cost.
    let mut least = [NEVER; WIDTH];
    for on_left in 1..WIDTH {
        let cost_left = left.0[on_left - 1];
        for (least, cost_right) in least.iter_mut().zip(&padded[WIDTH - on_left..]) {
            let cost = cost_left + cost_right;
            let tagged = f32::from_bits(cost.to_bits() & !TAG | on_left as u32);
            *least = if tagged < *least { tagged } else { *least };
        }
    }
    let as_one = area + least[WIDTH - 1];
    let mut costs = Costs([as_one; WIDTH]);
    let mut choices = 0;
    for (j, (cost, least)) in costs.0.iter_mut().zip(least).enumerate().skip(1) {
        let is_open = least < as_one || j == WIDTH - 1;
        let tag = if is_open { least.to_bits() & TAG } else { 0 };
        choices |= u64::from(tag) << (4 * j);
        *cost = if least < as_one { least } else { as_one };
    }
    (costs, choices)
}
