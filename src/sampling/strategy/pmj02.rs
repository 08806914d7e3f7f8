//! Progressive multi-jittered (0,2) points: of every power of two of them, each elementary interval of area 1/n holds
//! exactly one.
//!
//! Source: P. Christensen, A. Kensler and C. Kilpatrick, "Progressive Multi-Jittered Sample Sequences", EGSR 2018: every
//! doubling puts one point beside each that is there, first into the diagonally opposite quarter of its cell,
//! then into one of the two that are left. What follows for the strata is kept as bits, and candidates are tried
//! in a random order, so that a place is found if there is one.

use super::fraction::Fraction;
use super::permutation::permute;
use super::{PointSet, random_point};
use crate::sampling::CounterRng;
use crate::sampling::hash::combine;

/// The first `count` points of a sequence.
pub(super) fn points(count: u32, seed: u64) -> PointSet {
    let doublings = count.next_power_of_two().trailing_zeros();
    let mut rng = CounterRng::new(seed);
    let mut points = vec![random_point(&mut rng)];
    let mut attempts = 0;
    for m in 0..doublings {
        // A doubling that leaves no place for one of its points begins again with other numbers.
        loop {
            attempts += 1;
            if let Some(new) = doubling(&points, m, combine(seed, attempts)) {
                points.extend(new);
                break;
            }
        }
    }
    points.truncate(count as usize);
    let again = attempts - u64::from(doublings);
    PointSet::new(points, vec![("doublings begun again", again as f64)])
}

/// The points that make 2^(m+1) of 2^m; `None` if it comes to a dead end.
fn doubling(points: &[[Fraction; 2]], m: u32, seed: u64) -> Option<Vec<[Fraction; 2]>> {
    let mut strata = Strata::new(m + 1);
    for point in points {
        strata.take(point.map(|c| strata.fine(c)));
    }
    let mut rng = CounterRng::new(combine(seed, 2));
    let mut new = Vec::with_capacity(points.len());
    // Cells of 2^-k by 2^-k hold one point before, or two in opposite quarters.
    let (k, is_diagonal) = (m / 2, m.is_multiple_of(2));
    for (i, point) in points.iter().enumerate() {
        let quarter = point.map(|c| (u64::from(c) >> (31 - k)) as u32);
        // Which of the other two quarters comes first is one decision for both points of a cell.
        let other_first =
            combine(combine(seed, u64::from(quarter[0] >> 1)), u64::from(quarter[1] >> 1)) >> 63
                == 0;
        let target = match (is_diagonal, other_first) {
            (true, _) => [quarter[0] ^ 1, quarter[1] ^ 1],
            (false, true) => [quarter[0] ^ 1, quarter[1]],
            (false, false) => [quarter[0], quarter[1] ^ 1],
        };
        let fine = strata.place(target, k + 1, combine(seed, 8 + i as u64))?;
        strata.take(fine);
        let offset = random_point(&mut rng);
        new.push([0, 1].map(|axis| strata.fraction(fine[axis], offset[axis])));
    }
    Some(new)
}

/// Which elementary intervals of area 2^-m hold a point.
struct Strata {
    m: u32,
    /// For each shape, 2^-a by 2^-(m-a), a bool an interval.
    taken: Vec<Vec<bool>>,
}

impl Strata {
    fn new(m: u32) -> Self {
        Self { m, taken: vec![vec![false; 1 << m]; m as usize + 1] }
    }

    /// The finest stratum along an axis that a coordinate is in.
    fn fine(&self, c: Fraction) -> u32 {
        (u64::from(c) >> (32 - self.m)) as u32
    }

    /// The coordinate at `offset` of the way through a finest stratum.
    fn fraction(&self, fine: u32, offset: Fraction) -> Fraction {
        ((u64::from(fine) << 32 | u64::from(offset)) >> self.m) as u32
    }

    fn interval(&self, [x, y]: [u32; 2], a: u32) -> usize {
        ((x >> (self.m - a)) << (self.m - a) | y >> a) as usize
    }

    fn take(&mut self, fine: [u32; 2]) {
        for a in 0..=self.m {
            let interval = self.interval(fine, a);
            self.taken[a as usize][interval] = true;
        }
    }

    fn is_free(&self, fine: [u32; 2]) -> bool {
        (0..=self.m).all(|a| !self.taken[a as usize][self.interval(fine, a)])
    }

    /// A free place in quarter `quarter`, a square of side 2^-`bits`.
    fn place(&self, quarter: [u32; 2], bits: u32, seed: u64) -> Option<[u32; 2]> {
        let width = 1 << (self.m - bits);
        let start = quarter.map(|c| c * width);
        // Strata along each axis that are free as a whole.
        let columns =
            (start[0]..start[0] + width).filter(|x| !self.taken[self.m as usize][*x as usize]);
        let rows = (start[1]..start[1] + width).filter(|y| !self.taken[0][*y as usize]);
        let (columns, rows): (Vec<u32>, Vec<u32>) = (columns.collect(), rows.collect());
        let pairs = (columns.len() * rows.len()) as u32;
        let pair = |i: u32| {
            let i = permute(i, pairs, seed) as usize;
            [columns[i % columns.len()], rows[i / columns.len()]]
        };
        (0..pairs).map(pair).find(|fine| self.is_free(*fine))
    }
}
