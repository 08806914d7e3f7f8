//! What samplers promise: uniform, independent of each other, and in the strata of their sets.

use super::*;

fn samplers() -> impl Iterator<Item = Strategy> {
    Strategy::ALL.iter().copied().filter(|strategy| strategy.can_render())
}

#[test]
fn values_depend_on_every_part_of_the_key() {
    for strategy in samplers().filter(|s| *s != Strategy::Grid) {
        // Wholes of 64 numbers: single ones may well be the same.
        let of = |seed, x, y, block: u64, replicate, dimension| {
            let sampler = Sampler::new(strategy, seed, 256);
            let size = Sampler::set_size(strategy, 256).unwrap_or(1 << 32) * REPLICATES as u64;
            let first = block * size + replicate;
            (0..64)
                .map(|s| sampler.two(sampler.path(x, y, first + 4 * s), dimension))
                .collect::<Vec<_>>()
        };
        let base = of(0, 3, 5, 0, 1, Dimension::Film);
        let others = [
            of(1, 3, 5, 0, 1, Dimension::Film),
            of(0, 4, 5, 0, 1, Dimension::Film),
            of(0, 3, 6, 0, 1, Dimension::Film),
            of(0, 3, 5, 1, 1, Dimension::Film),
            of(0, 3, 5, 0, 2, Dimension::Film),
            of(0, 3, 5, 0, 1, Dimension::Lens),
        ];
        for (i, other) in others.iter().enumerate() {
            let same = base.iter().zip(other).filter(|(a, b)| a == b).count();
            assert!(same <= 1, "{}: {same} of 64 the same, part {i}", strategy.name());
        }
    }
}

#[test]
fn values_are_below_one() {
    for strategy in samplers() {
        let sampler = Sampler::new(strategy, 0, 1000);
        for s in 0..20_000 {
            let path = sampler.path(s as u32 % 7, 2, s);
            let [x, y] = sampler.two(path, Dimension::Lens);
            let z = sampler.one(path, Dimension::Roulette { bounce: 2 });
            for v in [x, y, z] {
                assert!((0.0..1.0).contains(&v), "{}: {v}", strategy.name());
            }
        }
    }
}

/// Whatever the strategy, every sample of a pixel is uniform by itself: 20 000 pixels in 8 by 8 boxes, for the first and
/// for another sample of a set of 16. Chi squared of 63 degrees is above 155 with 2e-9: 30 comparisons, 6e-8 in
/// all; a density off by a fifth in a quarter of the square would be found.
#[test]
fn every_sample_is_uniform() {
    for strategy in samplers().filter(|s| *s != Strategy::Grid) {
        for sample in [0, 36] {
            let mut counts = [0_u32; 64];
            let trials = 20_000;
            // One sampler, since tables take time: pixels randomise as seeds do.
            let sampler = Sampler::new(strategy, 0, 64);
            for trial in 0..trials {
                let (x, y) = (trial % 173, trial / 173);
                let [u, v] = sampler.two(sampler.path(x, y, sample), Dimension::Film);
                counts[(8.0 * u) as usize * 8 + (8.0 * v) as usize] += 1;
            }
            let expected = f64::from(trials) / 64.0;
            let chi_squared: f64 =
                counts.iter().map(|c| (f64::from(*c) - expected).powi(2) / expected).sum();
            assert!(chi_squared < 155.0, "{} {sample}: {chi_squared}", strategy.name());
        }
    }
}

/// Mean of a product of two dimensions, each a pair: 1/16 only if the dimensions are independent of each other. 16 384
/// pixels of 16 samples, 5.5 standard errors from their own spread: 15 comparisons, 6e-7 in all; a correlation
/// of 2 % would be found.
#[test]
fn dimensions_are_padded_without_correlation() {
    for strategy in samplers() {
        let sampler = Sampler::new(strategy, 0, 64);
        let (mut sum, mut squares) = (0.0, 0.0);
        let pixels = 16_384;
        for pixel in 0..pixels {
            let mut mean = 0.0;
            for s in 0..16 {
                let path = sampler.path(pixel % 128, pixel / 128, 4 * s);
                let [a, b] = sampler.two(path, Dimension::Film).map(|v| f64::from(v) - 0.5);
                let [c, d] = sampler.two(path, Dimension::Lens).map(|v| f64::from(v) - 0.5);
                mean += (a * c + b * d) / 16.0;
            }
            sum += mean;
            squares += mean * mean;
        }
        let n = f64::from(pixels);
        let error = (squares / n).sqrt() / n.sqrt();
        assert!((sum / n).abs() < 5.5 * error, "{}: {} {error}", strategy.name(), sum / n);
        assert!(error < 2.0 * 0.02 / 12.0 / 8.5, "{}: no power, {error}", strategy.name());
    }
}

