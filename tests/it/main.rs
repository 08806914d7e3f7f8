//! One integration binary.

mod camera;
mod light;
