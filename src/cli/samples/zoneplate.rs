//! `glint samples zoneplate`: the rings that show aliasing, sampled by any strategy and reconstructed with any filter; or a
//! table of how far all of them are from the truth.

use crate::cli::values::{filter, sampler};
use crate::cli::{DONE, progress, report};
use crate::error::{Error, Result};
use crate::filter::{Filter, FilterKind, FilterSampler};
use crate::image::{check_writable, srgb, write_png};
use crate::lab::zone_plate::{ZonePlate, rms_difference};
use crate::sampling::Strategy;
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;

pub(super) const EXAMPLES: &str = "\
Examples:
  glint samples zoneplate --sampler grid --spp 1 --filter box -o aliased.png
  glint samples zoneplate --sampler sobol --spp 16 -o rings.png
  glint samples zoneplate --exact --filter lanczos -o truth.png
  glint samples zoneplate --table --spp 1,4,16,64";

/// `glint samples zoneplate`.
#[derive(Debug, Args)]
pub(super) struct Zoneplate {
    /// Picture to write, .png
    #[arg(short, long, value_name = "FILE.png", required_unless_present = "table")]
    output: Option<PathBuf>,
    /// Strategy of sampling, as of glint render; the grid is not shifted, and so is biased
    #[arg(long, value_name = "NAME", default_value = "sobol", value_parser = sampler)]
    sampler: Strategy,
    /// Samples per pixel; of a table, several: 1,4,16
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "4",
          value_parser = clap::value_parser!(u64).range(1..=65_536))]
    spp: Vec<u64>,
    /// Filter: box, tent, gaussian, mitchell, blackman-harris or lanczos
    #[arg(long, value_name = "NAME[:RADIUS]", default_value = "blackman-harris", value_parser = filter)]
    filter: Filter,
    /// Pixels along a side
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=8192))]
    size: u32,
    /// Random seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// The truth instead of samples: the integral of rings times filter
    #[arg(long, conflicts_with_all = ["table", "sampler", "spp", "json"])]
    exact: bool,
    /// RMS error and seconds of every strategy with every filter
    #[arg(long, conflicts_with_all = ["output", "sampler", "filter"])]
    table: bool,
    /// Print the errors as JSON to standard output
    #[arg(long)]
    json: bool,
    /// Print nothing but errors and what was asked for
    #[arg(short, long)]
    quiet: bool,
}

/// How far a sampled picture is from the truth.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(in crate::cli) struct Run {
    sampler: &'static str,
    filter: String,
    samples_per_pixel: u64,
    /// Root mean square error of the pixels, whose range is 0 to 1.
    rmse: f64,
    seconds: f64,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(in crate::cli) struct Report {
    /// Of glint.
    version: &'static str,
    /// Pixels along a side.
    size: u32,
    runs: Vec<Run>,
}

/// Draws or tabulates as told; the exit code.
pub(super) fn run(args: &Zoneplate) -> Result<u8> {
    let runs = if args.table { table(args)? } else { vec![picture(args)?] };
    if args.json {
        report::json(&Report { version: env!("CARGO_PKG_VERSION"), size: args.size, runs })?;
    } else if args.table {
        report::print(&text(&runs, &args.spp))?;
    }
    Ok(DONE)
}

fn picture(args: &Zoneplate) -> Result<Run> {
    let (Some(path), [samples]) = (&args.output, &args.spp[..]) else {
        return Err(Error::Usage("--spp: a picture has one number of samples".into()));
    };
    if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        let name = path.display();
        return Err(Error::Usage(format!("-o {name}: the ending must be .png")));
    }
    check_writable(path)?;
    let plate = ZonePlate { size: args.size };
    let truth = plate.exact(args.filter);
    let (pixels, run) = match args.exact {
        true => {
            (truth, Run { samples_per_pixel: 0, ..Run::new(args.sampler, args.filter, *samples) })
        }
        false => sampled(plate, args.sampler, args.filter, *samples, args.seed, &truth),
    };
    // Shown as bright as it is measured: fine rings and their mean then look alike from afar.
    let shown: Vec<[u8; 1]> = pixels.iter().map(|v| [srgb::encode8(*v as f32)]).collect();
    write_png(path, &shown, args.size, args.size)?;
    if !args.quiet {
        let error = match args.exact {
            true => String::new(),
            false if args.sampler == Strategy::Grid => {
                format!(": RMS error {:.5} (biased)", run.rmse)
            }
            false => format!(": RMS error {:.5}", run.rmse),
        };
        let _ = writeln!(io::stderr(), "wrote {}{error}", path.display());
    }
    Ok(run)
}

/// A picture, and how far it is from the truth.
fn sampled(
    plate: ZonePlate,
    strategy: Strategy,
    filter: Filter,
    samples: u64,
    seed: u64,
    truth: &[f64],
) -> (Vec<f64>, Run) {
    let draw = FilterSampler::new(filter);
    let start = Instant::now();
    let pixels = plate.sampled(strategy, seed, &draw, samples);
    let seconds = start.elapsed().as_secs_f64();
    let rmse = rms_difference(&pixels, truth);
    (pixels, Run { rmse, seconds, ..Run::new(strategy, filter, samples) })
}

impl Run {
    fn new(strategy: Strategy, filter: Filter, samples_per_pixel: u64) -> Self {
        Self {
            sampler: strategy.name(),
            filter: filter.to_string(),
            samples_per_pixel,
            rmse: 0.0,
            seconds: 0.0,
        }
    }
}

fn table(args: &Zoneplate) -> Result<Vec<Run>> {
    let plate = ZonePlate { size: args.size };
    let strategies = || Strategy::ALL.iter().copied().filter(|strategy| strategy.can_render());
    let steps = FilterKind::ALL.len() * strategies().count() * args.spp.len();
    let bar = progress::steps(steps, args.quiet);
    let mut runs = Vec::new();
    for (_, kind, radius) in FilterKind::ALL {
        let filter = Filter { kind, radius };
        let truth = plate.exact(filter);
        for strategy in strategies() {
            for samples in &args.spp {
                runs.push(sampled(plate, strategy, filter, *samples, args.seed, &truth).1);
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    Ok(runs)
}

/// A line for each filter and sampler, with error and seconds for each number of samples.
fn text(runs: &[Run], spp: &[u64]) -> String {
    let mut text = format!("{:26} {:26}", "filter", "sampler");
    for samples in spp {
        text += &format!("  {:>8} {:>6}", format!("{samples} spp"), "s");
    }
    for row in runs.chunks(spp.len()) {
        if let Some(first) = row.first() {
            text += &format!("\n{:26} {:26}", first.filter, first.sampler);
        }
        for run in row {
            text += &format!("  {:>8.5} {:>6.2}", run.rmse, run.seconds);
        }
    }
    text
}
