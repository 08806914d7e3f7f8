//! Leaves that are gathered from the meshes whenever a ray visits them: half the memory of leaves that are kept, where
//! memory matters more than speed.
//!
//! What vertices the triangles share has been found out when the tree was built, so that gathering takes no branch.

use super::block::{Block, Meshes, SIZE, VERTICES};
use bytemuck::{Pod, Zeroable};

/// How to gather a leaf, in a cache line.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Recipe {
    /// Numbers of its triangles in their tree. Absent ones have that of the first.
    pub(super) triangles: [u32; SIZE],
    /// The numbers of their vertices, as in the block.
    corners: [i16; SIZE],
    /// Of which triangle's corners each vertex is the first: the triangle's lane times four, and the corner.
    firsts: [u8; VERTICES],
    unused: [u8; 7],
}

const _: () = assert!(size_of::<Recipe>() == 64);

impl Recipe {
    /// For the triangles of those numbers.
    ///
    /// # Panics
    /// If they are none, or do not fit into a block.
    pub(super) fn new(meshes: &Meshes<'_>, triangles: &[u32]) -> Self {
        let block = Block::new(meshes, triangles, 0);
        let mut recipe = Self { corners: block.corners, ..Self::zeroed() };
        recipe.triangles.fill(triangles[0]);
        recipe.triangles[..triangles.len()].copy_from_slice(triangles);
        // From the last to the first, which stays.
        for lane in (0..triangles.len()).rev() {
            for (corner, number) in block.numbers(lane).into_iter().enumerate().rev() {
                recipe.firsts[number] = (4 * lane + corner) as u8;
            }
        }
        recipe
    }

    /// The leaf.
    #[inline(always)]
    pub(super) fn gather(&self, meshes: &Meshes<'_>) -> Block {
        let mut block = Block::zeroed();
        block.corners = self.corners;
        for (vertex, first) in self.firsts.into_iter().enumerate() {
            let triangle = self.triangles[usize::from(first / 4) % SIZE];
            block.put(vertex, meshes.vertex(triangle, usize::from(first % 4)));
        }
        block
    }

    /// Asks the memory for the triangles' vertex numbers.
    #[inline(always)]
    pub(super) fn fetch_numbers(&self, meshes: &Meshes<'_>) {
        self.triangles.iter().for_each(|&triangle| meshes.fetch_numbers(triangle));
    }

    /// Asks the memory for the vertices, whose numbers have arrived.
    #[inline(always)]
    pub(super) fn fetch_vertices(&self, meshes: &Meshes<'_>) {
        for first in self.firsts {
            let triangle = self.triangles[usize::from(first / 4) % SIZE];
            meshes.fetch_vertex(triangle, usize::from(first % 4));
        }
    }
}
