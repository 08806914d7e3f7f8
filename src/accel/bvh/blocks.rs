//! Leaves: triangles by fours, as one array a coordinate. Knows no rays.

use super::binned::{BinaryNode, PrimitiveBox, leaves};
use crate::geometry::{Aabb, PrimitiveId, TriangleMesh};
use crate::math::Vec3;

/// Triangles a block, and so the most a leaf can have.
pub(super) const SIZE: usize = 4;

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// `corners[vertex][axis]`, a lane a triangle. Absent triangles are NaN: no ray is inside them.
    pub(super) corners: [[[f32; SIZE]; 3]; 3],
    /// Number of the triangle among those of all meshes.
    triangles: [u32; SIZE],
}

/// All leaves over some meshes.
pub(super) struct Blocks {
    blocks: Vec<Block>,
    /// Number of each mesh's first triangle.
    first: Vec<u32>,
}

/// Boxes of all triangles that have one; what is not finite is left out.
pub(super) fn boxes(meshes: &[TriangleMesh]) -> Vec<PrimitiveBox> {
    let triangles =
        meshes.iter().flat_map(|mesh| (0..mesh.triangles.len() as u32).map(|i| mesh.vertices(i)));
    let bounds = |corners: [Vec3; 3]| corners.into_iter().fold(Aabb::EMPTY, Aabb::with_point);
    triangles
        .zip(0..)
        .filter(|(corners, _)| corners.iter().all(|p| p.is_finite()))
        .map(|(corners, id)| PrimitiveBox { bounds: bounds(corners), id })
        .collect()
}

impl Blocks {
    /// One block a leaf of `tree`, in the order of their primitives, whose numbers are in `order`.
    pub(super) fn new(meshes: &[TriangleMesh], tree: &[BinaryNode], order: &[u32]) -> Self {
        let mut next = 0;
        let first = meshes
            .iter()
            .map(|mesh| {
                let first = next;
                next += mesh.triangles.len() as u32;
                first
            })
            .collect();
        let leaves = leaves(tree);
        let mut blocks = Self { blocks: Vec::with_capacity(leaves.len()), first };
        for (start, end) in leaves {
            let mut block = Block { corners: [[[f32::NAN; SIZE]; 3]; 3], triangles: [0; SIZE] };
            for (lane, &triangle) in order[start as usize..end as usize].iter().enumerate() {
                let (mesh, primitive) = blocks.locate(triangle);
                let corners = meshes[mesh].vertices(primitive);
                for (of_vertex, corner) in block.corners.iter_mut().zip(corners) {
                    for (axis, lanes) in of_vertex.iter_mut().enumerate() {
                        lanes[lane] = corner[axis];
                    }
                }
                block.triangles[lane] = triangle;
            }
            blocks.blocks.push(block);
        }
        blocks
    }

    /// The block of a leaf.
    #[inline(always)]
    pub(super) fn block(&self, leaf: u32) -> &Block {
        &self.blocks[leaf as usize]
    }

    /// The id of a block's triangle, in an instance or none.
    #[inline(always)]
    pub(super) fn id(&self, block: &Block, lane: usize, instance: u32) -> PrimitiveId {
        let (mesh, primitive) = self.locate(block.triangles[lane]);
        PrimitiveId { instance, geometry: mesh as u32, primitive }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.blocks) + size_of_val(&*self.first)
    }

    /// Mesh, and triangle within it.
    #[inline]
    fn locate(&self, triangle: u32) -> (usize, u32) {
        // The last mesh that begins at or before it: empty meshes share their start with the next.
        let mesh = self.first.partition_point(|&first| first <= triangle) - 1;
        (mesh, triangle - self.first[mesh])
    }
}
