//! Image files: what is written comes back, and only images are read and files replaced.
//!
//! `damaged` holds what reading survives, `limited` what happens when memory or the disk runs out.

#![expect(clippy::unwrap_used, reason = "a test may unwrap, and so may its helpers")]

mod damaged;
mod limited;

use glint::image::{
    Attribute, ColorSpace, ExrImage, Pixels, Samples, read, read_exr_channels, write_exr,
    write_hdr, write_png,
};
use glint::math::Rgb;
use glint::sampling::CounterRng;
use std::fs;
use std::path::Path;
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
