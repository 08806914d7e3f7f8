//! The samplers of paths: seed, pixel, sample and dimension to numbers in [0, 1).
//!
//! A sample number is (replicate, index in replicate): the replicates are independently randomised, so the spread
//! between their images measures the error. Strategies that go on for ever (random, Sobol, Halton) are padded: every
//! dimension has its own scramble and its own order. Of the others a replicate takes sets of points, in a random
//! order of its own for every pixel and dimension (pmj02 points within each doubling), and randomised so that
//! what the strategy is about stays: random strata are drawn anew, relaxed sets of a table are mirrored and rotated around
//! the torus (R. Cranley and T. N. L. Patterson, SIAM Journal on Numerical Analysis 13(6), 1976), (0,2)-nets
//! are digitally shifted or scrambled.
//!
//! What padding costs: a nested shuffle keeps points 2i and 2i + 1 together, which are in opposite halves of every
//! dimension; so products of two dimensions have up to twice the variance that random numbers give them.

mod key;
#[cfg(test)]
mod tests;

pub use key::SampleKey;

use super::Dimension;
use super::hash::{combine, mix64, unit_f32};
use super::strategy::{Formula, Fraction, Strategy, halton, in_stratum, permute};
use super::strategy::{screen, sobol, split};
use std::sync::Arc;

/// Independent randomisations of every pixel; sample `s` belongs to replicate `s % REPLICATES`.
pub const REPLICATES: usize = 4;

/// A strategy and its seed.
#[derive(Clone, Debug)]
pub struct Sampler {
    strategy: Strategy,
    seed: u64,
    /// Samples of a replicate after which it is randomised anew.
    size: u64,
    pub(in crate::sampling) source: Source,
}

/// Where numbers come from.
#[derive(Clone, Debug)]
pub(in crate::sampling) enum Source {
    Random,
    Sobol,
    Halton,
    /// Sobol points of sets of 2^this, shared out among pixels.
    ScreenSobol(u32),
    /// Hammersley points, shifted along x, where any shift keeps the strata, and scrambled along y.
    Hammersley,
    /// Sets without a shift: random ones, and the grid.
    Sets(Formula),
    /// So many sets, one after the other, one of which is mirrored and shifted: a single small one would prefer a direction.
    Shifted(Arc<[[Fraction; 2]]>, u32),
    /// Sets of which each prefix of a power of two is a net.
    Pmj02(Arc<[[Fraction; 2]]>),
}

impl Sampler {
    /// The largest set that is made beforehand.
    const MAX_TABLE: u32 = 1024;

    /// `strategy`, randomised by `seed`, for renders of `samples_per_pixel`: sets have the size of a replicate's share of
    /// them, or the next one that the strategy allows, up to 1024 where sets are made beforehand. Strategies that
    /// cannot render ([`Strategy::can_render`]) sample as their sisters of the torus.
    pub fn new(strategy: Strategy, seed: u64, samples_per_pixel: u64) -> Self {
        let strategy = match strategy {
            Strategy::BoundedVoronoi => Strategy::CentroidalVoronoi,
            strategy => strategy,
        };
        let size = Self::set_size(strategy, samples_per_pixel);
        let count = size.unwrap_or(1) as u32;
        let table = |sets: u32| {
            let set = |k| strategy.points(count, seed.wrapping_add(k)).map(|set| set.points);
            (0..u64::from(sets)).flat_map(|k| set(k).unwrap_or_default()).collect()
        };
        let source = match strategy {
            Strategy::Random => Source::Random,
            Strategy::Sobol => Source::Sobol,
            Strategy::Halton => Source::Halton,
            Strategy::ScreenSobol => Source::ScreenSobol(count.trailing_zeros()),
            Strategy::Pmj02 => Source::Pmj02(table(1)),
            Strategy::Hammersley => Source::Hammersley,
            _ => match Formula::new(strategy, count) {
                Some(formula) => Source::Sets(formula),
                None => {
                    let sets = (Self::MAX_TABLE / count).clamp(1, 64);
                    Source::Shifted(table(sets), sets)
                }
            },
        };
        let endless = if strategy == Strategy::Halton { halton::LENGTH } else { 1 << 32 };
        let size = size.unwrap_or(endless);
        Self { strategy, seed: mix64(seed ^ 0x676c_696e_7400_0001), size, source }
    }

    /// How many points a set has for renders of `samples_per_pixel`; `None` for strategies that take no sets.
    pub fn set_size(strategy: Strategy, samples_per_pixel: u64) -> Option<u64> {
        let share = samples_per_pixel.div_ceil(REPLICATES as u64);
        let up_to = |max: u32, n: u64| n.clamp(1, max.into()) as u32;
        let size = match strategy {
            Strategy::Random | Strategy::Sobol | Strategy::Halton => return None,
            // Not randomised, the replicates of a grid would be the same: they share one.
            Strategy::Grid => up_to(Strategy::MAX_COUNT, samples_per_pixel),
            Strategy::ScreenSobol => up_to(Strategy::MAX_COUNT, share).next_power_of_two(),
            Strategy::Pmj02 => up_to(Self::MAX_TABLE, share).next_power_of_two(),
            Strategy::Jittered
            | Strategy::NRooks
            | Strategy::MultiJittered
            | Strategy::CorrelatedMultiJittered => {
                let wanted = up_to(Strategy::MAX_COUNT, share);
                // A square number is near, and the largest is one.
                (wanted..=Strategy::MAX_COUNT).find(|n| strategy.allows(*n)).unwrap_or(wanted)
            }
            _ => up_to(Self::MAX_TABLE, share),
        };
        Some(size.into())
    }

