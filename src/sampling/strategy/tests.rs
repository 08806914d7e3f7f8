//! What the sets promise, strategy by strategy.

use super::*;
use crate::sampling::hash::combine;

fn sets() -> impl Iterator<Item = Strategy> {
    Strategy::ALL.iter().copied().filter(|strategy| strategy.has_sets())
}

fn points(strategy: Strategy, count: u32, seed: u64) -> Vec<[Fraction; 2]> {
    strategy.points(count, seed).unwrap_or_else(|e| panic!("{}: {e}", strategy.name())).points
}

/// Whether each of the `columns` times `rows` boxes holds just one of the points.
fn fills(points: &[[Fraction; 2]], columns: u32, rows: u32) -> bool {
    let mut seen = vec![false; (columns * rows) as usize];
    points.len() == seen.len()
        && points.iter().all(|[x, y]| {
            let column = (u64::from(*x) * u64::from(columns)) >> 32;
            let row = (u64::from(*y) * u64::from(rows)) >> 32;
            !std::mem::replace(&mut seen[(row * u64::from(columns) + column) as usize], true)
        })
}

#[test]
fn sets_have_as_many_points_as_asked_and_no_two_in_one_place() {
    for strategy in sets() {
        for count in [1, 2, 3, 16, 60, 100, 256] {
            let mut points = points(strategy, count, 0);
            assert_eq!(points.len(), count as usize, "{}", strategy.name());
            points.sort_unstable();
            points.dedup();
            assert_eq!(points.len(), count as usize, "{}", strategy.name());
        }
    }
}

#[test]
fn seeds_change_the_sets_that_are_random_and_no_others() {
    for strategy in sets() {
        let fixed = matches!(strategy, Strategy::Grid | Strategy::Halton | Strategy::Hammersley);
        assert_eq!(points(strategy, 64, 0), points(strategy, 64, 0));
        assert_eq!(
            points(strategy, 64, 0) == points(strategy, 64, 1),
            fixed,
            "{}",
            strategy.name()
        );
    }
}

/// Strata of each strategy, for square, oblong and odd counts.
#[test]
fn strata_are_filled_exactly() {
    for seed in 0..20 {
        for (strategy, side) in
            [(Strategy::Jittered, 7), (Strategy::Grid, 9), (Strategy::Jittered, 16)]
        {
            assert!(fills(&points(strategy, side * side, seed), side, side), "{}", strategy.name());
        }
        for count in [1, 2, 5, 17, 64, 99, 1000] {
            for strategy in [Strategy::NRooks, Strategy::Hammersley] {
                let set = points(strategy, count, seed);
                let is_full = fills(&set, count, 1);
                assert!(is_full, "{} {count}", strategy.name());
                assert!(strategy != Strategy::NRooks || fills(&set, 1, count));
            }
        }
        for (count, columns, rows) in [(12, 3, 4), (64, 8, 8), (99, 9, 11), (1000, 25, 40)] {
            for strategy in [Strategy::MultiJittered, Strategy::CorrelatedMultiJittered] {
                let set = points(strategy, count, seed);
                for (columns, rows) in [(columns, rows), (count, 1), (1, count)] {
                    assert!(fills(&set, columns, rows), "{} {count}", strategy.name());
                }
            }
        }
    }
}

/// The shuffles of correlated multi-jittered sets are the same in every column, those of plain ones are not.
#[test]
fn only_correlated_sets_are_correlated() {
    let places = |strategy, seed| {
        let mut columns = [[0; 8]; 8];
        for [x, y] in points(strategy, 64, seed) {
            let (fine, row) = ((u64::from(x) * 64) >> 32, (u64::from(y) * 8) >> 32);
            columns[(fine / 8) as usize][row as usize] = fine % 8;
        }
        columns
    };
    let is_same = |columns: [[u64; 8]; 8]| columns.iter().all(|column| *column == columns[0]);
    for seed in 0..20 {
        assert!(is_same(places(Strategy::CorrelatedMultiJittered, seed)));
        assert!(!is_same(places(Strategy::MultiJittered, seed)));
    }
}

