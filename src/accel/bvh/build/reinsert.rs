//! Makes a finished binary tree cheaper: subtrees are taken out and put back where they enlarge boxes least.
//!
//! Source: D. Meister, J. Bittner, "Parallel reinsertion for bounding volume hierarchy optimization", Computer
//! Graphics Forum 37(2), 2018. In each pass, all threads look for better places for the largest nodes; then the moves
//! are made one after the other, those that save most first, so the result is the same for any number of threads.

use super::HALVE_FROM;
use super::node::{BinaryNode, BinaryTree, Kind, Nodes, half_area};
use super::primitive::Bounds;
use crate::geometry::Aabb;
use rayon::prelude::*;

/// How much is moved: in so many passes, of all nodes one in `share`, the largest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reinsertion {
    pub(super) passes: usize,
    pub(super) share: usize,
}

/// Places that are tried for a node at most: where everything overlaps, a search would never end.
const MOST_TRIED: usize = 512;
/// Deeper trees than this are given up: rays have no room for them.
pub(super) const MOST_DEPTH: u32 = HALVE_FROM + 30;
/// Nodes less deep than this are laid out by one thread.
const TOP: u32 = 8;

/// The tree after some passes; as it was if that would be too deep.
pub(super) fn improve(tree: BinaryTree, Reinsertion { passes, share }: Reinsertion) -> BinaryTree {
    // No place is better in a tree of three.
    if passes == 0 || tree.nodes.len() < 4 {
        return tree;
    }
    let mut open = OpenTree::new(tree.nodes.clone());
    // To choose from in each pass: nodes that are much smaller will not be among the largest.
    let all: Vec<u32> = (1..open.nodes.len() as u32).collect();
    let count = all.len().div_ceil(share);
    let some = open.largest(&all, 4 * count);
    for _ in 0..passes {
        let largest = open.largest(&some, count);
        open.pass(&largest);
    }
    let (laid_out, depth) = lay_out(&open.nodes);
    if depth > MOST_DEPTH {
        return tree;
    }
    drop(tree.nodes);
    let (top, subtrees) = laid_out;
    top.join(&subtrees, tree.order)
}

/// A tree whose nodes know their parents. Siblings stay side by side, in any order else.
struct OpenTree {
    nodes: Vec<BinaryNode>,
    /// For each pair of siblings.
    parents: Vec<u32>,
}

/// A node and the one that it is to become the sibling of.
#[derive(Clone, Copy)]
struct Move {
    node: u32,
    to: u32,
    /// By how much all surfaces together shrink.
    saved: f32,
}

/// The pair that a node belongs to, which is not the root.
fn pair(node: u32) -> usize {
    (node as usize - 1) / 2
}

fn sibling(node: u32) -> u32 {
    ((node - 1) ^ 1) + 1
}

impl OpenTree {
    fn new(nodes: Vec<BinaryNode>) -> Self {
        let mut parents = vec![0; nodes.len() / 2];
        for (node, i) in nodes.iter().zip(0..) {
            if let Kind::Inner([left, _]) = node.kind() {
                parents[pair(left)] = i;
            }
        }
        Self { nodes, parents }
    }

    fn bounds(&self, node: u32) -> Aabb {
        self.nodes[node as usize].bounds()
    }

    fn area(&self, node: u32) -> f32 {
        half_area(&self.bounds(node))
    }

