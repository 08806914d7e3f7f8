//! Subtrees over few primitives: sorted along each axis, and cut wherever it is cheapest.
//!
//! Source of the sweep: J. D. MacDonald, K. S. Booth, "Heuristics for ray tracing using space subdivision", The
//! Visual Computer 6(3), 1990. A leaf costs the same with one primitive as with all that it has room for, in primitives and
//! in their points: that makes leaves come out full.

use super::HALVE_FROM;
use super::bins::{Grid, cheapest_axis};
use super::node::Nodes;
use super::points::{Leaves, Room};
use super::primitive::{Bounds, Centers, PrimitiveBox};
use super::range::Range;
use glam::{Vec3, Vec4};

/// Most primitives.
pub(super) const MOST: usize = 16;
/// Keeps an index below [`MOST`], for the compiler to see.
const MASK: usize = MOST - 1;

/// More points than any primitives here have.
const POINTS: usize = 64;

/// Room to work in, used again and again.
pub(super) struct Sweep<'a, L> {
    leaves: &'a L,
    room: Room,
    bounds: [Bounds; MOST],
    ids: [u32; MOST],
    /// The points of each primitive.
    points: [u64; MOST],
    /// The primitives in the order of their centres along each axis; a part has the same places in each.
    sorted: [[u8; MOST]; 3],
    /// Boxes in the order along each axis.
    in_order: [[Bounds; 3]; MOST],
    /// Points in the order along each axis.
    points_in_order: [[u64; 3]; MOST],
    /// Leaves that so many primitives fill, and so many points.
    by_count: [f32; MOST],
    by_points: [f32; POINTS + 1],
}

/// Places of primitives that are to become a subtree.
#[derive(Clone, Copy, Default)]
struct Part {
    start: usize,
    end: usize,
    node: usize,
    depth: u32,
    /// The axis along which it has been cut off.
    axis: usize,
}

/// Between two primitives along an axis.
struct Cut {
    axis: usize,
    /// How many are on the left.
    left: usize,
}

impl<'a, L: Leaves> Sweep<'a, L> {
    pub(super) fn new(leaves: &'a L) -> Self {
        let room = leaves.room();
        Self {
            leaves,
            room,
            bounds: [Bounds::EMPTY; MOST],
            ids: [0; MOST],
            points: [0; MOST],
            sorted: [[0; MOST]; 3],
            in_order: [[Bounds::EMPTY; 3]; MOST],
            points_in_order: [[0; 3]; MOST],
            by_count: std::array::from_fn(|n| n.div_ceil(room.primitives) as f32),
            by_points: std::array::from_fn(|n| n.div_ceil(room.points) as f32),
        }
    }