/// Powers of two of these: every elementary interval of area 1/n holds just one point.
#[test]
fn nets_are_nets() {
    for seed in 0..6 {
        for m in 0..=10 {
            let (sobol, pmj02) =
                (points(Strategy::Sobol, 1 << m, seed), points(Strategy::Pmj02, 1 << m, seed));
            let hammersley = points(Strategy::Hammersley, 1 << m, seed);
            for a in 0..=m {
                for set in [&sobol, &pmj02, &hammersley] {
                    assert!(fills(set, 1 << a, 1 << (m - a)), "seed {seed}, 2^{m}, shape {a}");
                }
            }
        }
    }
}

/// What comes first does not depend on how much there will be.
#[test]
fn progressive_sets_are_prefixes_of_larger_ones() {
    for strategy in [Strategy::Random, Strategy::Halton, Strategy::Sobol, Strategy::Pmj02] {
        for seed in 0..4 {
            let whole = points(strategy, 256, seed);
            for count in [1, 7, 64, 255] {
                assert_eq!(
                    points(strategy, count, seed),
                    whole[..count as usize],
                    "{}",
                    strategy.name()
                );
            }
        }
    }
}

/// Smallest distance between points relative to the largest that so many can have: what strategies of even spacing are for.
#[test]
fn even_spacing_is_even() {
    let smallest = |strategy, seed| {
        let set = points(strategy, 256, seed);
        let squared = (0..256).flat_map(|i| (0..i).map(move |j| (i, j)));
        let squared = squared.map(|(i, j)| fraction::distance_squared(set[i], set[j])).min();
        let hexagonal = (2.0 / (3.0_f64.sqrt() * 256.0)).sqrt();
        (squared.unwrap_or(0) as f64).sqrt() / 4_294_967_296.0 / hexagonal
    };
    for seed in 0..4 {
        for (strategy, least) in [
            (Strategy::DartThrowing, 0.69),
            (Strategy::PoissonDisk, 0.69),
            (Strategy::CentroidalVoronoi, 0.70),
            (Strategy::BlueNoise, 0.55),
        ] {
            let distance = smallest(strategy, seed);
            assert!(distance > least, "{}: {distance}", strategy.name());
        }
        assert!(smallest(Strategy::Random, seed) < 0.3);
    }
}

/// The same bytes on every machine: sums over the sets as they were when this was written.
#[test]
fn sets_are_the_same_everywhere() {
    let sums: Vec<String> = sets()
        .map(|strategy| {
            let bits = points(strategy, 64, 0).into_iter().flatten().map(u64::from);
            format!("{} {:016x}", strategy.name(), bits.fold(0, combine))
        })
        .collect();
    let expected = include_str!("golden.txt");
    assert_eq!(sums.join("\n"), expected.trim_end());
}

#[test]
fn counts_that_cannot_be_are_refused_with_advice() {
    let message = |strategy: Strategy, count| strategy.points(count, 0).unwrap_err().to_string();
    assert!(message(Strategy::Random, 0).contains("has 1 to 1048576 of them, not 0"));
    assert!(message(Strategy::Sobol, u32::MAX).contains("of them, not 4294967295"));
    let advice = message(Strategy::MultiJittered, 61);
    assert!(advice.ends_with("60 or 63, not 61"), "{advice}");
    assert!(Strategy::sampler("bounded-voronoi").is_err());
    assert!(Strategy::sampler("sobel").unwrap_err().to_string().contains("did you mean `sobol`"));
}

/// Ranks of blue noise: every prefix of a power of two keeps about the distance that so many points of their own would keep.
#[test]
fn prefixes_of_blue_noise_are_even() {
    for seed in 0..4 {
        let set = points(Strategy::BlueNoise, 256, seed);
        for count in [4, 8, 16, 32, 64, 128] {
            let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
            let squared = pairs.map(|(i, j)| fraction::distance_squared(set[i], set[j])).min();
            let hexagonal = (2.0 / (3.0_f64.sqrt() * count as f64)).sqrt();
            let distance = (squared.unwrap_or(0) as f64).sqrt() / 4_294_967_296.0 / hexagonal;
            assert!(distance > 0.4, "seed {seed}, first {count}: {distance}");
        }
    }
}
