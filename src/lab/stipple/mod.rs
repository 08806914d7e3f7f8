//! Weighted Voronoi stippling: a picture drawn with dots of one colour, each in the middle of its cell.
//!
//! Source: A. Secord, Weighted Voronoi Stippling, NPAR 2002: points are drawn from the picture's darkness,
//! then Lloyd's iteration (S. Lloyd, Least Squares Quantization in PCM, 1982) moves each to the weighted
//! centroid of its Voronoi cell until they are spread evenly. Two things differ:
//!
//! - The weight is the *square* of the darkness. In the plane the points of a least energy have the density
//!   of the square root of the weight (A. Gersho, Asymptotically Optimal Block Quantization, 1979). Weighted
//!   by the darkness itself, every iteration would draw points out of the dark; like this they stay where
//!   they were drawn.
//! - Everything that is compared or summed is an integer: points lie on a grid of 1/256 of a sample, weights
//!   have 24 bits. So a sum is the same in any order, and the energy cannot rise, not even by rounding.
//!
//! Knows nothing of files, nor of how many threads there are.

mod density;
mod drawing;
mod lloyd;
mod nearest;
mod raster;
mod svg;

pub use density::{Density, Tone};
pub use drawing::{Dot, Drawing};
pub use raster::MAX_PIXELS;

use crate::sampling::hash::{combine, mix64};
use std::ops::ControlFlow;

/// The most points of one picture.
pub const MAX_POINTS: usize = 1 << 22;

/// How to stipple.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Points, 1 to [`MAX_POINTS`].
    pub points: usize,
    /// Seed of the points that the iteration starts from.
    pub seed: u64,
    /// Moves of all points at most. With 0 they stay where they were drawn.
    pub iterations: u32,
    /// The energy's relative change below which the iteration ends.
    pub tolerance: f64,
}

/// A stippled picture.
#[derive(Clone, Debug)]
pub struct Stippling {
    /// Points in pixels, x to the right and y down, within the picture; in the order of a Z-curve where they
    /// were drawn.
    pub points: Vec<[f64; 2]>,
    /// Darkness of each point's cell: the area that its dot would have to cover, in square pixels.
    pub darkness: Vec<f64>,
    /// Mean squared distance of the weight from its point in square pixels: first of the points as they were
    /// drawn, then after each iteration. Never rises.
    pub energy: Vec<f64>,
    /// Whether the iteration ended because the energy changed too little.
    pub converged: bool,
}

/// Stipples `density`. `tell` hears the energy of the points as they were drawn (iteration 0) and after each
/// iteration; when it breaks off, the result is `None`.
///
/// A point whose cell is white has nowhere to go: it is drawn again from the density. It was nobody's nearest
/// point (but of white samples), so the energy does not rise by that.
pub fn stipple(
    density: &Density,
    settings: &Settings,
    tell: &mut dyn FnMut(u32, f64) -> ControlFlow<()>,
) -> Option<Stippling> {
    let key = mix64(settings.seed);
    let mut sites = density.stratified(settings.points, key);
    let mut partition = lloyd::partition(density, &sites);
    let mut energy = vec![partition.energy];
    let mut converged = false;
    for iteration in 0..=settings.iterations {
        if tell(iteration, partition.energy).is_break() {
            return None;
        }
        if converged || iteration == settings.iterations {
            break;
        }
        lloyd::move_sites(density, &partition, &mut sites, combine(key, iteration.into()));
        let before = partition.energy;
        partition = lloyd::partition(density, &sites);
        energy.push(partition.energy);
        converged = before - partition.energy <= settings.tolerance * before;
    }
    let points = sites.iter().map(|&site| density.pixel_position(site)).collect();
    let darkness = partition.cells.iter().map(|cell| density.darkness_of(cell)).collect();
    Some(Stippling { points, darkness, energy, converged })
}

#[cfg(test)]
mod tests;
