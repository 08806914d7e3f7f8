//! The one integration binary: physics, statistics and rules of the house.

mod accel;
mod load_mutations;
mod mtl;
mod obj;
mod support;
mod transport;
