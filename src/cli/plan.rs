//! `glint plan`: which effects a scene calls for, why, what they will cost and what is spared; and the same at the head
//! of a render.

use super::args::Render;
use super::backend::Task;
use super::prepare::Prepared;
use super::statistics::PlanRow;
use super::{DONE, plan_table, report};
use crate::accel::Accelerator;
use crate::error::Result;
use crate::filter::FilterSampler;
use crate::plan::Plan;
use crate::render::{FORECAST_SIZE, Forecast, forecast};
use serde::Serialize;
use std::io::Write;

/// What `glint plan --json` prints.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct PlanReport {
    /// Of glint.
    version: &'static str,
    effects: String,
    plan: Vec<PlanRow>,
    /// Names of the stages that run, in their order.
    stages: Vec<&'static str>,
    /// Seconds that the render will take, all threads together.
    predicted_worker_seconds: f64,
    /// The same if everything ran.
    predicted_worker_seconds_of_all: f64,
    /// Part of the light that is lost by what the user left out; negative where noise is larger than the loss.
    dropped_energy: Option<f64>,
}

impl PlanReport {
    pub(super) fn new(prepared: &Prepared, forecast: &Forecast) -> Self {
        let Prepared { plan, settings, .. } = prepared;
        let seconds = forecast.seconds(prepared.paths());
        Self {
            version: env!("CARGO_PKG_VERSION"),
            effects: settings.effects.to_string(),
            plan: rows(plan, Some(forecast)),
            stages: plan.stages().map(|stage| stage.name()).collect(),
            predicted_worker_seconds: seconds,
            predicted_worker_seconds_of_all: seconds * forecast.spared(),
            dropped_energy: forecast.dropped(&settings.effects),
        }
    }
}

/// The rows of the table, with what is predicted where something is.
pub(super) fn rows(plan: &Plan, forecast: Option<&Forecast>) -> Vec<PlanRow> {
    plan.rows.iter().map(|row| PlanRow::new(row, forecast)).collect()
}

/// Says what would be rendered; the exit code.
pub(super) fn run(args: &Render) -> Result<u8> {
    let prepared = Prepared::new(args)?;
    let geometry = prepared.world.geometry.clone();
    let options = args.build.options(args.threads);
    let chosen = prepared.chosen;
    chosen.build(geometry, &options, Show { args, prepared: &prepared })
}

struct Show<'a> {
    args: &'a Render,
    prepared: &'a Prepared,
}

impl Task for Show<'_> {
    fn run<A: Accelerator>(self, _: &'static str, _: String, accelerator: &A) -> Result<u8> {
        let Self { args, prepared } = self;
        let forecast = predict(args, prepared, accelerator)?;
        prepared.busy.finish_and_clear();
        let lines = plan_table::whole(prepared, &forecast);
        if args.json {
            report::say_all(args, &lines);
            report::json(&PlanReport::new(prepared, &forecast))?;
        } else {
            let _ = writeln!(std::io::stdout(), "{}", lines.join("\n"));
        }
        Ok(DONE)
    }
}

/// What it will cost.
///
/// # Errors
/// When threads cannot be started.
pub(super) fn predict<A: Accelerator>(
    args: &Render,
    prepared: &Prepared,
    accelerator: &A,
) -> Result<Forecast> {
    let Prepared { settings, world, plan, camera, .. } = prepared;
    let filter = FilterSampler::new(settings.filter);
    let tracer = settings.tracer(world, plan, camera, &filter).on(accelerator);
    let (everything, whole_plan, small) = prepared.everything(FORECAST_SIZE)?;
    forecast(&tracer, &small, (&everything, &whole_plan), args.threads)
}
