//! Random numbers with names, the maps that turn them into directions and points, and discrete choice.
//!
//! Numbers are stateless: a value is a function of (seed, pixel, sample, [`Dimension`]), so leaving a
//! stage out shifts no other number. Knows nothing of scenes.

mod alias;
mod dimension;
pub mod hash;
mod lanes;
mod piecewise;
mod rng;
mod sampler;
mod strategy;
pub mod voronoi;
pub mod warp;

pub use alias::AliasTable;
pub use dimension::Dimension;
pub use lanes::SampleKeys;
pub use piecewise::{PiecewiseConstant1d, PiecewiseConstant2d};
pub use rng::CounterRng;
pub use sampler::{REPLICATES, SampleKey, Sampler};
pub use strategy::{Fraction, PointSet, Strategy, to_f64};
