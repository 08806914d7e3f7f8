//! An even density as its quantiles: inverted by one look-up, without search or branch.
//!
//! Between neighbouring quantiles the density is constant. They are taken at shares of probability that grow
//! by a constant factor from the ends to the middle, like floating-point numbers, because smooth filters have
//! long and thin ends. A search per cell of position ([`crate::sampling::PiecewiseConstant1d`]) takes 40 to 90 ns
//! a camera ray, and cannot be vectorised: every camera ray inverts two tables.

/// Quantiles an octave of probability, as a power of two.
const BITS: u32 = 6;
/// Bits of a mantissa below those that count quantiles.
const LOW_BITS: u32 = f32::MANTISSA_DIGITS - 1 - BITS;
/// Added to every probability, so that 0 is one end of the first interval and needs no case of its own.
const START: f32 = 1.0 / 8192.0;
const FIRST: u32 = START.to_bits() >> LOW_BITS;

/// Length of a table: one interval past the middle, whose probability may round up.
pub(super) const QUANTILES: usize = ((0.5_f32.to_bits() >> LOW_BITS) - FIRST) as usize + 2;

/// Positions in [0, 1] of the quantiles of `values`, an even density over equal cells of [0, 1). Uniform where
/// the values sum to zero.
pub(super) fn quantiles(values: &[f64]) -> [f32; QUANTILES] {
    let cells = values.len() as f64;
    let total: f64 = values.iter().sum();
    let probability = |v: f64| if total > 0.0 { v / total } else { 1.0 / cells };
    let wanted = |k: usize| f64::from(f32::from_bits((FIRST + k as u32) << LOW_BITS) - START);
    let mut quantiles = [1.0; QUANTILES];
    let mut next = 0;
    // Walk along the cumulative distribution; it is linear in each cell.
    let mut start = 0.0;
    for (cell, &value) in values.iter().enumerate() {
        let end = start + probability(value);
        while next < QUANTILES && wanted(next) <= end && end > start {
            let within = (wanted(next) - start) / (end - start);
            quantiles[next] = ((cell as f64 + within) / cells) as f32;
            next += 1;
        }
        start = end;
    }
    quantiles
}

/// A place between two quantiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Index of the lower quantile.
    pub(super) index: u32,
    /// How far from it to the next, in [0, 1).
    within: f32,
    /// Whether the other half of the density is meant.
    mirrored: bool,
}

impl Place {
    /// Where probability `u`, in [0, 1] but for rounding, is looked up.
    #[inline(always)]
    pub(super) fn of(u: f32) -> Self {
        let mirrored = u > 0.5;
        let share = START + if mirrored { (1.0 - u).max(0.0) } else { u };
        let bits = share.to_bits();
        let low = f32::from_bits(bits >> LOW_BITS << LOW_BITS);
        // The reciprocal of the interval's length, 2^(exponent - BITS).
        let scale = f32::from_bits((254 + BITS - (bits >> 23)) << 23);
        Self { index: (bits >> LOW_BITS) - FIRST, within: (share - low) * scale, mirrored }
    }

    /// The position in [-1, 1] between the quantiles at `index` and the next.
    #[inline(always)]
    pub(super) fn position(&self, low: f32, high: f32) -> f32 {
        let position = 2.0 * (low + (high - low) * self.within) - 1.0;
        if self.mirrored { -position } else { position }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::PiecewiseConstant1d;

    /// Against bisection, for even densities with gaps, peaks, long ends and nothing at all.
    #[test]
    fn agree_with_bisection() {
        const CELLS: usize = 1024;
        let from_end = |i: usize| i.min(CELLS - 1 - i);
        let peak = |i: usize| if from_end(i) == 400 { 1e6 } else { 1e-3 };
        let gaps = |i: usize| if (from_end(i) / 100).is_multiple_of(2) { i as f64 } else { 0.0 };
        let ends = |i: usize| (from_end(i) as f64 + 0.5).powi(6);
        let even =
            |f: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..CELLS).map(|i| f(from_end(i))).collect() };
        for values in [even(&|_| 0.0), even(&peak), even(&gaps), even(&ends)] {
            let table = quantiles(&values);
            let bisection = PiecewiseConstant1d::new(values.iter().copied());
            for i in 0..100_000 {
                let u = (i as f32 + 0.5) / 100_000.0;
                let place = Place::of(u);
                let [low, high] = [0, 1].map(|k| table[place.index as usize + k]);
                assert!(place.position(low, high).abs() <= 1.0);
                let expected = 2.0 * bisection.sample(u).0 - 1.0;
                // It is within the interval, which is turned over in the second half.
                let sign = if u > 0.5 { -1.0 } else { 1.0 };
                let bounds = [low, high].map(|q| 2.0 * q - 1.0);
                let inside = sign * expected;
                assert!(bounds[0] <= inside + 1e-5 && inside <= bounds[1] + 1e-5, "at {u}");
            }
        }
    }

    #[test]
    fn the_ends_are_safe() {
        for u in
            [0.0, f32::MIN_POSITIVE, 0.5, 0.500_000_06, 1.0 - f32::EPSILON / 2.0, 1.0, 1.000_01]
        {
            let place = Place::of(u);
            assert!((place.index as usize) < QUANTILES - 1, "{u}");
            assert!((0.0..=1.0).contains(&place.within), "{u}");
        }
    }
}
