//! A forecast: a small picture of the scene, traced with what will run and with everything, tells what each effect will
//! cost and what is spared by leaving the others out.

use super::{RenderJob, Rendered, render};
use crate::accel::Accelerator;
use crate::error::Result;
use crate::film::Region;
use crate::ledger::Ledger;
use crate::plan::Row;
use crate::scene::{Effects, Style};
use crate::trace::{Tracer, Wavefront};

/// What a small picture took and showed.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// With what will run.
    pub planned: Ledger,
    /// With everything.
    pub everything: Ledger,
    /// Mean luminance of the two.
    light: [f64; 2],
}

/// Of the small picture, in pixels.
pub const FORECAST_SIZE: [u32; 2] = [128, 72];
/// Of the part of it that is traced; more a pixel where that is a small one.
const PATHS: u64 = 36_864;
const TRIALS: usize = 5;

/// Traces small pictures, of [`FORECAST_SIZE`], with what will run and with everything; `region` is the part of them that
/// counts.
///
/// # Errors
/// When threads cannot be started.
pub fn forecast<A: Accelerator, B: Accelerator>(
    planned: &Tracer<'_, A>,
    everything: &Tracer<'_, B>,
    region: Region,
    threads: usize,
) -> Result<Forecast> {
    let job = RenderJob {
        region,
        samples_per_pixel: PATHS.div_ceil(region.pixels().max(1) as u64),
        threads,
        batch: Wavefront::DEFAULT_BATCH,
        stop: None,
    };
    // The two take turns; of each the fastest counts, since whatever else runs on the machine, and a cold cache, can
    // only make it slower.
    let both = || Ok((render(planned, &job, &|_| ())?, render(everything, &job, &|_| ())?));
    let faster = |a: Rendered, b: Rendered| {
        if b.ledger.worker_seconds < a.ledger.worker_seconds { b } else { a }
    };
    let (mut planned, mut everything) = both()?;
    for _ in 1..TRIALS {
        let trial: (Rendered, Rendered) = both()?;
        (planned, everything) = (faster(planned, trial.0), faster(everything, trial.1));
    }
    let light = [&planned, &everything].map(|rendered| {
        let radiance = rendered.film.develop().radiance;
        radiance.iter().map(|r| f64::from(r.luminance())).sum()
    });
    Ok(Forecast { planned: planned.ledger, everything: everything.ledger, light })
}

impl Forecast {
    /// How many times as long it would take if everything ran.
    pub fn spared(&self) -> f64 {
        self.everything.worker_seconds / self.planned.worker_seconds.max(1e-9)
    }

    /// The part of the light that is lost by what `effects` leave out, to some hundredths; `None` where they leave
    /// out nothing, or the picture is not one of light.
    pub fn dropped(&self, effects: &Effects) -> Option<f64> {
        let is_light = effects.style != Style::AmbientOcclusion && self.light[1] > 0.0;
        (is_light && effects.left_out().next().is_some())
            .then(|| 1.0 - self.light[0] / self.light[1])
    }

    /// The part of the time that a row of the plan will take; of one that is off, that it would take if everything ran.
    /// `None` where that cannot be told from the rest.
    pub fn share(&self, row: &Row) -> Option<f64> {
        let ledger = if row.on { &self.planned } else { &self.everything };
        row.seconds(ledger).map(|seconds| seconds / ledger.worker_seconds.max(1e-9))
    }

    /// Worker seconds that `paths` paths will take.
    pub fn seconds(&self, paths: u64) -> f64 {
        self.planned.worker_seconds / self.planned.camera_rays().max(1) as f64 * paths as f64
    }
}
