//! The numbers of `N` paths at once: loops that the compiler turns into vector instructions.
//!
//! Each lane draws what [`Sampler`] would draw for it alone, by the same functions. Meant to be called from inside
//! kernels (`os::Kernel`), so everything here is inlined.

use super::sampler::Source;
use super::strategy::{sobol, split};
use super::{Dimension, SampleKey, Sampler, hash};

/// [`SampleKey`]s, as one array a field.
#[derive(Clone, Debug)]
pub struct SampleKeys<const N: usize> {
    keys: [u64; N],
    indices: [u32; N],
}

impl<const N: usize> SampleKeys<N> {
    /// Lanes of no path yet.
    pub fn new() -> Self {
        Self { keys: [0; N], indices: [0; N] }
    }

    /// The keys of sample `samples[i]` of pixel (`x[i]`, `y[i]`), as [`Sampler::path`].
    #[inline(always)]
    pub fn begin(&mut self, sampler: &Sampler, [x, y]: &[[u32; N]; 2], samples: &[u64; N]) {
        for i in 0..N {
            self.set_lane(i, sampler.path(x[i], y[i], samples[i]));
        }
    }

    /// The key of one lane.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> SampleKey {
        SampleKey { key: self.keys[i], index: self.indices[i] }
    }

    /// Sets the key of one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, path: SampleKey) {
        self.keys[i] = path.key;
        self.indices[i] = path.index;
    }

    /// [`Sampler::two`] of every lane i, for `dimension(i)`.
    #[inline(always)]
    pub fn two(
        &self,
        sampler: &Sampler,
        dimension: impl Fn(usize) -> Dimension,
        [x, y]: &mut [[f32; N]; 2],
    ) {
        // The strategy is chosen outside the loops, so that each is straight.
        match sampler.source {
            Source::Sobol => {
                for i in 0..N {
                    let path = self.lane(i);
                    let pair = sobol::owen_sobol_2d(path.index, path.seed(dimension(i)));
                    [x[i], y[i]] = pair.map(hash::unit_f32);
                }
            }
            Source::Random => {
                for i in 0..N {
                    let pair = split(self.lane(i).random(dimension(i)));
                    [x[i], y[i]] = pair.map(hash::unit_f32);
                }
            }
            _ => {
                for i in 0..N {
                    [x[i], y[i]] = sampler.two(self.lane(i), dimension(i));
                }
            }
        }
    }
}

impl<const N: usize> Default for SampleKeys<N> {
    fn default() -> Self {
        Self::new()
    }
}
