//! The largest of many lines at a growing x, while ranges of lines move up and down.
//!
//! Lines are sorted by slope and cut into blocks of about sqrt(n). Each block knows its upper envelope: the
//! lines that are largest somewhere, in the order in which they are as x grows. Moving a whole block keeps
//! its envelope; moving a part of it calls for a new one. So a range that ends at either end of the list
//! moves in O(sqrt n), and a maximum is found in O(sqrt n), both amortised. Knows nothing of points.

use std::ops::Range;

/// How far below the present line the next one may be to be looked at: more than a rounding of either, so
/// that rounding cannot hide the lines beyond it.
const TOLERANCE: f64 = 1e-15;

/// Lines `(height + offset of its block) * unit + slope * x`. Heights are whole numbers, so they stay exact.
pub(super) struct Envelope {
    slopes: Vec<f64>,
    heights: Vec<f64>,
    unit: f64,
    block_size: usize,
    blocks: Vec<Block>,
}

struct Block {
    /// Added to the heights of all lines of the block.
    offset: f64,
    /// Lines of the upper envelope, by growing slope.
    hull: Vec<usize>,
    /// The place in `hull` of the line that was largest at the last x.
    largest: usize,
    /// Whether heights changed since `hull` was found.
    stale: bool,
}

impl Envelope {
    /// Lines through (0, 0) of these slopes, which grow; one step of height is `unit`.
    pub(super) fn new(slopes: Vec<f64>, unit: f64) -> Self {
        let block_size = slopes.len().isqrt().max(8);
        let blocks = (0..slopes.len().div_ceil(block_size))
            .map(|_| Block { offset: 0.0, hull: Vec::new(), largest: 0, stale: true })
            .collect();
        Self { heights: vec![0.0; slopes.len()], slopes, unit, block_size, blocks }
    }

    /// Moves the lines of `range` by `steps`, a whole number.
    pub(super) fn shift(&mut self, range: Range<usize>, steps: f64) {
        if range.is_empty() {
            return;
        }
        for b in range.start / self.block_size..=(range.end - 1) / self.block_size {
            let all = self.lines(b);
            let block = &mut self.blocks[b];
            if range.start <= all.start && all.end <= range.end {
                block.offset += steps;
            } else {
                let part = range.start.max(all.start)..range.end.min(all.end);
                self.heights[part].iter_mut().for_each(|height| *height += steps);
                block.stale = true;
            }
        }
    }

    /// The largest line at x, at least as large as the x of the call before. Its error is at most a few
    /// roundings, below 1e-12 for values up to 1.
    pub(super) fn max_at(&mut self, x: f64) -> f64 {
        let mut max = f64::NEG_INFINITY;
        for b in 0..self.blocks.len() {
            if self.blocks[b].stale {
                self.find_hull(b);
            }
            let block = &mut self.blocks[b];
            let value = |line: usize| {
                (self.heights[line] + block.offset) * self.unit + self.slopes[line] * x
            };
            // Along the envelope values grow up to the largest.
            let mut present = value(block.hull[block.largest]);
            max = max.max(present);
            while let Some(&line) = block.hull.get(block.largest + 1) {
                let next = value(line);
                if next < present - TOLERANCE {
                    break;
                }
                block.largest += 1;
                present = next;
                max = max.max(next);
            }
        }
        max
    }

    /// The lines of block `b`.
    fn lines(&self, b: usize) -> Range<usize> {
        b * self.block_size..self.slopes.len().min((b + 1) * self.block_size)
    }

    /// Finds the upper envelope of block `b`: the convex hull of the dual points (slope, height).
    fn find_hull(&mut self, b: usize) {
        let lines = self.lines(b);
        let (slopes, heights) = (&self.slopes, &self.heights);
        let block = &mut self.blocks[b];
        block.hull.clear();
        for new in lines {
            while let [.., first, middle] = block.hull[..] {
                // The middle line is nowhere above both others.
                let (to_middle, to_new) =
                    (slopes[middle] - slopes[first], slopes[new] - slopes[first]);
                let covered = (heights[middle] - heights[first]) * to_new
                    <= (heights[new] - heights[first]) * to_middle;
                if !covered {
                    break;
                }
                block.hull.pop();
            }
            block.hull.push(new);
        }
        block.largest = 0;
        block.stale = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    #[test]
    fn against_every_line() {
        for seed in 0..100 {
            let mut rng = CounterRng::new(seed);
            let mut unit = || f64::from(rng.unit());
            let n = 1 + (unit() * 150.0) as usize;
            // Some slopes are equal, some differ by a rounding.
            let mut slopes: Vec<f64> = (0..n)
                .map(|_| {
                    (unit() * 40.0).floor() / 40.0 * (1.0 + (unit() * 3.0).floor() * f64::EPSILON)
                })
                .collect();
            slopes.sort_unstable_by(f64::total_cmp);
            let mut heights = vec![0.0; n];
            let mut envelope = Envelope::new(slopes.clone(), 0.01);
            for step in 0..200 {
                let x = f64::from(step) / 199.0;
                let (a, b) = ((unit() * n as f64) as usize, (unit() * n as f64) as usize);
                let range = [a.min(b)..a.max(b), 0..b, a..n][step as usize % 3].clone();
                let steps = (unit() * 7.0).floor() - 3.0;
                heights[range.clone()].iter_mut().for_each(|height| *height += steps);
                envelope.shift(range, steps);
                let values = slopes.iter().zip(&heights).map(|(s, h)| h * 0.01 + s * x);
                let expected = values.fold(f64::NEG_INFINITY, f64::max);
                assert!((envelope.max_at(x) - expected).abs() < 1e-14);
            }
        }
    }
}
