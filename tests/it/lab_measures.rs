//! Measures of point sets against SciPy, and against each other at sizes beyond brute force.
//!
//! Sets and values are in `tests/fixtures/points`, with the script that made them.

use glint::lab::measure::{self, Bracket, measure};
use glint::sampling::hash::{combine, mix64};
use glint::sampling::voronoi::Domain;
use serde_json::Value;
use std::path::Path;

fn fixture(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/points");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn random_set(n: usize, seed: u64) -> Vec<[f64; 2]> {
    let unit = |i: usize| (combine(mix64(seed), i as u64) >> 11) as f64 / (1_u64 << 53) as f64;
    (0..n).map(|i| [unit(2 * i), unit(2 * i + 1)]).collect()
}

fn hammersley(m: u32) -> Vec<[f64; 2]> {
    let mirrored = |i: u32| f64::from(i.reverse_bits()) / (1_u64 << 32) as f64;
    (0..1_u32 << m).map(|i| [f64::from(i) / f64::from(1_u32 << m), mirrored(i)]).collect()
}

#[test]
fn scipy_agrees_to_ten_digits() {
    let reference: Value = serde_json::from_str(&fixture("scipy.json")).unwrap();
    let sets = reference["sets"].as_object().unwrap();
    assert!(sets.len() >= 5);
    let mut compared = 0;
    for (name, expected) in sets {
        let points = measure::points_from_text(&fixture(&format!("{name}.txt")), name).unwrap();
        let found = measure(name, &points);
        let squares = &expected["squares"];
        for (found, expected) in [
            (found.l2_star, expected["l2_star"].as_f64()),
            (found.centered, squares["CD"].as_f64().map(f64::sqrt)),
            (found.wraparound, squares["WD"].as_f64().map(f64::sqrt)),
            (found.mixture, squares["MD"].as_f64().map(f64::sqrt)),
        ] {
            let expected = expected.unwrap();
            assert!((found / expected - 1.0).abs() < 1e-10, "{name}: {found} {expected}");
            compared += 1;
        }
        for (found, expected) in [
            (found.min_distance, &expected["bounded"]["min"]),
            (found.mean_distance, &expected["bounded"]["mean"]),
            (found.toroidal_min_distance, &expected["toroidal"]["min"]),
            (found.toroidal_mean_distance, &expected["toroidal"]["mean"]),
        ] {
            match (found, expected.as_f64()) {
                (Some(found), Some(expected)) => {
                    assert!((found - expected).abs() < 1e-12, "{name}: {found} {expected}");
                    compared += 1;
                }
                (found, expected) => assert_eq!(found, expected, "{name}"),
            }
        }
    }
    assert!(compared >= 4 * sets.len() + 4 * (sets.len() - 1));
}

/// Every measure of one set is consistent with the others, by the inequalities between them.
#[test]
fn measures_agree_with_each_other() {
    for seed in 0..6 {
        for points in [random_set(300 + 100 * seed as usize, seed), hammersley(5 + seed as u32)] {
            let found = measure("set", &points);
            let n = points.len() as f64;
            let Bracket { low: star, high } = found.star_discrepancy;
            assert_eq!(star, high);
            let extreme = found.extreme_discrepancy;
            assert!(
                star <= extreme.low && extreme.low <= extreme.high && extreme.high <= 4.0 * star
            );
            // A mean square is no more than the worst.
            assert!(found.l2_star < star);
            // A projection is the discrepancy of boxes as high as the square; they may be the worst.
            for projection in [found.projection_x_discrepancy, found.projection_y_discrepancy] {
                assert!(0.5 / n <= projection && projection <= star + 1e-12);
            }
            // The torus only shortens distances.
            assert!(found.toroidal_min_distance <= found.min_distance);
            assert!(found.toroidal_mean_distance <= found.mean_distance);
            assert!(found.min_distance <= found.mean_distance);
            assert!(found.relative_min_distance.unwrap() <= 1.0);
        }
    }
}

/// H. Niederreiter, 1992, chapter 4: D* n of a (0, m, 2)-net in base 2 is at most m/2 + 3/2.
#[test]
fn nets_keep_their_promise() {
    for m in 1..=13 {
        let points = hammersley(m);
        assert_eq!(measure::t_value(&points), Some(0));
        let star = measure::star_discrepancy(&points).high;
        assert!(star * points.len() as f64 <= f64::from(m) / 2.0 + 1.5 + 1e-9);
    }
}

/// Brackets of sets that are too large to be exact hold the value: a set repeated point by point has the
/// discrepancy of the set.
#[test]
fn large_sets_are_bracketed() {
    for seed in 0..2 {
        let few = random_set(700, seed);
        let exact = measure::extreme_discrepancy(&few);
        assert_eq!(exact.width(), 0.0);
        let many: Vec<_> = few.iter().flat_map(|p| [*p; 3]).collect();
        assert!(many.len() > measure::EXACT_UP_TO);
        let found = measure::extreme_discrepancy(&many);
        assert!(
            found.low <= exact.low + 1e-12 && exact.low <= found.high + 1e-12,
            "{found:?} {exact:?}"
        );
        let stars = [&few, &many].map(|set| measure::star_discrepancy(set).low);
        assert!((stars[0] - stars[1]).abs() < 1e-12);
    }
}

/// The same bits for one thread and for three.
#[test]
fn threads_do_not_matter() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            [random_set(900, 0), random_set(3000, 1), hammersley(9)].map(|points| {
                let spectrum = measure::Periodogram::new(&points, 40);
                (serde_json::to_string(&measure("set", &points)).unwrap(), spectrum)
            })
        })
    };
    assert!(with(1) == with(3));
}

/// Toroidal measures do not see where the tile begins; bounded ones do.
#[test]
fn shifts_on_the_torus() {
    let points = random_set(500, 4);
    let moved: Vec<_> =
        points.iter().map(|p| [(p[0] + 0.37).fract(), (p[1] + 0.81).fract()]).collect();
    let (a, b) = (measure("a", &points), measure("b", &moved));
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    assert!(same(a.wraparound, b.wraparound));
    assert!(same(a.anisotropy.unwrap(), b.anisotropy.unwrap()));
    let mean = |set: &[[f64; 2]], domain| measure::neighbours(set, domain).unwrap().mean;
    assert!(same(mean(&points, Domain::Torus), mean(&moved, Domain::Torus)));
    assert!(!same(mean(&points, Domain::Square), mean(&moved, Domain::Square)));
    assert!(!same(a.star_discrepancy.low, b.star_discrepancy.low));
    assert!(!same(a.centered, b.centered));
}
