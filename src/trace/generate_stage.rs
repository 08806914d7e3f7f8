//! Stage "generate": camera rays for many paths at once, in vector instructions.

use super::path::Path;
use super::{CameraStart, RayKind, Tracer};
use crate::accel::Accelerator;
use crate::camera::CameraRays;
use crate::os::{Isa, Kernel};
use crate::sampling::{Dimension, PathSamplers};

/// Paths that a kernel starts together.
pub(super) const LANES: usize = 64;

/// Which samples of which pixels are to be started.
#[derive(Clone, Debug)]
pub(super) struct Starts {
    /// Columns and rows.
    pixels: [[u32; LANES]; 2],
    samples: [u64; LANES],
    count: usize,
}

impl Starts {
    /// The next samples of a block: at most `limit` and [`LANES`]. Idle lanes repeat pixel 0.
    pub(super) fn take(block: &mut impl Iterator<Item = ([u32; 2], u64)>, limit: usize) -> Self {
        let mut starts = Self { pixels: [[0; LANES]; 2], samples: [0; LANES], count: 0 };
        for (pixel, sample) in block.take(limit.min(LANES)) {
            let i = starts.count;
            starts.pixels[0][i] = pixel[0];
            starts.pixels[1][i] = pixel[1];
            starts.samples[i] = sample;
            starts.count += 1;
        }
        starts
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }
}

/// What [`Tracer::camera_ray`] gives each of the starts.
pub(super) struct CameraLanes {
    numbers: PathSamplers<LANES>,
    weights: [f32; LANES],
    rays: CameraRays<LANES>,
}

struct CameraKernel<'a, 't, A> {
    tracer: &'a Tracer<'t, A>,
    starts: &'a Starts,
    lanes: &'a mut Option<CameraLanes>,
}

impl<A: Accelerator> Kernel for CameraKernel<'_, '_, A> {
    #[inline(always)]
    fn run(self) {
        let Self { tracer, starts: Starts { pixels, samples, .. }, lanes } = self;
        let numbers = PathSamplers::begin(&tracer.sampler, pixels, samples);
        let mut film = [[0.0; LANES]; 2];
        let mut weights = [0.0; LANES];
        tracer.filter.sample_lanes(&numbers.two(|_| Dimension::Film), &mut film, &mut weights);
        for (film, pixels) in film.iter_mut().zip(pixels) {
            for (film, &pixel) in film.iter_mut().zip(pixels) {
                *film += pixel as f32 + 0.5;
            }
        }
        let lens = match tracer.camera.needs_lens() {
            true => numbers.two(|_| Dimension::Lens),
            false => [[0.5; LANES]; 2],
        };
        let rays = tracer.camera.rays(&film, &lens);
        *lanes = Some(CameraLanes { numbers, weights, rays });
    }
}

impl<A: Accelerator> Tracer<'_, A> {
    /// Camera rays of all `starts`, to `sink`; each is what [`Tracer::camera_ray`] gives.
    pub(super) fn camera_rays(&self, isa: Isa, starts: &Starts, mut sink: impl FnMut(Path)) {
        let mut lanes = None;
        isa.run(CameraKernel { tracer: self, starts, lanes: &mut lanes });
        let Some(CameraLanes { numbers, weights, rays }) = &lanes else { return };
        for i in 0..starts.count {
            let sampler = numbers.lane(i);
            let mut camera = rays.lane(i);
            camera.ray.id = self.ray_id(&sampler, 0, RayKind::Path);
            let start = CameraStart { sampler, weight: weights[i], camera };
            let pixel = [starts.pixels[0][i], starts.pixels[1][i]];
            sink(Path::begin(&start, pixel, starts.samples[i]));
        }
    }
}
