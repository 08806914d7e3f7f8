//! Pairs of random numbers for many vertices at once, in vector instructions.

use super::Vertex;
use super::generate_stage::LANES;
use super::path::Path;
use crate::os::{Isa, Kernel};
use crate::sampling::{Dimension, PathSamplers, Sampler};

struct PairsKernel<'a, D> {
    samplers: &'a PathSamplers<LANES>,
    bounces: &'a [u32; LANES],
    dimension: D,
    pairs: &'a mut [[f32; 2]; LANES],
}

impl<D: Fn(u32) -> Dimension> Kernel for PairsKernel<'_, D> {
    #[inline(always)]
    fn run(self) {
        let Self { samplers, bounces, dimension, pairs } = self;
        let [x, y] = samplers.two(|i| dimension(bounces[i]));
        for i in 0..LANES {
            pairs[i] = [x[i], y[i]];
        }
    }
}

/// Fills `pairs` with the numbers `dimension(bounce)` of every vertex, in their order.
pub(super) fn draw_pairs(
    isa: Isa,
    sampler: &Sampler,
    (vertices, slots): (&[Vertex], &[Path]),
    dimension: impl Fn(u32) -> Dimension + Copy,
    pairs: &mut Vec<[f32; 2]>,
) {
    pairs.clear();
    for vertices in vertices.chunks(LANES) {
        let paths = vertices.iter().map(|vertex| &slots[vertex.slot as usize]);
        let samplers = &PathSamplers::gather(sampler, paths.clone().map(|path| path.sampler));
        let mut bounces = [0; LANES];
        for (bounce, path) in bounces.iter_mut().zip(paths) {
            *bounce = path.bounce;
        }
        let mut drawn = [[0.0; 2]; LANES];
        isa.run(PairsKernel { samplers, bounces: &bounces, dimension, pairs: &mut drawn });
        pairs.extend_from_slice(&drawn[..vertices.len()]);
    }
}
