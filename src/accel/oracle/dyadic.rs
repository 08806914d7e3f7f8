//! Numbers m 2^e with integers m of any length: sums, differences and products of floats without rounding.
//!
//! Whole numbers rather than floating-point expansions (Shewchuk 1997), for their range: two distances along a
//! ray are compared by products of degree six, and with the corners of instances (2^-298 to 2^258) those lie
//! between 2^-1639 and 2^1418, where an `f64` has long under- or overflown. Whole numbers have no such ends, and
//! neither need exact products of two `f64`. They are slow (about a microsecond for a determinant), which the
//! filter of `crossing` hides. Knows no geometry.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// The number `limbs * 2^exponent`, negative or not.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    negative: bool,
    /// Least significant first; the last is not 0. Zero has none.
    limbs: Vec<u64>,
    exponent: i32,
}

impl Dyadic {
    /// A finite number.
    pub(super) fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let (biased, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
        // Subnormal numbers have the exponent of the smallest normal ones, and no leading 1.
        let (mantissa, exponent) = match biased {
            0 => (fraction, -1074),
            _ => (fraction | 1 << 52, biased - 1075),
        };
        let zeros = mantissa.trailing_zeros() % 64;
        let limbs = if mantissa == 0 { Vec::new() } else { vec![mantissa >> zeros] };
        Self { negative: x < 0.0, limbs, exponent: exponent + zeros as i32 }
    }

    /// Less, equal to or greater than 0.
    pub(super) fn sign(&self) -> Ordering {
        match (self.limbs.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    /// Two numbers around `self / divisor`, at most 2^-48 of it apart, or around what is too large or too small
    /// for that. `divisor` is not 0.
    pub(super) fn ratio_bounds(&self, divisor: &Self) -> [f64; 2] {
        if self.limbs.is_empty() {
            return [0.0; 2];
        }
        let ((n, n_exponent), (d, d_exponent)) = (self.leading(), divisor.leading());
        // Each leading part is off by less than 2^-63 of itself, each conversion and the division by 2^-53 at most.
        let quotient = n as f64 / d as f64;
        let (low, high) = (quotient * (1.0 - SLACK), quotient * (1.0 + SLACK));
        let bounds = match n_exponent - d_exponent {
            ..-1000 => [0.0, power_of_two(-990)],
            1001.. => [power_of_two(990), f64::INFINITY],
            exponent => [low, high].map(|x| x * power_of_two(exponent)),
        };
        let [low, high] = bounds;
        if self.negative == divisor.negative { bounds } else { [-high, -low] }
    }

    /// The first 64 bits, of which the highest is 1, and the exponent of the last of them.
    fn leading(&self) -> (u64, i32) {
        let n = self.limbs.len();
        let (top, next) = (self.limbs[n - 1], if n > 1 { self.limbs[n - 2] } else { 0 });
        let shift = top.leading_zeros();
        let window = u128::from(top) << 64 | u128::from(next);
        ((window << shift >> 64) as u64, self.exponent + 64 * (n as i32 - 1) - shift as i32)
    }

    /// The limbs of the same number with a smaller exponent.
    fn limbs_at(&self, exponent: i32) -> Vec<u64> {
        let shift = (self.exponent - exponent) as usize;
        let (whole, bits) = (shift / 64, shift % 64);
        let mut limbs = vec![0; whole];
        let mut carry = 0;
        for &limb in &self.limbs {
            let wide = u128::from(limb) << bits | u128::from(carry);
            limbs.push(wide as u64);
            carry = (wide >> 64) as u64;
        }
        limbs.push(carry);
        trim(&mut limbs);
        limbs
    }

    /// `self + other`, or `self - other`.
    fn combine(&self, other: &Self, subtract: bool) -> Self {
        let other_negative = other.negative != subtract;
        if other.limbs.is_empty() {
            return self.clone();
        } else if self.limbs.is_empty() {
            return Self { negative: other_negative, ..other.clone() };
        }
        let exponent = self.exponent.min(other.exponent);
        let (a, b) = (self.limbs_at(exponent), other.limbs_at(exponent));
        if self.negative == other_negative {
            return Self { negative: self.negative, limbs: sum(&a, &b), exponent };
        }
        // The sign is that of the larger one.
        match compare(&a, &b) {
            Ordering::Less => {
                Self { negative: other_negative, limbs: difference(&b, &a), exponent }
            }
            _ => Self { negative: self.negative, limbs: difference(&a, &b), exponent },
        }
    }
}

/// More than the relative errors of [`Dyadic::ratio_bounds`].
const SLACK: f64 = 1.0 / (1_u64 << 50) as f64;

/// 2^exponent, for a normal number.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

impl Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: Self) -> Dyadic {
        self.combine(other, false)
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: Self) -> Dyadic {
        self.combine(other, true)
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: Self) -> Dyadic {
        let mut limbs = vec![0_u64; self.limbs.len() + other.limbs.len()];
        for (i, &x) in self.limbs.iter().enumerate() {
            let mut carry = 0_u64;
            for (j, &y) in other.limbs.iter().enumerate() {
                // At most (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1.
                let wide =
                    u128::from(x) * u128::from(y) + u128::from(limbs[i + j]) + u128::from(carry);
                limbs[i + j] = wide as u64;
                carry = (wide >> 64) as u64;
            }
            limbs[i + other.limbs.len()] = carry;
        }
        trim(&mut limbs);
        let negative = self.negative != other.negative;
        Dyadic { negative, limbs, exponent: self.exponent + other.exponent }
    }
}

