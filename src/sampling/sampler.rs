//! The samplers of paths: seed, pixel, sample and dimension to numbers in [0, 1).
//!
//! A sample number is (replicate, index in replicate): the replicates are independently randomised, so the spread
//! between their images measures the error. Strategies that go on for ever (random, Sobol, Halton) are padded: every
//! dimension has its own scramble and its own order. Of the others a replicate takes sets of points, in a random
//! order of its own for every pixel and dimension (pmj02 points within each doubling), and randomised so that
//! what the strategy is about stays: random strata are drawn anew, relaxed sets of one table are rotated around the
//! torus (R. Cranley and T. N. L. Patterson, SIAM Journal on Numerical Analysis 13(6), 1976), (0,2)-nets
//! are digitally shifted or scrambled.
//!
//! What padding costs: a nested shuffle keeps points 2i and 2i + 1 together, which are in opposite halves of every
//! dimension; so products of two dimensions have up to twice the variance that random numbers give them.

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
    pub(super) source: Source,
}

/// Where numbers come from.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Random,
    Sobol,
    Halton,
    /// Sobol points of sets of 2^this, shared out among pixels.
    ScreenSobol(u32),
    /// Hammersley points, shifted along x, where any shift keeps the strata, and scrambled along y.
    Hammersley,
    /// Sets without a shift: random ones, and the grid.
    Sets(Formula),
    /// A set that is shifted.
    Shifted(Arc<[[Fraction; 2]]>),
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
        let table =
            || strategy.points(count, seed).map(|set| set.points.into()).unwrap_or_default();
        let source = match strategy {
            Strategy::Random => Source::Random,
            Strategy::Sobol => Source::Sobol,
            Strategy::Halton => Source::Halton,
            Strategy::ScreenSobol => Source::ScreenSobol(count.trailing_zeros()),
            Strategy::Pmj02 => Source::Pmj02(table()),
            Strategy::Hammersley => Source::Hammersley,
            _ => match Formula::new(strategy, count) {
                Some(formula) => Source::Sets(formula),
                None => Source::Shifted(table()),
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
            Source::Shifted(points) => {
                let point = points[permute(path.index, points.len() as u32, mix64(seed)) as usize];
                let shift = split(seed);
                [0, 1].map(|k| point[k].wrapping_add(shift[k]))
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

/// Which sample of which pixel; with a [`Sampler`], all numbers of a path.
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleKey {
    pub(super) key: u64,
    pub(super) index: u32,
}

impl SampleKey {
    /// What hit filters know a ray of this path by: a hash of the path, the vertex and the kind of ray.
    #[inline(always)]
    pub fn ray_id(&self, bounce: u32, kind: u32) -> u32 {
        // Mixed, not added: keys of neighbouring pixels may differ in few bits.
        let path = combine(self.key, u64::from(self.index));
        (combine(path, u64::from(bounce) << 8 | u64::from(kind) | 1 << 63) >> 32) as u32
    }

    /// What randomises a dimension of the pixel and replicate.
    #[inline(always)]
    pub(super) fn seed(&self, dimension: Dimension) -> u64 {
        combine(self.key, u64::from(dimension.index()))
    }

    /// Random bits of the path.
    #[inline(always)]
    pub(super) fn random(&self, dimension: Dimension) -> u64 {
        combine(self.seed(dimension), u64::from(self.index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samplers() -> impl Iterator<Item = Strategy> {
        Strategy::ALL.iter().copied().filter(|strategy| strategy.can_render())
    }

    #[test]
    fn values_depend_on_every_part_of_the_key() {
        for strategy in samplers().filter(|s| *s != Strategy::Grid) {
            // Wholes of 64 numbers: single ones may well be the same.
            let of = |seed, x, y, block: u64, replicate, dimension| {
                let sampler = Sampler::new(strategy, seed, 256);
                let size = Sampler::set_size(strategy, 256).unwrap_or(1 << 32) * REPLICATES as u64;
                let first = block * size + replicate;
                (0..64)
                    .map(|s| sampler.two(sampler.path(x, y, first + 4 * s), dimension))
                    .collect::<Vec<_>>()
            };
            let base = of(0, 3, 5, 0, 1, Dimension::Film);
            let others = [
                of(1, 3, 5, 0, 1, Dimension::Film),
                of(0, 4, 5, 0, 1, Dimension::Film),
                of(0, 3, 6, 0, 1, Dimension::Film),
                of(0, 3, 5, 1, 1, Dimension::Film),
                of(0, 3, 5, 0, 2, Dimension::Film),
                of(0, 3, 5, 0, 1, Dimension::Lens),
            ];
            for (i, other) in others.iter().enumerate() {
                let same = base.iter().zip(other).filter(|(a, b)| a == b).count();
                assert!(same <= 1, "{}: {same} of 64 the same, part {i}", strategy.name());
            }
        }
    }

    #[test]
    fn values_are_below_one() {
        for strategy in samplers() {
            let sampler = Sampler::new(strategy, 0, 1000);
            for s in 0..20_000 {
                let path = sampler.path(s as u32 % 7, 2, s);
                let [x, y] = sampler.two(path, Dimension::Lens);
                let z = sampler.one(path, Dimension::Roulette { bounce: 2 });
                for v in [x, y, z] {
                    assert!((0.0..1.0).contains(&v), "{}: {v}", strategy.name());
                }
            }
        }
    }

    /// Whatever the strategy, every sample of a pixel is uniform by itself: 20 000 pixels in 8 by 8 boxes, for the first and
    /// for another sample of a set of 16. Chi squared of 63 degrees is above 155 with 2e-9: 30 comparisons, 6e-8 in
    /// all; a density off by a fifth in a quarter of the square would be found.
    #[test]
    fn every_sample_is_uniform() {
        for strategy in samplers().filter(|s| *s != Strategy::Grid) {
            for sample in [0, 36] {
                let mut counts = [0_u32; 64];
                let trials = 20_000;
                // One sampler, since tables take time: pixels randomise as seeds do.
                let sampler = Sampler::new(strategy, 0, 64);
                for trial in 0..trials {
                    let (x, y) = (trial % 173, trial / 173);
                    let [u, v] = sampler.two(sampler.path(x, y, sample), Dimension::Film);
                    counts[(8.0 * u) as usize * 8 + (8.0 * v) as usize] += 1;
                }
                let expected = f64::from(trials) / 64.0;
                let chi_squared: f64 =
                    counts.iter().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
                assert!(chi_squared < 155.0, "{} {sample}: {chi_squared}", strategy.name());
            }
        }
    }

    /// Mean of a product of two dimensions, each a pair: 1/16 only if the dimensions are independent of each other. 16 384
    /// pixels of 16 samples, 5.5 standard errors from their own spread: 15 comparisons, 6e-7 in all; a correlation
    /// of 2 % would be found.
    #[test]
    fn dimensions_are_padded_without_correlation() {
        for strategy in samplers() {
            let sampler = Sampler::new(strategy, 0, 64);
            let (mut sum, mut squares) = (0.0, 0.0);
            let pixels = 16_384;
            for pixel in 0..pixels {
                let mut mean = 0.0;
                for s in 0..16 {
                    let path = sampler.path(pixel % 128, pixel / 128, 4 * s);
                    let [a, b] = sampler.two(path, Dimension::Film).map(|v| f64::from(v) - 0.5);
                    let [c, d] = sampler.two(path, Dimension::Lens).map(|v| f64::from(v) - 0.5);
                    mean += (a * c + b * d) / 16.0;
                }
                sum += mean;
                squares += mean * mean;
            }
            let n = f64::from(pixels);
            let error = (squares / n).sqrt() / n.sqrt();
            assert!((sum / n).abs() < 5.5 * error, "{}: {} {error}", strategy.name(), sum / n);
            assert!(error < 2.0 * 0.02 / 12.0 / 8.5, "{}: no power, {error}", strategy.name());
        }
    }

    /// A sampler keeps the strata of its sets: in any pixel and dimension.
    #[test]
    fn sets_keep_their_strata() {
        let cell = |v: f32, n: f32| (v * n) as usize;
        for pixel in 0..50 {
            for (strategy, fills) in [
                (Strategy::Jittered, [true, false, false]),
                (Strategy::NRooks, [false, true, true]),
                (Strategy::Hammersley, [false, true, true]),
                (Strategy::MultiJittered, [true, true, true]),
                (Strategy::CorrelatedMultiJittered, [true, true, true]),
                (Strategy::Pmj02, [true, true, true]),
                (Strategy::Sobol, [true, true, true]),
            ] {
                let sampler = Sampler::new(strategy, 0, 64);
                let points = (0..16).map(|s| {
                    sampler.two(
                        sampler.path(pixel, 1, 4 * s + 2),
                        Dimension::LightPosition { bounce: 3 },
                    )
                });
                let mut seen = [[false; 16]; 3];
                for [x, y] in points {
                    seen[0][cell(x, 4.0) * 4 + cell(y, 4.0)] = true;
                    seen[1][cell(x, 16.0)] = true;
                    seen[2][cell(y, 16.0)] = true;
                }
                let filled = seen.map(|strata| strata.iter().all(|s| *s));
                for (is_filled, must) in filled.into_iter().zip(fills) {
                    assert!(is_filled || !must, "{}: {seen:?}", strategy.name());
                }
            }
        }
    }

    /// Mean of a smooth integrand: with 256 points the error of every strategy is at most six tenths of random's, from 256
    /// means (a ratio that is known to 6 %), and Sobol's falls with more than the power 1.2.
    #[test]
    fn strategies_beat_random_numbers() {
        let rms = |strategy, n: u64| {
            let mut sum = 0.0_f64;
            let sampler = Sampler::new(strategy, 0, n * REPLICATES as u64);
            for pixel in 0..256 {
                let path = |s| sampler.path(pixel % 16, pixel / 16, s * REPLICATES as u64);
                let value = |[x, y]: [f32; 2]| f64::from(x * x * y) / n as f64;
                let mean: f64 = (0..n).map(|s| value(sampler.two(path(s), Dimension::Film))).sum();
                sum += (mean - 1.0 / 6.0).powi(2);
            }
            (sum / 256.0).sqrt()
        };
        let random = rms(Strategy::Random, 256);
        for strategy in samplers().filter(|s| !matches!(s, Strategy::Random | Strategy::Grid)) {
            let ratio = rms(strategy, 256) / random;
            assert!(ratio < 0.6, "{}: {ratio}", strategy.name());
        }
        let slope = (rms(Strategy::Sobol, 16) / rms(Strategy::Sobol, 1024)).log2() / 6.0;
        assert!(slope > 1.2, "slope {slope}");
    }

    /// Single numbers fill their strata, too: light selection, lobes and roulette are drawn so.
    #[test]
    fn single_numbers_fill_their_strata() {
        for strategy in [
            Strategy::Grid,
            Strategy::Jittered,
            Strategy::NRooks,
            Strategy::MultiJittered,
            Strategy::CorrelatedMultiJittered,
            Strategy::Hammersley,
            Strategy::Sobol,
            Strategy::Pmj02,
        ] {
            // The replicates of a grid share one set.
            let (count, step) = if strategy == Strategy::Grid { (16, 1) } else { (64, 4) };
            let sampler = Sampler::new(strategy, 0, count);
            for pixel in 0..50 {
                let mut seen = [false; 16];
                for s in 0..16 {
                    let path = sampler.path(pixel, 1, step * s);
                    let number = sampler.one(path, Dimension::LightSelect { bounce: 2 });
                    seen[(16.0 * number) as usize] = true;
                }
                // A shift moves all strata alike, so that two may share a box and one be left.
                let filled = seen.iter().filter(|s| **s).count();
                let least = if strategy == Strategy::Hammersley { 15 } else { 16 };
                assert!(filled >= least, "{} {pixel}: {seen:?}", strategy.name());
            }
        }
    }

    /// No two samples of any pixels have the same name for hit filters.
    #[test]
    fn rays_have_names_of_their_own() {
        for strategy in samplers() {
            let sampler = Sampler::new(strategy, 0, 64);
            let mut ids = std::collections::BTreeSet::new();
            for pixel in 0..64 {
                for s in 0..64 {
                    ids.insert(sampler.path(pixel % 8, pixel / 8, s).ray_id(0, 0));
                }
            }
            // Of 4096 hashes of 32 bits, two are the same in one of 500 draws.
            assert!(ids.len() >= 4094, "{}: {}", strategy.name(), ids.len());
        }
    }
}
