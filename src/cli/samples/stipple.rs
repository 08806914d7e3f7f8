//! `glint samples stipple`: a picture in, the same drawn with dots out, as SVG, PNG or both.

use crate::cli::output::identity;
use crate::cli::progress;
use crate::cli::render::stop_flag;
use crate::cli::values::{count, threads};
use crate::cli::{DONE, INTERRUPTED, report};
use crate::error::{Error, Result};
use crate::image::{ColorSpace, Image, Pixels, check_writable, read, srgb, write_png, write_whole};
use crate::lab::stipple::{Density, Drawing, MAX_POINTS, Settings, Stippling, Tone, stipple};
use clap::Args;
use serde::Serialize;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

pub(super) const EXAMPLES: &str = "\
Examples:
  glint samples stipple portrait.png -n 20000 -o portrait.svg -o dots.png
  glint samples stipple night.png --invert --sized -o stars.svg
      white dots on black paper, each as large as what it stands for is light";

/// `glint samples stipple`.
#[derive(Debug, Args)]
pub(super) struct Stipple {
    /// Picture to draw: .png, .jpg, .tga, .bmp, .hdr or .exr
    image: PathBuf,
    /// Drawing to write, .svg or .png; may be repeated
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    /// Number of dots; k and M multiply it
    #[arg(short = 'n', long, value_name = "N", default_value = "20000", value_parser = count)]
    points: u64,
    /// Random seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Moves of all dots at most; fewer if they come to rest before
    #[arg(long, value_name = "N", default_value_t = 100,
          value_parser = clap::value_parser!(u32).range(..=100_000))]
    iterations: u32,
    /// Radius of the dots in pixels of the picture [default: together as large as the picture is dark]
    #[arg(long, value_name = "R", value_parser = radius, conflicts_with = "sized")]
    radius: Option<f64>,
    /// Make each dot as large as its part of the picture is dark
    #[arg(long)]
    sized: bool,
    /// How light a tone is drawn: 1 as light as it is, measured; 2.2 as light as it looks on a screen
    #[arg(long, value_name = "G", default_value_t = 1.0, value_parser = gamma)]
    gamma: f32,
    /// Draw light with white dots on black paper, instead of shade with black ones on white
    #[arg(long)]
    invert: bool,
    /// Pixels of a PNG file for each of the picture's, along each side
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=64))]
    scale: u32,
    /// Threads; 0 is one a core. The drawing is the same
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = threads)]
    threads: usize,
    /// Print a summary as JSON to standard output
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

fn radius(text: &str) -> std::result::Result<f64, String> {
    let pixels = text.parse().ok().filter(|r: &f64| (1e-3..=1e6).contains(r));
    pixels.ok_or_else(|| "expected a number of pixels from 0.001 to 1000000".into())
}

fn gamma(text: &str) -> std::result::Result<f32, String> {
    let gamma = text.parse().ok().filter(|g: &f32| (0.1..=10.0).contains(g));
    gamma.ok_or_else(|| "expected a number from 0.1 to 10".into())
}

/// What `--json` prints.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(in crate::cli) struct Summary<'a> {
    image: &'a Path,
    /// Pixels of the picture.
    size: [u32; 2],
    points: usize,
    seed: u64,
    iterations: usize,
    /// Whether the dots came to rest.
    converged: bool,
    /// Mean squared distance of the weight from its dot in square pixels: at first, and after each iteration.
    energy: &'a [f64],
    /// Smallest and largest radius in pixels of the picture.
    radii: [f64; 2],
    /// Part of the paper that would have to be covered.
    darkness: f64,
    files: &'a [PathBuf],
    seconds: f64,
}

