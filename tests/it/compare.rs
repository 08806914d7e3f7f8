//! Differences of pictures against implementations that are not ours, and what must hold of any pictures.

use glint::image::{ColorSpace, Image, Pixels, read};
use glint::math::Rgb;
use glint::study::compare::{Metrics, Picture, Values, compare};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/pictures")
}

fn values_of(name: &str) -> Values {
    if name.ends_with(".exr") { Values::Radiance } else { Values::Encoded }
}

fn picture(name: &str) -> Picture {
    let path = folder().join(name);
    let image = read(&path, ColorSpace::Srgb).expect("a picture");
    Picture::new(&image, values_of(name), &path).expect("finite")
}

fn metrics(a: &Picture, b: &Picture) -> Metrics {
    compare(a, b, &|_, _| {}).expect("they can be compared").metrics
}

/// `differences.json` was written by `make.py` beside it: FLIP is its authors' own, SSIM scikit-image's, the rest NumPy.
#[test]
fn differences_are_those_of_other_implementations() {
    let text = std::fs::read_to_string(folder().join("differences.json")).expect("fixtures");
    let cases: Vec<Value> = serde_json::from_str(&text).expect("JSON");
    assert_eq!(cases.len(), 4);
    for case in cases {
        let name = |key: &str| case[key].as_str().expect("a name").to_owned();
        let found = metrics(&picture(&name("picture")), &picture(&name("reference")));
        let found = serde_json::to_value(found).expect("JSON");
        for (key, tolerance) in [
            ("rmse", 1e-7),
            ("relative_rmse", 1e-7),
            ("mae", 1e-7),
            ("mean_a", 1e-7),
            ("mean_b", 1e-7),
            // Exposures and tables of the screen are in single precision.
            ("psnr", 1e-5),
            ("ssim", 1e-5),
            ("flip", 2e-5),
        ] {
            let [found, expected] = [&found, &case].map(|of| of[key].as_f64().expect(key));
            let error = (found / expected - 1.0).abs();
            assert!(error < tolerance, "{} {key}: {found}, {expected}: {error:e}", name("picture"));
        }
    }
}

fn painted(size: u32, values: Values, color: impl Fn(u32, u32) -> Rgb) -> Picture {
    let pixels = (0..size * size).map(|i| color(i % size, i / size)).collect();
    let image = Image::new(size, size, Pixels::Float(pixels), false).expect("a picture");
    Picture::new(&image, values, Path::new("painted")).expect("finite")
}

#[test]
fn equal_pictures_do_not_differ_and_black_is_far_from_white() {
    for values in [Values::Radiance, Values::Encoded] {
        let flat = |level| painted(16, values, |_, _| Rgb::splat(level));
        let stripes = painted(16, values, |x, _| Rgb::new((x % 2) as f32, 0.5, 0.25));
        for same in [flat(0.0), flat(0.5), stripes] {
            let Metrics { rmse, relative_rmse, mae, psnr, ssim, flip, .. } = metrics(&same, &same);
            assert_eq!([rmse, mae, flip], [0.0; 3]);
            assert_eq!(relative_rmse, Some(0.0));
            assert_eq!(psnr, None);
            assert!((ssim.expect("windows") - 1.0).abs() < 1e-9);
        }
    }
    let [black, white] =
        [0.0, 1.0].map(|level| painted(16, Values::Encoded, |_, _| Rgb::splat(level)));
    let far = metrics(&white, &black);
    assert!([far.rmse, far.mae, far.mean_a].iter().all(|one| (one - 1.0).abs() < 1e-12));
    assert_eq!(far.mean_b, 0.0);
    assert_eq!(far.relative_rmse, None);
    assert!(far.flip > 0.95, "{}", far.flip);
}

/// The unit of light changes neither what is relative nor what is seen.
#[test]
fn radiance_has_no_unit() {
    let image = |scale: f32, factor: f32| {
        painted(24, Values::Radiance, |x, y| {
            Rgb::new(x as f32 + 0.5, y as f32 + 0.5, (x * y % 7) as f32) * scale * factor
        })
    };
    let expected = metrics(&image(1.0, 1.1), &image(1.0, 1.0));
    for scale in [1e-6, 1e6] {
        let found = metrics(&image(scale, 1.1), &image(scale, 1.0));
        let pairs = [
            (found.relative_rmse.expect("light"), expected.relative_rmse.expect("light")),
            (found.flip, expected.flip),
            (found.ssim.expect("windows"), expected.ssim.expect("windows")),
        ];
        for (found, expected) in pairs {
            assert!((found / expected - 1.0).abs() < 1e-4, "{scale}: {found} {expected}");
        }
    }
}

#[test]
fn what_cannot_be_compared_says_why() {
    let [cornell, glass, png] = ["cornell-4.exr", "glass-4.exr", "cornell-4.png"].map(picture);
    let error = |a, b| compare(a, b, &|_, _| {}).expect_err("it is refused").to_string();
    assert!(error(&cornell, &glass).contains("48x40 and 48x27"));
    assert!(error(&cornell, &png).contains("two of a kind"));
    let hole = Pixels::Float(vec![Rgb::BLACK, Rgb::new(0.0, f32::NAN, 0.0)]);
    let image = Image::new(2, 1, hole, false).expect("a picture");
    let message = Picture::new(&image, Values::Radiance, Path::new("a.exr")).expect_err("a hole");
    assert!(message.to_string().contains("a.exr: pixel 1,0 is no number"), "{message}");
}
