//! The test for means: six standard errors, and proof that one percent would have been seen.
//!
//! False alarms: a correct mean of nearly normal samples leaves six standard errors with probability 2e-9. Of few
//! pairs the error itself is uncertain, so the limit is that quantile of Student's t (W. Gosset 1908). The binary makes
//! fewer than 250 such comparisons, so all of them together stay below 1e-6.

#![cfg(feature = "embree")]

use statrs::distribution::{ContinuousCDF, StudentsT};

/// How many standard errors a mean of `n` independent samples may be off.
pub(crate) fn limit(n: f64) -> f64 {
    let degrees = (n - 1.0).max(1.0);
    -StudentsT::new(0.0, 1.0, degrees).expect("a distribution").inverse_cdf(1e-9)
}

/// That few samples must leave more room, and many no less than a normal distribution does.
#[test]
fn the_limit_is_a_quantile() {
    let [few, many] = [24.0, 1e7].map(limit);
    assert!((9.4..9.6).contains(&few), "{few}");
    assert!((5.99..6.01).contains(&many), "{many}");
}

/// Rounding of `f32` arithmetic along a path, relative: no statistics can be finer.
const ROUNDING: f64 = 3e-5;

/// Asserts that the mean of independent, identically distributed `samples` is `truth`, and that the same
/// samples would have rejected a truth that is one percent off.
pub(crate) fn assert_mean(what: &str, samples: impl IntoIterator<Item = f64>, truth: f64) {
    assert_mean_power(what, samples, truth, 0.01);
}

/// As [`assert_mean`], where the error that must be seen is `power`, relative.
pub(crate) fn assert_mean_power(
    what: &str,
    samples: impl IntoIterator<Item = f64>,
    truth: f64,
    power: f64,
) {
    let samples: Vec<f64> = samples.into_iter().collect();
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    let variance = samples.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    let error = (variance / n).sqrt();
    let rejects = |truth: f64| (mean - truth).abs() > limit(n) * error + ROUNDING * truth.abs();
    assert!(!rejects(truth), "{what}: mean {mean} +- {error}, truth {truth}");
    // The mutated run: the same data against a truth that is off must fail.
    for off in [1.0 - power, 1.0 + power] {
        let wrong = truth * off;
        assert!(rejects(wrong), "{what}: {mean} +- {error} cannot tell {truth} from {wrong}");
    }
}

/// Asserts that two estimates of the same have the same mean, and that an error of `power`, relative, in one of them
/// would have been seen. `pairs` are independent of each other; the two of a pair need not be.
pub(crate) fn assert_difference(what: &str, pairs: &[[f64; 2]], power: f64) {
    let n = pairs.len() as f64;
    let mean = pairs.iter().map(|pair| pair[1]).sum::<f64>() / n;
    let test = |factor: f64| {
        let differences = || pairs.iter().map(|[a, b]| a * factor - b);
        let difference = differences().sum::<f64>() / n;
        let squares = differences().map(|d| (d - difference).powi(2)).sum::<f64>();
        let error = (squares / (n - 1.0) / n).sqrt();
        (difference, error, difference.abs() > limit(n) * error + ROUNDING * mean.abs())
    };
    let (difference, error, rejects) = test(1.0);
    assert!(!rejects, "{what}: {mean}, and {difference} +- {error} more");
    let is_told = test(1.0 + power).2 && test(1.0 - power).2;
    assert!(is_told, "{what}: {mean}, and {difference} +- {error} more: {power} could not be told");
}
