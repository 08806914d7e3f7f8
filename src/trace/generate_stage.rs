//! Stage "generate": camera rays for many paths at once, in vector instructions.

use super::path::Path;
use super::{BlockPaths, CameraStart, RayKind, Tracer};
use crate::accel::Accelerator;
use crate::camera::CameraRays;
use crate::os::{Isa, Kernel};
use crate::sampling::{Dimension, SampleKeys, Sampler};

/// Paths that a kernel starts together.
pub(super) const LANES: usize = 64;

/// Which samples of which pixels are to be started, and what [`Tracer::camera_ray`] gives each. The memory is
/// kept from batch to batch.
pub(super) struct Starts {
    count: usize,
    /// Columns and rows.
    pixels: [[u32; LANES]; 2],
    samples: [u64; LANES],
    /// The cell that each pixel is watched for, or [`Path::UNWATCHED`].
    cells: [u32; LANES],
    keys: SampleKeys<LANES>,
    /// Where on the film, in pixels, and with what weight.
    film: [[f32; LANES]; 2],
    weights: [f32; LANES],
    /// Where on the lens; its middle is a pinhole.
    lens: [[f32; LANES]; 2],
    rays: CameraRays<LANES>,
}

impl Starts {
    pub(super) fn new() -> Self {
        Self {
            count: 0,
            pixels: [[0; LANES]; 2],
            samples: [0; LANES],
            cells: [Path::UNWATCHED; LANES],
            keys: SampleKeys::new(),
            film: [[0.0; LANES]; 2],
            weights: [0.0; LANES],
            lens: [[0.5; LANES]; 2],
            rays: CameraRays::NONE,
        }
    }

    /// Takes the next samples of a block, at most `limit` and [`LANES`]; returns how many.
    pub(super) fn take(&mut self, block: &mut BlockPaths, limit: usize) -> usize {
        self.count = 0;
        let watch = block.block.watch;
        // The samples of a pixel follow each other.
        let mut last = ([u32::MAX; 2], Path::UNWATCHED);
        for (pixel, sample) in block.take(limit.min(LANES)) {
            if pixel != last.0 {
                last = (pixel, watch.cell(pixel).unwrap_or(Path::UNWATCHED));
            }
            self.cells[self.count] = last.1;
            self.pixels[0][self.count] = pixel[0];
            self.pixels[1][self.count] = pixel[1];
            self.samples[self.count] = sample;
            self.count += 1;
        }
        self.count
    }

    /// Draws the points on the film of what was taken. Idle lanes draw for what is left there from before.
    pub(super) fn film<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, isa: Isa) {
        isa.run(FilmKernel { tracer, starts: self });
    }

    /// Draws points on the lens, in place of its middle.
    pub(super) fn lens(&mut self, sampler: &Sampler, isa: Isa) {
        isa.run(LensKernel { sampler, starts: self });
    }

    /// Makes the rays.
    pub(super) fn rays<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, isa: Isa) {
        isa.run(RayKernel { tracer, starts: self });
    }

    /// The paths that were started.
    #[inline]
    pub(super) fn paths<A>(&self, tracer: &Tracer<'_, A>) -> impl Iterator<Item = Path> {
        (0..self.count).map(|i| {
            let key = self.keys.lane(i);
            let mut camera = self.rays.lane(i);
            camera.ray.id = tracer.ray_id(key, 0, RayKind::Path);
            let start = CameraStart { key, weight: self.weights[i], camera };
            let pixel = [self.pixels[0][i], self.pixels[1][i]];
            Path::begin(&start, pixel, self.samples[i], self.cells[i])
        })
    }
}

struct FilmKernel<'a, 't, A> {
    tracer: &'a Tracer<'t, A>,
    starts: &'a mut Starts,
}

impl<A: Accelerator> Kernel for FilmKernel<'_, '_, A> {
    #[inline(always)]
    fn run(self) {
        let Starts { pixels, samples, keys, film, weights, .. } = self.starts;
        let mut pairs = [[0.5; LANES]; 2];
        keys.begin(&self.tracer.sampler, pixels, samples);
        keys.two(&self.tracer.sampler, |_| Dimension::Film, &mut pairs);
        self.tracer.filter.sample_lanes(&pairs, film, weights);
        for (film, pixels) in film.iter_mut().zip(pixels) {
            for (film, &mut pixel) in film.iter_mut().zip(pixels) {
                *film += pixel as f32 + 0.5;
            }
        }
    }
}

struct LensKernel<'a> {
    sampler: &'a Sampler,
    starts: &'a mut Starts,
}

impl Kernel for LensKernel<'_> {
    #[inline(always)]
    fn run(self) {
        self.starts.keys.two(self.sampler, |_| Dimension::Lens, &mut self.starts.lens);
    }
}

struct RayKernel<'a, 't, A> {
    tracer: &'a Tracer<'t, A>,
    starts: &'a mut Starts,
}

impl<A: Accelerator> Kernel for RayKernel<'_, '_, A> {
    #[inline(always)]
    fn run(self) {
        let Starts { film, lens, rays, .. } = self.starts;
        self.tracer.camera.rays(film, lens, rays);
    }
}
