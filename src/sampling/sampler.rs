//! The samplers of paths: seed, pixel, sample and dimension to numbers in [0, 1).
//!
//! A sample number is (replicate, index in replicate): the replicates are independently randomised,
//! so the spread between their images measures the error. Each replicate is progressive.

use super::Dimension;
use super::hash::{combine, mix64, unit_f32};
use super::sobol::{owen_sobol_1d, owen_sobol_2d};

/// Independent randomisations of every pixel; sample `s` belongs to replicate `s % REPLICATES`.
pub const REPLICATES: usize = 4;

/// The strategies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SamplerKind {
    /// Uniform random numbers.
    Independent,
    /// Padded Owen-scrambled Sobol pairs (a (0,2)-sequence for every dimension of a path).
    #[default]
    Sobol,
}

impl SamplerKind {
    /// Every strategy with the name that the command line knows it by.
    pub const ALL: [(&'static str, Self); 2] =
        [("sobol", Self::Sobol), ("independent", Self::Independent)];
}

/// A strategy and its seed.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    pub(super) kind: SamplerKind,
    seed: u64,
}

impl Sampler {
    /// `kind`, randomised by `seed`.
    pub fn new(kind: SamplerKind, seed: u64) -> Self {
        Self { kind, seed: mix64(seed ^ 0x676c_696e_7400_0001) }
    }

    /// The numbers of sample `sample` of pixel (x, y).
    #[inline(always)]
    pub fn path(&self, x: u32, y: u32, sample: u64) -> PathSampler {
        let replicate = sample % REPLICATES as u64;
        let index = sample / REPLICATES as u64;
        let pixel = combine(self.seed, u64::from(y) << 32 | u64::from(x));
        // A replicate restarts, freshly randomised, every 2^32 samples.
        let key = combine(pixel, replicate | (index >> 32) << 8);
        PathSampler { key, index: index as u32, kind: self.kind }
    }
}

/// The numbers of one path: a pure function of [`Dimension`].
#[derive(Clone, Copy, Debug, Default)]
pub struct PathSampler {
    pub(super) key: u64,
    pub(super) index: u32,
    pub(super) kind: SamplerKind,
}

impl PathSampler {
    /// One number in [0, 1).
    #[inline(always)]
    pub fn one(&self, dimension: Dimension) -> f32 {
        let seed = self.dimension_seed(dimension);
        unit_f32(match self.kind {
            SamplerKind::Sobol => owen_sobol_1d(self.index, seed),
            SamplerKind::Independent => (self.independent(seed) >> 32) as u32,
        })
    }

    /// Two numbers in [0, 1), stratified together where the strategy stratifies.
    #[inline(always)]
    pub fn two(&self, dimension: Dimension) -> [f32; 2] {
        let seed = self.dimension_seed(dimension);
        let (x, y) = match self.kind {
            SamplerKind::Sobol => owen_sobol_2d(self.index, seed),
            SamplerKind::Independent => {
                let bits = self.independent(seed);
                ((bits >> 32) as u32, bits as u32)
            }
        };
        [unit_f32(x), unit_f32(y)]
    }

    /// What hit filters know a ray of this path by: a hash of the path, the vertex and the kind of ray.
    #[inline(always)]
    pub fn ray_id(&self, bounce: u32, kind: u32) -> u32 {
        let path = self.key ^ u64::from(self.index);
        (combine(path, u64::from(bounce) << 8 | u64::from(kind) | 1 << 63) >> 32) as u32
    }

    #[inline(always)]
    fn dimension_seed(&self, dimension: Dimension) -> u64 {
        combine(self.key, u64::from(dimension.index()))
    }

    #[inline(always)]
    fn independent(&self, seed: u64) -> u64 {
        combine(seed, u64::from(self.index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_below_one_and_depend_on_every_part_of_the_key() {
        for (_, kind) in SamplerKind::ALL {
            let value = |seed, x, y, s, d| Sampler::new(kind, seed).path(x, y, s).two(d);
            let base = value(0, 3, 5, 17, Dimension::Film);
            assert_ne!(base, value(1, 3, 5, 17, Dimension::Film));
            assert_ne!(base, value(0, 4, 5, 17, Dimension::Film));
            assert_ne!(base, value(0, 3, 6, 17, Dimension::Film));
            assert_ne!(base, value(0, 3, 5, 18, Dimension::Film));
            assert_ne!(base, value(0, 3, 5, 21, Dimension::Film));
            assert_ne!(base, value(0, 3, 5, 17 + (4 << 32), Dimension::Film));
            assert_ne!(base, value(0, 3, 5, 17, Dimension::Lens));
            for s in 0..100_000 {
                let path = Sampler::new(kind, 0).path(0, 0, s);
                let [x, y] = path.two(Dimension::Lens);
                let z = path.one(Dimension::Roulette { bounce: 2 });
                for v in [x, y, z] {
                    assert!((0.0..1.0).contains(&v));
                }
            }
        }
    }

    /// Mean of a smooth integrand over replicates: the Sobol error falls faster than random's.
    #[test]
    fn sobol_converges_faster_than_independent() {
        let rms = |kind, n: u64| {
            let mut sum = 0.0_f64;
            for pixel in 0..256 {
                let mut mean = 0.0_f64;
                for s in 0..n {
                    let [x, y] = Sampler::new(kind, 0)
                        .path(pixel, 0, s * REPLICATES as u64)
                        .two(Dimension::Film);
                    mean += f64::from(x * x * y) / n as f64;
                }
                sum += (mean - 1.0 / 6.0).powi(2);
            }
            (sum / 256.0).sqrt()
        };
        assert!(rms(SamplerKind::Sobol, 256) < 0.1 * rms(SamplerKind::Independent, 256));
        let slope = (rms(SamplerKind::Sobol, 16) / rms(SamplerKind::Sobol, 1024)).log2() / 6.0;
        assert!(slope > 1.2, "slope {slope}");
    }
}
