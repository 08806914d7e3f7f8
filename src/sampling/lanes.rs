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
    /// Lanes for paths that draw from `sampler`.
    pub fn new(sampler: &Sampler) -> Self {
        Self { keys: [0; N], indices: [0; N], kind: sampler.kind }
    }

    /// The numbers of sample `samples[i]` of pixel (`x[i]`, `y[i]`), as [`Sampler::path`].
    #[inline(always)]
    pub fn begin(&mut self, sampler: &Sampler, [x, y]: &[[u32; N]; 2], samples: &[u64; N]) {
        self.kind = sampler.kind;
        for i in 0..N {
            let path = sampler.path(x[i], y[i], samples[i]);
            self.keys[i] = path.key;
            self.indices[i] = path.index;
        }
    }

    /// The path of one lane; its strategy is that of all lanes.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> PathSampler {
        PathSampler { key: self.keys[i], index: self.indices[i], kind: self.kind }
    }

    /// Sets the path of one lane; all lanes must have one strategy.
    #[inline(always)]
    pub fn set_lane(&mut self, i: usize, path: PathSampler) {
        self.keys[i] = path.key;
        self.indices[i] = path.index;
        self.kind = path.kind;
    }

    /// [`PathSampler::two`] of every lane i, for `dimension(i)`.
    #[inline(always)]
    pub fn two(&self, dimension: impl Fn(usize) -> Dimension, numbers: &mut [[f32; N]; 2]) {
        // The strategy is chosen outside the loop, so that each loop is straight.
        match self.kind {
            SamplerKind::Sobol => self.two_of(SamplerKind::Sobol, dimension, numbers),
            SamplerKind::Independent => self.two_of(SamplerKind::Independent, dimension, numbers),
        }
    }

    #[inline(always)]
    fn two_of(
        &self,
        kind: SamplerKind,
        dimension: impl Fn(usize) -> Dimension,
        [x, y]: &mut [[f32; N]; 2],
    ) {
        for i in 0..N {
            let path = PathSampler { key: self.keys[i], index: self.indices[i], kind };
            [x[i], y[i]] = path.two(dimension(i));
        }
    }
}
