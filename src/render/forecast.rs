//! A forecast: a small picture of the scene, traced with what will run and with everything, tells what each effect will
//! cost and what is spared by leaving the others out.

use super::{RenderJob, render};
use crate::accel::Accelerator;
use crate::camera::Camera;
use crate::error::Result;
use crate::film::Region;
use crate::ledger::Ledger;
use crate::plan::Plan;
use crate::trace::{Tracer, Wavefront};
use crate::world::World;

/// What a small picture took.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// With what will run.
    pub planned: Ledger,
    /// With everything; hit filters are asked only where there is something to cut out.
    pub everything: Ledger,
}

/// Of the small picture, in pixels and a pixel.
pub const FORECAST_SIZE: [u32; 2] = [128, 72];
const SAMPLES: u64 = 2;

/// Traces small pictures of the scene of `tracer` with `camera`, which is its own for a picture of
/// [`FORECAST_SIZE`]; `everything` is the world in which everything runs, with its plan.
///
/// # Errors
/// When threads cannot be started.
pub fn forecast<A: Accelerator>(
    tracer: &Tracer<'_, A>,
    camera: &Camera,
    (world, plan): (&World, &Plan),
    threads: usize,
) -> Result<Forecast> {
    let job = RenderJob {
        region: Region::full(FORECAST_SIZE),
        samples_per_pixel: SAMPLES,
        threads,
        batch: Wavefront::DEFAULT_BATCH,
        stop: None,
    };
    let with = |world, plan| {
        let Tracer { accelerator, filter, sampler, .. } = *tracer;
        let tracer = Tracer { world, accelerator, camera, filter, sampler, plan };
        render(&tracer, &job, &|_| ()).map(|rendered| rendered.ledger)
    };
    // The first touches what the others find in the cache.
    with(tracer.world, tracer.plan)?;
    let planned = with(tracer.world, tracer.plan)?;
    Ok(Forecast { planned, everything: with(world, plan)? })
}

impl Forecast {
    /// Worker seconds that `paths` paths will take.
    pub fn seconds(&self, paths: u64) -> f64 {
        self.planned.worker_seconds / self.planned.camera_rays().max(1) as f64 * paths as f64
    }
}
