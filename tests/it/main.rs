//! The one integration binary: physics, statistics and rules of the house.

mod accel;
mod closed_forms;
mod determinism;
mod filter;
mod image;
mod load_mutations;
mod mtl;
mod obj;
mod support;
mod tidy;
