//! `glint generate`: a procedural model as OBJ, MTL and, where leaves are cut out, PNG.
//!
//! The small files are written while the large one waits to be renamed: all of them appear, or none.

use super::args::Generate;
use super::progress::{BAR, style};
use super::render::stop_flag;
use super::{DONE, INTERRUPTED};
use crate::error::{Error, Result};
use crate::generate::{FEWEST_TRIANGLES, Model, Written, cut_out, material_library, write_obj};
use crate::image::{check_writable, write_png, write_whole};
use indicatif::{ProgressBar, ProgressDrawTarget};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// What takes less than this needs no bar.
const SHORT: Duration = Duration::from_secs(2);

/// Generates as told; the exit code.
pub(super) fn run(args: &Generate) -> Result<u8> {
    let start = Instant::now();
    let names = Names::check(args)?;
    let stop = stop_flag()?;
    stop.store(false, Ordering::Relaxed);
    let model = Model { kind: args.kind, triangles: args.triangles, seed: args.seed };
    let bar = ProgressBar::with_draw_target(Some(model.triangles), ProgressDrawTarget::hidden());
    let mut tell = |done| {
        if bar.is_hidden() && !args.quiet && start.elapsed() > SHORT {
            bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
            bar.set_style(style(BAR));
        }
        bar.set_position(done);
        if stop.load(Ordering::Relaxed) { Err(io::ErrorKind::Interrupted.into()) } else { Ok(()) }
    };
    let mut written = Written::default();
    let outcome = write_whole(&names.obj, |file| {
        written = write_obj(&model, names.library_name(), file, &mut tell)?;
        names.write_others(&model).map_err(io::Error::other)
    });
    bar.finish_and_clear();
    let say = |line: &str| {
        if !args.quiet {
            let _ = writeln!(io::stderr(), "{line}");
        }
    };
    if outcome.is_err() && stop.load(Ordering::Relaxed) {
        say("interrupted: nothing is written");
        return Ok(INTERRUPTED);
    }
    outcome?;
    let seconds = start.elapsed().as_secs_f64();
    let Written { triangles, vertices, bytes } = written;
    say(&format!(
        "wrote {}: {triangles} triangles, {vertices} vertices, {bytes} bytes in {seconds:.2} s \
         ({:.2} M triangles/s, {:.0} MB/s)",
        names.listed(&model),
        triangles as f64 / seconds / 1e6,
        bytes as f64 / seconds / 1e6
    ));
    Ok(DONE)
}

/// The files to write, each known to be writable.
struct Names {
    obj: PathBuf,
    library: PathBuf,
    cut_out: PathBuf,
}

impl Names {
    /// # Errors
    /// A usage error for too few triangles or a name that OBJ cannot hold; [`Error::Io`] where a file could
    /// not be written.
    fn check(args: &Generate) -> Result<Self> {
        if args.triangles < FEWEST_TRIANGLES {
            let message = format!("--triangles: a model has at least {FEWEST_TRIANGLES}");
            return Err(Error::Usage(message));
        }
        let obj = args.output.clone();
        let refused = |reason: &str| Err(Error::Usage(format!("-o {}: {reason}", obj.display())));
        if obj.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("obj")) {
            return refused("the ending must be .obj");
        }
        let Some(stem) = obj.file_stem().and_then(|stem| stem.to_str()) else {
            return refused("the name must be text");
        };
        // The model and its library name their neighbours in lines of text.
        if stem.trim() != stem || stem.contains(|c: char| c.is_control() || c == '#' || c == '\\') {
            return refused("an OBJ file cannot name its material library after this");
        }
        let names = Self {
            library: obj.with_file_name(format!("{stem}.mtl")),
            cut_out: obj.with_file_name(format!("{stem}-leaf.png")),
            obj,
        };
        check_writable(&names.obj)?;
        check_writable(&names.library)?;
        if args.kind.has_cut_out() {
            check_writable(&names.cut_out)?;
        }
        Ok(names)
    }

    fn library_name(&self) -> &str {
        file_name(&self.library)
    }

    /// Writes what stands beside the OBJ file.
    fn write_others(&self, model: &Model) -> Result<()> {
        if model.kind.has_cut_out() {
            let (texels, side) = cut_out();
            write_png(&self.cut_out, &texels, side, side)?;
        }
        let library = material_library(model.kind, file_name(&self.cut_out));
        write_whole(&self.library, |file| file.write_all(library.as_bytes()))
    }

    /// What was written, for the closing line.
    fn listed(&self, model: &Model) -> String {
        let cut_out = model.kind.has_cut_out().then_some(&self.cut_out);
        let names = [Some(&self.obj), Some(&self.library), cut_out];
        let names: Vec<_> = names.iter().flatten().map(|p| p.display().to_string()).collect();
        names.join(", ")
    }
}

/// [`Names::check`] has seen that it is text.
fn file_name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}