    /// How it samples.
    pub fn strategy(&self) -> Strategy {
        self.strategy
    }

    /// The key of sample `sample` of pixel (x, y).
    #[inline(always)]
    pub fn path(&self, x: u32, y: u32, sample: u64) -> SampleKey {
        let is_endless = matches!(self.source, Source::Random | Source::Sobol);
        if is_endless {
            let replicate = sample % REPLICATES as u64;
            let index = sample / REPLICATES as u64;
            let pixel = combine(self.seed, u64::from(y) << 32 | u64::from(x));
            // A replicate restarts, freshly randomised, every 2^32 samples.
            let key = combine(pixel, replicate | (index >> 32) << 8);
            return SampleKey { key, index: index as u32 };
        }
        self.path_of_sets([x, y], sample)
    }

    #[inline(never)]
    fn path_of_sets(&self, [x, y]: [u32; 2], sample: u64) -> SampleKey {
        let (replicate, index) = match self.strategy {
            Strategy::Grid => (0, sample),
            _ => (sample % REPLICATES as u64, sample / REPLICATES as u64),
        };
        let (block, index) = (index / self.size, (index % self.size) as u32);
        let of_block = replicate | block << 8;
        let key = match self.source {
            // Pixels differ by their place alone.
            Source::ScreenSobol(_) => {
                let block = combine(self.seed, of_block) >> 32;
                block << 32 | u64::from(screen::z_order(x, y))
            }
            _ => combine(combine(self.seed, u64::from(y) << 32 | u64::from(x)), of_block),
        };
        SampleKey { key, index }
    }

    /// One number in [0, 1).
    #[inline(always)]
    pub fn one(&self, path: SampleKey, dimension: Dimension) -> f32 {
        unit_f32(match &self.source {
            Source::Random => split(path.random(dimension))[0],
            Source::Sobol => sobol::owen_sobol_1d(path.index, path.seed(dimension)),
            Source::Sets(formula) => self.number_of_sets(formula, path, dimension),
            _ => self.pair(path, dimension)[0],
        })
    }

    /// Two numbers in [0, 1), stratified together where the strategy stratifies.
    #[inline(always)]
    pub fn two(&self, path: SampleKey, dimension: Dimension) -> [f32; 2] {
        let pair = match &self.source {
            Source::Random => split(path.random(dimension)),
            Source::Sobol => sobol::owen_sobol_2d(path.index, path.seed(dimension)),
            _ => self.pair(path, dimension),
        };
        pair.map(unit_f32)
    }

    /// Of strategies whose numbers take longer than a call.
    #[inline(never)]
    fn pair(&self, path: SampleKey, dimension: Dimension) -> [Fraction; 2] {
        let seed = path.seed(dimension);
        match &self.source {
            Source::Random => split(path.random(dimension)),
            Source::Sobol => sobol::owen_sobol_2d(path.index, seed),
            Source::Halton => halton::scrambled(path.index, seed),
            Source::ScreenSobol(bits) => {
                let seed = combine(path.key >> 32, u64::from(dimension.index()));
                screen::point(path.key as u32, path.index, *bits, seed)
            }
            Source::Sets(formula) => {
                formula.point(permute(path.index, self.size as u32, mix64(seed)), seed)
            }
            Source::Hammersley => {
                let n = self.size as u32;
                let i = permute(path.index, n, mix64(seed));
                let [shift, scramble] = split(seed);
                let x = in_stratum(i, n, 0).wrapping_add(shift);
                [x, sobol::scramble_reversed(i, scramble).reverse_bits()]
            }
            Source::Shifted(points, sets) => {
                let (n, choice) = (self.size as u32, mix64(seed ^ 1));
                let set = ((choice >> 32) * u64::from(*sets)) >> 32;
                let index =
                    set as usize * n as usize + permute(path.index, n, mix64(seed)) as usize;
                let [mut x, mut y] = points[index];
                // The eight positions of the square.
                if choice & 1 != 0 {
                    (x, y) = (y, x);
                }
                let mirrors = [1, 2].map(|bit| (choice >> bit & 1) as Fraction);
                let shift = split(seed);
                // All bits of a fraction inverted are its mirror image, but for the last one.
                let position =
                    |c: Fraction, k: usize| (c ^ mirrors[k].wrapping_neg()).wrapping_add(shift[k]);
                [position(x, 0), position(y, 1)]
            }
            Source::Pmj02(points) => {
                // Prefixes of powers of two are nets: numbers change places within the second half of each.
                let start = if path.index == 0 { 0 } else { 1 << path.index.ilog2() };
                let place = start + permute(path.index - start, start.max(1), mix64(seed));
                let (point, flips) = (points[place as usize], split(seed));
                [0, 1].map(|k| point[k] ^ flips[k])
            }
        }
    }

    #[inline(never)]
    fn number_of_sets(&self, formula: &Formula, path: SampleKey, dimension: Dimension) -> Fraction {
        let (seed, size) = (path.seed(dimension), self.size as u32);
        formula.number(permute(path.index, size, mix64(seed)), size, seed)
    }
}