impl Neg for Dyadic {
    type Output = Self;
    fn neg(self) -> Self {
        Self { negative: !self.negative, ..self }
    }
}

fn trim(limbs: &mut Vec<u64>) {
    while limbs.last() == Some(&0) {
        limbs.pop();
    }
}

fn compare(a: &[u64], b: &[u64]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn sum(a: &[u64], b: &[u64]) -> Vec<u64> {
    let (long, short) = if a.len() < b.len() { (b, a) } else { (a, b) };
    let mut limbs = Vec::with_capacity(long.len() + 1);
    let mut carry = false;
    for (i, &x) in long.iter().enumerate() {
        let (partial, first) = x.overflowing_add(short.get(i).copied().unwrap_or(0));
        let (limb, second) = partial.overflowing_add(u64::from(carry));
        limbs.push(limb);
        carry = first | second;
    }
    limbs.push(u64::from(carry));
    trim(&mut limbs);
    limbs
}

/// `a - b`, where `a` is not smaller.
fn difference(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut limbs = Vec::with_capacity(a.len());
    let mut borrow = false;
    for (i, &x) in a.iter().enumerate() {
        let (partial, first) = x.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (limb, second) = partial.overflowing_sub(u64::from(borrow));
        limbs.push(limb);
        borrow = first | second;
    }
    trim(&mut limbs);
    limbs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;
    use num_rational::BigRational;
    use rand::Rng;

    /// Numbers of every kind: tiny integers, neighbours, all magnitudes of an `f64`, subnormal ones.
    fn number(rng: &mut CounterRng) -> f64 {
        let mut bits = || rng.next_u64();
        let sign = if bits() % 2 == 0 { 1.0 } else { -1.0 };
        sign * match bits() % 5 {
            0 => (bits() % 4) as f64,
            1 => 1.0 + (bits() % 3) as f64 * f64::EPSILON,
            2 => f64::from_bits(bits() % 7),
            3 => f64::from(f32::from_bits(bits() as u32 & 0x7f7f_ffff)),
            _ => f64::from_bits(bits() % f64::MAX.to_bits()),
        }
    }

    fn rational(x: &Dyadic) -> BigRational {
        let mut value = BigRational::from_integer(0.into());
        let two = BigRational::from_integer(2.into());
        for &limb in x.limbs.iter().rev() {
            value = value * two.pow(64) + BigRational::from_integer(limb.into());
        }
        let value = value * two.pow(x.exponent);
        if x.negative { -value } else { value }
    }

    fn exactly(x: f64) -> BigRational {
        BigRational::from_float(x).unwrap()
    }

    #[test]
    fn sums_and_products_are_those_of_rationals() {
        let mut rng = CounterRng::new(0);
        let zero = exactly(0.0);
        let mut signs = [0; 3];
        for _ in 0..1000 {
            let [a, b, c, d] = std::array::from_fn(|_| number(&mut rng));
            let [p, q, r, s] = [a, b, c, d].map(Dyadic::new);
            assert_eq!(rational(&p), exactly(a));
            let value = &(&(&p * &q) - &(&r * &s)) + &p;
            let [x, y, z, w] = [a, b, c, d].map(exactly);
            let truth = &x * &y - &z * &w + &x;
            assert_eq!(rational(&value), truth, "{a:e} {b:e} {c:e} {d:e}");
            assert_eq!(value.sign(), truth.cmp(&zero));
            assert_eq!((-value.clone()).sign(), zero.cmp(&truth));
            signs[(value.sign() as i8 + 1) as usize] += 1;
            assert_eq!((&value - &value).sign(), Ordering::Equal);
            if r.sign().is_ne() {
                let [low, high] = value.ratio_bounds(&r);
                let ratio = &truth / &z;
                assert!(low == f64::NEG_INFINITY || exactly(low) <= ratio);
                assert!(high == f64::INFINITY || ratio <= exactly(high));
                let magnitude = low.abs();
                if 1e-290 < magnitude && magnitude < 1e290 {
                    assert!(high - low <= 1e-14 * magnitude);
                }
            }
        }
        assert!(signs.iter().all(|&n| n > 20), "{signs:?}");
    }
}
