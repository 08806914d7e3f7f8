//! Leaves: up to four triangles, as one array a coordinate. Knows no rays.

use super::node::{LEAF_UNITS, UNIT};
use crate::geometry::{PrimitiveId, TriangleMesh};
use crate::math::Vec3;
use bytemuck::{Pod, Zeroable};

/// Triangles a block, and so the most a leaf can have.
pub(super) const SIZE: usize = 8;

/// Up to four triangles: three cache lines, wherever it begins.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// `corners[vertex][axis]`, a lane a triangle. Absent lanes have the first triangle once more.
    pub(super) corners: [[[f32; SIZE]; 3]; 3],
    /// Number of the triangle among those of all meshes of its hierarchy; in absent lanes with the uppermost bit.
    pub(super) triangles: [u32; SIZE],
}

/// Marks lanes without a triangle.
pub(super) const ABSENT: u32 = 1 << 31;

const _: () = assert!(size_of::<Block>() == LEAF_UNITS * UNIT);

impl Block {
    /// The triangles of those numbers, one to four.
    pub(super) fn new(meshes: &Meshes<'_>, triangles: &[u32]) -> Self {
        let mut block = Self::zeroed();
        for lane in 0..SIZE {
            let triangle = triangles[if lane < triangles.len() { lane } else { 0 }];
            block.triangles[lane] =
                if lane < triangles.len() { triangle } else { triangle | ABSENT };
            for (of_vertex, corner) in block.corners.iter_mut().zip(meshes.vertices(triangle)) {
                for (axis, lanes) in of_vertex.iter_mut().enumerate() {
                    lanes[lane] = corner[axis];
                }
            }
        }
        block
    }

    /// The corners of the triangle in that lane.
    #[inline(always)]
    pub(super) fn vertices(&self, lane: usize) -> [Vec3; 3] {
        self.corners.each_ref().map(|corner| Vec3::from(corner.each_ref().map(|axis| axis[lane])))
    }
}

/// The triangles of some meshes, numbered through.
pub(super) struct Meshes<'a> {
    meshes: &'a [TriangleMesh],
    numbers: Numbers,
}

/// From numbers to meshes and back.
pub(super) struct Numbers {
    /// Number of each mesh's first triangle.
    first: Vec<u32>,
}

impl Numbers {
    /// Of meshes with fewer than 2^32 triangles.
    pub(super) fn new(meshes: &[TriangleMesh]) -> Self {
        let mut next = 0;
        let mut first = Vec::with_capacity(meshes.len());
        for mesh in meshes {
            first.push(next);
            next += mesh.triangles.len() as u32;
        }
        Self { first }
    }

    /// Mesh, and triangle within it.
    #[inline]
    fn locate(&self, triangle: u32) -> (usize, u32) {
        // The last mesh that begins at or before it: empty meshes share their start with the next.
        let mesh = match self.first.len() {
            1 => 0,
            _ => self.first.partition_point(|&first| first <= triangle) - 1,
        };
        (mesh, triangle - self.first[mesh])
    }

    /// The id of a triangle, in an instance or none.
    #[inline]
    pub(super) fn id(&self, triangle: u32, instance: u32) -> PrimitiveId {
        let (mesh, primitive) = self.locate(triangle);
        PrimitiveId { instance, geometry: mesh as u32, primitive }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.first)
    }
}

impl<'a> Meshes<'a> {
    pub(super) fn new(meshes: &'a [TriangleMesh]) -> Self {
        Self { meshes, numbers: Numbers::new(meshes) }
    }

    /// The corners of a triangle.
    #[inline]
    pub(super) fn vertices(&self, triangle: u32) -> [Vec3; 3] {
        let (mesh, primitive) = self.numbers.locate(triangle);
        self.meshes[mesh].vertices(primitive)
    }

    pub(super) fn into_numbers(self) -> Numbers {
        self.numbers
    }
}
