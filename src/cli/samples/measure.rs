//! `glint samples measure`: discrepancies, distances, projections, spectra and errors of integration, as a table or JSON.

use super::exhibits::Sets;
use crate::cli::{DONE, report};
use crate::error::{Error, Result};
use crate::lab::exhibit::{Fit, Slopes, slopes};
use crate::lab::listing;
use crate::lab::measure::Measures;
use clap::Args;
use serde::Serialize;

pub(super) const EXAMPLES: &str = "\
Examples:
  glint samples measure --sampler all -n 1024
  glint samples measure --sampler jittered,sobol -n 256 --slopes
  glint samples measure points.txt --json > measures.json

Columns: D*, the star discrepancy; over any box; L2-star, centred, wrap-around and mixture discrepancies: all the smaller the more
even. A range brackets what would take too long to find. Smallest and mean distance to the nearest neighbour on the torus, relative to the
hexagonal lattice as dense. x and y strata: the part of n strata along each axis that holds a point. t: quality of the
(t, m, 2)-net in base 2. Anisotropy of the periodogram along rings: 0 dB where it has no direction.
--slopes: RMS error over 16 sets of the seeds after --seed (grid, halton and hammersley: one set, moved around the torus) with the most
points, and the exponent of n = N, N/4, N/16 and so on that it falls with.";

/// `glint samples measure`.
#[derive(Debug, Args)]
pub(super) struct Measure {
    #[command(flatten)]
    sets: Sets,
    /// Also integrate a disc, a Gaussian, a ramp and the zone plate with ever more points, up to -n: errors and exponents
    #[arg(long)]
    slopes: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(in crate::cli) struct Report {
    /// Of glint.
    version: &'static str,
    sets: Vec<Measures>,
    /// Where they were asked for.
    slopes: Vec<Slopes>,
}

impl Report {
    pub(super) fn new(sets: Vec<Measures>, slopes: Vec<Slopes>) -> Self {
        Self { version: env!("CARGO_PKG_VERSION"), sets, slopes }
    }
}

/// Sets of each size that errors are the mean of.
const SEEDS: u64 = 16;

/// Measures as told; the exit code.
pub(super) fn run(args: &Measure) -> Result<u8> {
    let Measure { sets, .. } = args;
    let strategies = sets.strategies()?;
    if args.slopes && strategies.is_empty() {
        let message = "--slopes: a file has one number of points; name strategies with --sampler";
        return Err(Error::Usage(message.into()));
    }
    let measured = sets.measures()?;
    let mut fitted = Vec::new();
    if args.slopes {
        let counts: Vec<u32> =
            (0..5).rev().map(|k| sets.count >> (2 * k)).filter(|n| *n > 0).collect();
        let bar = sets.bar(strategies.len());
        for strategy in strategies {
            fitted.push(slopes(strategy, &counts, sets.seed, SEEDS)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    if sets.json {
        report::json(&Report::new(measured, fitted))?;
        return Ok(DONE);
    }
    report::print(&listing::table(measured.iter()))?;
    if !fitted.is_empty() {
        report::print(&slope_table(&fitted))?;
    }
    Ok(DONE)
}

/// Errors of integration for the largest count, and exponents.
fn slope_table(fitted: &[Slopes]) -> String {
    let mut text = String::from(
        "\nintegration: RMS error with the most points, and the exponent of n that it falls with\n",
    );
    text += &format!("{:26}", "set");
    for fit in fitted.first().map_or(&[][..], |slopes| &slopes.fits) {
        text += &format!("  {:>17}", fit.integrand);
    }
    for slopes in fitted {
        text += &format!("\n{:26}", slopes.name);
        for Fit { rms_errors, exponent, .. } in &slopes.fits {
            let error = rms_errors.last().map_or("-".into(), |error| format!("{error:.2e}"));
            let exponent = exponent.map_or("-".into(), |exponent| format!("{exponent:.2}"));
            text += &format!("  {error:>10} {exponent:>6}");
        }
    }
    text
}
