//! The samplers of `N` paths at once: loops that the compiler turns into vector instructions.
//!
//! Each lane draws what its [`PathSampler`] would draw alone, by the same functions. Meant to be called from
//! inside kernels (`os::Kernel`), so everything here is inlined.

use super::{Dimension, PathSampler, Sampler, SamplerKind};

/// [`PathSampler`]s of one strategy, as one array a field.
#[derive(Clone, Debug)]
pub struct PathSamplers<const N: usize> {
    keys: [u64; N],
    indices: [u32; N],
    kind: SamplerKind,
}

impl<const N: usize> PathSamplers<N> {
    /// The numbers of sample `samples[i]` of pixel (`x[i]`, `y[i]`), as [`Sampler::path`].
    #[inline(always)]
    pub fn begin(sampler: &Sampler, [x, y]: &[[u32; N]; 2], samples: &[u64; N]) -> Self {
        let mut lanes = Self { keys: [0; N], indices: [0; N], kind: sampler.kind };
        for i in 0..N {
            let path = sampler.path(x[i], y[i], samples[i]);
            lanes.keys[i] = path.key;
            lanes.indices[i] = path.index;
        }
        lanes
    }

    /// The paths of `each`, which draw from one `sampler`; lanes beyond their number are idle.
    #[inline(always)]
    pub fn gather(sampler: &Sampler, each: impl Iterator<Item = PathSampler>) -> Self {
        let mut lanes = Self { keys: [0; N], indices: [0; N], kind: sampler.kind };
        for ((path, key), index) in each.zip(&mut lanes.keys).zip(&mut lanes.indices) {
            *key = path.key;
            *index = path.index;
        }
        lanes
    }

    /// The path of one lane.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> PathSampler {
        PathSampler { key: self.keys[i], index: self.indices[i], kind: self.kind }
    }

    /// [`PathSampler::two`] of every lane i, for `dimension(i)`.
    #[inline(always)]
    pub fn two(&self, dimension: impl Fn(usize) -> Dimension) -> [[f32; N]; 2] {
        // The strategy is chosen outside the loop, so that each loop is straight.
        match self.kind {
            SamplerKind::Sobol => self.two_of(SamplerKind::Sobol, dimension),
            SamplerKind::Independent => self.two_of(SamplerKind::Independent, dimension),
        }
    }

    #[inline(always)]
    fn two_of(&self, kind: SamplerKind, dimension: impl Fn(usize) -> Dimension) -> [[f32; N]; 2] {
        let mut numbers = [[0.0; N]; 2];
        let [x, y] = &mut numbers;
        for i in 0..N {
            let path = PathSampler { key: self.keys[i], index: self.indices[i], kind };
            [x[i], y[i]] = path.two(dimension(i));
        }
        numbers
    }
}
