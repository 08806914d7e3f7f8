//! Discrepancies in the mean square: star, centred, wrap-around, mixture.
//!
//! Sources: L2-star: T. Warnock, Computational investigations of low-discrepancy point sets, 1972. Centred
//! and wrap-around: F. Hickernell, A generalized discrepancy and quadrature error bound, Math. Comp. 67,
//! 1998, and Lattice rules: how well do they measure up?, 1998. Mixture: Y. Zhou, K. Fang and J. Ning,
//! Mixture discrepancy for quasi-random point sets, J. Complexity 29, 2013.
//!
//! All are sqrt(C - (2/n) sum_i H(p_i) + (1/n^2) sum_ij K(p_i, p_j)) with C, H and K products over the two
//! coordinates. They are roots here. SciPy's `qmc.discrepancy` (1.17) returns the root for `L2-star` and the
//! square for `CD`, `WD` and `MD`. Knows nothing of who made the points.

use super::sum::sum;
use rayon::prelude::*;

/// Root mean square of #(points in [0, a) x [0, b))/n - a b over (a, b) in the unit square. Values in [0, 1);
/// 1/3 without points. O(n^2), parallel. Relative error below 1e-10, as that of the other three.
pub fn l2_star(points: &[[f64; 2]]) -> f64 {
    discrepancy(
        points,
        &Kernel {
            scale: 6.0,
            constant: 2.0,
            single: |a: f64| 3.0 - 3.0 * a * a,
            pair: |a: f64, b: f64| 6.0 - 6.0 * if a > b { a } else { b },
        },
    )
}

/// Centred discrepancy: boxes between a point and the corner nearest to it, and the projections of the set.
/// Mirroring the set at the middle changes nothing. Values in [0, 1). 13/12 without points.
pub fn centered(points: &[[f64; 2]]) -> f64 {
    discrepancy(
        points,
        &Kernel {
            scale: 24.0,
            constant: 26.0,
            single: |a: f64| {
                let from_centre = (a - 0.5).abs();
                24.0 + 12.0 * from_centre - 12.0 * from_centre * from_centre
            },
            pair: |a: f64, b: f64| {
                24.0 + 12.0 * ((a - 0.5).abs() + (b - 0.5).abs() - (a - b).abs())
            },
        },
    )
}

/// Wrap-around discrepancy: boxes that may leave the square on one side and enter on the other. Shifting the
/// set on the torus changes nothing. Values in [0, 1). 4/3 without points.
pub fn wraparound(points: &[[f64; 2]]) -> f64 {
    discrepancy(
        points,
        &Kernel {
            scale: 6.0,
            constant: 8.0,
            single: |_: f64| 8.0,
            pair: |a: f64, b: f64| {
                let distance = (a - b).abs();
                9.0 - 6.0 * distance * (1.0 - distance)
            },
        },
    )
}

/// Mixture discrepancy: between the centred and the wrap-around one, without their blind spots. Values in
/// [0, 1). 19/12 without points.
pub fn mixture(points: &[[f64; 2]]) -> f64 {
    discrepancy(
        points,
        &Kernel {
            scale: 24.0,
            constant: 38.0,
            single: |a: f64| {
                let from_centre = (a - 0.5).abs();
                40.0 - 6.0 * from_centre - 6.0 * from_centre * from_centre
            },
            pair: |a: f64, b: f64| {
                let distance = (a - b).abs();
                45.0 - 6.0 * ((a - 0.5).abs() + (b - 0.5).abs()) - 18.0 * distance
                    + 12.0 * distance * distance
            },
        },
    )
}

/// C, H and K for one coordinate, times `scale`: that makes all constants whole numbers, so that none has a
/// rounding that n^2 terms would repeat.
struct Kernel<Single, Pair> {
    scale: f64,
    constant: f64,
    single: Single,
    pair: Pair,
}

