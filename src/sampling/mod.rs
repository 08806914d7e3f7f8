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
mod sobol;
pub mod warp;

pub use alias::AliasTable;
pub use dimension::Dimension;
pub use lanes::PathSamplers;
pub use piecewise::{PiecewiseConstant1d, PiecewiseConstant2d};
pub use rng::CounterRng;
pub use sampler::{PathSampler, REPLICATES, Sampler, SamplerKind};
