//! Poisson disk sampling in linear time: dart throwing that throws only where there may be room.
//!
//! Source: M. S. Ebeida et al., "A Simple Algorithm for Maximal Poisson-Disk Sampling in High Dimensions", Eurographics
//! 2012: darts fall into cells that are not known to be covered; cells are quartered as they get fewer, and dropped
//! when a single disc covers them. What is left out is covered, so the points have the distribution of plain
//! dart throwing. It ends with `count` points instead of with a full square.

use super::PointSet;
use super::fraction::{Fraction, HALF, distance_squared, in_stratum};
use crate::sampling::CounterRng;

/// The distance that points keep, on the torus.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius {
    distance: f64,
    shrunk: u32,
}

impl Radius {
    /// Of the largest distance that `count` points can keep: dart throwing gets stuck at some 0.77 of it (random
    /// sequential packing covers 54.7 % of a plane), and reaches this with some hundred darts for its last point.
    const SHARE: f64 = 0.7;

    pub(super) fn wanted(count: u32) -> Self {
        // On the torus of side 1 no two points are farther from each other than this.
        let farthest = 0.5_f64.sqrt();
        let hexagonal = (2.0 / (3.0_f64.sqrt() * f64::from(count))).sqrt();
        Self { distance: (Self::SHARE * hexagonal).min(Self::SHARE * farthest), shrunk: 0 }
    }

    /// A radius that is 5 % smaller; what kept the larger one keeps it.
    pub(super) fn shrink(&mut self) {
        self.distance *= 0.95;
        self.shrunk += 1;
    }

    pub(super) fn times_shrunk(self) -> u32 {
        self.shrunk
    }

    /// In units of the square's side.
    pub(super) fn distance(self) -> f64 {
        self.distance
    }

    /// In units of 2^-64.
    pub(super) fn squared(self) -> u64 {
        (self.distance * self.distance * 18_446_744_073_709_551_616.0) as u64
    }
}

/// `count` points on the torus, and what they cost.
pub(super) fn points(count: u32, seed: u64) -> PointSet {
    let mut rng = CounterRng::new(seed);
    let mut radius = Radius::wanted(count);
    let mut points: Vec<[Fraction; 2]> = Vec::with_capacity(count as usize);
    let mut darts = 0;
    // A square that is full before all points are in it starts again from them with a smaller radius.
    while !fill(&mut points, count as usize, radius, &mut rng, &mut darts) {
        radius.shrink();
    }
    let facts = vec![
        ("radius", radius.distance()),
        ("radius given up", f64::from(radius.times_shrunk())),
        ("darts", darts as f64),
    ];
    PointSet::new(points, facts)
}

/// Adds points until there are `count`; whether there are.
fn fill(
    points: &mut Vec<[Fraction; 2]>,
    count: usize,
    radius: Radius,
    rng: &mut CounterRng,
    darts: &mut u64,
) -> bool {
    let mut grid = Grid::new(radius, points);
    let mut side = grid.side;
    let mut active: Vec<[u32; 2]> =
        (0..side).flat_map(|y| (0..side).map(move |x| [x, y])).collect();
    active.retain(|cell| !grid.covers(points, *cell, side));
    while points.len() < count && !active.is_empty() {
        // Throw into cells that may have room, each as likely as the others.
        for _ in 0..active.len().max(8) {
            let cell = active[below(rng, active.len())];
            let dart = grid.random_in(cell, side, rng);
            *darts += 1;
            if grid.has_room(points, dart) {
                grid.insert(points, dart);
            }
            if points.len() == count {
                return true;
            }
        }
        // Drop what is covered by now; what is left is looked at more closely.
        let can_split = side < 1 << 30;
        active.retain(|cell| !grid.covers(points, *cell, side));
        if can_split {
            active = active
                .iter()
                .flat_map(|[x, y]| QUARTERS.map(|[i, j]| [2 * x + i, 2 * y + j]))
                .collect();
            side *= 2;
            active.retain(|cell| !grid.covers(points, *cell, side));
        }
    }
    points.len() == count
}

