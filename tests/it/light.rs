//! Lights: every sampler against its density, every estimate against a closed form or a quadrature.

#![expect(clippy::unwrap_used, reason = "a test may unwrap, and so may its helpers")]

mod images;
mod local;
mod sampling;
mod sky;
mod sphere_chi_square;

use glint::light::{Sky, SkyParameters};
use glint::math::fun::double;
use glint::math::{DVec3, Rgb, Vec3};
use glint::sampling::CounterRng;
use std::f64::consts::PI;

/// Texels that span four orders of magnitude.
fn spiky([width, height]: [usize; 2]) -> Vec<Rgb> {
    let mut rng = CounterRng::new(0);
    let mut channel = || double::exp(10.0 * f64::from(rng.unit()) - 5.0) as f32;
    (0..width * height).map(|_| Rgb::new(channel(), channel(), channel())).collect()
}

/// A black image with one bright texel.
fn one_bright([width, height]: [usize; 2], [column, row]: [usize; 2]) -> Vec<Rgb> {
    let mut texels = vec![Rgb::BLACK; width * height];
    texels[row * width + column] = Rgb::new(3.0, 2.0, 1.0);
    texels
}

/// Of the sun in [`clear_sky`], degrees.
const AZIMUTH: f64 = 130.0;

/// A sky over ground of albedo 0.2.
fn clear_sky(elevation: f64, turbidity: f64) -> Sky {
    let ground_albedo = Rgb::splat(0.2);
    let (azimuth, scale, up) = (AZIMUTH, 1.0, DVec3::Y);
    Sky::new(&SkyParameters { elevation, azimuth, turbidity, ground_albedo, scale, up }).unwrap()
}

/// Unit vector to the sun of [`clear_sky`].
fn direction_to_sun(elevation: f64) -> Vec3 {
    let (e, a) = (elevation.to_radians(), AZIMUTH.to_radians());
    DVec3::new(double::cos(e) * double::sin(a), double::sin(e), double::cos(e) * double::cos(a))
        .as_vec3()
}

/// Sums of `f(direction)` times solid angle over the sphere, on a latitude-longitude grid of `n` rows.
fn integrate<const N: usize>(n: usize, f: impl Fn(Vec3) -> [f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for row in 0..n {
        let (top, bottom) = (PI * row as f64 / n as f64, PI * (row + 1) as f64 / n as f64);
        let theta = 0.5 * (top + bottom);
        let solid_angle = (double::cos(top) - double::cos(bottom)) * PI / n as f64;
        for column in 0..2 * n {
            let phi = (column as f64 + 0.5) / n as f64 * PI;
            let direction = DVec3::new(
                double::sin(theta) * double::sin(phi),
                double::cos(theta),
                double::sin(theta) * double::cos(phi),
            );
            let values = f(direction.as_vec3());
            (0..N).for_each(|k| sums[k] += values[k] * solid_angle);
        }
    }
    sums
}
