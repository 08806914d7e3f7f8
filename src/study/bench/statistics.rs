//! What can be said from a few noisy repetitions: medians, and an interval for the median of ratios.
//!
//! The interval is between order statistics (see any text on nonparametric statistics, "confidence interval
//! for the median"): it assumes nothing of the noise but that repetitions are independent.

use serde::Serialize;

/// Where repeated measurements lie.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Spread {
    /// Half of them are below.
    pub median: f64,
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
}

/// A ratio of two contestants' speeds, from repetitions in which they took turns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Ratio {
    /// Of the ratios within each repetition.
    pub median: f64,
    /// Lower end of the interval that holds the true median in 95 of 100 benches, or of all ratios where
    /// there are fewer than six.
    pub low: f64,
    /// Upper end of it.
    pub high: f64,
    /// Whether the interval holds 1: the difference is inside the noise.
    pub tie: bool,
}

impl Spread {
    /// Of some values; none where there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let sorted = sorted(values);
        Some(Self { median: median(&sorted)?, min: *sorted.first()?, max: *sorted.last()? })
    }
}

impl Ratio {
    /// Of the values of two contestants in the same repetitions, `a` over `b`; none where there are none.
    pub fn of(a: &[f64], b: &[f64]) -> Option<Self> {
        let ratios: Vec<_> = a.iter().zip(b).map(|(a, b)| a / b).collect();
        let sorted = sorted(&ratios);
        let median = median(&sorted)?;
        let skipped = outside(sorted.len());
        let (low, high) = (sorted[skipped], sorted[sorted.len() - 1 - skipped]);
        Some(Self { median, low, high, tie: low <= 1.0 && 1.0 <= high })
    }
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

fn median(sorted: &[f64]) -> Option<f64> {
    let n = sorted.len();
    let below = sorted.get(n.checked_sub(1)? / 2)?;
    Some(0.5 * (below + sorted[n / 2]))
}

/// How many of `n` values may be left out at either end for an interval that still holds the median with
/// 95 %: the median is beyond the k-th smallest when fewer than k of n fair coins show heads.
fn outside(n: usize) -> usize {
    let (mut chance, mut below, mut skipped) = (0.5_f64.powi(n as i32), 0.0, 0);
    // `chance` is that of exactly `skipped` heads, `below` that of at most so many.
    loop {
        below += chance;
        if 2.0 * below > 0.05 {
            break;
        }
        chance *= (n - skipped) as f64 / (skipped + 1) as f64;
        skipped += 1;
    }
    skipped.saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        let spread = Spread::of(&[3.0, 1.0, 2.0, 9.0]).unwrap();
        assert_eq!((spread.median, spread.min, spread.max), (2.5, 1.0, 9.0));
        assert_eq!(Spread::of(&[7.0]).unwrap().median, 7.0);
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Ratio::of(&[], &[]), None);
    }

    #[test]
    fn intervals_are_those_of_the_tables() {
        // The largest numbers of values to leave out at each end, from tables of the sign test.
        let known = [(1, 0), (5, 0), (6, 0), (8, 0), (9, 1), (11, 1), (12, 2), (20, 5), (50, 17)];
        for (n, skipped) in known {
            assert_eq!(outside(n), skipped, "{n}");
        }
    }

    #[test]
    fn what_the_noise_hides_is_a_tie() {
        // The machine slows down by half on the way: both do, so the ratio stays.
        let drift = |i: i32| 10.0 - 0.5 * f64::from(i);
        let a: Vec<_> = (0..10).map(|i| 1.10 * drift(i)).collect();
        let b: Vec<_> = (0..10).map(drift).collect();
        let ratio = Ratio::of(&a, &b).unwrap();
        assert!((ratio.median - 1.10).abs() < 1e-9 && !ratio.tie, "{ratio:?}");
        // One repetition of ten the other way round changes nothing, four do.
        for (wrong, tie) in [(1, false), (4, true)] {
            let mut a = a.clone();
            a[..wrong].iter_mut().for_each(|speed| *speed *= 0.8);
            assert_eq!(Ratio::of(&a, &b).unwrap().tie, tie, "{wrong}");
        }
        assert!(Ratio::of(&b, &b).unwrap().tie);
        // Slower is no tie either.
        assert!(!Ratio::of(&b, &a).unwrap().tie);
    }
}