/// Stipples as told; the exit code.
pub(super) fn run(args: &Stipple) -> Result<u8> {
    let start = Instant::now();
    let formats = check(args)?;
    let stop = stop_flag()?;
    if args.threads > 0 {
        // A pool that is there already is from a command before in this process: results do not depend on it.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build_global();
    }

    // The picture.
    let (image, is_encoded) = read_compactly(&args.image)?;
    let size = [image.width(), image.height()];
    if formats.contains(&Format::Png) {
        Drawing::check_scale(size, args.scale)?;
    }
    let points = args.points as usize;
    if let Some(radius) = args.radius {
        Drawing::check_coverings(size, points as f64 * radius * radius)?;
    }
    let tone = Tone { gamma: args.gamma, inverted: args.invert };
    let density = Density::new(size, points, |x, y| {
        let (color, alpha) = image.texel(x, y);
        let decoded = |code: f32| srgb::LINEAR[(code * 255.0 + 0.5) as usize & 255];
        tone.darkness(if is_encoded { color.map(decoded) } else { color }, alpha)
    });
    let density = density.ok_or_else(|| nothing_to_draw(args))?;
    drop(image);

    // The dots.
    let settings =
        Settings { points, seed: args.seed, iterations: args.iterations, tolerance: TOLERANCE };
    let bar = progress::steps(args.iterations as usize, args.quiet);
    stop.store(false, Ordering::Relaxed);
    let stippling = stipple(&density, &settings, &mut |iteration, _| {
        bar.set_position(iteration.into());
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    bar.finish_and_clear();
    let Some(stippling) = stippling else {
        say(args, "interrupted: nothing is written");
        return Ok(INTERRUPTED);
    };
    let drawing = if args.sized {
        Drawing::sized(&stippling, size, tone)
    } else {
        let radius = args.radius.unwrap_or_else(|| Drawing::equal_radius(&density, points));
        Drawing::equal(&stippling, size, tone, radius)
    };

    // The files.
    for (path, format) in args.output.iter().zip(formats) {
        match format {
            Format::Svg => write_whole(path, |file| drawing.write_svg(file))?,
            Format::Png => {
                let [width, height] = size.map(|side| side * args.scale);
                write_png(path, &drawing.pixels(args.scale)?, width, height)?;
            }
        }
    }
    finished(args, &density, &stippling, &drawing, start.elapsed().as_secs_f64())?;
    Ok(DONE)
}

/// The energy's relative change from which on more iterations are not seen.
const TOLERANCE: f64 = 1e-4;

/// Formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

/// # Errors
/// A usage error for too many points, an unknown ending, and a file that would be written twice or over the
/// picture; [`Error::Io`] where one could not be written.
fn check(args: &Stipple) -> Result<Vec<Format>> {
    if args.points > MAX_POINTS as u64 {
        return Err(Error::Usage(format!("--points: at most {MAX_POINTS}")));
    }
    let mut taken = vec![identity(&args.image)];
    let mut formats = Vec::new();
    for path in &args.output {
        let name = path.display();
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        formats.push(match ending.as_deref() {
            Some("svg") => Format::Svg,
            Some("png") => Format::Png,
            _ => return Err(Error::Usage(format!("-o {name}: the ending must be .svg or .png"))),
        });
        let identity = identity(path);
        if taken[0] == identity {
            let message = format!("{name} is the picture to draw: name another one");
            return Err(Error::Usage(message));
        }
        if taken.contains(&identity) {
            return Err(Error::Usage(format!("{name} would be written twice: name two files")));
        }
        taken.push(identity);
        check_writable(path)?;
    }
    Ok(formats)
}

/// Reads a picture, and says whether its texels are sRGB-encoded still. Greys of 8 bits are read as they are
/// stored: decoded they would take four times the memory.
fn read_compactly(path: &Path) -> Result<(Image, bool)> {
    let stored = read(path, ColorSpace::Linear)?;
    if matches!(stored.pixels(), Pixels::Grey8(_) | Pixels::Linear8(_)) {
        return Ok((stored, true));
    }
    // 16 bits are encoded, HDR and EXR are not: whoever reads them knows.
    drop(stored);
    let mut image = read(path, ColorSpace::Srgb)?;
    image.replace_impossible();
    Ok((image, false))
}

fn nothing_to_draw(args: &Stipple) -> Error {
    let message = if args.invert {
        "the picture is black all over: nothing is light enough to draw; try without --invert"
    } else {
        "the picture is white all over: nothing is dark enough to draw; try --invert"
    };
    Error::image(&args.image, message)
}

/// The closing line, and the summary.
fn finished(
    args: &Stipple,
    density: &Density,
    stippling: &Stippling,
    drawing: &Drawing,
    seconds: f64,
) -> Result<()> {
    let radii = drawing.dots.iter().map(|dot| dot.radius);
    let smallest = radii.clone().fold(f64::INFINITY, f64::min);
    let largest = radii.fold(0.0, f64::max);
    let [width, height] = drawing.size;
    let iterations = stippling.energy.len() - 1;
    let names: Vec<_> = args.output.iter().map(|path| path.display().to_string()).collect();
    say(
        args,
        &format!(
            "wrote {}: {} dots of radius {smallest:.2} to {largest:.2} pixels, {iterations} iterations{}, \
             in {seconds:.2} s",
            names.join(", "),
            drawing.dots.len(),
            if stippling.converged { " until they rested" } else { "" },
        ),
    );
    if !args.json {
        return Ok(());
    }
    report::json(&Summary {
        image: &args.image,
        size: drawing.size,
        points: drawing.dots.len(),
        seed: args.seed,
        iterations,
        converged: stippling.converged,
        energy: &stippling.energy,
        radii: [smallest, largest],
        darkness: density.darkness() / (f64::from(width) * f64::from(height)),
        files: &args.output,
        seconds,
    })
}

fn say(args: &Stipple, line: &str) {
    if !args.quiet {
        let _ = writeln!(io::stderr(), "{line}");
    }
}
