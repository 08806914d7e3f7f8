//! Transport classes partition the light: a class brings what is lost when it is left out.

#![cfg(feature = "embree")]

use crate::support::scenes::{Builder, cornell, cornell_shot, zoo, zoo_shot};
use crate::support::shot::Shot;
use crate::support::z_test::assert_difference;
use glint::film::ClassShare;
use glint::ledger::Class;
use glint::math::Rgb;
use glint::render::Rendered;
use glint::scene::{ColorInput, Environment, ScalarInput, Surface};
use glint::world::World;

fn luminance(rendered: &Rendered) -> f64 {
    let pixels = rendered.film.develop().radiance;
    pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / pixels.len() as f64
}

fn shares(rendered: &Rendered) -> Vec<ClassShare> {
    let (pixels, shares) = rendered.classes.shares(&rendered.film);
    assert_eq!(pixels, rendered.film.region().pixels(), "small pictures are watched whole");
    shares
}

/// A lamp, a floor, a glass ball, a rough metal ball and a mirror: every class has light.
fn table() -> Builder {
    let mut b = Builder::default();
    let n = ScalarInput::constant;
    let floor = b.lambert(0.6, 0.55, 0.5);
    let metal = b.material(Surface::Conductor {
        eta: Rgb::splat(0.2),
        k: Rgb::splat(3.0),
        roughness: n(0.5),
        anisotropy: 0.0,
    });
    let glass = b.material(Surface::Dielectric {
        eta: 1.5,
        roughness: n(0.0),
        absorption: Rgb::new(0.3, 0.1, 0.1),
        transmittance: Rgb::WHITE,
        thin: false,
    });
    let mirror = b.material(Surface::Mirror { reflectance: ColorInput::constant(Rgb::splat(0.9)) });
    let lamp = b.emitter(0.0, Rgb::splat(12.0));
    b.quad([-3.0, 0.0, -3.0], [0.0, 0.0, 6.0], [6.0, 0.0, 0.0], floor);
    b.quad([-2.0, 0.0, -1.5], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0], mirror);
    b.quad([-0.5, 3.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    b.sphere([-0.8, 0.5, 0.4], 0.5, 16, true, glass);
    b.sphere([0.7, 0.5, 0.3], 0.5, 16, true, metal);
    b.environment(Rgb::splat(0.2));
    b
}

fn table_shot() -> Shot {
    Shot::new([0.0, 1.6, 5.0], [0.0, 0.6, 0.0], 35.0, [48, 36], 64)
}

fn scenes() -> [(&'static str, World, Shot); 3] {
    [
        ("table", table().build(), table_shot()),
        ("zoo", zoo().build(), zoo_shot([48, 36], 32)),
        ("cornell", cornell().build(), cornell_shot([40, 40], 32)),
    ]
}

/// What is left out, one after the other, and the classes whose light is gone then. Each render draws the same numbers
/// as the one before: a path that ends sooner is the same path up to there.
const CHAIN: [(&str, &[Class]); 7] = [
    ("no-caustics", &[Class::Caustic]),
    ("no-refraction", &[Class::Refraction]),
    ("no-mirror", &[Class::Mirror]),
    ("no-glossy", &[Class::Glossy]),
    ("no-diffuse", &[Class::Diffuse]),
    (
        "no-direct",
        &[Class::DirectPoint, Class::DirectSun, Class::DirectSurface, Class::DirectEnvironment],
    ),
    ("no-emission,no-environment", &[Class::Seen]),
];

#[test]
fn the_light_of_a_class_is_what_is_lost_without_it() {
    for (name, world, shot) in scenes() {
        let whole = shot.render(&world);
        let (shares, all) = (shares(&whole), luminance(&whole));
        let (mut words, mut before, mut seen) = ("auto".to_owned(), all, 0);
        for (word, classes) in CHAIN {
            words = format!("{words},{word}");
            let without = luminance(&shot.with_effects(&words).render(&world));
            let energy: f64 = shares
                .iter()
                .filter(|share| classes.contains(&share.class))
                .map(|share| share.energy)
                .sum();
            let lost = (before - without) / all;
            assert!((lost - energy).abs() < 1e-5, "{name} {word}: {lost} lost, {energy} billed");
            seen += usize::from(energy > 1e-3);
            before = without;
        }
        assert!(before.abs() < 1e-6 * all, "{name}: {before} of {all} is left");
        assert!(seen >= if name == "table" { 7 } else { 3 }, "{name}: only {seen} have light");
    }
}

#[test]
fn shares_add_up() {
    for (name, world, shot) in scenes() {
        let shares = shares(&shot.render(&world));
        let sum = |of: fn(&ClassShare) -> f64| shares.iter().map(of).sum::<f64>();
        assert!((sum(|s| s.energy) - 1.0).abs() < 1e-12, "{name} {shares:?}");
        assert!((sum(|s| s.variance.expect("noise")) - 1.0).abs() < 1e-9, "{name} {shares:?}");
    }
}

/// Scenes in which `auto` leaves a constant environment to scattering and `all` samples it have the same mean: one
/// percent of difference would be seen.
#[test]
fn both_estimators_have_the_same_mean() {
    let mut open = Builder::default();
    let grey = open.lambert(0.6, 0.6, 0.6);
    open.quad([-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], grey);
    open.sphere([0.0, 0.6, 0.0], 0.6, 12, false, grey);
    open.environment(Rgb::splat(1.0));
    for (name, world, shot) in [
        ("open", open.build(), Shot::new([0.0, 1.5, 4.0], [0.0, 0.4, 0.0], 35.0, [24, 18], 16)),
        ("table", table().build(), Shot { spp: 16, size: [24, 18], ..table_shot() }),
    ] {
        let [auto, all] = ["auto", "all"].map(|effects| shot.with_effects(effects));
        assert_ne!(auto.plan(&world).1.lights.is_empty(), name == "table", "{name}");
        let of = |shot: &Shot, seed| luminance(&Shot { seed, ..shot.clone() }.render(&world));
        let seeds = if name == "open" { 24 } else { 400 };
        let pairs: Vec<[f64; 2]> =
            (0..seeds).map(|seed| [of(&auto, seed), of(&all, seed)]).collect();
        assert_difference(name, &pairs, 0.01);
    }
}

/// The variance share of a class is not that of another one: what is steady has none, whoever it is.
#[test]
fn noise_is_billed_to_whom_it_belongs() {
    // A floor under a constant environment, seen next to a glass ball that throws caustics of a lamp.
    let (_, world, shot) = scenes().into_iter().next().expect("the table");
    let whole = shares(&shot.render(&world));
    let of = |class: Class| whole.iter().find(|share| share.class == class).expect("it has light");
    let caustic = of(Class::Caustic);
    assert!(
        caustic.variance.expect("noise") > 3.0 * caustic.energy,
        "caustics are noisy: {caustic:?}"
    );
    let steady = of(Class::DirectSurface);
    assert!(steady.variance.expect("noise") < steady.energy, "direct light is not: {steady:?}");
}

#[test]
fn direct_light_is_billed_to_its_kind_of_light() {
    use glint::math::DVec3;
    use glint::scene::Light;
    let position = DVec3::new(1.0, 2.0, 1.0);
    let intensity = Rgb::splat(5.0);
    let direction = DVec3::new(0.2, -1.0, 0.1);
    let sun = |angular_diameter| Light::Directional {
        direction,
        irradiance: Rgb::WHITE,
        angular_diameter,
    };
    let spot = Light::Spot { position, direction, intensity, outer_angle: 60.0, inner_angle: 50.0 };
    let sky = Environment::Constant { radiance: Rgb::WHITE };
    type Setting<'a> = (Class, &'a dyn Fn(&mut Builder));
    let settings: [Setting<'_>; 6] = [
        (Class::DirectPoint, &|b| b.scene.lights.push(Light::Point { position, intensity })),
        (Class::DirectPoint, &|b| b.scene.lights.push(spot)),
        (Class::DirectSun, &|b| b.scene.lights.push(sun(0.0))),
        (Class::DirectSun, &|b| b.scene.lights.push(sun(2.0))),
        (Class::DirectEnvironment, &|b| b.scene.environment = Some(sky)),
        (Class::DirectSurface, &|b| {
            let lamp = b.emitter(0.0, Rgb::splat(9.0));
            b.quad([-0.5, 3.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
        }),
    ];
    for (class, light) in settings {
        let mut b = Builder::default();
        let floor = b.lambert(0.5, 0.5, 0.5);
        b.quad([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], floor);
        light(&mut b);
        let shot = Shot::new([0.0, 2.0, 3.0], [0.0, 0.0, 0.0], 30.0, [16, 16], 4);
        for effects in ["auto", "all"] {
            let world = World::compile(b.scene.clone()).expect("it compiles");
            let shares = shares(&shot.with_effects(effects).render(&world));
            // A flat floor: nothing but direct light.
            assert_eq!(shares.len(), 1, "{class:?} {effects}: {shares:?}");
            assert_eq!(shares[0].class, class, "{effects}");
        }
    }
}

#[test]
fn wavefront_equals_naive_whatever_is_left_out() {
    for (name, world, shot) in scenes() {
        let shot = Shot { size: [24, 18], spp: 4, ..shot };
        for effects in [
            "all",
            "whitted",
            "direct",
            "ambient-occlusion",
            "no-shadows",
            "no-scatter-sampling",
            "no-light-sampling",
            "no-absorption,no-caustics",
            "no-direct,no-emission",
            "no-diffuse",
            "no-glossy",
            "no-mirror",
            "no-refraction",
            "mirror,refraction,environment",
        ] {
            for max_depth in [u32::MAX, 3] {
                let shot = Shot { max_depth, ..shot.with_effects(effects) };
                let wavefront = shot.wavefront_samples(&world);
                let naive = shot.naive_samples(&world);
                for (sample, naive) in wavefront.iter().zip(naive) {
                    let difference = (sample.radiance - naive).map(f32::abs).max_channel();
                    let size = naive.map(f32::abs).max_channel();
                    let allowed = 1e-5 * size;
                    assert!(
                        difference <= allowed,
                        "{name} {effects} {max_depth}: {:?} and {naive:?} at {:?}",
                        sample.radiance,
                        sample.pixel
                    );
                }
            }
        }
    }
}
