//! Image files: what is written comes back, damage is an error, and a file is whole or not there.

#![expect(clippy::unwrap_used, reason = "a test may unwrap, and so may its helpers")]

use glint::image::{
    Attribute, ColorSpace, ExrImage, Pixels, Samples, read, read_exr_channels, write_exr,
    write_hdr, write_png,
};
use glint::math::Rgb;
use glint::sampling::CounterRng;
use image::{DynamicImage, ImageFormat};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// `n` colours over twenty powers of two.
fn radiance(n: usize) -> Vec<Rgb> {
    let mut rng = CounterRng::new(0);
    let mut channel = || rng.unit() * (1 << (rng.unit() * 20.0) as u32) as f32;
    (0..n).map(|_| Rgb::new(channel(), channel(), channel())).collect()
}

/// An image with layers, identifiers, metadata and every kind of float.
fn layered() -> ExrImage {
    let (width, height) = (37, 19);
    let n = width as usize * height as usize;
    let mut pixels: Vec<_> = radiance(n).into_iter().map(|p| [p.r, p.g, p.b, 0.5]).collect();
    let odd = [f32::INFINITY, f32::NEG_INFINITY, -0.0, -3.5, 1e-42, f32::MAX, f32::NAN];
    for (pixel, value) in pixels.iter_mut().zip(odd) {
        pixel[1] = value;
    }
    pixels[9] = [f32::from_bits(0x7fc0_1234); 4];
    let mut image = ExrImage::new(width, height);
    image.add_layer("", ["R", "G", "B", "A"], pixels.iter().copied());
    image.add_layer("normal", ["X", "Y", "Z"], pixels.iter().map(|&[r, g, b, _]| [b, r, g]));
    image.add_layer("depth", ["Z"], pixels.iter().map(|&[r, ..]| [r]));
    let ids = (0..n as u32).map(|i| u32::MAX - i).collect();
    image.channels.insert("primitive.id".into(), Samples::Uint(ids));
    for i in 0..20 {
        image.metadata.insert(format!("glint:number{i}"), Attribute::Number(f64::from(i) / 3.0));
    }
    let command = "glint render Häuser.obj -o 漢字.exr ".repeat(20);
    image.metadata.insert("glint:command".into(), Attribute::Text(command));
    image
}

/// The samples as bits, since a NaN equals nothing.
fn bits(image: &ExrImage) -> Vec<(String, Vec<u32>)> {
    let bits = |samples: &Samples| match samples {
        Samples::Float(v) => v.iter().map(|x| x.to_bits()).collect(),
        Samples::Uint(v) => v.clone(),
    };
    image.channels.iter().map(|(name, samples)| (name.clone(), bits(samples))).collect()
}

#[test]
fn exr_comes_back_bit_for_bit() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.exr");
    let image = layered();
    write_exr(&path, image.clone()).unwrap();
    let back = read_exr_channels(&path).unwrap();
    assert_eq!((back.width, back.height), (image.width, image.height));
    assert_eq!(bits(&back), bits(&image));
    assert_eq!(back.metadata, image.metadata);
    assert_eq!(back.channel("depth.Z").unwrap().len(), 37 * 19);
    assert_eq!(back.channel("primitive.id"), None);

    // As a texture: the unnamed layer.
    let texture = read(&path, ColorSpace::Srgb).unwrap();
    assert!(texture.has_alpha());
    assert_eq!(texture.texel(36, 18).0.r, back.channel("R").unwrap()[37 * 19 - 1]);
    assert_eq!(texture.texel(36, 18).1, 0.5);
}

/// Attributes go through a hash map whose order differs from map to map: twenty times the same bytes.
#[test]
fn exr_bytes_are_reproducible_and_sorted() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.exr");
    write_exr(&path, layered()).unwrap();
    let bytes = fs::read(&path).unwrap();
    for _ in 0..20 {
        write_exr(&path, layered()).unwrap();
        assert!(fs::read(&path).unwrap() == bytes);
    }
    let position = |name: &[u8]| bytes.windows(name.len()).position(|w| w == name).unwrap();
    let names =
        [&b"channels\0"[..], b"dataWindow\0", b"glint:command\0", b"glint:number9\0", b"type\0"];
    assert!(names.map(position)[..4].is_sorted());
}

#[test]
fn exr_textures_choose_their_channels() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.exr");
    let channels = |names: &[&str]| {
        let mut image = ExrImage::new(1, 1);
        for (value, name) in names.iter().enumerate() {
            image.channels.insert((*name).into(), Samples::Float(vec![value as f32]));
        }
        write_exr(&path, image).unwrap();
        read(&path, ColorSpace::Linear).map(|image| image.texel(0, 0))
    };
    assert_eq!(channels(&["a.R", "a.G", "a.B", "R", "G", "B"]).unwrap().0, Rgb::new(3.0, 4.0, 5.0));
    assert_eq!(channels(&["Y", "A"]).unwrap(), (Rgb::BLACK, 1.0));
    let layer = channels(&["a.Z", "b.R", "b.G", "b.B", "b.A"]).unwrap();
    assert_eq!(layer, (Rgb::new(1.0, 2.0, 3.0), 4.0));
    let message = channels(&["Z"]).unwrap_err().to_string();
    assert!(message.contains("a.exr: ") && message.contains("no channels R, G and B"), "{message}");
}

