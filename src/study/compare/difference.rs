//! Errors of numbers. Slices hold the channels of all pixels, one after the other, as many in both.

use crate::math::fun::double::ln;

/// Mean of the values; 0 of none.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Root mean square error.
pub(super) fn rmse(a: &[f64], b: &[f64]) -> f64 {
    mean_of(a, b, |a, b| (a - b) * (a - b)).sqrt()
}

/// Mean absolute error.
pub(super) fn mae(a: &[f64], b: &[f64]) -> f64 {
    mean_of(a, b, |a, b| (a - b).abs())
}

/// Relative root mean square error: `sqrt(mean((a - b)^2 / (b^2 + (0.1 m)^2)))`, m the mean of `b`. Dark pixels count
/// as much as bright ones do, down to a tenth of the mean, and the unit of light does not matter. 0 for two black pictures.
pub fn relative_rmse(a: &[f64], b: &[f64]) -> f64 {
    let floor = 0.1 * mean(b);
    let relative = |a: f64, b: f64| match b * b + floor * floor {
        0.0 if a == b => 0.0,
        denominator => (a - b) * (a - b) / denominator,
    };
    mean_of(a, b, relative).sqrt()
}

/// Peak signal-to-noise ratio in dB of values whose peak is 1; `None` where there is no noise.
pub(super) fn psnr(a: &[f64], b: &[f64]) -> Option<f64> {
    let error = rmse(a, b);
    (error > 0.0).then(|| -20.0 * ln(error) / std::f64::consts::LN_10)
}

fn mean_of(a: &[f64], b: &[f64], error: impl Fn(f64, f64) -> f64) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| error(*a, *b)).sum();
    sum / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_few_numbers() {
        let (a, b) = ([1.0, 2.0, 4.0, 1.0], [1.0, 1.0, 1.0, 1.0]);
        assert_eq!(mean(&a), 2.0);
        assert_eq!(rmse(&a, &b), 2.5_f64.sqrt());
        assert_eq!(mae(&a, &b), 1.0);
        // The floor is 0.1.
        assert!((relative_rmse(&a, &b) - (2.5_f64 / 1.01).sqrt()).abs() < 1e-15);
        assert_eq!(psnr(&[0.5], &[0.6]).map(|db| (db * 1e9).round()), Some(20e9));
        assert_eq!(psnr(&a, &a), None);
    }

    #[test]
    fn relative_errors_know_no_unit_of_light() {
        let (a, b) = ([0.3, 0.0, 7.0, 0.2], [0.25, 0.01, 8.0, 0.0]);
        let expected = relative_rmse(&a, &b);
        for scale in [1e-6, 1e6] {
            let scaled = |values: [f64; 4]| values.map(|v| scale * v);
            let found = relative_rmse(&scaled(a), &scaled(b));
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(relative_rmse(&[0.0], &[0.0]), 0.0);
        assert_eq!(relative_rmse(&[1.0], &[0.0]), f64::INFINITY);
    }
}
