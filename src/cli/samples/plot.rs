//! `glint samples plot`: sets of points to look at, side by side on a page, or one a file.

use super::exhibits::Sets;
use super::measure::Report;
use crate::cli::output::identity;
use crate::cli::{DONE, report};
use crate::error::{Error, Result};
use crate::image::{check_writable, write_png, write_whole};
use crate::lab::picture;
use crate::study::report::{panel, samples_page};
use clap::Args;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

pub(super) const EXAMPLES: &str = "\
Examples:
  glint samples plot -o samples.html
      every strategy, 256 points each
  glint samples plot --sampler jittered,sobol -n 1024 -o set.svg
      set-jittered.svg and set-sobol.svg
  glint samples plot points.txt -o points.svg";

/// `glint samples plot`.
#[derive(Debug, Args)]
pub(super) struct Plot {
    #[command(flatten)]
    sets: Sets,
    /// Page or drawing to write: .html, .svg or .png (points beside their periodogram); may be repeated. Of several sets,
    /// drawings have the set's name before their ending
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Html,
    Svg,
    Png,
}

/// A file to write, and of which set: none for a page of all.
struct Target {
    path: PathBuf,
    format: Format,
    set: Option<usize>,
}

/// The most points of a drawing: more would be some ten megabytes a set.
const MOST_DRAWN: usize = 32_768;

/// Draws as told; the exit code.
pub(super) fn run(args: &Plot) -> Result<u8> {
    let targets = targets(args)?;
    let exhibits = args.sets.exhibits(MOST_DRAWN)?;
    for Target { path, format, set } in &targets {
        match (format, set.map(|set| &exhibits[set])) {
            (Format::Svg, Some(exhibit)) => {
                let drawing = panel(exhibit);
                write_whole(path, |file| file.write_all(drawing.as_bytes()))?;
            }
            (Format::Png, Some(exhibit)) => {
                let (pixels, [width, height]) = picture::of(exhibit);
                write_png(path, &pixels, width, height)?;
            }
            _ => {
                let page = samples_page(&exhibits);
                write_whole(path, |file| file.write_all(page.as_bytes()))?;
            }
        }
    }
    if !args.sets.quiet {
        let names: Vec<_> = targets.iter().map(|t| t.path.display().to_string()).collect();
        let _ = writeln!(io::stderr(), "wrote {}", names.join(", "));
    }
    if args.sets.json {
        let measures = exhibits.into_iter().map(|exhibit| exhibit.measures);
        report::json(&Report::new(measures.collect(), Vec::new()))?;
    }
    Ok(DONE)
}

/// Every file that will be written.
///
/// # Errors
/// A usage error for an unknown ending, and for a file that is read, too, or would be written twice; where one cannot
/// be written.
fn targets(args: &Plot) -> Result<Vec<Target>> {
    let strategies = args.sets.strategies()?;
    let of_files = args.sets.files().iter().map(|file| {
        let name = file.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    });
    let names: Vec<String> =
        of_files.chain(strategies.iter().map(|strategy| strategy.name().to_owned())).collect();
    let mut targets = Vec::new();
    for path in &args.output {
        let format = format(path)?;
        if format == Format::Html {
            targets.push(Target { path: path.clone(), format, set: None });
            continue;
        }
        for (set, name) in names.iter().enumerate() {
            let path = if names.len() == 1 { path.clone() } else { named(path, name) };
            targets.push(Target { path, format, set: Some(set) });
        }
    }
    let mut taken: Vec<PathBuf> = args.sets.files().iter().map(|file| identity(file)).collect();
    for Target { path, .. } in &targets {
        let same = identity(path);
        if taken.contains(&same) {
            let name = path.display();
            let message =
                format!("{name}: it is read, or would be written twice; name another file");
            return Err(Error::Usage(message));
        }
        taken.push(same);
        check_writable(path)?;
    }
    Ok(targets)
}

/// # Errors
/// A usage error for another ending.
fn format(path: &Path) -> Result<Format> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        Some("html") => Ok(Format::Html),
        Some("svg") => Ok(Format::Svg),
        Some("png") => Ok(Format::Png),
        _ => {
            let name = path.display();
            Err(Error::Usage(format!("-o {name}: the ending must be .html, .svg or .png")))
        }
    }
}

/// `set.svg` of a set named `sobol`: `set-sobol.svg`.
fn named(path: &Path, set: &str) -> PathBuf {
    let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(path.file_stem()), part(path.extension()));
    path.with_file_name(format!("{stem}-{set}.{ending}"))
}
