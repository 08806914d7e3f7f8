//! PNG and Radiance HDR files. (EXR has its own file.)

use super::atomic::write_whole;
use crate::error::{Error, Result};
use crate::math::Rgb;
use image::codecs::{hdr::HdrEncoder, png::PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::io;
use std::path::Path;

/// Writes sRGB-encoded pixels as an 8-bit PNG; `CHANNELS` is 1 (grey), 3 (red, green, blue) or 4 (and
/// alpha, by which colour is not multiplied). Row-major, top row first.
///
/// # Errors
/// When the file cannot be written, or `pixels` are not `width * height`, at least one.
pub fn write_png<const CHANNELS: usize>(
    path: &Path,
    pixels: &[[u8; CHANNELS]],
    width: u32,
    height: u32,
) -> Result<()> {
    let color = const {
        match CHANNELS {
            1 => ExtendedColorType::L8,
            3 => ExtendedColorType::Rgb8,
            4 => ExtendedColorType::Rgba8,
            _ => panic!("a PNG has 1, 3 or 4 channels"),
        }
    };
    check_size(path, pixels.len(), width, height)?;
    write_whole(path, |file| {
        let bytes = pixels.as_flattened();
        PngEncoder::new(file).write_image(bytes, width, height, color).map_err(io_error)
    })
}

/// Writes linear radiance as a Radiance HDR (RGBE) picture: 8 bits of precision under a common exponent.
/// Negative values and NaN become 0, since the format has neither. Row-major, top row first.
///
/// # Errors
/// When the file cannot be written, or `pixels` are not `width * height`, at least one.
pub fn write_hdr(path: &Path, pixels: &[Rgb], width: u32, height: u32) -> Result<()> {
    check_size(path, pixels.len(), width, height)?;
    let rounded: Vec<_> = pixels.iter().map(|&p| image::Rgb(nearest_rgbe(p).to_array())).collect();
    write_whole(path, |file| {
        HdrEncoder::new(file).encode(&rounded, width as usize, height as usize).map_err(io_error)
    })
}

/// The nearest colour that RGBE represents. The encoder truncates, which would darken by 0.3 % on average,
/// and takes its exponent from the C library's logarithm, which is safe only away from powers of two.
fn nearest_rgbe(pixel: Rgb) -> Rgb {
    // The largest value that the format holds with a mantissa of 255.
    const MAX: f32 = 1.69e38;
    let pixel = pixel.map(|c| if c > 0.0 { c.min(MAX) } else { 0.0 });
    let max = pixel.max_channel();
    if max < f32::MIN_POSITIVE {
        return Rgb::BLACK;
    }
    let quantise = |exponent: u32| {
        // Two factors, since 2^-e itself can be out of range. Both are exact.
        let step = f32::from_bits(exponent << 23) * (1.0 / 128.0);
        pixel.map(|c| (c / step).round() * step)
    };
    // The power of two just below the maximum; if rounding reaches the next one, its coarser steps apply.
    let exponent = max.to_bits() >> 23;
    let rounded = quantise(exponent);
    if rounded.max_channel().to_bits() >> 23 == exponent { rounded } else { quantise(exponent + 1) }
}

fn check_size(path: &Path, pixels: usize, width: u32, height: u32) -> Result<()> {
    if pixels == width as usize * height as usize && pixels > 0 {
        return Ok(());
    }
    Err(Error::image(path, format!("{pixels} pixels do not make an image of {width} x {height}")))
}

/// The system's reason where there is one.
fn io_error(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(e) => e,
        e => io::Error::other(e),
    }
}