/// A sampler keeps the strata of its sets: in any pixel and dimension.
#[test]
fn sets_keep_their_strata() {
    let cell = |v: f32, n: f32| (v * n) as usize;
    for pixel in 0..50 {
        for (strategy, fills) in [
            (Strategy::Jittered, [true, false, false]),
            (Strategy::NRooks, [false, true, true]),
            (Strategy::Hammersley, [false, true, true]),
            (Strategy::MultiJittered, [true, true, true]),
            (Strategy::CorrelatedMultiJittered, [true, true, true]),
            (Strategy::Pmj02, [true, true, true]),
            (Strategy::Sobol, [true, true, true]),
        ] {
            let sampler = Sampler::new(strategy, 0, 64);
            let points = (0..16).map(|s| {
                sampler
                    .two(sampler.path(pixel, 1, 4 * s + 2), Dimension::LightPosition { bounce: 3 })
            });
            let mut seen = [[false; 16]; 3];
            for [x, y] in points {
                seen[0][cell(x, 4.0) * 4 + cell(y, 4.0)] = true;
                seen[1][cell(x, 16.0)] = true;
                seen[2][cell(y, 16.0)] = true;
            }
            let filled = seen.map(|strata| strata.iter().all(|s| *s));
            for (is_filled, must) in filled.into_iter().zip(fills) {
                assert!(is_filled || !must, "{}: {seen:?}", strategy.name());
            }
        }
    }
}

/// Mean of a smooth integrand: with 256 points the error of every strategy is at most six tenths of random's, from 256
/// means (a ratio that is known to 6 %), and Sobol's falls with more than the power 1.2.
#[test]
fn strategies_beat_random_numbers() {
    let rms = |strategy, n: u64| {
        let mut sum = 0.0_f64;
        let sampler = Sampler::new(strategy, 0, n * REPLICATES as u64);
        for pixel in 0..256 {
            let path = |s| sampler.path(pixel % 16, pixel / 16, s * REPLICATES as u64);
            let value = |[x, y]: [f32; 2]| f64::from(x * x * y) / n as f64;
            let mean: f64 = (0..n).map(|s| value(sampler.two(path(s), Dimension::Film))).sum();
            sum += (mean - 1.0 / 6.0).powi(2);
        }
        (sum / 256.0).sqrt()
    };
    let random = rms(Strategy::Random, 256);
    for strategy in samplers().filter(|s| !matches!(s, Strategy::Random | Strategy::Grid)) {
        let ratio = rms(strategy, 256) / random;
        assert!(ratio < 0.6, "{}: {ratio}", strategy.name());
    }
    let slope = (rms(Strategy::Sobol, 16) / rms(Strategy::Sobol, 1024)).log2() / 6.0;
    assert!(slope > 1.2, "slope {slope}");
}

/// Single numbers fill their strata, too: light selection, lobes and roulette are drawn so.
#[test]
fn single_numbers_fill_their_strata() {
    for strategy in [
        Strategy::Grid,
        Strategy::Jittered,
        Strategy::NRooks,
        Strategy::MultiJittered,
        Strategy::CorrelatedMultiJittered,
        Strategy::Hammersley,
        Strategy::Sobol,
        Strategy::Pmj02,
    ] {
        // The replicates of a grid share one set.
        let (count, step) = if strategy == Strategy::Grid { (16, 1) } else { (64, 4) };
        let sampler = Sampler::new(strategy, 0, count);
        for pixel in 0..50 {
            let mut seen = [false; 16];
            for s in 0..16 {
                let path = sampler.path(pixel, 1, step * s);
                let number = sampler.one(path, Dimension::LightSelect { bounce: 2 });
                seen[(16.0 * number) as usize] = true;
            }
            // A shift moves all strata alike, so that two may share a box and one be left.
            let filled = seen.iter().filter(|s| **s).count();
            let least = if strategy == Strategy::Hammersley { 15 } else { 16 };
            assert!(filled >= least, "{} {pixel}: {seen:?}", strategy.name());
        }
    }
}

/// No two samples of any pixels have the same name for hit filters.
#[test]
fn rays_have_names_of_their_own() {
    for strategy in samplers() {
        let sampler = Sampler::new(strategy, 0, 64);
        let mut ids = std::collections::BTreeSet::new();
        for pixel in 0..64 {
            for s in 0..64 {
                ids.insert(sampler.path(pixel % 8, pixel / 8, s).ray_id(0, 0));
            }
        }
        // Of 4096 hashes of 32 bits, two are the same in one of 500 draws.
        assert!(ids.len() >= 4094, "{}: {}", strategy.name(), ids.len());
    }
}
