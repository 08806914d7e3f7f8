//! Star discrepancy: the worst box with a corner at the origin.
//!
//! Source: the finite form of the supremum is H. Niederreiter's (1972); that convex hulls which change
//! with the points spare most of the n^2 boxes was shown by D. Dobkin and D. Eppstein, Computing the
//! discrepancy, SoCG 1993. With [`super::envelope`] it takes O(n sqrt n). Knows nothing of who made the
//! points.

use super::envelope::Envelope;
use serde::Serialize;

/// Bounds of a value: `low <= value <= high`, each to about 1e-12 for rounding. Equal when the value is
/// exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Bracket {
    /// No more than the value.
    pub low: f64,
    /// No less than the value.
    pub high: f64,
}

impl Bracket {
    /// The bounds of a value that is known.
    pub fn exact(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// high - low: 0 when the value is exact.
    pub fn width(self) -> f64 {
        self.high - self.low
    }
}

/// Boxes whose bound is this far below the worst so far are not looked at. It is more than all roundings, so
/// the result has the same bits as if they were.
pub(super) const SLACK: f64 = 1e-12;

/// D* = sup over (a, b) in [0, 1]^2 of |#(points in [0, a) x [0, b))/n - a b|, values in [0, 1). Exact for
/// every n: `low` is `high`, true to 1e-12. 1 without points. O(n sqrt n) time, O(n) memory.
pub fn star_discrepancy(points: &[[f64; 2]]) -> Bracket {
    let n = points.len();
    if n == 0 {
        return Bracket::exact(1.0);
    }
    let share = 1.0 / n as f64;

    // Corners of the worst box are at coordinates of points or at 1. At a corner (x, y_j), where c_j counts
    // the points so far up to the j-th by y, a box that has too many holds the points on its far edges and
    // has c_j/n - x y_j too many, a line in x of slope -y_j. A box that has too few does not hold them and
    // lacks x y_j - c_(j-1)/n, with y_n = 1 besides.
    let mut by_y: Vec<usize> = (0..n).collect();
    by_y.sort_unstable_by(|&a, &b| points[a][1].total_cmp(&points[b][1]));
    let mut place = vec![0; n];
    by_y.iter().enumerate().for_each(|(j, &point)| place[point] = j);
    let y = |&point: &usize| points[point][1];
    let mut too_many = Envelope::new(by_y.iter().rev().map(|p| -y(p)).collect(), share);
    let mut too_few = Envelope::new(by_y.iter().map(y).chain([1.0]).collect(), share);

    // Points enter by growing x. Of points with the same x or y, those before the last enter boxes that miss
    // some on the edge: less extreme than the true box, which is looked at as well.
    let mut by_x: Vec<usize> = (0..n).collect();
    by_x.sort_unstable_by(|&a, &b| points[a][0].total_cmp(&points[b][0]));
    let mut worst = 0.0_f64;
    // What the two maxima cannot exceed: a point adds 1/n to one, a step in x its length to the other.
    let (mut excess, mut lack, mut last_x) = (0.0, 0.0, 0.0);
    for point in by_x {
        let x = points[point][0];
        lack += x - last_x;
        if lack > worst - SLACK {
            lack = too_few.max_at(x);
            worst = worst.max(lack);
        }
        too_many.shift(0..n - place[point], 1.0);
        too_few.shift(place[point] + 1..n + 1, -1.0);
        excess += share;
        if excess > worst - SLACK {
            excess = too_many.max_at(x);
            worst = worst.max(excess);
        }
        last_x = x;
    }
    Bracket::exact(worst.max(too_few.max_at(1.0)))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hammersley, random_set, random_tied_set};
    use super::*;

    fn exact(points: &[[f64; 2]]) -> f64 {
        let bracket = star_discrepancy(points);
        assert_eq!(bracket.width(), 0.0);
        bracket.low
    }

    /// From the definition: every corner at coordinates and 1, with and without its edges.
    fn brute_force(points: &[[f64; 2]]) -> f64 {
        let n = points.len() as f64;
        let ends = |axis: usize| points.iter().map(move |p| p[axis]).chain([1.0]);
        let mut worst = 0.0_f64;
        for x in ends(0) {
            for y in ends(1) {
                let open = points.iter().filter(|p| p[0] < x && p[1] < y).count() as f64 / n;
                let closed = points.iter().filter(|p| p[0] <= x && p[1] <= y).count() as f64 / n;
                worst = worst.max(x * y - open).max(closed - x * y);
            }
        }
        worst
    }

    /// One point (a, b): the box up to it holds all, or the larger of the empty boxes beside it holds none.
    #[test]
    fn one_point() {
        for (a, b) in [(0.0, 0.0), (0.5, 0.5), (0.9, 0.3), (0.3, 0.9), (0.99, 0.99), (0.0, 0.7)] {
            let expected = f64::max(1.0 - a * b, f64::max(a, b));
            assert!((exact(&[[a, b]]) - expected).abs() < 1e-15, "{a} {b}");
        }
        assert_eq!(exact(&[]), 1.0);
        assert_eq!(exact(&[[0.5, 0.5]; 9]), 0.75);
    }

    /// Centred grids of m x m: the corner at the last point has all of them, 1 - (1 - 1/(2m))^2.
    #[test]
    fn regular_grids() {
        for m in 1..20_u32 {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(m);
            let grid: Vec<_> = (0..m * m).map(|i| [at(i / m), at(i % m)]).collect();
            let side = 1.0 - 0.5 / f64::from(m);
            assert!((exact(&grid) - (1.0 - side * side)).abs() < 1e-14);
        }
    }

    /// J. Halton and S. Zaremba (The extreme and L2 discrepancies of some plane sets, 1969): n D* of
    /// Hammersley's set of n = 2^m points is m/3 + 13/9 - (-1)^m 4/(9 2^m), m > 1.
    #[test]
    fn hammersley_sets() {
        for m in 2..=14_u32 {
            let n = f64::from(1 << m);
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            let expected = f64::from(m) / 3.0 + 13.0 / 9.0 - sign * 4.0 / (9.0 * n);
            assert!((exact(&hammersley(m)) * n - expected).abs() < 1e-9, "{m}");
        }
    }

    #[test]
    fn against_brute_force() {
        for seed in 0..200 {
            let n = 1 + seed as usize % 40;
            for points in [random_set(n, seed), random_tied_set(n, seed)] {
                let (found, expected) = (exact(&points), brute_force(&points));
                assert!((found - expected).abs() < 1e-14, "{seed}: {found} {expected}");
            }
        }
    }

    /// The order of points and of coordinates does not matter.
    #[test]
    fn symmetries() {
        for seed in 0..10 {
            let points = random_set(1000, seed);
            let mirrored: Vec<_> = points.iter().rev().map(|[x, y]| [*y, *x]).collect();
            assert!((exact(&points) - exact(&mirrored)).abs() < 1e-14);
        }
    }
}
