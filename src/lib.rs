//! glint: a path tracer for large OBJ scenes on Embree.
//!
//! The modules are the pipeline, in reading order: tools, models, stages, front end. A module uses only
//! modules above it in this list (`tests/it/tidy.rs` holds the table and fails on any other edge).

#[cfg(not(any(feature = "embree", feature = "bvh")))]
compile_error!("glint needs a backend: enable feature `embree`, feature `bvh`, or both");

// Tools.
pub mod error;
pub mod math;
pub mod sampling;
pub mod image;
pub mod ledger;
pub mod os;

// Models: pure types and functions that know no scene.
pub mod geometry;
pub mod texture;
pub mod bsdf;
pub mod light;
pub mod camera;
pub mod filter;

// Stages, in the order of the data.
pub mod scene;
pub mod load;
pub mod accel;
pub mod world;
pub mod plan;
pub mod trace;
pub mod film;
pub mod render;

// Uses.
pub mod lab;
pub mod generate;
pub mod study;

// Front end.
pub mod cli;
