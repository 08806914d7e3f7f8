//! Pairs of random numbers for many vertices at once, in vector instructions.

use super::Vertex;
use super::batch::Batch;
use super::generate_stage::LANES;
use super::path::Path;
use crate::os::{Isa, Kernel};
use crate::sampling::{Dimension, SampleKeys, Sampler};

/// Pairs of numbers in [0, 1), one for each vertex of a batch.
pub(super) struct Pairs {
    pairs: Batch<[f32; 2]>,
    keys: SampleKeys<LANES>,
    bounces: [u32; LANES],
    drawn: [[f32; LANES]; 2],
}

impl Pairs {
    /// Room for `capacity` vertices.
    pub(super) fn new(capacity: usize) -> Self {
        Self {
            pairs: Batch::new(capacity),
            keys: SampleKeys::new(),
            bounces: [0; LANES],
            drawn: [[0.0; LANES]; 2],
        }
    }

    /// The numbers `dimension(bounce)` of every vertex, in their order.
    pub(super) fn draw(
        &mut self,
        isa: Isa,
        sampler: &Sampler,
        vertices: &[Vertex],
        slots: &[Path],
        dimension: impl Fn(u32) -> Dimension + Copy,
    ) -> &[[f32; 2]] {
        self.pairs.clear();
        for vertices in vertices.chunks(LANES) {
            for (i, vertex) in vertices.iter().enumerate() {
                let path = &slots[vertex.slot as usize];
                self.keys.set_lane(i, path.key);
                self.bounces[i] = path.bounce;
            }
            let Self { keys, bounces, drawn, .. } = &mut *self;
            isa.run(PairsKernel { sampler, keys, bounces, dimension, drawn });
            for i in 0..vertices.len() {
                self.pairs.push([self.drawn[0][i], self.drawn[1][i]]);
            }
        }
        &self.pairs
    }
}

struct PairsKernel<'a, D> {
    sampler: &'a Sampler,
    keys: &'a SampleKeys<LANES>,
    bounces: &'a [u32; LANES],
    dimension: D,
    drawn: &'a mut [[f32; LANES]; 2],
}

impl<D: Fn(u32) -> Dimension> Kernel for PairsKernel<'_, D> {
    #[inline(always)]
    fn run(self) {
        let Self { sampler, keys, bounces, dimension, drawn } = self;
        keys.two(sampler, |i| dimension(bounces[i]), drawn);
    }
}
