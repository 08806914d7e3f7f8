//! The one integration binary: physics, statistics and rules of the house.

mod accel;
mod support;
mod tidy;
mod transport;
