//! The binary tree: its nodes, and how they are put down.

use super::primitive::Bounds;
use crate::geometry::Aabb;
use crate::math::Vec3;
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use std::ops::Range;

/// A binary tree over primitives.
#[derive(Debug, Default)]
pub(in super::super) struct BinaryTree {
    /// Root first; none without primitives. Children come after their parents, two siblings side by side, the
    /// left one in an odd place.
    pub(in super::super) nodes: Vec<BinaryNode>,
    /// Numbers of the primitives; leaves are ranges of them.
    pub(in super::super) order: Vec<u32>,
    /// Subtrees by their roots, with the places of all that is below; together they are all leaves. In each, the
    /// descendants of a node follow its children, those of the left child first.
    pub(in super::super) parts: Vec<(u32, Range<usize>)>,
}

/// A node of the binary tree: its box, and what is below.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(in super::super) struct BinaryNode {
    min: Vec3,
    /// The left child; or a leaf's first primitive.
    first: u32,
    max: Vec3,
    /// Primitives of a leaf; 0 of an inner node.
    count: u32,
}

/// What is below a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Kind {
    /// Places of the two children.
    Inner([u32; 2]),
    /// Range of the primitives, in the builder's order.
    Leaf { start: u32, end: u32 },
}

impl BinaryNode {
    /// With nothing below yet.
    #[inline(always)]
    fn new(bounds: &Bounds) -> Self {
        let Aabb { min, max } = bounds.aabb();
        Self { min, first: 0, max, count: 0 }
    }

    /// Its box.
    #[inline(always)]
    pub(in super::super) fn bounds(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }

    /// What is below it.
    #[inline(always)]
    pub(in super::super) fn kind(&self) -> Kind {
        if self.count == 0 {
            Kind::Inner([self.first, self.first + 1])
        } else {
            Kind::Leaf { start: self.first, end: self.first + self.count }
        }
    }

    /// Gives it another box.
    #[inline(always)]
    pub(super) fn set_bounds(&mut self, bounds: Aabb) {
        (self.min, self.max) = (bounds.min, bounds.max);
    }

    /// Makes it an inner node.
    #[inline(always)]
    pub(super) fn set_inner(&mut self, left: u32) {
        (self.first, self.count) = (left, 0);
    }

    /// The same with its children `by` places further.
    #[inline(always)]
    fn moved(self, by: u32) -> Self {
        Self { first: self.first + if self.count == 0 { by } else { 0 }, ..self }
    }
}

/// A tree that grows downward from its root.
pub(super) struct Nodes(Vec<BinaryNode>);

impl Nodes {
    /// The root alone.
    pub(super) fn new(root: &Bounds, capacity: usize) -> Self {
        let mut nodes = Vec::with_capacity(capacity);
        nodes.push(BinaryNode::new(root));
        Self(nodes)
    }

    /// Gives a node two children; returns the place of the left one, to which the right one is the next.
    #[inline(always)]
    pub(super) fn split(&mut self, node: usize, children: &[Bounds; 2]) -> usize {
        let left = self.0.len();
        self.0[node].first = left as u32;
        self.0.extend_from_slice(&[BinaryNode::new(&children[0]), BinaryNode::new(&children[1])]);
        left
    }

    /// Makes a node a leaf.
    #[inline(always)]
    pub(super) fn leaf(&mut self, node: usize, first: u32, count: u32) {
        (self.0[node].first, self.0[node].count) = (first, count);
    }

    /// This tree with others in the places of its leaves, in one piece.
    pub(super) fn join(self, subtrees: &[(usize, Self)], order: Vec<u32>) -> BinaryTree {
        // The root of a subtree takes its place in this tree; the rest follows behind.
        let rest = |nodes: &Self| nodes.0.len() - 1;
        let mut end = self.0.len();
        let mut parts = Vec::with_capacity(subtrees.len());
        for (root, nodes) in subtrees {
            parts.push((*root as u32, end..end + rest(nodes)));
            end += rest(nodes);
        }
        let mut nodes: Vec<BinaryNode> = bytemuck::zeroed_vec(end);
        let (top, mut below) = nodes.split_at_mut(self.0.len());
        top.copy_from_slice(&self.0);
        let mut jobs = Vec::with_capacity(subtrees.len());
        for ((root, range), (_, subtree)) in parts.iter().zip(subtrees) {
            let by = range.start as u32 - 1;
            top[*root as usize] = subtree.0[0].moved(by);
            let (places, behind) = below.split_at_mut(range.len());
            below = behind;
            jobs.push((places, &subtree.0[1..], by));
        }
        jobs.into_par_iter().for_each(|(places, nodes, by)| {
            for (place, node) in places.iter_mut().zip(nodes) {
                *place = node.moved(by);
            }
        });
        BinaryTree { nodes, order, parts }
    }
}

/// Half the surface of a box; 0 of an empty one.
#[inline]
pub(in super::super) fn half_area(bounds: &Aabb) -> f32 {
    let e = bounds.extent().max(Vec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}
