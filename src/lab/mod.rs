//! The sampling laboratory: what a set of points is worth, whoever made it.
//!
//! Works on plain points of the unit square. Knows nothing of scenes, rays or renders.

pub mod measure;
