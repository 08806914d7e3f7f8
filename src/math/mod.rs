//! Vectors, colours, frames and transcendental functions: the tools at the bottom of the crate.
//!
//! Vectors are glam's. Everything whose result depends on the C library or the CPU is replaced by
//! [`fun`], so that an image is the same bytes on every x86-64. Knows nothing of rays or scenes.

mod affine;
mod frame;
pub mod fun;
mod rgb;

pub use affine::Affine;
pub use frame::Frame;
pub use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3, Vec4};
pub use rgb::Rgb;

/// Half of the distance from 1 to the next larger `f32`: the unit round-off.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// The largest `f32` below 1: the upper end of every random number.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - UNIT_ROUNDOFF;
