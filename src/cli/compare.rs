//! `glint compare`: how far a picture is from another, as a table or JSON; limits, for scripts; and a heat map.

use super::output::identity;
use super::{DONE, NOT_MET, progress, report};
use crate::error::{Error, Result};
use crate::image::{ColorSpace, check_writable, is_radiance, read, write_png};
use crate::study::compare::{Comparison, Metrics, Picture, Values, compare};
use clap::Args;
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const EXAMPLES: &str = "\
Examples:
  glint compare render.exr reference.exr
  glint compare render.exr reference.exr -o differences.png
      where they differ for the eye (FLIP), from black to white
  glint compare render.png expected.png --max-flip 0.05 --min-ssim 0.95
      exit code 3 if they differ more, for scripts
  glint compare render.exr reference.exr --max-relative-rmse 2% --json

Of EXR and HDR files the radiance is compared, of all others the encoded values, 0 to 1. PSNR and SSIM are of what a screen
shows: radiance at the reference's automatic exposure, clipped, as sRGB; FLIP of radiance is the largest over all exposures
that matter (HDR-FLIP), on a screen with 67 pixels a degree.";

/// `glint compare`.
#[derive(Debug, Args)]
pub(super) struct Compare {
    /// Picture to judge: .exr, .hdr, .png, .jpg, .tga or .bmp
    image: PathBuf,
    /// What it should be
    reference: PathBuf,
    /// Heat map of FLIP to write, .png
    #[arg(short, long, value_name = "FILE.png", help_heading = "Output")]
    output: Option<PathBuf>,
    /// Print the metrics as JSON to standard output
    #[arg(long, help_heading = "Output")]
    json: bool,
    /// Print nothing but errors, and the JSON if asked for
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
    /// Largest root mean square error to accept; also in per cent, as are all limits
    #[arg(long, value_name = "X", value_parser = limit, help_heading = "Limits")]
    max_rmse: Option<f64>,
    /// Largest relative error: sqrt(mean((I-R)^2 / (R^2 + (0.1 mean(R))^2)))
    #[arg(long, value_name = "X", value_parser = limit, help_heading = "Limits")]
    max_relative_rmse: Option<f64>,
    /// Largest mean absolute error
    #[arg(long, value_name = "X", value_parser = limit, help_heading = "Limits")]
    max_mae: Option<f64>,
    /// Largest mean of FLIP, 0 to 1
    #[arg(long, value_name = "X", value_parser = limit, help_heading = "Limits")]
    max_flip: Option<f64>,
    /// Smallest peak signal-to-noise ratio, dB
    #[arg(long, value_name = "DB", value_parser = limit, help_heading = "Limits")]
    min_psnr: Option<f64>,
    /// Smallest structural similarity, at most 1
    #[arg(long, value_name = "X", value_parser = limit, help_heading = "Limits")]
    min_ssim: Option<f64>,
}

/// A number that is not negative, or so many per cent.
fn limit(text: &str) -> std::result::Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let value = number.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v >= 0.0);
    value.map(|v| v * unit).ok_or_else(|| "expected a number, as in 0.02, or 2%".into())
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Report {
    /// Of glint.
    version: &'static str,
    image: String,
    reference: String,
    #[serde(flatten)]
    metrics: Metrics,
    /// The limits that were not kept.
    missed: Vec<&'static str>,
}

/// Compares as told; the exit code.
pub(super) fn run(args: &Compare) -> Result<u8> {
    if let Some(path) = &args.output {
        check_output(path, args)?;
    }
    let [image, reference] = [&args.image, &args.reference].map(|path| picture(path));
    let (image, reference) = (image?, reference?);
    let bar = progress::steps(1, args.quiet);
    let tell = |done, total| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
    };
    let Comparison { metrics, map } = compare(&image, &reference, &tell)?;
    bar.finish_and_clear();
    let missed = missed(args, &metrics);
    if let Some(path) = &args.output {
        let color = |flip: &f64| colorous::MAGMA.eval_continuous(flip.clamp(0.0, 1.0)).as_array();
        let pixels: Vec<[u8; 3]> = map.values().iter().map(color).collect();
        let [width, height] = image.size();
        write_png(path, &pixels, width, height)?;
    }
    if args.json {
        let [image, reference] =
            [&args.image, &args.reference].map(|path| path.display().to_string());
        let missed = missed.iter().map(|limit| limit.option).collect();
        let version = env!("CARGO_PKG_VERSION");
        report::json(&Report { version, image, reference, metrics, missed })?;
    } else if !args.quiet {
        report::print(&text(&metrics, image.values()))?;
    }
    for Limit { option, limit, found } in &missed {
        say(args, &format!("{option} {limit} is not kept: {found}"));
    }
    if let Some(path) = &args.output {
        say(args, &format!("wrote {}", path.display()));
    }
    Ok(if missed.is_empty() { DONE } else { NOT_MET })
}

