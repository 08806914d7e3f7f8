//! A node of sixteen children in two cache lines, as a ray meets it, and how one refers to another.
//!
//! Boxes have eight bits a plane on the node's own grid, rounded outwards (J. Mahovsky, B. Wyvill, "Memory-Conserving
//! Bounding Volume Hierarchies with Coherent Raytracing", CGF 25(2), 2006). A node's children lie side by side, inner
//! ones first. Knows neither how the tree came about nor what leaves hold.

use crate::geometry::Aabb;
use bytemuck::{Pod, Zeroable};

/// Children a node, at most.
pub(super) const WIDTH: usize = 16;

/// Bytes of a node, and of a leaf.
pub(super) const UNIT: usize = 128;

/// What is next: a node, a leaf, an instance, or an event of the traversal. Two bits of kind, then a number: for
/// nodes and leaves the place in the arena, in units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub(super) struct Reference(pub(super) u32);

impl Reference {
    /// Below it are all numbers.
    pub(super) const NUMBERS: usize = 1 << 30;
    /// To nothing at all.
    pub(super) const NOTHING: Self = Self::new(Kind::Event, 0);
    /// The ray is done with the object that it is in.
    pub(super) const LEAVE: Self = Self::new(Kind::Event, 1);
    /// Nothing is left to be done.
    pub(super) const DONE: Self = Self::new(Kind::Event, 2);

    /// The number must be below [`Self::NUMBERS`].
    pub(super) const fn new(kind: Kind, number: usize) -> Self {
        Self((kind as u32) << 30 | number as u32)
    }

    /// The kind as a number.
    #[inline(always)]
    pub(super) fn kind(self) -> usize {
        (self.0 >> 30) as usize
    }

    /// Place in the arena in units.
    #[inline(always)]
    pub(super) fn number(self) -> usize {
        self.0 as usize & (Self::NUMBERS - 1)
    }
}

/// What a reference refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    Leaf,
    Instance,
    Event,
}

/// Two cache lines. All bytes zero is a node without children.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(128))]
pub(super) struct Node {
    /// `planes[axis]`: the lower planes, then the upper ones. A plane is at origin + number * 2^exponent.
    pub(super) planes: [[u8; 2 * WIDTH]; 3],
    /// The lowest corner of all children; the fourth has, as its bytes, the three biased exponents and the number of
    /// children.
    pub(super) origin: [f32; 4],
    /// A bit for each child that is there, and for each that is a node.
    pub(super) present: u16,
    pub(super) inner: u16,
    /// What the first child's reference would be if it were a node.
    pub(super) first_inner: u32,
    /// What the first child's reference would be if it were no node.
    pub(super) first_leaf: u32,
    unused: u32,
}

const _: () = assert!(size_of::<Node>() == UNIT);

impl Node {
    /// A node of one to sixteen children with these boxes, of which the first `inner` are nodes, which lie in the arena
    /// from `place` on. The others are leaves or instances from `first_leaf` on.
    pub(super) fn new(
        children: &[Aabb],
        inner: usize,
        place: usize,
        first_leaf: Reference,
    ) -> Self {
        let first_leaf = first_leaf.0.wrapping_sub(inner as u32);
        let all = children.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let [x, y, z] = [0, 1, 2].map(|axis| exponent(all.min[axis], all.max[axis]));
        let last = f32::from_le_bytes([x, y, z, children.len() as u8]);
        let mut node = Self {
            origin: [all.min.x, all.min.y, all.min.z, last],
            present: first_bits(children.len()),
            inner: first_bits(inner),
            first_inner: Reference::new(Kind::Node, place).0,
            first_leaf,
            ..Self::zeroed()
        };
        for axis in 0..3 {
            let (origin, step) = (f64::from(node.origin[axis]), f64::from(node.step(axis)));
            for (i, child) in children.iter().enumerate() {
                // The quotient may be rounded to a plane on the wrong side; the plane itself is exact.
                let (min, max) = (f64::from(child.min[axis]), f64::from(child.max[axis]));
                let plane = |place: f64| origin + place * step;
                let lower = ((min - origin) / step).floor();
                let lower = if plane(lower) > min { lower - 1.0 } else { lower };
                let upper = ((max - origin) / step).ceil();
                let upper = if plane(upper) < max { upper + 1.0 } else { upper };
                node.planes[axis][i] = lower.clamp(0.0, 255.0) as u8;
                node.planes[axis][WIDTH + i] = upper.clamp(0.0, 255.0) as u8;
            }
        }
        node
    }

