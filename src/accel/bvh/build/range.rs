//! Primitives that are to be split: counted into bins, then moved to either side of a plane.

use super::bins::{Bins, Grid, Side};
use super::primitive::{Bounds, Centers, PrimitiveBox};
use super::{HALVE_FROM, Settings};

/// Primitives that are still to be split.
pub(super) struct Range<'a> {
    pub(super) here: &'a mut [PrimitiveBox],
    /// As much room besides, or none.
    pub(super) there: &'a mut [PrimitiveBox],
    /// Where their numbers go in the end.
    pub(super) order: &'a mut [u32],
    /// The place of the first of these.
    pub(super) first: u32,
    /// The node that they are below, and how deep that is.
    pub(super) node: usize,
    pub(super) depth: u32,
    pub(super) bounds: Bounds,
    pub(super) centers: Centers,
}

impl Range<'_> {
    /// The first `n` and the rest, both said to be all that this is.
    pub(super) fn split_at(self, n: usize) -> [Self; 2] {
        let here = self.here.split_at_mut(n);
        let there = self.there.split_at_mut(n.min(self.there.len()));
        let order = self.order.split_at_mut(n);
        let first = self.first + n as u32;
        [
            Self { here: here.0, there: there.0, order: order.0, ..self },
            Self { here: here.1, there: there.1, order: order.1, first, ..self },
        ]
    }

    /// Two parts, on either side of the cheapest plane between bins; in two halves where there is none, and
    /// deep down. They are still said to be below this one's node.
    pub(super) fn split(mut self, settings: &Settings, bins: &mut Bins) -> [Self; 2] {
        let (middle, bounds) = self.move_to_sides(settings, bins).unwrap_or_else(|| {
            let (left, right) = self.here.split_at(self.here.len() / 2);
            (left.len(), [Bounds::of(left), Bounds::of(right)])
        });
        self.depth += 1;
        let [mut left, mut right] = self.split_at(middle);
        [left.bounds, right.bounds] = bounds;
        left.centers = Centers::of(left.here);
        right.centers = Centers::of(right.here);
        [left, right]
    }

    /// Moves the primitives; returns how many are on the left, and the boxes of both sides.
    fn move_to_sides(
        &mut self,
        settings: &Settings,
        bins: &mut Bins,
    ) -> Option<(usize, [Bounds; 2])> {
        if self.depth >= HALVE_FROM {
            return None;
        }
        let count = settings.bins(self.here.len());
        let grid = Grid::new(&self.centers, count);
        bins.clear(count);
        bins.add_primitives(&grid, self.here);
        let plane = bins.cheapest(count, settings.leaf_shift)?;
        let middle = partition(self.here, &grid.side(&plane));
        Some((middle, bins.sides(&plane, count)))
    }
}

/// Moves the primitives on the left to the front; returns how many. The same order every time.
#[inline(always)]
fn partition(primitives: &mut [PrimitiveBox], side: &Side) -> usize {
    let mut left = 0;
    for i in 0..primitives.len() {
        // Swapped without asking: what is moved for nothing costs less than a branch that cannot be foreseen.
        let is_left = !side.is_right(&primitives[i]);
        PrimitiveBox::swap(primitives, i, left);
        left += usize::from(is_left);
    }
    left
}
