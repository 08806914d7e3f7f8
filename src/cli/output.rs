//! The files that a render writes: formats by ending, checked before the first ray is traced.

use super::args::Render;
use super::select::Settings;
use crate::error::{Error, Result};
use crate::film::Pixels;
use crate::image::{
    Attribute, ExrImage, auto_exposure, check_writable, develop, srgb, write_exr, write_hdr,
    write_png,
};
use crate::math::Rgb;
use crate::render::{Aov, Layers};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
    Hdr,
}

/// The files to write, each known to be writable.
#[derive(Debug)]
pub(super) struct Outputs {
    files: Vec<(PathBuf, Format)>,
}

/// The same for all names of a file.
pub(super) fn identity(path: &Path) -> PathBuf {
    let same = std::fs::canonicalize(path).or_else(|_| std::path::absolute(path));
    same.unwrap_or_else(|_| path.to_path_buf())
}

impl Outputs {
    /// What `-o` names, or SCENE.exr and SCENE.png in the current folder; the files of `--stats` and `--report` are
    /// written elsewhere, but checked here too.
    ///
    /// # Errors
    /// A usage error for an unknown ending and for a file that would be written twice; [`Error::Io`] where one could
    /// not be written.
    pub(super) fn check(args: &Render) -> Result<Self> {
        let default;
        let names = if args.output.is_empty() {
            let stem = PathBuf::from(args.scene.file_stem().unwrap_or("render".as_ref()));
            default = [stem.with_extension("exr"), stem.with_extension("png")];
            &default[..]
        } else {
            &args.output
        };
        let files = names
            .iter()
            .map(|path| {
                let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
                let format = match ending.as_deref() {
                    Some("exr") => Format::Exr,
                    Some("png") => Format::Png,
                    Some("hdr") => Format::Hdr,
                    _ => {
                        let name = path.display();
                        return Err(Error::Usage(format!(
                            "-o {name}: the ending must be .exr, .png or .hdr"
                        )));
                    }
                };
                check_writable(path)?;
                Ok((path.clone(), format))
            })
            .collect::<Result<_>>()?;
        if let Some(page) = &args.report {
            let ending = page.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
            if !matches!(ending.as_deref(), Some("html" | "htm")) {
                let name = page.display();
                return Err(Error::Usage(format!("--report {name}: the ending must be .html")));
            }
        }
        let mut seen = HashSet::new();
        let texts = || args.stats.iter().chain(&args.report);
        for path in names.iter().chain(texts()) {
            if !seen.insert(identity(path)) {
                let name = path.display();
                return Err(Error::Usage(format!("{name} would be written twice: name two files")));
            }
        }
        texts().try_for_each(|path| check_writable(path))?;
        Ok(Self { files })
    }

    /// # Errors
    /// A usage error where one of the files that `args` would write is one of `inputs`.
    pub(super) fn check_against(&self, args: &Render, inputs: &[PathBuf]) -> Result<()> {
        let read: HashSet<PathBuf> = inputs.iter().map(|path| identity(path)).collect();
        let written = self.files.iter().map(|(path, _)| path);
        for path in written.chain(&args.stats).chain(&args.report) {
            if read.contains(&identity(path)) {
                let name = path.display();
                return Err(Error::Usage(format!(
                    "{name} is a file of the scene: name another one"
                )));
            }
        }
        Ok(())
    }

    /// Whether extra layers have a file to go to.
    pub(super) fn has_exr(&self) -> bool {
        self.files.iter().any(|(_, format)| *format == Format::Exr)
    }

    /// Writes every file; returns their names and the exposure that PNG files got.
    pub(super) fn write(&self, picture: &Picture<'_>) -> Result<(Vec<String>, f32)> {
        let pixels = picture.pixels;
        let [width, height] = [pixels.region.width(), pixels.region.height()];
        let exposure = picture.settings.exposure.unwrap_or_else(|| {
            let on_surfaces = pixels.radiance.iter().zip(&pixels.alpha).filter(|(_, a)| **a > 0.5);
            let seen: Vec<Rgb> = on_surfaces.map(|(c, _)| *c).collect();
            let middle_grey =
                auto_exposure(if seen.is_empty() { pixels.radiance.clone() } else { seen });
            middle_grey + LIGHTER_THAN_GREY
        });
        for (path, format) in &self.files {
            match format {
                Format::Exr => write_exr(path, exr(picture))?,
                Format::Hdr => write_hdr(path, &pixels.radiance, width, height)?,
                Format::Png => {
                    let mut bytes = develop(&pixels.radiance, exposure, picture.settings.tonemap);
                    if let Some(background) = picture.background {
                        composite(&mut bytes, &pixels.alpha, background);
                    }
                    write_png(path, &bytes, width, height)?;
                }
            }
        }
        Ok((self.files.iter().map(|(p, _)| p.display().to_string()).collect(), exposure))
    }
}

/// Surfaces of models are lighter than middle grey (0.18) by about a stop: shown as middle grey they
/// would look underexposed.
const LIGHTER_THAN_GREY: f32 = 1.0;

/// Everything that goes into the files.
pub(super) struct Picture<'a> {
    pub(super) settings: &'a Settings,
    pub(super) pixels: &'a Pixels,
    pub(super) samples: f32,
    pub(super) layers: Option<&'a Layers>,
    pub(super) background: Option<Rgb>,
    pub(super) metadata: Vec<(&'static str, Attribute)>,
}

fn exr(picture: &Picture<'_>) -> ExrImage {
    let pixels = picture.pixels;
    let mut image = ExrImage::new(pixels.region.width(), pixels.region.height());
    let rgba = pixels.radiance.iter().zip(&pixels.alpha).map(|(c, a)| [c.r, c.g, c.b, *a]);
    image.add_layer("", ["R", "G", "B", "A"], rgba);
    for &aov in &picture.settings.aovs {
        let name = Aov::ALL.iter().find(|(_, a)| *a == aov).map_or("", |(name, _)| name);
        match aov {
            Aov::Variance => {
                image.add_layer(
                    name,
                    ["R", "G", "B"],
                    pixels.variance.iter().map(|v| v.to_array()),
                );
            }
            Aov::Samples => {
                let samples = picture.samples;
                image.add_layer(name, ["N"], pixels.alpha.iter().map(|_| [samples]));
            }
            _ => {
                let channels =
                    picture.layers.map(|layers| layers.channels(aov)).unwrap_or_default();
                for (channel, samples) in channels {
                    image.channels.insert(format!("{name}.{channel}"), samples);
                }
            }
        }
    }
    let metadata = picture.metadata.iter().cloned();
    image.metadata = metadata.map(|(name, value)| (name.to_owned(), value)).collect();
    image
}

/// Puts the pixels over an sRGB colour, in linear light.
fn composite(bytes: &mut [[u8; 3]], alpha: &[f32], background: Rgb) {
    for (pixel, alpha) in bytes.iter_mut().zip(alpha) {
        for (channel, behind) in pixel.iter_mut().zip(background.to_array()) {
            // The radiance is already multiplied by its coverage.
            let front = srgb::decode(f32::from(*channel) / 255.0);
            let both = front + (1.0 - alpha) * srgb::decode(behind.min(1.0));
            *channel = srgb::encode8(both);
        }
    }
}
