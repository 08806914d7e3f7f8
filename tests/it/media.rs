//! Light within absorbing media: the law of Beer and Lambert on the way from the light as on the way to the camera,
//! however the light is found.

#![cfg(feature = "embree")]

use crate::support::scenes::{Builder, mean};
use crate::support::shot::Shot;
use crate::support::z_test::assert_mean;
use glint::math::{DVec3, Rgb};
use glint::scene::{Light, ScalarInput, Surface};
use std::f64::consts::PI;

const ABSORPTION: [f32; 3] = [0.2, 0.5, 0.8];

/// A pool from the bottom at y = 0 to the surface at y = 2, which bends and reflects nothing.
fn pool() -> Builder {
    let mut b = Builder::default();
    let floor = b.lambert(0.5, 0.5, 0.5);
    b.quad([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], floor);
    let [red, green, blue] = ABSORPTION;
    let water = b.material(Surface::Dielectric {
        eta: 1.0,
        roughness: ScalarInput::constant(0.0),
        absorption: Rgb::new(red, green, blue),
        transmittance: Rgb::WHITE,
        thin: false,
    });
    b.quad([-9.0, 2.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], water);
    b
}

/// One pixel of the bottom from straight above.
fn shot(spp: u64) -> Shot {
    let mut shot = Shot::new([0.001, 5.0, 0.0], [0.0, 0.0, 0.0], 0.02, [1, 1], spp);
    shot.max_depth = 3;
    shot
}

#[test]
fn a_lamp_in_the_water_lights_the_bottom_by_the_law() {
    let mut b = pool();
    let (intensity, height) = (3.0, 1.5);
    let position = DVec3::new(0.4, height, 0.0);
    b.scene.lights = vec![Light::Point { position, intensity: Rgb::splat(intensity) }];
    let world = b.build();
    let found = mean(&shot(16).pixels(&world));
    // Irradiance of a point light, I cos / d^2, dimmed on d metres to the bottom and 2 m from there to the surface.
    let distance = (0.4_f64 * 0.4 + height * height).sqrt();
    let irradiance = f64::from(intensity) * height / distance.powi(3);
    for (c, absorption) in ABSORPTION.into_iter().enumerate() {
        let kept = (-f64::from(absorption) * (distance + 2.0)).exp();
        let truth = 0.5 / PI * irradiance * kept;
        assert!((found[c] / truth - 1.0).abs() < 1e-3, "{c}: {} for {truth}", found[c]);
    }
}

/// Both ways of finding a lamp, and the two together, against a sum over small parts of it.
#[test]
fn every_way_of_finding_a_lamp_loses_the_same() {
    let mut b = pool();
    let lamp = b.emitter(0.0, Rgb::splat(4.0));
    b.quad([0.2, 1.5, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    let world = b.build();
    let mut irradiance = 0.0;
    const PARTS: u32 = 400;
    for i in 0..PARTS * PARTS {
        let [x, z] = [i % PARTS, i / PARTS].map(|k| (f64::from(k) + 0.5) / f64::from(PARTS));
        let (x, z) = (0.2 + x, z - 0.5);
        let squared = x * x + z * z + 1.5 * 1.5;
        // Two cosines, each 1.5 / distance.
        let kept = (-f64::from(ABSORPTION[2]) * squared.sqrt()).exp();
        irradiance += 4.0 * 1.5 * 1.5 / (squared * squared) * kept / f64::from(PARTS * PARTS);
    }
    let truth = 0.5 / PI * irradiance * (-2.0 * f64::from(ABSORPTION[2])).exp();
    for effects in ["auto", "all", "no-light-sampling", "no-scatter-sampling"] {
        let shot = shot(16_384).with_effects(effects);
        let of = |seed| mean(&Shot { seed, ..shot.clone() }.pixels(&world))[2];
        assert_mean(effects, (0..64).map(of), truth);
    }
}
