//! The command line: words to jobs, jobs to exit codes. The only place that prints.
//!
//! Exit codes: 0 done; 1 failed; 2 wrong usage; 3 done, but something asked for was not met; 130 ended by a
//! signal with nothing written.

mod args;
mod backend;
mod bench;
mod compare;
mod generate;
mod ledger_table;
mod options;
mod output;
mod plan;
mod plan_table;
mod prepare;
mod progress;
mod render;
mod report;
mod samples;
mod select;
mod statistics;
mod values;

use crate::error::{Error, Result};
use crate::os::Isa;
use clap::Parser;
use std::process::ExitCode;

/// Done.
const DONE: u8 = 0;
/// Failed.
const FAILED: u8 = 1;
/// Wrong usage.
const USAGE: u8 = 2;
/// Done, but something that was asked for was not met.
const NOT_MET: u8 = 3;
/// Ended by a signal, with nothing to show for it.
const INTERRUPTED: u8 = 130;

/// Runs the command that the process was started with.
pub fn main() -> ExitCode {
    let args = args::Glint::parse();
    let code = match args.command {
        args::Command::Render(args) => render::run(&args),
        args::Command::Plan(args) => plan::run(&args),
        args::Command::Bench(args) => bench::run(&args),
        args::Command::Compare(args) => compare::run(&args),
        args::Command::Generate(args) => generate::run(&args),
        args::Command::Samples(args) => samples::run(&args),
    };
    ExitCode::from(code.unwrap_or_else(|error| {
        report::error(&error);
        if matches!(error, Error::Usage(_)) { USAGE } else { FAILED }
    }))
}

/// The instructions to use: those asked for, or the widest of this machine.
fn instructions(wanted: Option<Isa>) -> Result<Isa> {
    match wanted.unwrap_or(Isa::detect()) {
        isa if isa <= Isa::detect() => Ok(isa),
        _ => Err(Error::Usage("--isa: this machine does not have these instructions".into())),
    }
}