#[test]
fn exr_refuses_what_does_not_fit() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.exr");
    let mut wrong = layered();
    wrong.width += 1;
    assert!(write_exr(&path, wrong).is_err());
    assert!(write_exr(&path, ExrImage::new(1, 1)).is_err());
    for name in ["", "compression", &"long".repeat(100)] {
        let mut reserved = layered();
        reserved.metadata.insert(name.into(), Attribute::Number(1.0));
        assert!(write_exr(&path, reserved).is_err(), "{name}");
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn png_comes_back() {
    let dir = TempDir::new().unwrap();
    // A file is what it contains, whatever it is called.
    let path = dir.path().join("a.jpg");
    let rgb: Vec<[u8; 3]> = (0..=255).map(|i| [i, 255 - i, i / 2]).collect();
    write_png(&path, &rgb, 32, 8).unwrap();
    for (space, stored) in [(ColorSpace::Srgb, 0), (ColorSpace::Linear, 1)] {
        let image = read(&path, space).unwrap();
        let texels = match (stored, image.pixels()) {
            (0, Pixels::Srgb8(texels)) | (1, Pixels::Linear8(texels)) => texels,
            (_, pixels) => panic!("{pixels:?}"),
        };
        assert!(!image.has_alpha());
        assert!(texels.iter().zip(&rgb).all(|(t, p)| *t == [p[0], p[1], p[2], 255]));
    }
    let rgba: Vec<[u8; 4]> = (0..=255).map(|i| [i, 1, 2, 255 - i]).collect();
    write_png(&path, &rgba, 8, 32).unwrap();
    let image = read(&path, ColorSpace::Srgb).unwrap();
    assert!(image.has_alpha() && *image.pixels() == Pixels::Srgb8(rgba));

    let grey: Vec<[u8; 1]> = (0..=255).map(|i| [i]).collect();
    write_png(&path, &grey, 16, 16).unwrap();
    let linear = read(&path, ColorSpace::Linear).unwrap();
    assert_eq!(*linear.pixels(), Pixels::Grey8((0..=255).collect()));
    assert_eq!(linear.texel(15, 15), (Rgb::WHITE, 1.0));
    let srgb = read(&path, ColorSpace::Srgb).unwrap();
    assert_eq!(srgb.texel(15, 15), (Rgb::WHITE, 1.0));
    assert!(write_png(&path, &grey, 16, 17).is_err());
}

/// 16-bit height maps keep their steps.
#[test]
fn sixteen_bits_become_floats() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("height.png");
    image::ImageBuffer::<image::Luma<u16>, _>::from_fn(256, 1, |x, _| {
        image::Luma([30_000 + x as u16])
    })
    .save(&path)
    .unwrap();
    let image = read(&path, ColorSpace::Linear).unwrap();
    for x in 0..256 {
        assert_eq!(image.texel(x, 0), (Rgb::splat((30_000 + x) as f32 / 65535.0), 1.0));
    }
}

#[test]
fn hdr_comes_back_within_its_precision() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.hdr");
    let mut pixels = radiance(64 * 64);
    pixels[0] = Rgb::new(f32::NAN, -1.0, 2.0);
    pixels[1] = Rgb::splat(255.9);
    pixels[2] = Rgb::new(f32::INFINITY, 1.0, 1e38);
    pixels[3] = Rgb::BLACK;
    write_hdr(&path, &pixels, 64, 64).unwrap();
    let image = read(&path, ColorSpace::Srgb).unwrap();
    let Pixels::Float(back) = image.pixels() else { panic!("{:?}", image.pixels()) };
    assert_eq!(back[0], Rgb::new(0.0, 0.0, 2.0));
    assert_eq!(back[1], Rgb::splat(256.0));
    assert!(back[2].r > 1e38 && back[2].is_finite());
    assert_eq!(back[3], Rgb::BLACK);
    let mut bias = 0.0;
    for (a, b) in back.iter().zip(&pixels).skip(4) {
        // Half a unit of a mantissa of at least 128.
        let error = (*a - *b).map(f32::abs).max_channel() / b.max_channel();
        assert!(error <= 1.0 / 256.0, "{a:?} {b:?}");
        bias += f64::from((a.max_channel() - b.max_channel()) / b.max_channel()) / 4092.0;
    }
    // Truncation would have a bias of -2.6e-3; that of rounding is below 3e-5 times a deviate of 4.
    assert!(bias.abs() < 1e-4, "{bias}");
    // What was read is representable, so it is written unchanged.
    write_hdr(&path, back, 64, 64).unwrap();
    assert_eq!(read(&path, ColorSpace::Srgb).unwrap(), image);
}

