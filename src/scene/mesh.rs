//! A triangle mesh as a model file describes it, in `f32` around its own `f64` origin.

use super::MaterialId;
use crate::math::DVec3;

/// An indexed mesh with optional attributes. All present attribute arrays have one entry a vertex.
///
/// A file's vertex at `origin + position`: the origin is the first vertex snapped to a grid of powers of
/// two, so that georeferenced models (coordinates in the millions) keep their detail in `f32`.
#[derive(Clone, Debug, Default)]
pub struct MeshData {
    /// Added to every position, exactly representable in the file's `f64`.
    pub origin: DVec3,
    /// Positions relative to `origin`.
    pub positions: Vec<[f32; 3]>,
    /// Unit shading normals; empty when the file has none for these faces.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, v upward as in the file; empty when the file has none for these faces.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertex indices a triangle, each below `positions.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle.
    pub materials: Vec<MaterialId>,
    /// Line of the file that each triangle's face is on, from 1; empty when there is no file.
    pub lines: Vec<u32>,
}
