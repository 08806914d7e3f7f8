//! Blue noise by the void-and-cluster method: points of a fine grid, moved from the tightest cluster to the largest void
//! until that is one and the same place, and ranked so that every prefix is spread as well as it can be.
//!
//! Source: R. A. Ulichney, "The void-and-cluster method for dither array generation", Proc. SPIE 1913, 1993: the initial
//! pattern of section 4, and of its three phases of ranking the first, which numbers the points of that pattern.

use super::fraction::in_stratum;
use super::{PointSet, random_point};
use crate::math::fun::double;
use crate::sampling::CounterRng;

/// `count` points on the torus, in the order of their ranks.
pub(super) fn points(count: u32, seed: u64) -> PointSet {
    let mut rng = CounterRng::new(seed);
    let mut field = Field::new(count);
    // Begin with random cells.
    let mut placed = 0;
    while placed < count {
        let [high, _] = random_point(&mut rng);
        let cell = ((u64::from(high) * field.taken.len() as u64) >> 32) as usize;
        if !field.taken[cell] {
            field.set(cell, true);
            placed += 1;
        }
    }
    // Move the point of the tightest cluster to the largest void, until it would go back to where it was.
    let mut moves = 0;
    loop {
        let cluster = field.tightest_cluster();
        field.set(cluster, false);
        let void = field.largest_void();
        field.set(void, true);
        moves += 1;
        if void == cluster || moves > 20 * u64::from(count) {
            break;
        }
    }
    // Take the points away, always the one of the tightest cluster: the last one is the first in rank.
    // The fewer are left, the farther they must see.
    let mut cells: Vec<usize> = (0..count)
        .map(|taken_away| {
            let left = count - taken_away;
            if left < count && left.is_power_of_two() {
                field.look_around(left);
            }
            let cluster = field.tightest_cluster();
            field.set(cluster, false);
            cluster
        })
        .collect();
    cells.reverse();
    // Points are uniform within their cells, so that they are on no grid.
    let side = field.side;
    let points = cells.iter().map(|cell| {
        let offset = random_point(&mut rng);
        let (column, row) = (*cell as u32 % side, *cell as u32 / side);
        [in_stratum(column, side, offset[0]), in_stratum(row, side, offset[1])]
    });
    PointSet::new(points.collect(), vec![("moves", moves as f64), ("grid", f64::from(side))])
}

/// Which cells of a grid on the torus hold a point, and how crowded each cell is: the sum of a Gaussian around every point.
struct Field {
    side: u32,
    taken: Vec<bool>,
    crowding: Vec<f64>,
    /// The Gaussian by distance along an axis; the one in the plane is a product of two.
    profile: Vec<f64>,
    /// Of each row: the tightest cluster and the largest void; `None` where they are to be looked for again.
    rows: Vec<Option<Extremes>>,
}

/// A row's most crowded cell with a point, and its least crowded one without.
#[derive(Clone, Copy, Debug, Default)]
struct Extremes {
    cluster: Option<usize>,
    void: Option<usize>,
}

impl Field {
    /// Cells a point, at least: the grid is finer than the distance between points by the root of it.
    const CELLS_A_POINT: f64 = 100.0;
    /// Standard deviation of the Gaussian in units of the mean spacing of the points. The smallest distance of 256 points is
    /// 0.70, 0.63, 0.52 and 0.12 of the largest possible one with 0.3, 0.4, 0.5 and 0.6.
    const WIDTH: f64 = 0.3;

    fn new(count: u32) -> Self {
        let side = (f64::from(count) * Self::CELLS_A_POINT).sqrt().ceil() as u32;
        let taken = vec![false; side as usize * side as usize];
        let rows = vec![None; side as usize];
        let mut field = Self { side, crowding: Vec::new(), taken, profile: Vec::new(), rows };
        field.look_around(count);
        field
    }

    /// Makes the Gaussian as wide as `count` points need it.
    fn look_around(&mut self, count: u32) {
        let spacing = f64::from(self.side) / f64::from(count).sqrt();
        let deviation = Self::WIDTH * spacing;
        let reach = ((4.5 * deviation).ceil() as u32).min(self.side / 2);
        let gaussian = |d: u32| double::exp(-0.5 * (f64::from(d) / deviation).powi(2));
        self.profile = (0..=reach).map(gaussian).collect();
        self.crowding = vec![0.0; self.taken.len()];
        self.rows.fill(None);
        for cell in 0..self.taken.len() {
            if self.taken[cell] {
                self.set(cell, true);
            }
        }
    }

    /// Puts a point into a cell or takes it away.
    fn set(&mut self, cell: usize, taken: bool) {
        self.taken[cell] = taken;
        let (side, reach) = (self.side as usize, self.profile.len() - 1);
        let (column, row) = (cell % side, cell / side);
        // Where the profile reaches half around, the farthest cells are the same on both sides.
        let around = |middle: usize| {
            let doubled = 2 * reach == side;
            (0..2 * reach + 1 - usize::from(doubled))
                .map(move |i| ((middle + side + i - reach) % side, i.abs_diff(reach)))
        };
        let sign = if taken { 1.0 } else { -1.0 };
        for (y, dy) in around(row) {
            self.rows[y] = None;
            for (x, dx) in around(column) {
                self.crowding[y * side + x] += sign * self.profile[dy] * self.profile[dx];
            }
        }
    }

    /// The most crowded of the cells that hold a point; the first of several.
    fn tightest_cluster(&mut self) -> usize {
        let clusters = self.extremes().filter_map(|row| row.cluster).collect::<Vec<_>>();
        self.first_best(clusters, |a, b| a > b).unwrap_or(0)
    }

    /// The least crowded of the cells that hold none; the first of several.
    fn largest_void(&mut self) -> usize {
        let voids = self.extremes().filter_map(|row| row.void).collect::<Vec<_>>();
        self.first_best(voids, |a, b| a < b).unwrap_or(0)
    }

    /// Those of all rows; only rows that a change has reached are looked through.
    fn extremes(&mut self) -> impl Iterator<Item = Extremes> {
        let side = self.side as usize;
        for row in 0..side {
            if self.rows[row].is_none() {
                let cells = row * side..(row + 1) * side;
                let taken = |wanted: bool| {
                    let field = &*self;
                    cells.clone().filter(move |cell| field.taken[*cell] == wanted)
                };
                let cluster = self.first_best(taken(true), |a, b| a > b);
                let void = self.first_best(taken(false), |a, b| a < b);
                self.rows[row] = Some(Extremes { cluster, void });
            }
        }
        self.rows.iter().flatten().copied()
    }

    fn first_best(
        &self,
        cells: impl IntoIterator<Item = usize>,
        better: impl Fn(f64, f64) -> bool,
    ) -> Option<usize> {
        let mut best: Option<usize> = None;
        for cell in cells {
            if best.is_none_or(|b| better(self.crowding[cell], self.crowding[b])) {
                best = Some(cell);
            }
        }
        best
    }
}