/// A small valid file of each format that is read.
fn samples(dir: &Path) -> Vec<PathBuf> {
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

#[test]
fn what_is_no_image_file_is_refused() {
    let dir = TempDir::new().unwrap();
    let message = |path: &Path| read(path, ColorSpace::Srgb).unwrap_err().to_string();
    assert!(message(&dir.path().join("none.png")).contains("none.png: cannot read: "));
    assert!(message(dir.path()).contains("not a regular file"));
    assert!(message(Path::new("/dev/zero")).contains("not a regular file"));
    let text = dir.path().join("a.txt");
    fs::write(&text, "text").unwrap();
    assert!(message(&text).contains("convert it to png, jpg, tga, bmp, hdr or exr"));
    let gif = dir.path().join("a.png");
    fs::write(&gif, b"GIF89a____________").unwrap();
    assert!(message(&gif).contains("convert it to png"));
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
fn forgeries(dir: &Path) -> Vec<PathBuf> {
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

/// Runs the test `name` of this binary by itself, in `dir`, after the shell command `limit`.
fn run_limited(name: &str, limit: &str, dir: &Path) {
    let output = Command::new("sh")
        .args([
            "-c",
            &format!("{limit} && exec \"$0\" --exact {name} --nocapture --test-threads 1"),
        ])
        .arg(std::env::current_exe().unwrap())
        .env("GLINT_TEST_DIR", dir)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}

/// The folder that [`run_limited`] gave; a test that has none does nothing.
fn limited_dir() -> Option<PathBuf> {
    std::env::var_os("GLINT_TEST_DIR").map(PathBuf::from)
}

/// With a gigabyte of address space, an attempt to hold the pixels would abort the process.
#[test]
fn forged_sizes_are_refused_without_taking_memory() {
    let dir = TempDir::new().unwrap();
    forgeries(dir.path());
    run_limited("image::limited_memory", "ulimit -v 1048576", dir.path());
}

#[test]
fn limited_memory() {
    let Some(dir) = limited_dir() else { return };
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let message = read(&path, ColorSpace::Srgb).unwrap_err().to_string();
        assert!(message.contains("scale it down"), "{message}");
    }
}

/// A disk that is full after 8 KiB: no file, no litter, an error; and an old file stays.
#[test]
fn a_full_disk_leaves_no_file() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("old.exr"), "old").unwrap();
    // Without the trap the system would kill the process instead of failing the write.
    let limit = "trap '' XFSZ && ulimit -f 16";
    run_limited("image::limited_disk", limit, dir.path());
}

#[test]
fn limited_disk() {
    let Some(dir) = limited_dir() else { return };
    let n = 100;
    let pixels = radiance(n * n);
    let bytes: Vec<[u8; 3]> =
        pixels.iter().map(|p| p.to_array().map(|c| c.to_bits() as u8)).collect();
    let exr = || {
        let mut image = ExrImage::new(n as u32, n as u32);
        image.add_layer("", ["R", "G", "B"], pixels.iter().map(|p| p.to_array()));
        image
    };
    let results = [
        write_png(&dir.join("a.png"), &bytes, n as u32, n as u32),
        write_hdr(&dir.join("a.hdr"), &pixels, n as u32, n as u32),
        write_exr(&dir.join("a.exr"), exr()),
        write_exr(&dir.join("old.exr"), exr()),
    ];
    for result in results {
        let message = result.unwrap_err().to_string();
        assert!(message.contains("cannot write: File too large"), "{message}");
    }
    let left: Vec<_> = fs::read_dir(&dir).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["old.exr"]);
    assert_eq!(fs::read(dir.join("old.exr")).unwrap(), b"old");
}

#[test]
fn devices_and_folders_are_not_overwritten_and_links_are_followed() {
    let dir = TempDir::new().unwrap();
    let write = |path: &Path| write_png(path, &[[1, 2, 3]], 1, 1);
    let message = write(Path::new("/dev/full")).unwrap_err().to_string();
    assert!(message.contains("not a regular file"), "{message}");
    assert!(write(dir.path()).is_err());
    assert!(write(&dir.path().join("none/a.png")).is_err());

    let (real, link) = (dir.path().join("real.png"), dir.path().join("link.png"));
    fs::write(&real, "old").unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    write(&link).unwrap();
    write(&dir.path().join("new.png")).unwrap();
    assert!(link.is_symlink());
    assert_eq!(read(&real, ColorSpace::Srgb).unwrap().width(), 1);
    // A new file has the mode that any program would give it.
    let mode = |path: &Path| {
        std::os::unix::fs::PermissionsExt::mode(&path.metadata().unwrap().permissions())
    };
    assert_eq!(mode(&dir.path().join("new.png")), mode(&real));
}
