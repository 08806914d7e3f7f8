//! What moves on a terminal while glint works: a spinner, and a bar with the time that is left.
//!
//! All of it goes to stderr, and nothing at all where that is no terminal.

use super::args::Render;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

/// While there is no telling how long it will take.
const SPINNER: &str = "{spinner} {msg} {elapsed_precise}";

/// While there is.
pub(super) const BAR: &str =
    "{bar:40} {percent:>3} %  {elapsed_precise} elapsed, {eta_precise} to go";

/// What takes less than this needs no bar.
const SHORT: Duration = Duration::from_secs(1);

/// A spinner.
pub(super) fn busy(args: &Render, what: &'static str) -> ProgressBar {
    let spinner = shown(args.quiet, None, SPINNER);
    spinner.set_message(what);
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}

/// A bar of so many paths.
pub(super) fn bar(args: &Render, paths: u64) -> ProgressBar {
    shown(args.quiet, Some(paths), BAR)
}

/// A bar of so many steps.
pub(super) fn steps(count: usize, is_quiet: bool) -> ProgressBar {
    shown(is_quiet, Some(count as u64), BAR)
}

/// Makes `spinner` a bar while `done` of `total` bytes are read, if that takes its time.
pub(super) fn reading(spinner: &ProgressBar, done: u64, total: u64) {
    let is_bar = spinner.length().is_some();
    if done < total && spinner.elapsed() > SHORT {
        if !is_bar {
            spinner.set_length(total);
            spinner.set_style(style(&format!("{{msg}} {BAR}")));
        }
        spinner.set_position(done);
    } else if done >= total && is_bar {
        spinner.set_style(style(SPINNER));
        spinner.unset_length();
    }
}

fn shown(is_quiet: bool, length: Option<u64>, template: &str) -> ProgressBar {
    if is_quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr_with_hz(5));
    bar.set_style(style(template));
    bar
}

/// The templates are constants, so an invalid one shows in the first run of a test.
pub(super) fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
