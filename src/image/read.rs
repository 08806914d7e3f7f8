//! Reads PNG, JPEG, TGA, BMP, HDR and EXR files into [`Image`]s.
//!
//! A file is what its content says, whatever it is called; only TGA, which has no signature, goes by its
//! extension. Files are not trusted: sizes are checked before memory is taken, and damage is an error.

use super::exr;
use super::open::open_regular;
use super::{Image, Pixels, srgb};
use crate::error::{Error, Result};
use crate::math::Rgb;
use image::{DynamicImage, ImageError, ImageFormat, ImageReader, Limits};
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The longest side that an image may have, pixels.
pub const MAX_SIDE: u32 = 32768;

/// The most memory that a decoded file may take, bytes. (In an [`Image`] three 8-bit channels become four.)
pub const MAX_BYTES: u64 = 2 << 30;

/// What the numbers of a file with 8 or 16 bits a channel mean. HDR and EXR files are linear always.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Encoded colour: albedo, emission, photographs.
    Srgb,
    /// Data: bump, normal, roughness and opacity maps.
    Linear,
}

/// Reads the image file `path`. Texels of HDR and EXR files can be negative, NaN or infinite (see
/// [`Image::replace_impossible`]); of an EXR file the layer R, G, B (A) is read, or else Y, or else the first
/// layer that has R, G and B.
///
/// # Errors
/// When the file cannot be read, is no image, is damaged, or exceeds [`MAX_SIDE`] or [`MAX_BYTES`].
pub fn read(path: &Path, color_space: ColorSpace) -> Result<Image> {
    let mut file = BufReader::new(open_regular(path)?);
    let head = file.fill_buf().map_err(|e| Error::io(path, "read", e))?;
    if head.starts_with(&exr::MAGIC) {
        return from_exr(path);
    }
    let format = image::guess_format(head).ok().or_else(|| ImageFormat::from_path(path).ok());
    let Some(format) = format.filter(ImageFormat::reading_enabled) else {
        return Err(Error::image(
            path,
            "not an image that glint can read; convert it to png, jpg, tga, bmp, hdr or exr",
        ));
    };
    let mut reader = ImageReader::with_format(file, format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    let decoded = reader.decode().map_err(|error| decode_error(path, error))?;
    from_decoded(decoded, color_space)
        .ok_or_else(|| Error::image(path, "the image has no pixels; export it again"))
}

/// Whether the file holds radiance, as EXR and HDR files do, and not colours for a screen.
///
/// # Errors
/// When the file cannot be read.
pub fn is_radiance(path: &Path) -> Result<bool> {
    let mut file = BufReader::new(open_regular(path)?);
    let head = file.fill_buf().map_err(|e| Error::io(path, "read", e))?;
    let is_hdr = || image::guess_format(head).is_ok_and(|format| format == ImageFormat::Hdr);
    Ok(head.starts_with(&exr::MAGIC) || is_hdr())
}

/// What a file that is too large is told.
pub(super) fn too_large(path: &Path) -> Error {
    let gigabytes = MAX_BYTES >> 30;
    let message = format!(
        "the image is larger than {MAX_SIDE} pixels a side or {gigabytes} GiB decoded; scale it down"
    );
    Error::image(path, message)
}

fn decode_error(path: &Path, error: ImageError) -> Error {
    match error {
        ImageError::Limits(_) => too_large(path),
        error => Error::image(path, format!("{error}; the file is damaged, export it again")),
    }
}

/// Chooses the most compact storage that keeps what was decoded.
fn from_decoded(decoded: DynamicImage, color_space: ColorSpace) -> Option<Image> {
    let (width, height) = (decoded.width(), decoded.height());
    let linear = color_space == ColorSpace::Linear;
    let (pixels, has_alpha) = match decoded {
        DynamicImage::ImageLuma8(grey) if linear => (Pixels::Grey8(grey.into_raw()), false),
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => {
            let texels: Vec<_> = decoded.into_rgba8().pixels().map(|p| p.0).collect();
            let has_alpha = texels.iter().any(|t| t[3] != 255);
            (if linear { Pixels::Linear8(texels) } else { Pixels::Srgb8(texels) }, has_alpha)
        }
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            float_pixels(decoded.into_rgba32f().pixels().map(|p| p.0))
        }
        // 16 bits become floats: a height map in 8 bits would show steps. (The enum is non-exhaustive.)
        _ => {
            let color = |v: u16| match f32::from(v) / 65535.0 {
                v if linear => v,
                v => srgb::decode(v),
            };
            let texel =
                |[r, g, b, a]: [u16; 4]| [color(r), color(g), color(b), f32::from(a) / 65535.0];
            float_pixels(decoded.into_rgba16().pixels().map(|p| texel(p.0)))
        }
    };
    Image::new(width, height, pixels, has_alpha)
}

/// Float storage of RGBA texels, and whether it has alpha: opaque alpha is left out.
fn float_pixels(texels: impl Iterator<Item = [f32; 4]> + Clone) -> (Pixels, bool) {
    if texels.clone().all(|t| t[3] == 1.0) {
        (Pixels::Float(texels.map(|[r, g, b, _]| Rgb::new(r, g, b)).collect()), false)
    } else {
        (Pixels::FloatAlpha(texels.collect()), true)
    }
}

fn from_exr(path: &Path) -> Result<Image> {
    let file = exr::read_exr_channels(path)?;
    // The unnamed layer first, then the others.
    let layers = file.channels.keys().filter_map(|name| name.strip_suffix('R'));
    let color = |layer: &str| {
        let channel = |name: &str| file.channel(&format!("{layer}{name}"));
        Some((layer.to_owned(), [channel("R")?, channel("G")?, channel("B")?]))
    };
    let grey = || file.channel("Y").map(|y| (String::new(), [y; 3]));
    let found = color("").or_else(grey).or_else(|| layers.into_iter().find_map(color));
    let Some((layer, [r, g, b])) = found else {
        return Err(Error::image(path, "the EXR file has no channels R, G and B, and no Y"));
    };
    let alpha = file.channel(&format!("{layer}A"));
    let texels = (0..r.len()).map(|i| [r[i], g[i], b[i], alpha.map_or(1.0, |a| a[i])]);
    let (pixels, has_alpha) = float_pixels(texels);
    Image::new(file.width, file.height, pixels, has_alpha)
        .ok_or_else(|| Error::image(path, "the EXR file has no pixels; write it again"))
}
