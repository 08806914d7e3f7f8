//! Every sampler of renders: unbiased, the same path by path in both integrators, and better than random numbers.

#![cfg(feature = "embree")]

use crate::support::effort;
use crate::support::scene_files::{FileScene, Small};
use crate::support::scenes::{cornell, cornell_shot, mean, zoo, zoo_shot};
use crate::support::shot::Shot;
use crate::support::z_test::limit;
use glint::accel::embree::EmbreeAccelerator;
use glint::sampling::Strategy;
use glint::world::World;
use std::path::Path;

fn samplers() -> impl Iterator<Item = Strategy> {
    Strategy::ALL.iter().copied().filter(|strategy| strategy.can_render())
}

/// Those whose estimates are unbiased.
fn unbiased() -> impl Iterator<Item = Strategy> {
    samplers().filter(|strategy| *strategy != Strategy::Grid)
}

/// Mean luminance of pictures under many seeds against that of ten times as many of random numbers. 14 samplers, three
/// scenes; an error of 6 % of the light is found, 2 % in the thorough tier.
#[test]
fn every_sampler_but_the_grid_is_unbiased() {
    let power = effort(6, 2) as f64 / 100.0;
    let seeds = effort(100, 900) as u64;
    let depth_of_field =
        FileScene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/effects/lens.toml"));
    let (lens_world, lens_plan) = depth_of_field.plan("auto");
    let lens_embree = EmbreeAccelerator::build(lens_world.geometry.clone(), 2).expect("it builds");
    let (cornell, zoo) = (cornell().build(), zoo().build());
    let of_shot = |world: &World, shot: Shot, strategy, seed| {
        luminance(mean(&Shot { kind: strategy, seed, threads: 2, ..shot }.pixels(world)))
    };
    let of_lens = |strategy, seed| {
        let small = Small { size: [20, 12], spp: 16, seed, strategy };
        let rendered = depth_of_field.render_on(&lens_world, &lens_plan, &lens_embree, small);
        luminance(mean(&rendered.film.develop()))
    };
    // Counts that are no powers of two are among them.
    type Picture<'a> = (&'static str, Box<dyn Fn(Strategy, u64) -> f64 + 'a>);
    let bright = |spp| Shot { max_depth: 2, ..zoo_shot([20, 16], spp) };
    let pictures: [Picture<'_>; 3] = [
        ("cornell", Box::new(|s, seed| of_shot(&cornell, cornell_shot([16, 16], 16), s, seed))),
        ("zoo", Box::new(|s, seed| of_shot(&zoo, bright(20), s, seed))),
        ("lens", Box::new(of_lens)),
    ];
    for (name, picture) in &pictures {
        // Random numbers for a reference: what a set could get wrong is not in it.
        let references = 10 * seeds;
        let reference =
            moments((0..references).map(|seed| picture(Strategy::Random, seeds + seed)));
        for strategy in unbiased() {
            let own = moments((0..seeds).map(|seed| picture(strategy, seed)));
            // Nearly all of the variance, and so of its uncertainty, is that of the fewer pictures.
            let limit = limit(seeds as f64) * (own.1 + reference.1).sqrt();
            let difference = (own.0 - reference.0).abs();
            let what = format!("{name}, {}: {own:?} {reference:?}", strategy.name());
            assert!(difference < limit, "{what}");
            assert!(power * reference.0 > difference + limit, "{what}: no power");
        }
    }
}

/// Mean, and the variance of that mean.
fn moments(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
    (mean, squares / (n - 1.0) / n)
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// What sampling is for: at equal samples the error of a picture is no larger than random numbers make it, 5 % of noise
/// aside, and that of the default is at most nine tenths of it.
#[test]
fn no_sampler_is_worse_than_random_numbers() {
    let world = cornell().build();
    let picture = |strategy, seed, spp| {
        let shot = Shot { kind: strategy, seed, ..cornell_shot([32, 32], spp) };
        shot.pixels(&world).radiance.iter().map(|r| f64::from(r.luminance())).collect::<Vec<_>>()
    };
    let truth = picture(Strategy::Sobol, 8, 4096);
    let error = |strategy| {
        let squared = |seed| {
            let pixels = picture(strategy, seed, 16);
            pixels.iter().zip(&truth).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
        };
        (0..8).map(squared).sum::<f64>().sqrt()
    };
    let random = error(Strategy::Random);
    for strategy in unbiased() {
        let ratio = error(strategy) / random;
        assert!(ratio < 1.05, "{}: {ratio}", strategy.name());
        assert!(strategy != Strategy::Sobol || ratio < 0.9, "sobol: {ratio}");
    }
}

/// The error that `sobol-blue-noise` leaves on the screen has less power at low frequencies: blurred over 4 by 4 pixels, the
/// pictures are nearer to the truth than with `sobol`, though pixel by pixel they are as far.
#[test]
fn blue_noise_on_the_screen_is_blue() {
    let world = cornell().build();
    let pixels = |strategy, seed, spp| {
        let shot = Shot { kind: strategy, seed, max_depth: 2, ..cornell_shot([32, 32], spp) };
        shot.pixels(&world).radiance.iter().map(|r| f64::from(r.luminance())).collect::<Vec<_>>()
    };
    let truth = pixels(Strategy::Sobol, 16, 4096);
    let errors = |strategy| {
        let (mut sharp, mut blurred) = (0.0, 0.0);
        for seed in 0..16 {
            let image = pixels(strategy, seed, 4);
            let difference = |x: usize, y: usize| image[32 * y + x] - truth[32 * y + x];
            for y in (0..32).step_by(4) {
                for x in (0..32).step_by(4) {
                    let block = || (0..16).map(|i| difference(x + i % 4, y + i / 4));
                    sharp += block().map(|d| d * d).sum::<f64>();
                    blurred += (block().sum::<f64>() / 4.0).powi(2);
                }
            }
        }
        (sharp.sqrt(), blurred.sqrt())
    };
    let (plain, screen) = (errors(Strategy::Sobol), errors(Strategy::ScreenSobol));
    assert!((0.8..1.2).contains(&(screen.0 / plain.0)), "pixel by pixel {}", screen.0 / plain.0);
    assert!(screen.1 / plain.1 < 0.85, "blurred {}", screen.1 / plain.1);
}
