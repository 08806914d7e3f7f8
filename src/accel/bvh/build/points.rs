//! What fits into a leaf: so many primitives, over so many points, which neighbours may share.
//!
//! The builder asks only for sets of points; what they are, it does not know.

use super::sweep::MOST;
use crate::math::Vec3;

/// How much a leaf has room for.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Room {
    /// A power of two up to 8.
    pub(in super::super) primitives: usize,
    /// Enough for any one primitive.
    pub(in super::super) points: usize,
}

/// What leaves are made of.
pub(in super::super) trait Leaves: Sync {
    /// How much one has room for.
    fn room(&self) -> Room;

    /// For each of these primitives the set of its points, a bit for each that any of them has.
    fn points(&self, primitives: &[u32]) -> [u64; MOST];
}

/// Leaves that have room for so many primitives, whatever they are.
pub(in super::super) struct Anything(pub(in super::super) usize);

impl Leaves for Anything {
    fn room(&self) -> Room {
        Room { primitives: self.0, points: self.0 }
    }

    fn points(&self, _: &[u32]) -> [u64; MOST] {
        std::array::from_fn(|i| 1 << i)
    }
}

/// Leaves of triangles, whose corners are the points: the same ones have the same bits.
pub(in super::super) struct Triangles<F> {
    pub(in super::super) room: Room,
    /// The corners of a triangle.
    pub(in super::super) corners: F,
}

impl<F: Fn(u32) -> [Vec3; 3] + Sync> Leaves for Triangles<F> {
    fn room(&self) -> Room {
        self.room
    }

    fn points(&self, primitives: &[u32]) -> [u64; MOST] {
        // A hash table with room to spare: there are at most 48 points.
        const SLOTS: usize = 128;
        let mut number_of = [u8::MAX; SLOTS];
        let mut known = [[0_u32; 3]; 64];
        let mut count = 0;
        let mut sets = [0; MOST];
        for (set, &primitive) in sets.iter_mut().zip(primitives) {
            for corner in (self.corners)(primitive) {
                let bits = corner.to_array().map(f32::to_bits);
                let [x, y, z] = bits.map(u64::from);
                // Multiplied by odd numbers near the golden ratio's fractions of 2^64, whose upper bits mix well.
                let mixed = (x ^ z << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15)
                    ^ y.wrapping_mul(0xd1b5_4a32_d192_ed03);
                let mut slot = (mixed >> 57) as usize;
                let number = loop {
                    let number = number_of[slot % SLOTS];
                    if number == u8::MAX {
                        number_of[slot % SLOTS] = count;
                        known[usize::from(count) % 64] = bits;
                        count += 1;
                        break count - 1;
                    }
                    if known[usize::from(number) % 64] == bits {
                        break number;
                    }
                    slot += 1;
                };
                *set |= 1 << (number % 64);
            }
        }
        sets
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    /// How many points two triangles share, and how many there are, as counted one by one.
    #[test]
    fn triangles_share_the_points_that_they_share() {
        let mut rng = CounterRng::new(0);
        for round in 0..500 {
            // From soups to fans, with degenerate ones among them.
            let points: Vec<_> = (0..3 + round % 60)
                .map(|_| Vec3::new(rng.unit(), (rng.unit() * 4.0).floor(), -rng.unit()))
                .collect();
            let mut pick = || points[(rng.unit() * points.len() as f32) as usize % points.len()];
            let corners: Vec<_> = (0..MOST).map(|_| [(); 3].map(|()| pick())).collect();
            let room = Room { primitives: 8, points: 9 };
            let leaves = Triangles { room, corners: |i: u32| corners[i as usize] };
            let ids: Vec<_> = (0..1 + (round % MOST) as u32).collect();
            let sets = leaves.points(&ids);
            let distinct = |some: &[Vec3]| {
                (0..some.len()).filter(|&i| !some[..i].contains(&some[i])).count() as u32
            };
            for &i in &ids {
                for &j in &ids {
                    let union = (sets[i as usize] | sets[j as usize]).count_ones();
                    let both = [corners[i as usize], corners[j as usize]].concat();
                    assert_eq!(union, distinct(&both), "{round}");
                }
            }
            let all = sets[..ids.len()].iter().fold(0, |all, set| all | set);
            assert_eq!(all.count_ones(), distinct(&corners[..ids.len()].concat()), "{round}");
        }
    }
}