fn say(args: &Compare, line: &str) {
    if !args.quiet {
        let _ = writeln!(std::io::stderr(), "{line}");
    }
}

fn picture(path: &Path) -> Result<Picture> {
    let values = if is_radiance(path)? { Values::Radiance } else { Values::Encoded };
    Picture::new(&read(path, ColorSpace::Srgb)?, values, path)
}

/// # Errors
/// A usage error for another ending, and for a file that is read; where it cannot be written.
fn check_output(path: &Path, args: &Compare) -> Result<()> {
    let name = path.display();
    if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        return Err(Error::Usage(format!("-o {name}: the ending must be .png")));
    }
    if [&args.image, &args.reference].iter().any(|read| identity(read) == identity(path)) {
        return Err(Error::Usage(format!("-o {name}: it is read; name another file")));
    }
    check_writable(path)
}

/// A limit that is not kept.
struct Limit {
    option: &'static str,
    limit: f64,
    found: String,
}

fn missed(args: &Compare, metrics: &Metrics) -> Vec<Limit> {
    let Metrics { rmse, relative_rmse, mae, flip, psnr, ssim, .. } = *metrics;
    let relative_rmse = relative_rmse.unwrap_or(f64::INFINITY);
    let at_most = [
        ("--max-rmse", args.max_rmse, rmse),
        ("--max-relative-rmse", args.max_relative_rmse, relative_rmse),
        ("--max-mae", args.max_mae, mae),
        ("--max-flip", args.max_flip, flip),
    ];
    let above = at_most.into_iter().filter_map(|(option, limit, found)| {
        let limit = limit.filter(|limit| found > *limit)?;
        Some(Limit { option, limit, found: found.to_string() })
    });
    // Equal pictures have no noise; of tiny ones the similarity is unknown, which is not enough.
    let psnr = psnr.unwrap_or(f64::INFINITY);
    let at_least = [("--min-psnr", args.min_psnr, Some(psnr)), ("--min-ssim", args.min_ssim, ssim)];
    let below = at_least.into_iter().filter_map(|(option, limit, found)| {
        let limit = limit.filter(|limit| found.is_none_or(|found| found < *limit))?;
        let found = found.map_or("the picture is too small for it".into(), |v| v.to_string());
        Some(Limit { option, limit, found })
    });
    above.chain(below).collect()
}

fn text(metrics: &Metrics, values: Values) -> String {
    let Metrics { rmse, relative_rmse, mae, psnr, ssim, flip, mean_a, mean_b } = *metrics;
    let of = match values {
        Values::Radiance => "radiance",
        Values::Encoded => "encoded values, 0 to 1",
    };
    let relative = relative_rmse.map_or("infinite: the reference is black".into(), |error| {
        format!("{:.3} %", 100.0 * error)
    });
    let psnr = psnr.map_or("no noise".into(), |psnr| format!("{psnr:.2} dB"));
    let ssim = ssim.map_or("picture too small".into(), |ssim| format!("{ssim:.4}"));
    [
        format!("mean           {mean_a:.6}, of the reference {mean_b:.6} ({of})"),
        format!("RMSE           {rmse:.6}"),
        format!("relative RMSE  {relative}"),
        format!("MAE            {mae:.6}"),
        format!("PSNR           {psnr}"),
        format!("SSIM           {ssim}"),
        format!("FLIP           {flip:.4}"),
    ]
    .join("\n")
}
