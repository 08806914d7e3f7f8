//! Which of many points is nearest to each sample of a grid: exact, by cutting the grid into quarters.
//!
//! Each rectangle has the list of the points that may be nearest to one of its samples. From the list of a
//! quarter is left out who is farther everywhere in it than the point nearest to its middle: the difference
//! of two squared distances is linear, so its least value over a rectangle is that of a corner. Lists shrink
//! to two or three points before rectangles shrink to a few samples, however unevenly the points are spread.
//!
//! Distances are Euclidean, squared, of integers in 64 bits: nothing is rounded. Of points equally near the
//! first has the sample. Knows nothing of weights.

/// Bits after the point of a coordinate: a sample is 2^8 units wide. Sample i has its centre in the middle.
pub(super) const FRACTION: u32 = 8;

/// Side of the rectangles that are shared out to threads, in samples. Sums within one fit in 64 bits.
const TILE: u32 = 256;

/// Side of the rectangles that are searched sample by sample.
const LEAF: u32 = 4;

/// Samples from `low` up to, but not including, `high`.
#[derive(Clone, Copy, Debug)]
struct Area {
    low: [u32; 2],
    high: [u32; 2],
}

/// A point that may be nearest.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    position: [i64; 2],
    /// Squared distance from the origin.
    square: i64,
    index: u32,
}

/// Samples `start..end` of row `y`, all nearest to one point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) y: u32,
    pub(super) start: u32,
    pub(super) end: u32,
    /// Which of [`Tile::sites`].
    pub(super) slot: u32,
}

/// A rectangle of at most [`TILE`] samples a side.
#[derive(Debug)]
pub(super) struct Tile {
    area: Area,
    /// Indices of the points that may be nearest to one of its samples, ascending.
    pub(super) sites: Vec<u32>,
    candidates: Vec<Candidate>,
}

/// Cuts a grid of `size` samples, at least one, into tiles. There is at least one point.
pub(super) fn tiles(size: [u32; 2], points: &[[i64; 2]]) -> Vec<Tile> {
    let candidates = points.iter().zip(0..).map(|(&position, index)| {
        let square = position.iter().map(|x| x * x).sum();
        Candidate { position, square, index }
    });
    let mut tiles = Vec::new();
    let all = Area { low: [0, 0], high: size };
    cut(all, &mut candidates.collect(), 0, TILE, 0, &mut |area, candidates| {
        let sites = candidates.iter().map(|candidate| candidate.index).collect();
        let in_slots = |(slot, &candidate)| Candidate { index: slot, ..candidate };
        let candidates = (0..).zip(candidates).map(in_slots).collect();
        tiles.push(Tile { area, sites, candidates });
    });
    tiles
}

impl Tile {
    /// The first sample: column and row.
    pub(super) fn origin(&self) -> [u32; 2] {
        self.area.low
    }

    /// Tells the nearest point of every sample, each once, in runs.
    pub(super) fn runs(&self, emit: &mut impl FnMut(Run)) {
        let mut stack = self.candidates.clone();
        cut(self.area, &mut stack, 0, LEAF, 1, &mut |area, candidates| match candidates {
            [only] => {
                let [start, end] = [area.low[0], area.high[0]];
                for y in area.low[1]..area.high[1] {
                    emit(Run { y, start, end, slot: only.index });
                }
            }
            _ => search(area, candidates, emit),
        });
    }
}

/// Cuts `area`, whose candidates are `stack[start..]`, until no side is longer than `side` or no more than
/// `enough` candidates are left. Leaves the stack as it was.
fn cut<F: FnMut(Area, &[Candidate])>(
    area: Area,
    stack: &mut Vec<Candidate>,
    start: usize,
    side: u32,
    enough: usize,
    leaf: &mut F,
) {
    let sides = [0, 1].map(|axis| area.high[axis] - area.low[axis]);
    let end = stack.len();
    if sides.iter().all(|&s| s <= side) || end - start <= enough {
        return leaf(area, &stack[start..]);
    }
    let middle = [0, 1].map(|axis| match sides[axis] {
        s if s > side => area.low[axis] + s / 2,
        _ => area.high[axis],
    });
    let halves = |axis: usize| {
        [(area.low[axis], middle[axis]), (middle[axis], area.high[axis])]
            .into_iter()
            .filter(|(low, high)| low < high)
    };
    for (top, bottom) in halves(1) {
        for (left, right) in halves(0) {
            let quarter = Area { low: [left, top], high: [right, bottom] };
            narrow(quarter, stack, start);
            cut(quarter, stack, end, side, enough, leaf);
            stack.truncate(end);
        }
    }
}

/// Appends to the stack those of `stack[start..]` that may be nearest to a sample of `area`.
fn narrow(area: Area, stack: &mut Vec<Candidate>, start: usize) {
    let end = stack.len();
    let low = area.low.map(centre);
    let high = area.high.map(|i| centre(i - 1));
    // Centres are even numbers of units.
    let middle = [0, 1].map(|axis| (low[axis] + high[axis]) / 2);
    let to_middle = |candidate: &Candidate| distance(candidate, middle);
    let Some(&best) = stack[start..].iter().min_by_key(|candidate| to_middle(candidate)) else {
        return;
    };
    for i in start..end {
        let candidate = stack[i];
        // The corner where the candidate fares best against the best one.
        let corner = [0, 1].map(|axis| {
            let is_before = candidate.position[axis] < best.position[axis];
            if is_before { low[axis] } else { high[axis] }
        });
        if distance(&candidate, corner) <= distance(&best, corner) {
            stack.push(candidate);
        }
    }
}

