//! The two projections of a set to one coordinate: strata that are hit, and their star discrepancy.
//!
//! Source: H. Niederreiter, Discrepancy and convex programming, Ann. Mat. Pura Appl. 93, 1972, for the closed
//! form in one dimension. A strategy whose projections are bad wastes samples where an integrand changes
//! along one axis only. Knows nothing of who made the points.

/// How even one coordinate of a set is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Fraction of the n strata [i/n, (i+1)/n) that hold a coordinate: 1 for a Latin hypercube (n rooks),
    /// 1/sqrt(n) for a regular grid, about 0.632 for independent points. The stratum of a coordinate x is the
    /// whole part of x n, a product of `f64`: exact for n a power of two.
    pub strata: f64,
    /// sup over a in [0, 1] of |#(x < a)/n - a|, exact but for rounding: 1/(2n) at best, 1 at worst.
    pub star_discrepancy: f64,
}

/// The projections of the points, values in [0, 1), to x and to y. Without points no stratum is hit, and the
/// discrepancy is 1. O(n log n).
pub fn projections(points: &[[f64; 2]]) -> [Projection; 2] {
    [0, 1].map(|axis| {
        let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        values.sort_unstable_by(f64::total_cmp);
        Projection { strata: strata(&values), star_discrepancy: star_discrepancy(&values) }
    })
}

/// Fraction of the n strata that hold one of the sorted `values`.
fn strata(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    // A value just below 1 may round up to n.
    let mut hit: Vec<u64> = values.iter().map(|x| (x * n).min(n - 1.0) as u64).collect();
    hit.dedup();
    hit.len() as f64 / n.max(1.0)
}

/// The star discrepancy of the sorted `values` alone: 1/(2n) + max |x_i - (2i - 1)/(2n)|, i from 1.
fn star_discrepancy(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 1.0;
    }
    let n = values.len() as f64;
    let off_centre = |(i, x): (usize, &f64)| (x - (i as f64 + 0.5) / n).abs();
    0.5 / n + values.iter().enumerate().map(off_centre).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{random_set, random_tied_set};
    use super::*;

    #[test]
    fn closed_forms() {
        let n = 49_u32;
        let centred = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let rooks: Vec<_> = (0..n).map(|i| [centred(i), centred(i * 10 % n)]).collect();
        for p in projections(&rooks) {
            assert_eq!(p.strata, 1.0);
            assert!((p.star_discrepancy - 0.5 / 49.0).abs() < 1e-15);
        }
        // A grid of 7 x 7: seven coordinates, each seven times.
        let seventh = |i: u32| (f64::from(i) + 0.5) / 7.0;
        let grid: Vec<_> = (0..n).map(|i| [seventh(i / 7), seventh(i % 7)]).collect();
        for p in projections(&grid) {
            assert_eq!(p.strata, 7.0 / 49.0);
            assert!((p.star_discrepancy - 0.5 / 7.0).abs() < 1e-15);
        }
        let empty = Projection { strata: 0.0, star_discrepancy: 1.0 };
        assert_eq!(projections(&[]), [empty; 2]);
        let one = projections(&[[0.25, 1.0 - f64::EPSILON / 2.0]]);
        assert_eq!((one[0].strata, one[0].star_discrepancy), (1.0, 0.75));
        assert_eq!(one[1].strata, 1.0);
    }

    /// The left end of a stratum belongs to it, for powers of two exactly.
    #[test]
    fn ends_of_strata() {
        let points: Vec<_> =
            (0..64).map(|i| [f64::from(i) / 64.0, f64::from(i / 2) / 32.0]).collect();
        let [x, y] = projections(&points);
        assert_eq!((x.strata, y.strata), (1.0, 0.5));
        assert_eq!((x.star_discrepancy, y.star_discrepancy), (1.0 / 64.0, 1.0 / 32.0));
    }

    /// All ends that matter: at each coordinate and at 1, the point counted and not counted.
    fn brute_force(values: &[f64]) -> f64 {
        let n = values.len() as f64;
        let ends = values.iter().copied().chain([1.0]);
        ends.fold(0.0, |worst, a| {
            let below = values.iter().filter(|x| **x < a).count() as f64 / n;
            let up_to = values.iter().filter(|x| **x <= a).count() as f64 / n;
            worst.max(a - below).max(up_to - a)
        })
    }

    #[test]
    fn against_brute_force() {
        for seed in 0..200 {
            let n = 1 + seed as usize % 20;
            for points in [random_set(n, seed), random_tied_set(n, seed)] {
                let measured = projections(&points);
                for axis in [0, 1] {
                    let values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
                    let expected = brute_force(&values);
                    assert!((measured[axis].star_discrepancy - expected).abs() < 1e-15);
                }
            }
        }
    }
}
