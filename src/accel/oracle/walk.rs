//! A line through a tree of boxes that leaves out no box that it meets.

use super::tree::{Bounds, BoxTree, Content};
use crate::math::DVec3;

/// A line with what is needed of it to meet boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    origin: DVec3,
    /// Of the direction; infinite along axes on which the line does not move.
    reciprocal: DVec3,
}

impl Line {
    pub(super) fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, reciprocal: direction.recip() }
    }

    /// A lower bound of the parameter in `range` at which the line enters the box. `None` only if it meets no point
    /// of the box within `range`.
    ///
    /// If a point o + t d of the line is in the box, then on each axis t is between the distances of the two planes,
    /// (plane - o) / d. As computed they passed three roundings (reciprocal, difference, product), without
    /// under- or overflow as in `triple`, and so are off by less than 4 u of themselves, u = 2^-53. They are
    /// moved apart by 8 u, one more rounding: each stays on its side of t, and so do their maximum and minimum.
    /// On an axis without movement, o itself is between the planes, which is compared exactly.
    #[inline]
    fn meet(&self, bounds: &Bounds, range: [f64; 2]) -> Option<f64> {
        const APART: f64 = 4.0 * f64::EPSILON;
        let [mut enter, mut exit] = range;
        for k in 0..3 {
            let (o, r) = (self.origin[k], self.reciprocal[k]);
            if !r.is_finite() {
                if o < bounds.low[k] || o > bounds.high[k] {
                    return None;
                }
                continue;
            }
            let (p, q) = ((bounds.low[k] - o) * r, (bounds.high[k] - o) * r);
            let (near, far) = (p.min(q), p.max(q));
            enter = enter.max(near - near.abs() * APART);
            exit = exit.min(far + far.abs() * APART);
        }
        (enter <= exit).then_some(enter)
    }

    /// Calls `visit` with each id whose box, changed by `change`, the line may meet within `range`; nearer nodes
    /// first. `visit` returns the upper end of what is still of interest.
    pub(super) fn walk(
        &self,
        tree: &BoxTree,
        [start, mut end]: [f64; 2],
        change: impl Fn(&Bounds) -> Bounds,
        mut visit: impl FnMut(u32) -> f64,
    ) {
        let enter = |node: u32, end: f64| {
            let bounds = change(&tree.nodes[node as usize].bounds);
            self.meet(&bounds, [start, end]).map(|entry| (entry, node))
        };
        let mut open = Vec::with_capacity(64);
        if !tree.nodes.is_empty() {
            open.extend(enter(0, end));
        }
        while let Some((entry, node)) = open.pop() {
            if entry > end {
                continue;
            }
            match tree.nodes[node as usize].content {
                Content::Ids(first, last) => {
                    for &id in &tree.ids[first as usize..last as usize] {
                        end = visit(id);
                    }
                }
                Content::Children(first) => {
                    let [left, right] = [enter(first, end), enter(first + 1, end)];
                    // The nearer one on top.
                    if left.map(|l| l.0) < right.map(|r| r.0) {
                        open.extend(right.into_iter().chain(left));
                    } else {
                        open.extend(left.into_iter().chain(right));
                    }
                }
            }
        }
    }
}
