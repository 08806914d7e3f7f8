//! Rays, hits and the shared geometry buffers: all that an accelerator knows.
//!
//! Must not know materials, lights or the scene. Units are those of the file, relative to the world
//! origin that `world` chose.

mod aabb;
mod buffer;
mod mesh;
mod ray;
mod triangle;

pub use aabb::Aabb;
pub use buffer::Buffer;
pub use mesh::{Geometry, Instance, Object, TriangleMesh};
pub use ray::{Hit, NONE, PrimitiveId, Ray};
pub use triangle::{
    TriangleHit, intersect_triangle, offset_distance, triangle_distance, within_box,
};
