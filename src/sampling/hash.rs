//! Integer mixers: the source of every random bit.
//!
//! Source: `mix64` is the finaliser of SplitMix64 with Stafford's constants (mix 13); `mix32` is
//! lowbias32 by C. Wellons.

/// A bijection of 64-bit integers in which every output bit depends on every input bit.
#[inline(always)]
pub const fn mix64(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A bijection of 32-bit integers with low bias.
#[inline(always)]
pub const fn mix32(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Folds `value` into a running hash.
#[inline(always)]
pub const fn combine(hash: u64, value: u64) -> u64 {
    mix64(hash ^ value.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x9e37_79b9_7f4a_7c15))
}

/// The upper 24 bits as a number in [0, 1).
#[inline(always)]
pub const fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}
