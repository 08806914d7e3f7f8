//! Leaves: up to eight triangles over up to nine vertices, which neighbours share, in two cache lines. Knows no rays.
//!
//! A patch of two by two quadrilaterals is a full leaf; triangles that share nothing fill it in threes.

use super::node::UNIT;
use crate::geometry::{PrimitiveId, TriangleMesh};
use crate::math::Vec3;
use crate::os::prefetch;
use bytemuck::{Pod, Zeroable};

/// Triangles a block, and so the most a leaf can have.
pub(super) const SIZE: usize = 8;

/// Vertices a block.
pub(super) const VERTICES: usize = 9;

/// A leaf.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(128))]
pub(super) struct Block {
    /// Eight vertices along x, along y and along z, then the ninth: no vector of eight crosses a cache line. Any numbers
    /// where there is none.
    positions: [f32; 3 * VERTICES],
    /// For each triangle the numbers of its three vertices, four bits each, the first one lowest. Absent ones have those of
    /// the first triangle, and the sign.
    pub(super) corners: [i16; SIZE],
    /// Where the number of the first triangle is kept; those of the others follow.
    pub(super) first: u32,
}

const _: () = assert!(size_of::<Block>() == UNIT);

impl Block {
    /// The triangles of those numbers, which are kept from place `first` on.
    ///
    /// # Panics
    /// If they are none, or do not fit.
    pub(super) fn new(meshes: &Meshes<'_>, triangles: &[u32], first: u32) -> Self {
        let mut block = Self { first, ..Self::zeroed() };
        let mut known = [[0; 3]; VERTICES];
        let mut count = 0;
        let mut all = [0; SIZE];
        for (corners, &triangle) in all.iter_mut().zip(triangles) {
            for (shift, corner) in [0, 4, 8].into_iter().zip(meshes.vertices(triangle)) {
                // The same vertex has the same bits.
                let bits = corner.to_array().map(f32::to_bits);
                let number = known[..count].iter().position(|k| *k == bits).unwrap_or(count);
                if number == count {
                    known[count] = bits;
                    count += 1;
                    block.put(number, corner);
                }
                *corners |= (number << shift) as i16;
            }
        }
        let absent = all[0] | i16::MIN;
        all[triangles.len()..].fill(absent);
        Self { corners: all, ..block }
    }

    /// Makes it the vertex of that number.
    #[inline(always)]
    pub(super) fn put(&mut self, vertex: usize, position: Vec3) {
        for axis in 0..3 {
            self.positions[place(axis, vertex)] = position[axis];
        }
    }

    /// Whether there is a triangle in that lane.
    #[inline(always)]
    pub(super) fn has(&self, lane: usize) -> bool {
        self.corners[lane] >= 0
    }

    /// The numbers of the vertices of the triangle in that lane.
    #[inline(always)]
    pub(super) fn numbers(&self, lane: usize) -> [usize; 3] {
        let corners = self.corners[lane] as usize;
        [corners & 15, corners >> 4 & 15, corners >> 8 & 15]
    }

    /// The corners of the triangle in that lane.
    #[inline(always)]
    pub(super) fn vertices(&self, lane: usize) -> [Vec3; 3] {
        self.numbers(lane).map(|vertex| Vec3::from([0, 1, 2].map(|axis| self.along(axis, vertex))))
    }

    /// A vertex along an axis.
    #[inline(always)]
    pub(super) fn along(&self, axis: usize, vertex: usize) -> f32 {
        self.positions[place(axis, vertex)]
    }

    /// The first eight vertices along an axis, and the ninth.
    #[inline(always)]
    pub(super) fn nine(&self, axis: usize) -> (&[f32; 8], f32) {
        debug_assert!(axis < 3);
        // SAFETY: axes are 0, 1, 2: `Shear::new` makes no others, and without one they are zero.
        let eight = unsafe { &*self.positions.as_ptr().wrapping_add(8 * axis).cast() };
        // SAFETY: as above.
        (eight, unsafe { *self.positions.get_unchecked(3 * 8 + axis) })
    }
}

/// Where a vertex is among the positions.
#[inline(always)]
fn place(axis: usize, vertex: usize) -> usize {
    if vertex < 8 { 8 * axis + vertex } else { 3 * 8 + axis }
}

/// The triangles of some meshes, numbered through.
pub(super) struct Meshes<'a> {
    meshes: &'a [TriangleMesh],
    numbers: &'a Numbers,
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
    pub(super) fn new(meshes: &'a [TriangleMesh], numbers: &'a Numbers) -> Self {
        Self { meshes, numbers }
    }

    /// The corners of a triangle.
    #[inline]
    pub(super) fn vertices(&self, triangle: u32) -> [Vec3; 3] {
        let (mesh, primitive) = self.numbers.locate(triangle);
        self.meshes[mesh].vertices(primitive)
    }

    /// A corner of a triangle.
    #[inline(always)]
    pub(super) fn vertex(&self, triangle: u32, corner: usize) -> Vec3 {
        let (mesh, primitive) = self.numbers.locate(triangle);
        let mesh = &self.meshes[mesh];
        let number = mesh.triangles.as_flattened()[3 * primitive as usize + corner];
        Vec3::from_array(mesh.positions[number as usize])
    }

    /// Asks the memory for the numbers of a triangle's vertices.
    #[inline(always)]
    pub(super) fn fetch_numbers(&self, triangle: u32) {
        let (mesh, primitive) = self.numbers.locate(triangle);
        prefetch(self.meshes[mesh].triangles.as_ptr().wrapping_add(primitive as usize));
    }

    /// Asks the memory for a corner of a triangle, whose numbers have arrived.
    #[inline(always)]
    pub(super) fn fetch_vertex(&self, triangle: u32, corner: usize) {
        let (mesh, primitive) = self.numbers.locate(triangle);
        let mesh = &self.meshes[mesh];
        let number = mesh.triangles.as_flattened()[3 * primitive as usize + corner];
        prefetch(mesh.positions.as_ptr().wrapping_add(number as usize));
    }
}