/// Tries all candidates on every sample.
fn search(area: Area, candidates: &[Candidate], emit: &mut impl FnMut(Run)) {
    for y in area.low[1]..area.high[1] {
        let mut run: Option<Run> = None;
        for x in area.low[0]..area.high[0] {
            let sample = [centre(x), centre(y)];
            // The first of equals: they are in the order of their indices.
            let nearest = candidates.iter().min_by_key(|candidate| distance(candidate, sample));
            let slot = nearest.map_or(0, |candidate| candidate.index);
            match &mut run {
                Some(run) if run.slot == slot => run.end = x + 1,
                _ => {
                    let next = Run { y, start: x, end: x + 1, slot };
                    run.replace(next).into_iter().for_each(&mut *emit);
                }
            }
        }
        run.into_iter().for_each(&mut *emit);
    }
}

/// Squared distance of a candidate, less the squared distance of `to` from the origin.
#[inline(always)]
fn distance(candidate: &Candidate, to: [i64; 2]) -> i64 {
    let [x, y] = candidate.position;
    candidate.square - 2 * (x * to[0] + y * to[1])
}

/// Coordinate of the centre of sample `i`.
#[inline(always)]
fn centre(i: u32) -> i64 {
    (i64::from(i) << FRACTION) + (1 << (FRACTION - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::hash::combine;

    /// The nearest point of every sample, row-major; each must be told once.
    fn owners(size: [u32; 2], points: &[[i64; 2]]) -> Vec<u32> {
        let mut owners = vec![u32::MAX; (size[0] * size[1]) as usize];
        for tile in tiles(size, points) {
            tile.runs(&mut |run| {
                for x in run.start..run.end {
                    let owner = &mut owners[(run.y * size[0] + x) as usize];
                    assert_eq!(*owner, u32::MAX, "sample {x}, {} is told twice", run.y);
                    *owner = tile.sites[run.slot as usize];
                }
            });
        }
        owners
    }

    fn by_brute_force(size: [u32; 2], points: &[[i64; 2]]) -> Vec<u32> {
        let nearest = |x: u32, y: u32| {
            let squared = |p: &[i64; 2]| (p[0] - centre(x)).pow(2) + (p[1] - centre(y)).pow(2);
            (0..).zip(points).min_by_key(|(_, p)| squared(p)).unwrap().0
        };
        (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| nearest(x, y))).collect()
    }

    fn assert_nearest(size: [u32; 2], points: &[[i64; 2]]) {
        assert!(owners(size, points) == by_brute_force(size, points), "{size:?} {}", points.len());
    }

    /// Anywhere, and crowded in a corner; more points than samples, one point, thin grids, several tiles.
    #[test]
    fn every_sample_goes_to_the_nearest_point() {
        for (size, points) in [
            ([1, 1], 3),
            ([7, 5], 90),
            ([40, 30], 1),
            ([64, 64], 50),
            ([700, 1], 30),
            ([1, 530], 9),
            ([530, 270], 41),
        ] {
            for seed in 0..4 {
                let at = |i: u64| {
                    [0, 1].map(|axis| {
                        let span = u64::from(size[axis as usize]) << FRACTION;
                        let crowd = if seed % 2 == 0 { 1 } else { 9 };
                        (combine(seed, 2 * i + axis) % span / crowd) as i64
                    })
                };
                assert_nearest(size, &(0..points).map(at).collect::<Vec<_>>());
            }
        }
    }

    /// Points on a coarse lattice, many of them twice: most samples on borders are ties.
    #[test]
    fn of_equals_the_first_is_nearest() {
        let mut ties = 0;
        for seed in 0..20 {
            let at = |i| {
                let random = combine(seed, i);
                [random, random >> 32].map(|r| ((r % 9) as i64 * 4) << FRACTION)
            };
            let points: Vec<_> = (0..40).map(at).collect();
            assert_nearest([33, 34], &points);
            let mut reversed = points.clone();
            reversed.reverse();
            let (forwards, backwards) = (owners([33, 34], &points), owners([33, 34], &reversed));
            ties += forwards.iter().zip(&backwards).filter(|(a, b)| **a != 39 - **b).count();
        }
        assert!(ties > 1000, "{ties}");
    }

    /// The largest grid that there can be: nothing overflows.
    #[test]
    fn far_corners_are_told_apart() {
        let size = [1 << 19, 2];
        let points = [[0, 0], [(1 << (19 + FRACTION)) - 1, (2 << FRACTION) - 1]];
        let owners = owners(size, &points);
        let first = owners.iter().filter(|&&owner| owner == 0).count();
        assert_eq!(first, 1 << 19);
        assert_eq!((owners[(1 << 18) - 1], owners[(1 << 18) + 1]), (0, 1));
    }
}
