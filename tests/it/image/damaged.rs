//! Damaged and forged image files: an image or an error, never a panic.

use super::{layered, radiance};
use glint::image::{ColorSpace, read, write_exr, write_hdr};
use glint::sampling::CounterRng;
use image::{DynamicImage, ImageFormat};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A small valid file of each format that is read.
pub(super) fn samples(dir: &Path) -> Vec<PathBuf> {
    let rgb: Vec<u8> = (0..16 * 16 * 3).map(|i| (i * 7) as u8).collect();
    let picture = image::RgbImage::from_raw(16, 16, rgb).unwrap();
    let picture = DynamicImage::ImageRgb8(picture);
    let mut paths = Vec::new();
    for (name, format) in [
        ("a.png", ImageFormat::Png),
        ("a.jpg", ImageFormat::Jpeg),
        ("a.tga", ImageFormat::Tga),
        ("a.bmp", ImageFormat::Bmp),
    ] {
        picture.save_with_format(dir.join(name), format).unwrap();
        paths.push(dir.join(name));
    }
    write_hdr(&dir.join("a.hdr"), &radiance(256), 16, 16).unwrap();
    write_exr(&dir.join("a.exr"), layered()).unwrap();
    paths.extend([dir.join("a.hdr"), dir.join("a.exr")]);
    // B44 decoding can overflow on damaged data.
    let half = |x: usize, y: usize| {
        let value = exr::prelude::f16::from_f32((x * y) as f32);
        (value, value, value)
    };
    let mut b44 = exr::prelude::Image::from_channels(
        (32, 32),
        exr::prelude::SpecificChannels::rgb(move |p: exr::prelude::Vec2<usize>| half(p.0, p.1)),
    );
    b44.layer_data.encoding = exr::prelude::Encoding {
        compression: exr::prelude::Compression::B44,
        ..exr::prelude::Encoding::SMALL_LOSSLESS
    };
    exr::prelude::WritableImage::write(&b44).to_file(dir.join("b44.exr")).unwrap();
    paths.push(dir.join("b44.exr"));
    paths
}

#[test]
fn damaged_files_are_errors() {
    let dir = TempDir::new().unwrap();
    let damaged = dir.path().join("damaged");
    for path in samples(dir.path()) {
        read(&path, ColorSpace::Srgb).unwrap();
        let good = fs::read(&path).unwrap();
        let damaged = damaged.with_extension(path.extension().unwrap());
        let read_bytes = |bytes: &[u8]| {
            fs::write(&damaged, bytes).unwrap();
            read(&damaged, ColorSpace::Srgb)
        };
        // Cut short: always an error that names the file and what to do.
        for length in [0, 1, 4, 10, 18, 30, good.len() / 4, good.len() / 2] {
            let result = read_bytes(&good[..length]);
            let message =
                result.expect_err(&format!("{} cut to {length}", path.display())).to_string();
            assert!(message.contains("damaged.") && message.contains(';'), "{message}");
        }
        // Junk behind a good start, and single wrong bytes: an image or an error.
        let mut rng = CounterRng::new(0);
        for _ in 0..400 {
            let mut bytes = good.clone();
            let at = (rng.unit() * bytes.len() as f32) as usize;
            if rng.unit() < 0.1 {
                bytes[at..].fill_with(|| (rng.unit() * 256.0) as u8);
            } else {
                bytes[at] = (rng.unit() * 256.0) as u8;
            }
            let _ = read_bytes(&bytes);
        }
        assert!(read_bytes(&vec![b'x'; 1000]).is_err());
    }
}

/// A PNG that claims `width` x `height` RGBA pixels and holds none.
fn forged_png(width: u32, height: u32) -> Vec<u8> {
    let mut header = b"IHDR".to_vec();
    header.extend([width.to_be_bytes(), height.to_be_bytes()].concat());
    header.extend([8, 6, 0, 0, 0]);
    // CRC-32 of ISO 3309, bit by bit.
    let crc = !header.iter().fold(!0_u32, |crc, &byte| {
        (0..8).fold(
            crc ^ u32::from(byte),
            |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 },
        )
    });
    let mut file = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
    file.extend(header);
    file.extend(crc.to_be_bytes());
    file
}

/// Files that claim more than the limits, of a side or in all.
pub(super) fn forgeries(dir: &Path) -> Vec<PathBuf> {
    let patch =
        |bytes: &mut [u8], at: usize, value: [u8; 4]| bytes[at..at + 4].copy_from_slice(&value);
    let paths = samples(dir);
    for path in &paths {
        let mut bytes = fs::read(path).unwrap();
        match path.extension().unwrap().to_str().unwrap() {
            "png" => bytes = forged_png(60_000, 60_000),
            "bmp" => {
                patch(&mut bytes, 18, 60_000_u32.to_le_bytes());
                patch(&mut bytes, 22, 60_000_u32.to_le_bytes());
            }
            "tga" => patch(&mut bytes, 12, [0xff; 4]),
            "jpg" => {
                let frame = bytes.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
                patch(&mut bytes, frame + 5, [0xff; 4]);
            }
            "hdr" => bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30000 +X 30000\n".to_vec(),
            _ => {
                // The last column and row, and the number of blocks of 16 or (B44) 32 rows.
                let lines = if path.ends_with("b44.exr") { 32 } else { 16 };
                let mut set = |name: &[u8], offset: usize, value: u32| {
                    let start = bytes.windows(name.len()).position(|w| w == name).unwrap();
                    patch(&mut bytes, start + name.len() + offset, value.to_le_bytes());
                };
                set(b"dataWindow\0box2i\0", 12, 31_999);
                set(b"dataWindow\0box2i\0", 16, 31_999);
                set(b"chunkCount\0int\0", 4, 32_000 / lines);
            }
        }
        fs::write(path, bytes).unwrap();
    }
    paths
}
