//! `glint samples plot`: sets of points to look at, side by side on a page, or one a file.

use super::exhibits::Sets;
use super::measure::Report;
use crate::cli::output::identity;
use crate::cli::{DONE, report};
use crate::error::{Error, Result};
use crate::image::{check_writable, write_png, write_whole};
use crate::lab::exhibit::Exhibit;
use crate::lab::picture;
use crate::study::report::{panel, samples_page};
use clap::Args;
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

/// Draws as told; the exit code.
pub(super) fn run(args: &Plot) -> Result<u8> {
    let formats: Vec<Format> =
        args.output.iter().map(|path| format(path)).collect::<Result<_>>()?;
    let mut taken: Vec<PathBuf> = args.sets.files().iter().map(|file| identity(file)).collect();
    for path in &args.output {
        // A drawing over a file of points, or two in one place, would lose one of them.
        let same = identity(path);
        if taken.contains(&same) {
            let name = path.display();
            let message =
                format!("-o {name}: it is read, or would be written twice; name another file");
            return Err(Error::Usage(message));
        }
        taken.push(same);
        check_writable(path)?;
    }
    let exhibits = args.sets.exhibits()?;
    let mut written = Vec::new();
    for (path, format) in args.output.iter().zip(formats) {
        if format == Format::Html {
            let page = samples_page(&exhibits);
            write_whole(path, |file| file.write_all(page.as_bytes()))?;
            written.push(path.clone());
            continue;
        }
        for exhibit in &exhibits {
            let path = if exhibits.len() == 1 { path.clone() } else { named(path, exhibit) };
            if format == Format::Svg {
                let drawing = panel(exhibit);
                write_whole(&path, |file| file.write_all(drawing.as_bytes()))?;
            } else {
                let (pixels, [width, height]) = picture::of(exhibit);
                write_png(&path, &pixels, width, height)?;
            }
            written.push(path);
        }
    }
    if !args.sets.quiet {
        let names: Vec<_> = written.iter().map(|path| path.display().to_string()).collect();
        let _ = writeln!(io::stderr(), "wrote {}", names.join(", "));
    }
    if args.sets.json {
        let measures = exhibits.into_iter().map(|exhibit| exhibit.measures);
        report::json(&Report::new(measures.collect(), Vec::new()))?;
    }
    Ok(DONE)
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
fn named(path: &Path, exhibit: &Exhibit) -> PathBuf {
    let part =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(path.file_stem()), part(path.extension()));
    // Names of files are paths: no part of them may lead elsewhere.
    let name = exhibit.measures.name.replace(['/', '\\'], "_");
    path.with_file_name(format!("{stem}-{name}.{ending}"))
}
