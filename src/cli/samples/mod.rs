//! `glint samples`: the commands of the sampling laboratory, each in a file of its own with its options.

mod exhibits;
pub(super) mod measure;
mod plot;
pub(super) mod stipple;
pub(super) mod zoneplate;

use crate::error::Result;
use clap::{Args, Subcommand};

/// `glint samples`.
#[derive(Debug, Args)]
pub(super) struct Samples {
    #[command(subcommand)]
    command: Command,
}

/// The commands of the laboratory.
#[derive(Debug, Subcommand)]
enum Command {
    /// Draws sets of points: with projections, Voronoi cells, periodogram and measures, side by side
    #[command(after_help = plot::EXAMPLES)]
    Plot(plot::Plot),
    /// Measures sets of points: discrepancies, distances, projections, spectra, errors of integration
    #[command(after_help = measure::EXAMPLES)]
    Measure(measure::Measure),
    /// Samples the zone plate, whose rings show how a strategy and a filter deal with aliasing
    #[command(after_help = zoneplate::EXAMPLES)]
    Zoneplate(zoneplate::Zoneplate),
    /// Draws a picture with dots: weighted Voronoi stippling
    #[command(after_help = stipple::EXAMPLES)]
    Stipple(stipple::Stipple),
}

/// Does as told; the exit code.
pub(super) fn run(args: &Samples) -> Result<u8> {
    match &args.command {
        Command::Plot(args) => plot::run(args),
        Command::Measure(args) => measure::run(args),
        Command::Zoneplate(args) => zoneplate::run(args),
        Command::Stipple(args) => stipple::run(args),
    }
}
