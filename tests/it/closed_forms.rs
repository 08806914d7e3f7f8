//! Renders whose answer is known in closed form.

#![cfg(feature = "embree")]

use crate::support::scenes::{Builder, mean};
use crate::support::shot::Shot;
use crate::support::z_test::{assert_mean, assert_mean_power};
use glint::film::Pixels;
use glint::math::{DVec3, Rgb};
use glint::scene::{ColorInput, Light, Surface};
use glint::world::World;
use std::f64::consts::PI;

fn red(pixels: &Pixels) -> impl Iterator<Item = f64> {
    pixels.radiance.iter().map(|p| f64::from(p.r))
}

/// A shot of a spot of the floor around the origin, small enough for its radiance to be constant.
fn floor_spot(spp: u64) -> Shot {
    Shot::new([0.0, 0.5, 3.0], [0.0, 0.0, 0.0], 0.02, [32, 32], spp)
}

/// Radiance of a white Lambertian floor at the origin under what `light` adds.
fn floor_under(light: impl FnOnce(&mut Builder), spp: u64) -> Pixels {
    let mut b = Builder::default();
    let white = b.lambert(1.0, 1.0, 1.0);
    b.quad([-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    light(&mut b);
    let mut shot = floor_spot(spp);
    shot.max_depth = 2;
    shot.pixels(&b.build())
}

/// Lambert's formula: irradiance at the origin (normal +y) from a polygon of radiance 1.
/// E = 1/2 sum over edges of (angle subtended by the edge) (unit normal of its plane) . n.
fn polygon_irradiance(corners: &[DVec3]) -> f64 {
    let n = corners.len();
    let sum: f64 = (0..n)
        .map(|i| {
            let (a, b) = (corners[i].normalize(), corners[(i + 1) % n].normalize());
            a.dot(b).acos() * a.cross(b).normalize().y
        })
        .sum();
    (0.5 * sum).abs()
}

#[test]
fn irradiance_under_a_rectangle_is_lamberts() {
    for (corner, a, b) in [
        ([-0.5, 1.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([0.5, 0.2, -0.4], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]),
    ] {
        let pixels = floor_under(
            |s| {
                let lamp = s.emitter(0.0, Rgb::splat(1.0));
                s.quad(corner, a, b, lamp);
            },
            256,
        );
        let at = |s: f64, t: f64| {
            DVec3::from(corner.map(f64::from))
                + DVec3::from(a.map(f64::from)) * s
                + DVec3::from(b.map(f64::from)) * t
        };
        let truth =
            polygon_irradiance(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]) / PI;
        // The bar: half a percent.
        assert_mean_power("rectangle", red(&pixels), truth, 0.005);
    }
}

#[test]
fn irradiance_under_a_sphere_is_its_solid_angle() {
    // A sphere of radius r at height h overhead: E = pi L (r/h)^2. The mesh is inscribed: its projected
    // area falls short by the ratio of the polygon's, which the fine tessellation keeps below 0.05 %.
    let pixels = floor_under(
        |s| {
            let lamp = s.emitter(0.0, Rgb::splat(2.0));
            s.sphere([0.0, 2.0, 0.0], 0.5, 96, false, lamp);
        },
        1024,
    );
    assert_mean("sphere light", red(&pixels), 2.0 * 0.25_f64.powi(2));
}

#[test]
fn point_and_distant_lights_follow_their_laws() {
    let point = |position: DVec3| {
        let intensity = Rgb::splat(3.0);
        floor_under(|s| s.scene.lights.push(Light::Point { position, intensity }), 1)
    };
    // E = I cos / d^2; radiance E / pi.
    let p = DVec3::new(1.0, 2.0, -0.5);
    let truth = 3.0 * (p.y / p.length()) / p.length_squared() / PI;
    assert!((mean(&point(p))[0] / truth - 1.0).abs() < 1e-3);

    for angular_diameter in [0.0, 5.0] {
        let pixels = floor_under(
            |s| {
                s.scene.lights.push(Light::Directional {
                    direction: DVec3::new(0.0, -1.0, 1.0),
                    irradiance: Rgb::splat(2.0),
                    angular_diameter,
                });
            },
            64,
        );
        let truth = 2.0 * 0.5_f64.sqrt() / PI;
        assert!((mean(&pixels)[0] / truth - 1.0).abs() < 2e-3, "{angular_diameter}");
    }
}

/// A closed room that emits 1 and reflects `albedo` everywhere has radiance 1 / (1 - albedo).
#[test]
fn furnace_radiance_is_the_geometric_series() {
    for albedo in [0.2_f32, 0.5, 0.8] {
        let mut b = Builder::default();
        let wall = b.emitter(albedo, Rgb::WHITE);
        b.sphere([0.0; 3], 1.0, 12, false, wall);
        let shot = Shot::new([0.1, 0.2, 0.0], [1.0, 0.0, 0.3], 60.0, [32, 32], 1024);
        let truth = 1.0 / (1.0 - f64::from(albedo));
        assert_mean(&format!("furnace {albedo}"), red(&shot.pixels(&b.build())), truth);
    }
}

/// The same far from the origin and at other scales: ray offsets neither leak nor self-shadow.
#[test]
fn furnace_holds_at_any_scale_and_place() {
    for (scale, shift) in [(1e-5, 0.0), (1e5, 0.0), (1.0, 1e6), (1e-2, -3e3)] {
        let mut b = Builder::default();
        let wall = b.emitter(0.5, Rgb::WHITE);
        b.sphere([0.0; 3], scale, 12, true, wall);
        b.scene.placements[0].world_from_object =
            glint::math::DAffine3::from_translation(DVec3::new(shift, 0.0, -shift));
        let s = f64::from(scale);
        let from = [shift + 0.1 * s, 0.2 * s, -shift];
        let to = [shift + s, 0.0, 0.3 * s - shift];
        let shot = Shot::new(from, to, 60.0, [32, 32], 64);
        // Smooth normals reject some directions below the facets: compare with the flat room's 2
        // within the few percent that this takes, from below only.
        let m = mean(&shot.pixels(&b.build()))[0];
        assert!((1.9..2.0003).contains(&m), "scale {scale} shift {shift}: {m}");
    }
}

/// A white object in a white environment disappears.
#[test]
fn white_furnace_in_the_open() {
    let mut b = Builder::default();
    let white = b.lambert(1.0, 1.0, 1.0);
    b.sphere([0.0; 3], 1.0, 24, false, white);
    b.quad([-2.0, -1.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], white);
    b.environment(Rgb::splat(0.7));
    let shot = Shot::new([0.0, 1.0, 6.0], [0.0; 3], 30.0, [32, 32], 256);
    assert_mean("white furnace", red(&shot.pixels(&b.build())), f64::from(0.7_f32));
}

/// Seen in a mirror, a lamp is where the mirrored lamp would be, as bright as the mirror lets it.
#[test]
fn a_mirror_shows_the_mirrored_scene() {
    let lamp_at = |through_mirror: bool| -> World {
        let mut b = Builder::default();
        let lamp = b.emitter(0.0, Rgb::new(1.0, 0.5, 0.25));
        let z = if through_mirror { 1.0 } else { -3.0 };
        if through_mirror {
            let reflectance = ColorInput::constant(Rgb::splat(0.5));
            let mirror = b.material(Surface::Mirror { reflectance });
            b.quad([-9.0, -9.0, -1.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0], mirror);
        }
        b.quad([0.7, 0.2, z], [0.4, 0.0, 0.0], [0.0, 0.5, 0.0], lamp);
        b.environment(Rgb::BLACK);
        b.build()
    };
    // The camera sits between the lamp and the mirror, and sees the lamp in the mirror only.
    let shot = Shot::new([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 60.0, [96, 96], 16);
    let reflected = shot.pixels(&lamp_at(true));
    let direct = shot.pixels(&lamp_at(false));
    for (reflected, direct) in reflected.radiance.iter().zip(&direct.radiance) {
        // Rays of the same pixel sample meet the same points but for rounding at the lamp's edge.
        assert!((*reflected - *direct * 0.5).map(f32::abs).max_channel() < 0.07);
    }
    let (a, b) = (mean(&reflected)[0], mean(&direct)[0]);
    assert!(b > 0.001 && (a / (0.5 * b) - 1.0).abs() < 1e-3, "{a} {b}");
}

/// A glass slab absorbs by Beer-Lambert's law and reflects by Fresnel's.
#[test]
fn a_slab_of_glass_transmits_what_beer_and_fresnel_leave() {
    let mut b = Builder::default();
    let glass = b.material(Surface::Dielectric {
        eta: 1.5,
        roughness: glint::scene::ScalarInput::constant(0.0),
        absorption: Rgb::new(0.3, 1.0, 2.0),
        transmittance: Rgb::WHITE,
        thin: false,
    });
    // Two faces, half a unit apart, winding outward; a lamp behind, seen straight through.
    b.quad([-9.0, -9.0, 0.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0], glass);
    b.quad([-9.0, -9.0, -0.5], [0.0, 18.0, 0.0], [18.0, 0.0, 0.0], glass);
    let lamp = b.emitter(0.0, Rgb::WHITE);
    b.quad([-9.0, -9.0, -2.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0], lamp);
    let shot = Shot::new([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 0.05, [48, 48], 256);
    let pixels = shot.pixels(&b.build());
    for (c, absorption) in [0.3_f64, 1.0, 2.0].into_iter().enumerate() {
        let (r, t) = (0.04, (-0.5 * absorption).exp());
        // Two interfaces with all inner reflections: (1-r)^2 t / (1 - r^2 t^2).
        let truth = (1.0 - r) * (1.0 - r) * t / (1.0 - r * r * t * t);
        let channel = pixels.radiance.iter().map(|p| f64::from(p[c]));
        assert_mean(&format!("slab, channel {c}"), channel, truth);
    }
}

/// Depth counts segments: 1 shows emitters only, 2 adds direct light, 3 one bounce more.
#[test]
fn depth_counts_path_segments() {
    let at_depth = |max_depth: u32| {
        let mut b = Builder::default();
        let wall = b.emitter(0.5, Rgb::WHITE);
        b.sphere([0.0; 3], 1.0, 12, false, wall);
        let mut shot = Shot::new([0.1, 0.2, 0.0], [1.0, 0.0, 0.3], 60.0, [32, 32], 64);
        shot.max_depth = max_depth;
        shot.pixels(&b.build())
    };
    for (depth, truth) in [(1, 1.0), (2, 1.5), (3, 1.75)] {
        assert_mean(&format!("depth {depth}"), red(&at_depth(depth)), truth);
    }
}

/// Ten thousand emitters of very different power: picked in proportion to it, the noise is that of one.
#[test]
fn many_emitters_are_picked_by_power() {
    let lamps = |n: u32| {
        floor_under(
            |s| {
                let dim = s.emitter(0.0, Rgb::splat(1e-4));
                let bright = s.emitter(0.0, Rgb::splat(50.0));
                for i in 0..n {
                    let (x, z) = ((i % 100) as f32 * 0.02 - 1.0, (i / 100) as f32 * 0.02 - 1.0);
                    let m = if i == n / 2 { bright } else { dim };
                    s.quad([x, 1.0, z], [0.01, 0.0, 0.0], [0.0, 0.0, 0.01], m);
                }
            },
            16,
        )
    };
    let pixels = lamps(5_000);
    let m = mean(&pixels)[0];
    let variance = red(&pixels).map(|x| (x - m) * (x - m)).sum::<f64>() / 1024.0;
    // Uniform picking would have a relative deviation of sqrt(10 000 / 16) = 25.
    assert!(variance.sqrt() / m < 0.1, "relative deviation {}", variance.sqrt() / m);
}