    /// Width of the grid's cells along an axis: a power of two.
    #[inline(always)]
    pub(super) fn step(&self, axis: usize) -> f32 {
        f32::from_bits(u32::from(self.origin[3].to_le_bytes()[axis]) << 23)
    }

    /// Where child `i` is.
    #[inline(always)]
    pub(super) fn child(&self, i: usize) -> Reference {
        Reference(match self.inner >> i & 1 {
            0 => self.first_leaf.wrapping_add(i as u32),
            _ => self.first_inner + i as u32,
        })
    }
}

/// The lowest `n` bits, at most sixteen.
fn first_bits(n: usize) -> u16 {
    ((1_u32 << n) - 1) as u16
}

/// The smallest biased exponent whose 254 steps span from `min` to `max`: one is left for rounding. Never so small that steps vanish beside the
/// coordinates, nor outside the normal numbers.
fn exponent(min: f32, max: f32) -> u8 {
    let extent = f64::from(max) - f64::from(min);
    let smallest = f64::from(min.abs().max(max.abs())) * 2.0_f64.powi(-28);
    let step = (extent / 254.0).max(smallest).max(f64::from(f32::MIN_POSITIVE));
    // Rounded up to a power of two: 2^(bits - 127).
    let rounded = (step.to_bits() + ((1 << 52) - 1)) >> 52;
    (rounded as i64 - 1023 + 127).clamp(1, 254) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::sampling::CounterRng;

    #[test]
    fn boxes_hold_what_they_were_made_of_and_little_more() {
        let mut rng = CounterRng::new(0);
        for round in 0..2000 {
            let scale = 10.0_f32.powf((round % 70) as f32 - 35.0);
            let n = 1 + round % WIDTH;
            let mut point = || Vec3::new(rng.unit() - 0.5, rng.unit(), 7.0 - rng.unit()) * scale;
            let boxes: Vec<_> = (0..n)
                .map(|i| {
                    let (p, q) = (point(), point());
                    // Some are flat along an axis, or a point.
                    let q = if i % 8 == 0 { Vec3::new(p.x, q.y, q.z) } else { q };
                    let q = if i % 16 == 1 { p } else { q };
                    Aabb { min: p.min(q), max: p.max(q) }
                })
                .collect();
            let node = Node::new(&boxes, n / 2, 100, Reference::new(Kind::Leaf, 300));
            assert_eq!(
                (node.present.count_ones(), node.inner.count_ones()),
                (n as u32, n as u32 / 2)
            );
            for (i, b) in boxes.iter().enumerate() {
                for axis in 0..3 {
                    let (origin, step) = (f64::from(node.origin[axis]), f64::from(node.step(axis)));
                    let plane =
                        |side: usize| origin + f64::from(node.planes[axis][side + i]) * step;
                    let (lower, upper) = (f64::from(b.min[axis]), f64::from(b.max[axis]));
                    assert!(
                        plane(0) <= lower && lower < plane(0) + 1.001 * step,
                        "{round} {i} {axis}"
                    );
                    assert!(plane(WIDTH) >= upper && upper > plane(WIDTH) - 1.001 * step);
                }
                let (kind, place) =
                    if i < n / 2 { (Kind::Node, 100 + i) } else { (Kind::Leaf, 300 + i - n / 2) };
                assert_eq!(node.child(i), Reference::new(kind, place));
            }
        }
    }
}
