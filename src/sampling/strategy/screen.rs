//! Sobol samples shared out among pixels so that the error on the screen is blue noise: an error that the eye, or a blur,
//! averages away.
//!
//! Source: A. G. M. Ahmed and P. Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
//! Hierarchical Ordering of Pixels", ACM TOG 39(6), 2020: pixels are put in the order of a Z curve whose four
//! branches are shuffled at every node, and take their samples from one sequence one after the other; so
//! any 2^k by 2^k of them have a well-spread set together.

use super::Fraction;
use super::sobol::{pascal_reversed, scramble_reversed};
use crate::sampling::hash::{combine, mix32};

/// Bits of pixel numbers: images are at most 65536 pixels wide and high.
const PIXEL_BITS: u32 = 32;

/// The place of a pixel on the Z curve.
#[inline]
pub(in crate::sampling) const fn z_order(x: u32, y: u32) -> u32 {
    spread(x) | spread(y) << 1
}

/// Bit i of the lower half moved to bit 2 i.
#[inline]
const fn spread(x: u32) -> u32 {
    let x = x & 0xffff;
    let x = (x | x << 8) & 0x00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

/// Sample `i < 2^bits` of the pixel at `place` on the Z curve. `seed` has the dimension in it, and not the pixel.
#[inline]
pub(in crate::sampling) fn point(place: u32, i: u32, bits: u32, seed: u64) -> [Fraction; 2] {
    let place = shuffled(place, seed);
    // Within a pixel the order is shuffled as well, as a nested scramble of its bits.
    let order = mix32(place ^ seed as u32);
    let i = if bits == 0 {
        0
    } else {
        scramble_reversed(i.reverse_bits(), order).reverse_bits() & (u32::MAX >> (32 - bits))
    };
    // The largest images leave no room for the pixel's first digits: then far parts of them share their samples.
    let index = (u64::from(place) << bits) as u32 | i;
    let [seed_x, seed_y] = [0, 1].map(|axis| (combine(seed, axis) >> 32) as u32);
    let x = scramble_reversed(index, seed_x).reverse_bits();
    let y = scramble_reversed(pascal_reversed(index), seed_y).reverse_bits();
    [x, y]
}

/// The digits of base 4 of a place, each permuted as those before it choose.
#[inline]
fn shuffled(place: u32, seed: u64) -> u32 {
    let mut result = 0;
    for digit in (0..PIXEL_BITS / 2).rev() {
        let shift = 2 * digit;
        // What is above this digit, and how far up it is.
        let above = (u64::from(place) >> (shift + 2)) << 5 | u64::from(digit);
        let hash = combine(seed, above) >> 32;
        result |= permuted(place >> shift & 3, hash as u32) << shift;
    }
    result
}

/// `digit` under one of the 24 permutations of 0..4: a bijection v -> (a v + b), then two of the four values exchanged or not.
#[inline]
fn permuted(digit: u32, hash: u32) -> u32 {
    // One of three pairings of the four values, of which exclusive or and an exchange within make eight each.
    let rotated = match (digit, (hash >> 8) % 3) {
        (0, _) => 0,
        (d, turn) => (d - 1 + turn) % 3 + 1,
    };
    let exchanged = if hash & 4 != 0 && rotated & 2 != 0 { rotated ^ 1 } else { rotated };
    exchanged ^ (hash & 3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_z_curve_visits_every_pixel_once() {
        let places: BTreeSet<_> = (0..64).map(|i| z_order(i % 8, i / 8)).collect();
        assert_eq!(places.into_iter().collect::<Vec<_>>(), (0..64).collect::<Vec<_>>());
        assert_eq!(z_order(65_535, 65_535), u32::MAX);
    }

    #[test]
    fn digits_have_all_24_permutations_alike() {
        let mut counts = std::collections::BTreeMap::new();
        for low in 0..8 {
            for turn in 0..3 {
                let images: Vec<_> = (0..4).map(|d| permuted(d, turn << 8 | low)).collect();
                *counts.entry(images).or_insert(0) += 1;
            }
        }
        assert_eq!(counts.len(), 24);
    }

    /// Every aligned square of 2^k by 2^k pixels has a (0,2)-net together: one point in each elementary interval.
    #[test]
    fn squares_of_pixels_have_nets() {
        for seed in 0..4 {
            let seed = combine(9, seed);
            for (k, bits) in [(0, 4), (1, 3), (2, 2), (3, 0)] {
                let side = 1 << k;
                let mut points = Vec::new();
                for pixel in 0..side * side {
                    let (x, y) = (5 * side + pixel % side, 3 * side + pixel / side);
                    points.extend((0..1 << bits).map(|i| point(z_order(x, y), i, bits, seed)));
                }
                let m = 2 * k + bits;
                for a in 0..=m {
                    let cell = |p: &[u32; 2]| {
                        (u64::from(p[0]) >> (32 - a)) << (m - a) | u64::from(p[1]) >> (32 - (m - a))
                    };
                    let cells: BTreeSet<_> = points.iter().map(cell).collect();
                    assert_eq!(cells.len(), 1 << m, "seed {seed}, k {k}, {bits} bits, a {a}");
                }
            }
        }
    }
}
