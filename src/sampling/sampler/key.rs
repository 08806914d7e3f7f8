//! The name of a sample: from it and a dimension follows every random number of a path. Knows no strategy.

use crate::sampling::Dimension;
use crate::sampling::hash::combine;

/// Which sample of which pixel; with a [`Sampler`](super::Sampler), all numbers of a path.
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleKey {
    pub(in crate::sampling) key: u64,
    pub(in crate::sampling) index: u32,
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
    pub(in crate::sampling) fn seed(&self, dimension: Dimension) -> u64 {
        combine(self.key, u64::from(dimension.index()))
    }

    /// Random bits of the path.
    #[inline(always)]
    pub(in crate::sampling) fn random(&self, dimension: Dimension) -> u64 {
        combine(self.seed(dimension), u64::from(self.index))
    }
}
