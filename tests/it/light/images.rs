//! Image environments: where they are, and their awkward texels.

use super::{one_bright, spiky};
use glint::light::{ImageEnvironment, orientation};
use glint::math::{DVec3, Rgb, Vec3, fun};
use glint::sampling::{CounterRng, warp};

fn unturned(texels: Vec<Rgb>, width: usize) -> ImageEnvironment {
    ImageEnvironment::new(texels, width, orientation(DVec3::Y, 0.0)).unwrap()
}

/// Its centre towards -z, its right half towards +x, its top towards +y; then turned, and stood up for
/// z-up scenes.
#[test]
fn an_image_is_oriented_as_documented() {
    let texels: Vec<Rgb> = (0..32).map(|i| Rgb::splat(i as f32)).collect();
    let build =
        |up, rotation| ImageEnvironment::new(texels.clone(), 8, orientation(up, rotation)).unwrap();
    let plain = build(DVec3::Y, 0.0);
    let (turned, stood_up) = (build(DVec3::Y, 90.0), build(DVec3::Z, 0.0));
    let near = |a: Rgb, b: Rgb| (a.r - b.r).abs() < 1e-4;
    for (i, &texel) in texels.iter().enumerate() {
        let (sin_phi, cos_phi) = fun::sin_cos_turns(((i % 8) as f32 + 0.5) / 8.0 - 0.5);
        let (sin_theta, cos_theta) = fun::sin_cos_turns(((i / 8) as f32 + 0.5) / 8.0);
        let d = Vec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
        assert!(near(plain.radiance(d), texel), "texel {i}");
        // A quarter turn carries +z to +x, and +x to -z.
        assert!(near(turned.radiance(Vec3::new(d.z, d.y, -d.x)), texel), "texel {i}");
        assert!(near(stood_up.radiance(Vec3::new(d.x, -d.z, d.y)), texel), "texel {i}");
    }
    // Halfway between texels, across the seam; and at the pole, between all texels of the top row.
    let (sin, cos) = fun::sin_cos_turns(3.0 / 16.0);
    assert!(near(plain.radiance(Vec3::new(0.0, cos, sin)), Rgb::splat(11.5)));
    assert!((0.0..=7.0).contains(&plain.radiance(Vec3::Y).r));
}

/// Wherever an image emits, its density is positive, also beside a texel that outshines everything.
#[test]
fn dim_texels_are_not_lost_beside_the_sun() {
    let mut texels = spiky([256, 128]);
    texels[40 * 256 + 100] = Rgb::splat(1e12);
    let environment = unturned(texels, 256);
    let mut rng = CounterRng::new(0);
    for _ in 0..100_000 {
        let direction = warp::sphere([rng.unit(), rng.unit()]);
        let (radiance, pdf) = environment.radiance_and_pdf(direction);
        assert!(radiance.is_black() || pdf > 0.0, "{radiance:?} at {direction}");
    }
}

/// One bright texel is sampled with next to no variance: luminance over density is almost constant. (A
/// density that is constant on each texel has a relative standard deviation of 1.)
#[test]
fn one_bright_texel_has_no_variance() {
    for row in [0, 3, 15, 31] {
        let environment = unturned(one_bright([64, 32], [17, row]), 64);
        let mut rng = CounterRng::new(0);
        let (n, mut mean, mut squares) = (10_000, 0.0, 0.0);
        for _ in 0..n {
            let sample = environment.sample([rng.unit(), rng.unit()]).unwrap();
            let estimate = f64::from(sample.radiance.luminance() / sample.pdf_solid_angle);
            mean += estimate / f64::from(n);
            squares += estimate * estimate / f64::from(n);
        }
        let deviation = (squares / (mean * mean) - 1.0).max(0.0).sqrt();
        assert!(deviation < 0.15, "row {row}: relative standard deviation {deviation}");
    }
}

#[test]
fn bad_texels_are_counted_and_black_images_send_nothing() {
    let texels = vec![
        Rgb::new(f32::NAN, 1.0, 2.0),
        Rgb::new(1.0, -3.0, 2.0),
        Rgb::new(1.0, 1.0, f32::INFINITY),
        Rgb::WHITE,
    ];
    let environment = unturned(texels, 2);
    assert_eq!(environment.repaired_texels(), 3);
    assert!(environment.radiance(Vec3::X).is_finite());
    let black = unturned(vec![Rgb::BLACK; 6], 3);
    assert_eq!(black.sample([0.2, 0.9]), None);
    assert_eq!((black.radiance(Vec3::X), black.power_estimate(1.0)), (Rgb::BLACK, 0.0));
    assert!(black.pdf_solid_angle(Vec3::Y).is_finite());
}
