//! The Halton sequence in bases 2 and 3: as it is, and randomised for the paths of a render.
//!
//! Source: J. H. Halton, "On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional
//! integrals", Numerische Mathematik 2, 1960; nested (Owen) scrambling: A. B. Owen, "Randomly Permuted (t,m,s)-Nets and
//! (t,s)-Sequences", 1995, which holds for any base.

use super::fraction::Fraction;
use super::sobol::scramble_reversed;
use crate::sampling::hash::combine;

/// Digits of base 3 that a fraction has room for, and 3 to that power.
const DIGITS: u32 = 20;
const RANGE: u64 = 3_u64.pow(DIGITS);

/// How many points [`shuffled`] puts into an order: 6^12.
pub(in crate::sampling) const LENGTH: u64 = 6_u64.pow(12);

/// Point `i` of the sequence, i from 0.
pub(super) fn point(i: u32) -> [Fraction; 2] {
    [i.reverse_bits(), inverse_of_3(i, |digit| digit)]
}

/// Point `i < `[`LENGTH`] of a randomised sequence: nested scrambles of both coordinates, and a nested shuffle of the order,
/// under which aligned blocks of 6^k points stay together, so that sequences with different seeds can be padded.
pub(in crate::sampling) fn scrambled(i: u32, seed: u64) -> [Fraction; 2] {
    let i = shuffled(i, combine(seed, 0));
    let x = scramble_reversed(i, seed as u32).reverse_bits();
    let mut digits_so_far = combine(seed, 1);
    let y = inverse_of_3(i, |digit| {
        let permuted = PERMUTATIONS_OF_3[(digits_so_far >> 32) as usize % 6][digit as usize];
        digits_so_far = combine(digits_so_far, u64::from(digit));
        permuted
    });
    [x, y]
}

/// The radical inverse of `i` in base 3, its digits replaced from the lowest on, which counts most.
fn inverse_of_3(mut i: u32, mut replaced: impl FnMut(u32) -> u32) -> Fraction {
    let mut inverse = 0;
    for _ in 0..DIGITS {
        inverse = inverse * 3 + u64::from(replaced(i % 3));
        i /= 3;
    }
    // Upwards: not below the bound of the box that the digits name.
    (inverse << 32).div_ceil(RANGE) as u32
}

/// Nested shuffle of the order in digits of base 6: each is permuted in a way that the digits above it choose.
fn shuffled(i: u32, seed: u64) -> u32 {
    let mut rest = u64::from(i);
    let mut unit = LENGTH / 6;
    let mut digits_so_far = seed;
    let mut result = 0;
    while unit > 0 {
        let digit = rest / unit;
        rest %= unit;
        // A permutation of six as one of its halves and one of its thirds.
        let hash = digits_so_far >> 32;
        let half = (digit % 2) ^ hash & 1;
        let third = PERMUTATIONS_OF_3[(hash >> 1) as usize % 6][(digit / 2) as usize];
        result += unit * (2 * u64::from(third) + half);
        digits_so_far = combine(digits_so_far, digit);
        unit /= 6;
    }
    result as u32
}

const PERMUTATIONS_OF_3: [[u32; 3]; 6] =
    [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::strategy::fraction::to_f64;

    #[test]
    fn the_first_points_are_those_of_the_definition() {
        let expected = [
            [0.0, 0.0],
            [1.0 / 2.0, 1.0 / 3.0],
            [1.0 / 4.0, 2.0 / 3.0],
            [3.0 / 4.0, 1.0 / 9.0],
            [1.0 / 8.0, 4.0 / 9.0],
            [5.0 / 8.0, 7.0 / 9.0],
        ];
        for (i, expected) in (0..).zip(expected) {
            for (a, b) in point(i).map(to_f64).into_iter().zip(expected) {
                assert!((a - b).abs() < 1e-9, "point {i}: {a} instead of {b}");
            }
        }
    }

    /// Every aligned block of 6^k points has one in each box of 2^-k by 3^-k, whatever the seed.
    #[test]
    fn aligned_blocks_fill_their_boxes() {
        for seed in 0..8 {
            for k in 1..=4_u32 {
                let (columns, rows) = (2_u64.pow(k), 3_u64.pow(k));
                for block in 0..3 {
                    let mut seen = vec![false; (columns * rows) as usize];
                    for i in 0..6_u32.pow(k) {
                        let [x, y] = scrambled(block * 6_u32.pow(k) + i, combine(7, seed));
                        let column = (u64::from(x) * columns) >> 32;
                        let row = (u64::from(y) * rows) >> 32;
                        let cell = (column * rows + row) as usize;
                        assert!(!seen[cell], "seed {seed}, block {block} of 6^{k}");
                        seen[cell] = true;
                    }
                }
            }
        }
    }
}
