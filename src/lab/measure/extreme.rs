//! Extreme discrepancy: the worst of all boxes with sides along the axes.
//!
//! Source: the definition is in H. Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, SIAM
//! 1992, section 2.1. Small sets: all strips between two coordinates, O(n^3) in the worst case; D. Dobkin, D.
//! Gunopulos and W. Maass, Computing the maximum bichromatic discrepancy, 1996, do better for more points.
//! Large sets: bounds from boxes on a grid of quantiles, in the manner of E. Thiémard, An algorithm to
//! compute bounds for the star discrepancy, 2001. Knows nothing of who made the points.

use super::star::{Bracket, SLACK, star_discrepancy};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Sets of at most this many points are measured exactly.
pub const EXACT_UP_TO: usize = 2048;

/// Columns and rows of the grid that bounds larger sets.
const GRID: usize = 1024;

/// D = sup over boxes [a, b) x [c, d) in [0, 1]^2 of |#(points in the box)/n - (b - a)(d - c)|.
///
/// Values in [0, 1). It is between D* and 4 D* ([`star_discrepancy`]). Exact (`low` is `high`, true to 1e-12)
/// up to [`EXACT_UP_TO`] points. For more, a bracket no wider than 3 D*, and about 4/1024 for sets without
/// gaps. 1 without points.
pub fn extreme_discrepancy(points: &[[f64; 2]]) -> Bracket {
    let star = star_discrepancy(points);
    if points.is_empty() {
        star
    } else if points.len() <= EXACT_UP_TO {
        Bracket::exact(exact(points, star.low))
    } else {
        let grid = bracket(points, GRID);
        Bracket { low: grid.low.max(star.low), high: grid.high.min(4.0 * star.high) }
    }
}

/// The discrepancy by all strips between coordinates; it is known to be at least `known`.
fn exact(points: &[[f64; 2]], known: f64) -> f64 {
    let mut points = points.to_vec();
    points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    let ranks = (1..=points.len()).map(|j| j as f64 / points.len() as f64).collect();
    let (zeros, worst) = (vec![0.0; points.len()], AtomicU64::new(known.to_bits()));
    let strips = Strips { points, ranks, zeros, worst };
    (0..=strips.points.len()).into_par_iter().for_each(|first| strips.search_from(first));
    f64::from_bits(strips.worst.into_inner())
}

/// The search of all strips between coordinates.
struct Strips {
    /// By growing x.
    points: Vec<[f64; 2]>,
    /// 1/n, 2/n, .. 1.
    ranks: Vec<f64>,
    zeros: Vec<f64>,
    /// The worst box so far, as bits.
    worst: AtomicU64,
}

impl Strips {
    /// Looks at all boxes whose leftmost point is number `first`.
    fn search_from(&self, first: usize) {
        // Of points with the same x, strips that begin or end between them miss or hold some too many: less
        // extreme than a true strip, which is looked at as well.
        let x = |i: usize| self.points.get(i).map_or(1.0, |p| p[0]);
        let left = if first == 0 { 0.0 } else { x(first - 1) };
        let share = self.ranks.first().copied().unwrap_or(1.0);
        let mut inside: Vec<f64> = Vec::with_capacity(self.points.len() - first);
        // What the two discrepancies cannot exceed: each point adds 1/n, each step in x its length.
        let (mut closed, mut open) = (0.0, 0.0);
        let mut widths = (0.0, 0.0);
        for next in first..=self.points.len() {
            // The strip from the first to the last point inside, both in it: boxes with too many points.
            if next > first {
                let y = self.points[next - 1][1];
                inside.insert(inside.partition_point(|other| *other < y), y);
                let width = x(next - 1) - x(first);
                closed += share + (width - widths.0);
                raise(&self.worst, &mut closed, || self.worst_inside(&inside, width));
                widths.0 = width;
            }
            // The strip between the nearest points outside, both not in it: boxes with too few points.
            let width = x(next) - left;
            open += share + (width - widths.1);
            raise(&self.worst, &mut open, || self.worst_inside(&inside, width));
            widths.1 = width;
        }
    }