const QUARTERS: [[u32; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

/// Points in cells so small that each holds at most one.
struct Grid {
    /// Cells along an axis.
    side: u32,
    /// Number of a point plus 1, or 0.
    cells: Vec<u32>,
    radius_squared: u64,
    /// Cells in each direction that a disc can reach into.
    reach: u32,
}

impl Grid {
    fn new(radius: Radius, points: &[[Fraction; 2]]) -> Self {
        // The diagonal of a cell is at most the radius.
        let side = (2.0_f64.sqrt() / radius.distance()).ceil() as u32;
        let reach = ((radius.distance() * f64::from(side)).ceil() as u32).min(side);
        let cells = vec![0; side as usize * side as usize];
        let mut grid = Self { side, cells, radius_squared: radius.squared(), reach };
        for (i, point) in (1..).zip(points) {
            let cell = grid.cell(*point);
            grid.cells[cell] = i;
        }
        grid
    }

    fn cell(&self, point: [Fraction; 2]) -> usize {
        let [x, y] = point.map(|c| ((u64::from(c) * u64::from(self.side)) >> 32) as usize);
        y * self.side as usize + x
    }

    fn insert(&mut self, points: &mut Vec<[Fraction; 2]>, point: [Fraction; 2]) {
        let cell = self.cell(point);
        points.push(point);
        self.cells[cell] = points.len() as u32;
    }

    fn has_room(&self, points: &[[Fraction; 2]], dart: [Fraction; 2]) -> bool {
        self.cells[self.cell(dart)] == 0
            && self.near(points, dart).all(|p| distance_squared(p, dart) >= self.radius_squared)
    }

    /// Whether one disc covers the whole of a cell of a grid of `side` cells.
    fn covers(&self, points: &[[Fraction; 2]], cell: [u32; 2], side: u32) -> bool {
        // All corners as seen from the image of the point that is nearest to the middle: on a small torus, each could
        // be near another image.
        let middle = cell.map(|c| in_stratum(c, side, HALF));
        let half = u64::from(u32::MAX.div_ceil(2 * side)) + 1;
        self.near(points, middle).any(|p| {
            let farthest = [0, 1].map(|k| {
                let distance = u64::from((p[k].wrapping_sub(middle[k]) as i32).unsigned_abs());
                (distance + half) * (distance + half)
            });
            farthest[0] + farthest[1] < self.radius_squared
        })
    }

    /// The points in the cells around that of `at`, some of them twice where the torus is small.
    fn near<'a>(
        &'a self,
        points: &'a [[Fraction; 2]],
        at: [Fraction; 2],
    ) -> impl Iterator<Item = [Fraction; 2]> + 'a {
        let (side, reach) = (self.side, self.reach);
        let cell = self.cell(at) as u32;
        let [column, row] = [cell % side, cell / side];
        (0..=2 * reach).flat_map(move |j| {
            let y = (row + side + j - reach) % side;
            (0..=2 * reach).filter_map(move |i| {
                let x = (column + side + i - reach) % side;
                let number = self.cells[(y * side + x) as usize];
                (number > 0).then(|| points[number as usize - 1])
            })
        })
    }

    /// A uniform point in a cell of a grid of `side` cells.
    fn random_in(&self, cell: [u32; 2], side: u32, rng: &mut CounterRng) -> [Fraction; 2] {
        let offset = super::random_point(rng);
        [0, 1].map(|k| in_stratum(cell[k], side, offset[k]))
    }
}

/// A uniform number below `n`.
fn below(rng: &mut CounterRng, n: usize) -> usize {
    let [high, _] = super::random_point(rng);
    ((u64::from(high) * n as u64) >> 32) as usize
}

#[cfg(test)]
mod tests {
    use super::super::dart_throwing;
    use super::*;

    #[test]
    fn all_points_keep_their_distance() {
        for (count, seed) in [(1, 0), (2, 0), (3, 1), (5, 2), (16, 3), (100, 4), (1000, 5)] {
            for set in [points(count, seed), dart_throwing::points(count, seed)] {
                assert_eq!(set.points.len(), count as usize);
                let radius = set.facts[0].1;
                for (i, a) in set.points.iter().enumerate() {
                    for b in &set.points[..i] {
                        let distance = (distance_squared(*a, *b) as f64).sqrt() / 4_294_967_296.0;
                        assert!(distance >= radius * (1.0 - 1e-9), "{count}: {distance} {radius}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_radius_is_seldom_given_up() {
        for count in [16, 64, 256, 1024] {
            for seed in 0..4 {
                assert_eq!(points(count, seed).facts[1], ("radius given up", 0.0), "{count}");
            }
        }
    }

    /// Both ways draw from one distribution: the mean distance of the k-th point to the nearest of those before it is the
    /// same. Two means of 1600 sets each; 5.6 standard errors are passed by chance with 2e-8, five comparisons; a
    /// difference of 5 % of the mean would be found.
    #[test]
    fn the_fast_way_has_the_distribution_of_the_slow_one() {
        const SETS: u64 = 1600;
        for (count, k) in [(24, 8), (24, 16), (24, 23), (2, 1), (3, 2)] {
            let nearest = |set: PointSet| {
                let (before, last) = (&set.points[..k], set.points[k]);
                let squared = before.iter().map(|p| distance_squared(*p, last)).min();
                (squared.unwrap_or(0) as f64).sqrt() / 4_294_967_296.0
            };
            let moments = |make: fn(u32, u64) -> PointSet, first: u64| {
                let values: Vec<f64> =
                    (first..first + SETS).map(|s| nearest(make(count, s))).collect();
                let mean = values.iter().sum::<f64>() / SETS as f64;
                let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / SETS as f64;
                (mean, variance / SETS as f64)
            };
            let (fast, slow) = (moments(points, 0), moments(dart_throwing::points, SETS));
            let limit = 5.6 * (fast.1 + slow.1).sqrt();
            assert!(limit < 0.05 * slow.0, "no power: {limit} of {}", slow.0);
            assert!((fast.0 - slow.0).abs() < limit, "k = {k}: {fast:?} {slow:?}");
        }
    }
}
