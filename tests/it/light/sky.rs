//! The analytic sky: its unit, its colours, and that it stays sane from noon to night.

use super::{clear_sky, direction_to_sun, integrate};
use glint::light::Sky;
use glint::math::fun::double;
use glint::math::{Rgb, Vec3};
use std::f64::consts::PI;

/// Irradiance on horizontal ground by the sky without the sun.
fn from_sky(sky: &Sky) -> Rgb {
    let received = |d: Vec3| (sky.environment.radiance(d) * d.y.max(0.0)).to_array().map(f64::from);
    Rgb::from(integrate(180, received).map(|e| e as f32))
}

/// Irradiance on horizontal ground by the sun alone, which stands at `elevation` degrees.
fn from_sun(sky: &Sky, elevation: f64) -> Rgb {
    sky.sun.irradiance() * double::sin(elevation.to_radians()) as f32
}

/// The unit: a white diffuse horizontal surface has radiance 1 on a clear day at noon.
#[test]
fn a_white_surface_at_noon_has_radiance_one() {
    let sky = clear_sky(60.0, 3.0);
    let white = (from_sky(&sky) + from_sun(&sky, 60.0)).luminance() / PI as f32;
    assert!((0.98..1.02).contains(&white), "{white}");
}

/// On a very clear day the sun gives four to five times what the sky does; haze turns that around.
#[test]
fn haze_moves_light_from_the_sun_to_the_sky() {
    let ratio = |turbidity| {
        let sky = clear_sky(45.0, turbidity);
        from_sun(&sky, 45.0).luminance() / from_sky(&sky).luminance()
    };
    assert!((4.0..5.0).contains(&ratio(2.0)), "{}", ratio(2.0));
    assert!(ratio(8.0) < 1.0, "{}", ratio(8.0));
}

#[test]
fn the_sky_is_blue_and_the_sun_is_warm_where_it_should_be() {
    let mut warmth = 1.0;
    for elevation in [60.0, 30.0, 10.0, 5.0] {
        let sky = clear_sky(elevation, 3.0);
        let zenith = sky.environment.radiance(Vec3::Y);
        assert!(zenith.b > 1.2 * zenith.r, "{elevation}: {zenith:?}");
        // The lower, the warmer.
        let sun = sky.sun.irradiance();
        assert!(sun.r > warmth * sun.b, "{elevation}: {sun:?}");
        warmth = sun.r / sun.b;
        // The brightest part of the sky is around the sun, where the disc is.
        let to_sun = direction_to_sun(elevation);
        let around = sky.environment.radiance(to_sun).luminance();
        let opposite = Vec3::new(-to_sun.x, to_sun.y, -to_sun.z);
        assert!(around > 3.0 * sky.environment.radiance(opposite).luminance());
        assert!(sky.sun.radiance(to_sun).luminance() > 50.0 * around);
        assert!(sky.sun.radiance(opposite).is_black());
        // The ground is a diffuse surface, of albedo 0.2, under all of that.
        let ground = sky.environment.radiance(Vec3::NEG_Y);
        let expected = (from_sky(&sky) + from_sun(&sky, elevation)) * (0.2 / PI as f32);
        for c in 0..3 {
            assert!((ground[c] / expected[c] - 1.0).abs() < 0.02, "{ground:?} {expected:?}");
        }
    }
}

/// At any height of the sun and any haze, no texel is negative or not finite, and the light fades steadily
/// from noon to night.
#[test]
fn the_sky_is_finite_and_fades() {
    for turbidity in [1.0, 10.0] {
        let mut brighter = f32::INFINITY;
        for elevation in [90.0, 20.0, 3.0, 0.0, -6.0, -90.0] {
            let sky = clear_sky(elevation, turbidity);
            assert_eq!(sky.environment.repaired_texels(), 0);
            assert!(sky.sun.irradiance().is_finite());
            assert!(elevation > 0.0 || sky.sun.irradiance().is_black());
            let power = sky.environment.power_estimate(1.0) + sky.sun.power_estimate(1.0);
            assert!(power < brighter, "{turbidity} {elevation}: {power}");
            brighter = power;
        }
        assert!(brighter < 1e-6, "{brighter}");
    }
}