    /// The worst box in a strip of this width that holds points of the sorted coordinates `inside`.
    ///
    /// With t_j = j/n - width y_j, j from 1, a box from y_i to y_j with its edges has the excess
    /// t_j - (t_i - 1/n), and one without its edges lacks t_i - (t_j - 1/n), where t = 0 at the lower edge of
    /// the square and t - 1/n is k/n - width at the upper, above all k points. So the worst is the largest t
    /// less the smallest t - 1/n, whichever comes first. (Equal coordinates: as for the strips.)
    fn worst_inside(&self, inside: &[f64], width: f64) -> f64 {
        let Some(last) = inside.len().checked_sub(1) else {
            return width;
        };
        let (ranks, zeros) = (&self.ranks[..=last], &self.zeros[..=last]);
        let (max, min) = extremes(ranks, zeros, inside, width);
        max.max(0.0) - (min - self.ranks[0]).min(ranks[last] - width)
    }
}

/// Raises `worst` to `value`, unless its bound says that this is in vain; then the bound is the value.
/// Numbers that are not negative are in the order of their bits, and skipped ones are too small to show:
/// threads cannot matter.
fn raise(worst: &AtomicU64, bound: &mut f64, value: impl FnOnce() -> f64) {
    if *bound > f64::from_bits(worst.load(Ordering::Relaxed)) - SLACK {
        *bound = value();
        worst.fetch_max(bound.to_bits(), Ordering::Relaxed);
    }
}

/// The largest and the smallest of right - left - width y, lists of equal length, in several lanes at a time.
#[inline(always)]
fn extremes(right: &[f64], left: &[f64], y: &[f64], width: f64) -> (f64, f64) {
    const LANES: usize = 8;
    let (mut max, mut min) = ([f64::NEG_INFINITY; LANES], [f64::INFINITY; LANES]);
    let (rights, right_rest) = right.as_chunks::<LANES>();
    let (lefts, left_rest) = left.as_chunks::<LANES>();
    let (ys, y_rest) = y.as_chunks::<LANES>();
    for ((right, left), y) in rights.iter().zip(lefts).zip(ys) {
        for l in 0..LANES {
            let value = right[l] - left[l] - width * y[l];
            max[l] = if value > max[l] { value } else { max[l] };
            min[l] = if value < min[l] { value } else { min[l] };
        }
    }
    for ((right, left), y) in right_rest.iter().zip(left_rest).zip(y_rest) {
        let value = right - left - width * y;
        (max[0], min[0]) = (max[0].max(value), min[0].min(value));
    }
    let largest = max.into_iter().fold(f64::NEG_INFINITY, f64::max);
    (largest, min.into_iter().fold(f64::INFINITY, f64::min))
}