/// The discrepancy of a kernel. Sums K(p, q) - H(p) - H(q) + C over all pairs: its terms have the mean zero,
/// so that no large numbers cancel at the end.
fn discrepancy<Single, Pair>(points: &[[f64; 2]], kernel: &Kernel<Single, Pair>) -> f64
where
    Single: Fn(f64) -> f64 + Sync,
    Pair: Fn(f64, f64) -> f64 + Sync,
{
    let Kernel { scale, constant, single, pair } = kernel;
    if points.is_empty() {
        return constant / scale;
    }
    let x: Vec<f64> = points.iter().map(|p| p[0]).collect();
    let y: Vec<f64> = points.iter().map(|p| p[1]).collect();
    let h: Vec<f64> = points.iter().map(|p| single(p[0]) * single(p[1])).collect();

    // Each pair once, in rows: point i and those before it.
    let row = |i: usize| {
        let own = h[i] - constant * constant;
        let term = |xj: f64, yj: f64, hj: f64| pair(x[i], xj) * pair(y[i], yj) - hj - own;
        const LANES: usize = 8;
        let mut lanes = [0.0; LANES];
        let (xs, rest) = x[..i].as_chunks::<LANES>();
        let (ys, hs) = (y[..i].as_chunks::<LANES>().0, h[..i].as_chunks::<LANES>().0);
        for ((x, y), h) in xs.iter().zip(ys).zip(hs) {
            for l in 0..LANES {
                lanes[l] += term(x[l], y[l], h[l]);
            }
        }
        let last = (i - rest.len()..i).map(|j| term(x[j], y[j], h[j]));
        2.0 * sum(lanes.into_iter().chain(last)) + term(x[i], y[i], h[i])
    };
    let rows: Vec<f64> = (0..points.len()).into_par_iter().map(row).collect();
    // Rounding may leave a square that is zero below it.
    sum(rows).max(0.0).sqrt() / (scale * points.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hammersley, random_set, shifted};
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
    }

    /// The squares of one point (a, b) by hand.
    #[test]
    fn one_point() {
        for [a, b] in [[0.0, 0.0], [0.5, 0.5], [0.3, 0.8], [0.9, 0.9]] {
            let point = [[a, b]];
            let star = 1.0 / 9.0 - (1.0 - a * a) * (1.0 - b * b) / 2.0 + (1.0 - a) * (1.0 - b);
            close(l2_star(&point), star.sqrt());
            close(wraparound(&point), (9.0_f64 / 4.0 - 16.0 / 9.0).sqrt());
            let (u, v) = ((a - 0.5_f64).abs(), (b - 0.5_f64).abs());
            let single = |u: f64| 1.0 + u / 2.0 - u * u / 2.0;
            let square = 169.0 / 144.0 - 2.0 * single(u) * single(v) + (1.0 + u) * (1.0 + v);
            close(centered(&point), square.sqrt());
            let single = |u: f64| 5.0 / 3.0 - u / 4.0 - u * u / 4.0;
            let pair = |u: f64| 15.0 / 8.0 - u / 2.0;
            let square = 361.0 / 144.0 - 2.0 * single(u) * single(v) + pair(u) * pair(v);
            close(mixture(&point), square.sqrt());
        }
        let empty = [l2_star, centered, wraparound, mixture].map(|measure| measure(&[]));
        assert_eq!(empty, [1.0 / 3.0, 13.0 / 12.0, 4.0 / 3.0, 19.0 / 12.0]);
    }

    /// J. Halton and S. Zaremba, 1969: (n L2)^2 of Hammersley's set of n = 2^m points. For thousands of
    /// points the square is a millionth of its terms.
    #[test]
    fn hammersley_sets() {
        for m in 0..=12_u32 {
            let (n, k) = (f64::from(1 << m), f64::from(m));
            let square = k * k / 64.0 + 29.0 * k / 192.0 + 3.0 / 8.0 - k / (16.0 * n)
                + 1.0 / (4.0 * n)
                - 1.0 / (72.0 * n * n);
            let found = l2_star(&hammersley(m)) * n;
            assert!((found / square.sqrt() - 1.0).abs() < 1e-10, "{m}: {found}");
        }
    }

    /// Periodic sums of the wrap-around kernel are known: 3/2 - d(1 - d) over the m points of a regular grid
    /// has the mean 4/3 + 1/(6 m^2).
    #[test]
    fn regular_grids() {
        for m in 1..30_u32 {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(m);
            let grid: Vec<_> = (0..m * m).map(|i| [at(i / m), at(i % m)]).collect();
            let step = 1.0 / f64::from(6 * m * m);
            // (4/3 + s)^2 - (4/3)^2
            let square = step * (8.0 / 3.0 + step);
            let found = wraparound(&grid);
            assert!((found / square.sqrt() - 1.0).abs() < 1e-10, "{m}: {found}");
        }
    }

    #[test]
    fn symmetries() {
        let points = random_set(300, 0);
        let moved = shifted(&points, [0.37, 0.81]);
        let mirrored: Vec<_> = points.iter().map(|[x, y]| [1.0 - x, *y]).collect();
        let same =
            |f: fn(&[[f64; 2]]) -> f64, set: &[[f64; 2]]| (f(&points) / f(set) - 1.0).abs() < 1e-10;
        assert!(same(wraparound, &moved) && !same(centered, &moved) && !same(mixture, &moved));
        assert!(same(centered, &mirrored) && same(mixture, &mirrored) && !same(l2_star, &mirrored));
    }

    /// The mean square itself, from one box in each cell of a fine grid.
    #[test]
    fn star_is_a_mean_over_boxes() {
        let points = random_set(12, 3);
        let side = 400;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(side);
        let squares = (0..side * side).map(|i| {
            let (a, b) = (at(i / side), at(i % side));
            let inside = points.iter().filter(|p| p[0] < a && p[1] < b).count() as f64;
            let local = inside / 12.0 - a * b;
            local * local
        });
        let found = (sum(squares) / f64::from(side * side)).sqrt();
        assert!((found / l2_star(&points) - 1.0).abs() < 0.005, "{found}");
    }
}
