//! The sampling laboratory: points in the plane and what can be said of them, for looking at.
//!
//! Knows images and random numbers; nothing of scenes, rays or files.

pub mod stipple;
