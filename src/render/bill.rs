//! The bill of a render: what each stage and each class of transport took, and what the classes brought.
//!
//! Tables, statistics and pages all show this one account; it is serialized under `ledger` in the JSON of `glint render`.

use super::Rendered;
use crate::ledger::{Class, ClassRays, Stage};
use serde::Serialize;

/// What a render cost, and what for.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Bill {
    /// Seconds of all threads, in stages or not.
    pub worker_seconds: f64,
    /// Every stage of the wavefront, summed over threads.
    pub stages: Vec<StageRow>,
    /// What hit filters took within the stages that trace rays.
    pub cut_outs: CutOutsRow,
    /// The transport classes that brought any light or took any rays.
    pub classes: Vec<ClassRow>,
    /// Pixels whose light was told apart by class.
    pub watched_pixels: usize,
}

/// One stage.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StageRow {
    /// Its name.
    pub stage: &'static str,
    /// Of all threads.
    pub seconds: f64,
    /// Its part of the worker seconds.
    pub time_share: f64,
    /// Batches.
    pub calls: u64,
    /// Paths or rays in all batches.
    pub rays: u64,
    /// Paths or rays in a batch.
    pub mean_batch: f64,
}

/// The decisions whether a hit counts.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CutOutsRow {
    /// Of all threads, which the stages have counted too; estimated from some of the calls.
    pub seconds: f64,
    /// Its part of the worker seconds.
    pub time_share: f64,
    /// Hits that were decided on.
    pub calls: u64,
}

/// One class of transport.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ClassRow {
    /// Its name.
    pub class: &'static str,
    /// Its stages' seconds, by number of rays.
    pub seconds: f64,
    /// Its part of the worker seconds.
    pub time_share: f64,
    /// From the camera, from surface to surface, and towards lights.
    pub rays: u64,
    /// Its part of the light.
    pub energy_share: f64,
    /// Its part of the noise; `None` where there is none, or fewer than two samples a pixel.
    pub variance_share: Option<f64>,
}

impl Bill {
    /// The account of a finished render.
    pub fn new(rendered: &Rendered) -> Self {
        let Rendered { ledger, film, classes, .. } = rendered;
        let time_share = |seconds: f64| seconds / ledger.worker_seconds.max(1e-9);
        let stage = |&stage: &Stage| {
            let totals = ledger.stage(stage);
            StageRow {
                stage: stage.name(),
                seconds: totals.seconds,
                time_share: time_share(totals.seconds),
                calls: totals.calls,
                rays: totals.items,
                mean_batch: totals.items as f64 / totals.calls.max(1) as f64,
            }
        };
        let (watched_pixels, shares) = classes.shares(film);
        let of_none = shares.iter().find_map(|share| share.variance).map(|_| 0.0);
        let class = |&class: &Class| {
            let ClassRays { path, light } = ledger.class_rays(class);
            let shadow = if ledger.shadow_rays() > 0 { light } else { 0 };
            let share = shares.iter().find(|share| share.class == class);
            let seconds = ledger.class_seconds(class);
            let row = ClassRow {
                class: class.name(),
                seconds,
                time_share: time_share(seconds),
                rays: path + shadow,
                energy_share: share.map_or(0.0, |share| share.energy),
                variance_share: share.map_or(of_none, |share| share.variance),
            };
            (path + light > 0 || share.is_some()).then_some(row)
        };
        let cut_outs = ledger.cut_outs;
        Self {
            worker_seconds: ledger.worker_seconds,
            stages: Stage::ALL.iter().map(stage).collect(),
            cut_outs: CutOutsRow {
                seconds: cut_outs.seconds,
                time_share: time_share(cut_outs.seconds),
                calls: cut_outs.calls,
            },
            classes: Class::ALL.iter().filter_map(class).collect(),
            watched_pixels,
        }
    }

    /// The stages that ran.
    pub fn ran(&self) -> impl Iterator<Item = &StageRow> {
        self.stages.iter().filter(|row| row.calls > 0)
    }
}

impl StageRow {
    /// Nanoseconds that it took for a path or a ray; `None` where it had none.
    pub fn nanoseconds_per_ray(&self) -> Option<f64> {
        (self.rays > 0).then(|| 1e9 * self.seconds / self.rays as f64)
    }
}
