//! `glint plan`: which effects a scene calls for, why, what they will cost and what is spared; and the same at the head
//! of a render.

use super::args::Render;
use super::backend::Task;
use super::prepare::Prepared;
use super::statistics::PlanRow;
use super::{DONE, plan_table, report};
use crate::accel::Accelerator;
use crate::error::{Error, Result};
use crate::film::Region;
use crate::filter::FilterSampler;
use crate::plan::Plan;
use crate::render::{FORECAST_SIZE, Forecast, forecast};
use crate::trace::Tracer;
use serde::Serialize;

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
            report::print(&lines.join("\n"))?;
        }
        Ok(DONE)
    }
}

/// What it will cost.
///
/// # Errors
/// When threads cannot be started, and where an accelerator cannot be built.
pub(super) fn predict<A: Accelerator>(
    args: &Render,
    prepared: &Prepared,
    accelerator: &A,
) -> Result<Forecast> {
    let Prepared { settings, world, plan, chosen, .. } = prepared;
    let filter = FilterSampler::new(settings.filter);
    let (everything, whole_plan, small) = prepared.everything(FORECAST_SIZE)?;
    let planned = settings.tracer(world, plan, &small, &filter).on(accelerator);
    let whole = settings.tracer(&everything, &whole_plan, &small, &filter);
    let region = shrunk(settings.region, settings.size);
    // An accelerator asks hit filters about what they were wanted for when it was built. Another one for what everything
    // costs takes no time worth saying, unless the scene is a large one: then that cost is left out.
    if everything.geometry.stored_triangles() > REBUILT {
        return forecast(&planned, &whole.on(accelerator), region, args.threads);
    }
    let mut found = None;
    let compared = Compare { planned, whole, region, threads: args.threads, found: &mut found };
    chosen.build(everything.geometry.clone(), &args.build.options(args.threads), compared)?;
    found.ok_or_else(|| Error::Usage("there is no forecast".into()))
}

/// Triangles of the largest scene for whose forecast another accelerator is built.
const REBUILT: usize = 1_000_000;

/// A forecast, once there is an accelerator in which everything runs.
struct Compare<'a, 't, A> {
    planned: Tracer<'t, A>,
    whole: Tracer<'t, ()>,
    region: Region,
    threads: usize,
    found: &'a mut Option<Forecast>,
}

impl<A: Accelerator> Task for Compare<'_, '_, A> {
    fn run<B: Accelerator>(self, _: &'static str, _: String, accelerator: &B) -> Result<u8> {
        let Self { planned, whole, region, threads, found } = self;
        *found = Some(forecast(&planned, &whole.on(accelerator), region, threads)?);
        Ok(DONE)
    }
}

/// The pixels of the forecast's picture that show anything of `region` of a picture of `size`.
fn shrunk(region: Region, size: [u32; 2]) -> Region {
    let scaled = |pixel: u32, k: usize| u64::from(pixel) * u64::from(FORECAST_SIZE[k]);
    Region {
        start: [0, 1].map(|k| (scaled(region.start[k], k) / u64::from(size[k])) as u32),
        end: [0, 1].map(|k| scaled(region.end[k], k).div_ceil(u64::from(size[k])) as u32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crop_is_forecast_from_what_it_shows() {
        let crop = |start, end, size| shrunk(Region { start, end }, size);
        assert_eq!(crop([0, 0], [1280, 720], [1280, 720]), Region::full(FORECAST_SIZE));
        let part = crop([635, 0], [645, 10], [1280, 720]);
        assert_eq!(part, Region { start: [63, 0], end: [65, 1] });
        let tiny = crop([3, 3], [4, 4], [4, 4]);
        assert_eq!(tiny, Region { start: [96, 54], end: FORECAST_SIZE });
    }
}