/// Bounds from the boxes whose sides are on `grid` + 1 quantiles of each coordinate: they are boxes
/// themselves, and every other box is between two of them, one column and row larger and smaller on each
/// side.
fn bracket(points: &[[f64; 2]], grid: usize) -> Bracket {
    let n = points.len() as f64;
    let x = quantiles(points.iter().map(|p| p[0]).collect(), grid);
    let y = quantiles(points.iter().map(|p| p[1]).collect(), grid);
    let (columns, rows) = (x.len() - 1, y.len() - 1);

    // below[a][j]: the fraction of points in [0, x_a) x [0, y_j).
    let mut below = vec![vec![0.0_f64; rows + 1]; columns + 1];
    for p in points {
        let column = x.partition_point(|edge| *edge <= p[0]).min(columns);
        let row = y.partition_point(|edge| *edge <= p[1]).min(rows);
        below[column][row] += 1.0;
    }
    for a in 0..=columns {
        for j in 1..=rows {
            below[a][j] += below[a][j - 1];
        }
        if let (before @ [.., _], [column, ..]) = below.split_at_mut(a) {
            let before = &before[a - 1];
            column.iter_mut().zip(before).for_each(|(sum, before)| *sum += before);
        }
    }
    below.iter_mut().flatten().for_each(|count| *count /= n);

    let (low, high) = (AtomicU64::new(0), AtomicU64::new(0));
    let strip =
        |a: usize, b: usize| Strip { left: &below[a], right: &below[b], width: x[b] - x[a] };
    (0..columns).into_par_iter().for_each(|a| {
        let (mut low_bound, mut high_bound) = (0.0, 0.0);
        let mut last = [strip(a, a); 2];
        for b in a + 1..=columns {
            let outer = strip(a, b);
            let inner = if a + 1 < b { strip(a + 1, b - 1) } else { strip(a, a) };
            // What the column that came in may add to either.
            let grown = |i: usize, strip: Strip| {
                (strip.count() - last[i].count(), strip.width - last[i].width)
            };
            let ((count_out, width_out), (count_in, width_in)) = (grown(0, outer), grown(1, inner));
            low_bound += count_out + width_out;
            high_bound += (count_out + width_in).max(width_out + count_in);
            raise(&low, &mut low_bound, || on_grid(outer, &y));
            raise(&high, &mut high_bound, || between(outer, inner, &y));
            last = [outer, inner];
        }
    });
    let [low, high] = [low, high].map(|bits| f64::from_bits(bits.into_inner()));
    Bracket { low, high: high.min(1.0) }
}

/// What is between two vertical lines.
#[derive(Clone, Copy)]
struct Strip<'a> {
    /// Fractions of points left of each line, and below y_j.
    left: &'a [f64],
    right: &'a [f64],
    width: f64,
}

impl Strip<'_> {
    /// The fraction of points in the strip.
    fn count(self) -> f64 {
        self.right[self.right.len() - 1] - self.left[self.left.len() - 1]
    }

    /// The largest and the smallest c_i - width y_j, c_i the fraction of points below row i: i and j go
    /// through ranges of the same length.
    #[inline(always)]
    fn extremes(self, i: Range<usize>, j: Range<usize>, y: &[f64], width: f64) -> (f64, f64) {
        extremes(&self.right[i.clone()], &self.left[i], &y[j], width)
    }
}

/// The worst box as wide as the strip with sides on the grid: its excess is a difference of two values of one
/// function.
fn on_grid(strip: Strip, y: &[f64]) -> f64 {
    let (max, min) = strip.extremes(0..y.len(), 0..y.len(), y, strip.width);
    max - min
}

/// More than the worst box whose left and right sides are between those of the strips. Its lower and upper
/// side are in rows, of which row j is between y_j and y_(j+1).
fn between(outer: Strip, inner: Strip, y: &[f64]) -> f64 {
    let (lower, upper) = (0..y.len() - 1, 1..y.len());
    // Excess: no more than all points of the outer box less the area of the inner.
    let (most, _) = outer.extremes(upper.clone(), lower.clone(), y, inner.width);
    let (_, least) = outer.extremes(lower.clone(), upper.clone(), y, inner.width);
    let excess = most - least;
    // Lack: no more than the area of the outer box less the points of the inner.
    let (_, least) = inner.extremes(lower.clone(), upper.clone(), y, outer.width);
    let (most, _) = inner.extremes(upper, lower, y, outer.width);
    excess.max(most - least)
}