    /// Builds the subtree over at most [`MOST`] primitives.
    pub(super) fn build(&mut self, range: Range<'_>, nodes: &mut Nodes) {
        self.sort(range.here, &range.centers);
        self.points = self.leaves.points(&self.ids[..range.here.len()]);
        let Range { node, depth, .. } = range;
        let mut stack = [Part::default(); MOST];
        stack[0] = Part { start: 0, end: range.here.len(), node, depth, axis: 0 };
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let part = stack[len & MASK];
            let Part { start, end, node, depth, .. } = part;
            if self.fits(&self.sorted[part.axis][start..end]) {
                for (place, i) in range.order[start..end].iter_mut().zip(start..) {
                    *place = self.ids[self.sorted[part.axis][i & MASK] as usize & MASK];
                }
                nodes.leaf(node, range.first + start as u32, (end - start) as u32);
                continue;
            }
            self.put_in_order(&part);
            let Cut { axis, left: count } = self.best_cut(&part);
            let middle = start + count;
            let sides = [start..middle, middle..end].map(|side| &self.sorted[axis][side]);
            if !sides.into_iter().all(|side| self.fits(side)) {
                self.distribute(&part, axis, middle);
            }
            let union = |a: Bounds, j: usize| a.union(self.in_order[j & MASK][axis]);
            let left = (0..count).fold(Bounds::EMPTY, union);
            let right = (count..end - start).fold(Bounds::EMPTY, union);
            let child = nodes.split(node, &[left, right]);
            let depth = depth + 1;
            stack[len & MASK] = Part { start: middle, end, node: child + 1, depth, axis };
            stack[(len + 1) & MASK] = Part { start, end: middle, node: child, depth, axis };
            len += 2;
        }
    }

    /// Whether these primitives fit into a leaf.
    #[inline(always)]
    fn fits(&self, primitives: &[u8]) -> bool {
        let points = primitives.iter().fold(0, |all, &p| all | self.points[p as usize & MASK]);
        primitives.len() <= self.room.primitives && points.count_ones() as usize <= self.room.points
    }

    /// Takes the primitives over, and sorts them along each axis.
    #[inline(always)]
    fn sort(&mut self, primitives: &[PrimitiveBox], centers: &Centers) {
        let n = primitives.len().min(MOST);
        // So fine that it hardly matters who is first in a bin; the number makes all keys differ.
        let grid = Grid::new(centers, 1024);
        let mut keys = [[i16::MAX; MOST]; 3];
        for (i, p) in primitives[..n].iter().enumerate() {
            self.bounds[i & MASK] = p.bounds();
            self.ids[i & MASK] = p.id();
            for (keys, bin) in keys.iter_mut().zip(grid.of(p.center2())) {
                keys[i & MASK] = (bin * MOST + i) as i16;
            }
        }
        for (sorted, keys) in self.sorted.iter_mut().zip(&keys) {
            // A primitive's place is the number of keys below its own.
            let mut places = [0_i16; MOST];
            // Bit by bit: the compiler is to make vectors of the inner loop, not of this one.
            let mut rest = (1_u32 << n) - 1;
            while rest != 0 {
                let key = keys[rest.trailing_zeros() as usize & MASK];
                rest &= rest - 1;
                for (place, &other) in places.iter_mut().zip(keys) {
                    *place += i16::from(key < other);
                }
            }
            for (i, &place) in places[..n].iter().enumerate() {
                sorted[place as usize & MASK] = i as u8;
            }
        }
    }

    /// Puts the boxes and the points of a part in order.
    #[inline(always)]
    fn put_in_order(&mut self, part: &Part) {
        for (axis, sorted) in self.sorted.iter().enumerate() {
            let places = self.in_order.iter_mut().zip(&mut self.points_in_order);
            for ((boxes, points), i) in places.zip(part.start..part.end) {
                let primitive = sorted[i & MASK] as usize & MASK;
                boxes[axis] = self.bounds[primitive];
                points[axis] = self.points[primitive];
            }
        }
    }

    /// The cheapest cut of a part; the middle one where none is better than another, and deep down.
    #[inline(always)]
    fn best_cut(&self, part: &Part) -> Cut {
        let n = (part.end - part.start).min(MOST);
        let by_points = |points: u64| self.by_points[points.count_ones() as usize];
        let leaves = |count: usize, points: [u64; 3]| {
            let by_points = Vec3::from(points.map(by_points)).extend(0.0);
            by_points.max(Vec4::splat(self.by_count[count & MASK]))
        };
        // From the right: what each cut leaves there. All axes at once, one in each lane.
        let mut right = [Vec4::ZERO; MOST];
        let (mut union, mut points) =
            (self.in_order[(n - 1) & MASK], self.points_in_order[(n - 1) & MASK]);
        for left in (1..n).rev() {
            right[left] = Bounds::half_areas(&union) * leaves(n - left, points);
            add(&mut union, &self.in_order[left - 1]);
            add_points(&mut points, &self.points_in_order[left - 1]);
        }
        let (mut union, mut points) = (self.in_order[0], self.points_in_order[0]);
        let (mut least, mut best) = (Vec4::INFINITY, Vec4::ZERO);
        for (left, right) in right.iter().enumerate().take(n).skip(1) {
            let cost = Bounds::half_areas(&union) * leaves(left, points) + right;
            let is_less = cost.cmplt(least);
            least = Vec4::select(is_less, cost, least);
            best = Vec4::select(is_less, Vec4::splat(left as f32), best);
            add(&mut union, &self.in_order[left]);
            add_points(&mut points, &self.points_in_order[left]);
        }
        let axis = cheapest_axis(least);
        let left = best[axis] as usize & MASK;
        let is_any = left > 0 && part.depth < HALVE_FROM;
        if is_any { Cut { axis, left } } else { Cut { axis: 0, left: n / 2 } }
    }

    /// Brings the orders along the other axes in line with a cut, in whose own order the left side comes first.
    #[inline(always)]
    fn distribute(&mut self, part: &Part, axis: usize, middle: usize) {
        let mut on_right = 0_u32;
        for i in middle..part.end {
            on_right |= 1 << (self.sorted[axis][i & MASK] & MASK as u8);
        }
        for other in [(axis + 1) % 3, (axis + 2) % 3] {
            let sorted = &mut self.sorted[other];
            let old = *sorted;
            let (mut left, mut right) = (part.start, middle);
            for i in part.start..part.end {
                let p = old[i & MASK];
                let is_right = on_right >> (p & MASK as u8) & 1 != 0;
                sorted[if is_right { right } else { left } & MASK] = p;
                left += usize::from(!is_right);
                right += usize::from(is_right);
            }
        }
    }
}

/// Makes boxes larger, so that they hold others.
#[inline(always)]
fn add(boxes: &mut [Bounds; 3], others: &[Bounds; 3]) {
    for (a, b) in boxes.iter_mut().zip(others) {
        *a = a.union(*b);
    }
}

/// Makes sets of points larger, so that they hold others.
#[inline(always)]
fn add_points(sets: &mut [u64; 3], others: &[u64; 3]) {
    for (a, b) in sets.iter_mut().zip(others) {
        *a |= b;
    }
}
