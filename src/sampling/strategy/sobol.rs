//! The first two Sobol dimensions with Owen scrambling, by bit operations only.
//!
//! Source: B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020 (nested uniform
//! scrambling by hashing the reversed bits, after Laine and Karras 2011; constants by N. Vegdahl,
//! 2021). The second Sobol dimension's matrix is Pascal's triangle modulo 2, which is a Kronecker
//! power of a 2 x 2 matrix and so factors into five shifts.

/// Hash in which bit i of the result depends only on bits 0..=i of `x`: a nested uniform (Owen)
/// scramble of the bit-reversed value.
#[inline(always)]
pub(in crate::sampling) const fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second Sobol dimension of `index`, with its bits reversed.
#[inline(always)]
pub(super) const fn pascal_reversed(mut x: u32) -> u32 {
    x ^= (x & 0xaaaa_aaaa) >> 1;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^ ((x & 0xffff_0000) >> 16)
}

/// Point `index` of an Owen-scrambled (0,2)-sequence in base 2, as 32-bit fractions; the order of the
/// points is Owen-shuffled too, so that sequences with different seeds can be padded together.
#[inline(always)]
pub(in crate::sampling) const fn owen_sobol_2d(index: u32, seed: u64) -> [u32; 2] {
    let seed_order = seed as u32;
    let seed_x = (seed >> 32) as u32;
    let seed_y = crate::sampling::hash::mix32(seed_order ^ seed_x.rotate_left(13) ^ 0x68bc_21eb);
    // Owen-shuffle the order: scramble the index as if it were a digit expansion.
    let index = scramble_reversed(index.reverse_bits(), seed_order).reverse_bits();
    // Dimension 0 is van der Corput: its reversed bits are the index itself.
    let x = scramble_reversed(index, seed_x).reverse_bits();
    let y = scramble_reversed(pascal_reversed(index), seed_y).reverse_bits();
    [x, y]
}

/// As [`owen_sobol_2d`], the first coordinate alone.
#[inline(always)]
pub(in crate::sampling) const fn owen_sobol_1d(index: u32, seed: u64) -> u32 {
    let index = scramble_reversed(index.reverse_bits(), seed as u32).reverse_bits();
    scramble_reversed(index, (seed >> 32) as u32).reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every aligned block of 2^m points hits every elementary interval of area 2^-m exactly once.
    #[test]
    fn every_aligned_block_is_a_0_2_net() {
        for seed in 0..16_u64 {
            let seed = crate::sampling::hash::mix64(seed);
            for m in 0..=10_u32 {
                for block in 0..4_u32 {
                    let points: Vec<_> =
                        (0..1 << m).map(|i| owen_sobol_2d((block << m) + i, seed)).collect();
                    for x_bits in 0..=m {
                        let y_bits = m - x_bits;
                        let mut seen = vec![false; 1 << m];
                        for &[x, y] in &points {
                            let column = (u64::from(x) >> (32 - x_bits)) as usize;
                            let row = (u64::from(y) >> (32 - y_bits)) as usize;
                            let cell = column << y_bits | row;
                            assert!(!seen[cell], "seed {seed} m {m} block {block}");
                            seen[cell] = true;
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn one_is_the_first_of_two() {
        for i in 0..100 {
            assert_eq!(owen_sobol_1d(i, 77), owen_sobol_2d(i, 77)[0]);
        }
    }
}