/// 0, at most `count` - 1 quantiles of the values, and 1: growing.
fn quantiles(mut values: Vec<f64>, count: usize) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let inner = (1..count).map(|i| values[i * values.len() / count]);
    let mut edges: Vec<f64> = std::iter::once(0.0).chain(inner).chain([1.0]).collect();
    edges.dedup();
    edges
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hammersley, random_set, random_tied_set};
    use super::*;

    /// From the definition: every box between coordinates, 0 and 1, with and without its edges.
    fn brute_force(points: &[[f64; 2]]) -> f64 {
        let n = points.len() as f64;
        let ends = |axis: usize| -> Vec<f64> {
            points.iter().map(|p| p[axis]).chain([0.0, 1.0]).collect()
        };
        let (xs, ys) = (ends(0), ends(1));
        let mut worst = 0.0_f64;
        for &a in &xs {
            for &b in xs.iter().filter(|b| **b >= a) {
                for &c in &ys {
                    for &d in ys.iter().filter(|d| **d >= c) {
                        let open = |p: &&[f64; 2]| a < p[0] && p[0] < b && c < p[1] && p[1] < d;
                        let closed =
                            |p: &&[f64; 2]| a <= p[0] && p[0] <= b && c <= p[1] && p[1] <= d;
                        let area = (b - a) * (d - c);
                        worst = worst.max(area - points.iter().filter(open).count() as f64 / n);
                        worst = worst.max(points.iter().filter(closed).count() as f64 / n - area);
                    }
                }
            }
        }
        worst
    }

    #[test]
    fn against_brute_force() {
        for seed in 0..200 {
            let n = 1 + seed as usize % 12;
            for points in [random_set(n, seed), random_tied_set(n, seed)] {
                let found = extreme_discrepancy(&points);
                assert_eq!(found.width(), 0.0);
                let expected = brute_force(&points);
                assert!((found.low - expected).abs() < 1e-14, "{seed}: {found:?} {expected}");
            }
        }
    }

    /// Centred grids of m x m: k x l points in a closed box have the excess (k l - (k - 1)(l - 1))/m^2, which
    /// is largest for all of them; the strips without points lack no more than 1/m.
    #[test]
    fn closed_forms() {
        for m in 1..12_u32 {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(m);
            let grid: Vec<_> = (0..m * m).map(|i| [at(i / m), at(i % m)]).collect();
            let pitch = 1.0 / f64::from(m);
            let full = 1.0 - (1.0 - pitch) * (1.0 - pitch);
            let found = extreme_discrepancy(&grid).low;
            assert!((found - full).abs() < 1e-14, "{m}: {found} {full}");
        }
        assert_eq!(extreme_discrepancy(&[]), Bracket::exact(1.0));
    }

    /// Sets that are squeezed to a line reach their upper bounds nearly: the outermost column has its points
    /// at one side.
    #[test]
    fn brackets_hold_the_exact_value() {
        for seed in 0..30 {
            let n = 2 + 23 * seed as usize;
            let even = random_set(n, seed);
            let squeezed: Vec<_> = even.iter().map(|[x, y]| [0.5 + 1e-3 * x, *y]).collect();
            let turned = squeezed.iter().map(|[x, y]| [*y, *x]).collect();
            let tied = random_tied_set(n, seed);
            for points in [even, squeezed, turned, tied, hammersley(seed as u32 / 4)] {
                let exact = extreme_discrepancy(&points).low;
                for grid in [1, 2, 7, 16, 64] {
                    let Bracket { low, high } = bracket(&points, grid);
                    let holds = low <= exact + SLACK && exact <= high + SLACK;
                    assert!(holds, "{seed} {grid}: {low} {exact} {high}");
                }
                let star = star_discrepancy(&points).low;
                assert!(star <= exact && exact <= 4.0 * star);
            }
        }
    }

    #[test]
    fn finer_grids_are_closer() {
        let points = random_set(4096, 0);
        let widths = [16, 64, 256].map(|grid| bracket(&points, grid).width());
        assert!(widths[1] < 0.4 * widths[0] && widths[2] < 0.4 * widths[1], "{widths:?}");
        let full = extreme_discrepancy(&points);
        assert!(full.width() < 8.0 / 1024.0, "{full:?}");
    }

    /// Turned and mirrored sets have the same discrepancy, which the star discrepancy does not keep.
    #[test]
    fn symmetries() {
        for seed in 0..5 {
            let points = random_set(200, seed);
            let turned: Vec<_> = points.iter().map(|[x, y]| [*y, 1.0 - f64::EPSILON - x]).collect();
            let (a, b) = (extreme_discrepancy(&points).low, extreme_discrepancy(&turned).low);
            assert!((a - b).abs() < 1e-12);
        }
    }
}
