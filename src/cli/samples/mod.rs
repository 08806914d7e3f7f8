//! `glint samples`: the commands of the sampling laboratory, each in a file of its own with its options.

mod stipple;

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
    /// Draws a picture with dots: weighted Voronoi stippling.
    #[command(after_help = stipple::EXAMPLES)]
    Stipple(stipple::Stipple),
}

/// Does as told; the exit code.
pub(super) fn run(args: &Samples) -> Result<u8> {
    match &args.command {
        Command::Stipple(args) => stipple::run(args),
    }
}