    /// The `count` largest of some nodes.
    fn largest(&self, some: &[u32], count: usize) -> Vec<u32> {
        let mut keys: Vec<(f32, u32)> = some.par_iter().map(|&i| (self.area(i), i)).collect();
        if count < keys.len() {
            keys.select_nth_unstable_by(count, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            keys.truncate(count);
        }
        keys.into_iter().map(|(_, node)| node).collect()
    }

    /// Looks for places for some nodes, and moves them.
    fn pass(&mut self, some: &[u32]) {
        let find = |stack: &mut Vec<_>, &node: &u32| self.find_place(node, stack);
        let mut moves: Vec<Move> = some.par_iter().map_init(Vec::new, find).flatten().collect();
        moves.par_sort_unstable_by(|a, b| b.saved.total_cmp(&a.saved).then(a.node.cmp(&b.node)));
        let mut is_touched = vec![false; self.nodes.len()];
        for one in moves {
            self.make(one, &mut is_touched);
        }
    }

    /// The best new sibling for a node, if any saves surface.
    fn find_place(&self, node: u32, stack: &mut Vec<(f32, u32)>) -> Option<Move> {
        let (bounds, area) = (self.bounds(node), self.area(node));
        let mut best = Move { node, to: node, saved: 0.0 };
        let mut tried = 0;
        // From the node's sibling on, up to the root: what is below the sibling of each node on the way.
        let mut above = self.parents[pair(node)];
        let mut beside = sibling(node);
        // The box of the node `above` without this one, and what has been saved on the way. The parent goes away.
        let mut without = self.bounds(beside);
        let mut saved = self.area(above);
        loop {
            stack.clear();
            stack.push((saved, beside));
            while let Some((saved, to)) = stack.pop() {
                // No box around both is smaller than the node.
                if saved - area <= best.saved || tried == MOST_TRIED {
                    continue;
                }
                tried += 1;
                let here = saved - half_area(&self.bounds(to).union(bounds));
                if here > best.saved {
                    (best.to, best.saved) = (to, here);
                }
                if let Kind::Inner([left, right]) = self.nodes[to as usize].kind() {
                    let below = here + self.area(to);
                    stack.extend([(below, right), (below, left)]);
                }
            }
            if above == 0 || tried == MOST_TRIED {
                break;
            }
            beside = sibling(above);
            let next = self.parents[pair(above)];
            if above != self.parents[pair(node)] {
                saved += self.area(above) - half_area(&without);
            }
            without = without.union(self.bounds(beside));
            above = next;
        }
        (best.saved > 0.0).then_some(best)
    }

    /// Moves a node, unless others have been moved from or to its old or its new place.
    fn make(&mut self, Move { node, to, .. }: Move, is_touched: &mut [bool]) {
        let free = pair(node);
        let (parent, beside) = (self.parents[free], sibling(node));
        let involved = [node, beside, parent, to];
        let is_in_vain = to == beside
            || involved.iter().any(|&i| is_touched[i as usize])
            || !self.is_apart(to, node)
            || !self.is_apart(node, to);
        if is_in_vain {
            return;
        }
        for i in involved {
            is_touched[i as usize] = true;
        }
        // The sibling takes the parent's place.
        let taken = self.nodes[node as usize];
        self.put(parent, self.nodes[beside as usize]);
        // The pair becomes what is below the new parent, in the place where its new sibling was.
        let first = 2 * free as u32 + 1;
        self.put(first, self.nodes[to as usize]);
        self.put(first + 1, taken);
        self.nodes[to as usize].set_inner(first);
        self.parents[free] = to;
        self.refit(to);
        if parent != 0 {
            self.refit(self.parents[pair(parent)]);
        }
    }

    /// Whether another node is not on the way from a node up to the root, and that is not too long a way: chains are not
    /// to become ever longer, for each move goes all the way up.
    fn is_apart(&self, mut node: u32, other: u32) -> bool {
        for _ in 0..=MOST_DEPTH {
            if node == other {
                return false;
            }
            if node == 0 {
                return true;
            }
            node = self.parents[pair(node)];
        }
        false
    }

    /// Puts a node with what is below it in some place.
    fn put(&mut self, place: u32, node: BinaryNode) {
        self.nodes[place as usize] = node;
        if let Kind::Inner([left, _]) = node.kind() {
            self.parents[pair(left)] = place;
        }
    }

    /// Makes boxes fit again from an inner node up, as far as any changes.
    fn refit(&mut self, mut node: u32) {
        while let Kind::Inner([left, right]) = self.nodes[node as usize].kind() {
            let (old, new) = (self.bounds(node), self.bounds(left).union(self.bounds(right)));
            if old == new {
                break;
            }
            self.nodes[node as usize].set_bounds(new);
            if node == 0 {
                break;
            }
            node = self.parents[pair(node)];
        }
    }
}

/// The top of a tree, and the subtrees below with their places in it.
type Parts = (Nodes, Vec<(usize, Nodes)>);

/// The same tree with its nodes in the order that is promised, and its depth.
fn lay_out(nodes: &[BinaryNode]) -> (Parts, u32) {
    let top = copy(nodes, 0, TOP);
    let subtree = |&(place, node): &(usize, u32)| (place, copy(nodes, node, u32::MAX));
    let below: Vec<_> = top.below.par_iter().map(subtree).collect();
    let depth = below.iter().map(|(_, copied)| copied.depth).max().unwrap_or(0);
    let below = below.into_iter().map(|(place, copied)| (place, copied.nodes)).collect();
    ((top.nodes, below), top.depth + depth)
}

/// A copy of a subtree.
struct Copied {
    nodes: Nodes,
    depth: u32,
    /// What begins where the copy was broken off: places in the copy, and nodes.
    below: Vec<(usize, u32)>,
}

/// Copies a subtree down to some depth.
fn copy(nodes: &[BinaryNode], root: u32, most_depth: u32) -> Copied {
    let bounds = |node: u32| Bounds::around(&nodes[node as usize].bounds());
    let mut copied = Copied { nodes: Nodes::new(&bounds(root), 1), depth: 0, below: Vec::new() };
    let mut stack = vec![(0, root, 0)];
    while let Some((place, node, depth)) = stack.pop() {
        copied.depth = copied.depth.max(depth);
        match nodes[node as usize].kind() {
            _ if depth == most_depth => copied.below.push((place, node)),
            Kind::Inner([left, right]) => {
                let child = copied.nodes.split(place, &[bounds(left), bounds(right)]);
                stack.extend([(child + 1, right, depth + 1), (child, left, depth + 1)]);
            }
            Kind::Leaf { start, end } => copied.nodes.leaf(place, start, end - start),
        }
    }
    copied
}
