//! Structural similarity: luminance, contrast and correlation of small windows.
//!
//! Source: Z. Wang, A. Bovik, H. Sheikh and E. Simoncelli, Image quality assessment: from error visibility to structural
//! similarity, IEEE Transactions on Image Processing 13(4), 2004, equation 13, with its constants; windows that do not
//! fit into the picture are left out, and channels are averaged.

use super::field::Field;
use crate::math::fun::double::exp;

/// Of the windows: 11 pixels, of a normal distribution of 1.5 pixels.
const RADIUS: usize = 5;
const DEVIATION: f64 = 1.5;

/// Mean structural similarity of encoded values in [0, 1], three channels a pixel; `None` where no window fits.
pub(super) fn ssim(a: &[f64], b: &[f64], size: [u32; 2]) -> Option<f64> {
    let channel = |values: &[f64], c: usize| {
        Field::new(size, values.iter().skip(c).step_by(3).copied().collect())
    };
    let of_channel = |c| ssim_of_channel(&channel(a, c), &channel(b, c));
    Some((of_channel(0)? + of_channel(1)? + of_channel(2)?) / 3.0)
}

fn ssim_of_channel(a: &Field, b: &Field) -> Option<f64> {
    let distances = (0..=2 * RADIUS).map(|k| (k as f64 - RADIUS as f64) / DEVIATION);
    let window: Vec<f64> = distances.map(|d| exp(-0.5 * d * d)).collect();
    let total: f64 = window.iter().sum();
    let window: Vec<f64> = window.iter().map(|w| w / total).collect();
    let mean = |field: Field| field.filtered(&window, &window);

    let (mean_a, mean_b) = (mean(a.clone()), mean(b.clone()));
    let product = |a: &Field, b: &Field| mean(a.zip(b, |a, b| a * b));
    let covariance = |a: &Field, b: &Field, mean_a: &Field, mean_b: &Field| {
        product(a, b).zip(&mean_a.zip(mean_b, |a, b| a * b), |product, means| product - means)
    };
    let variances =
        covariance(a, a, &mean_a, &mean_a).zip(&covariance(b, b, &mean_b, &mean_b), |a, b| a + b);
    let covariance = covariance(a, b, &mean_a, &mean_b);

    let [c1, c2] = [0.01_f64 * 0.01, 0.03 * 0.03];
    let luminance = mean_a.zip(&mean_b, |a, b| (2.0 * a * b + c1) / (a * a + b * b + c1));
    let structure = covariance.zip(&variances, |both, each| (2.0 * both + c2) / (each + c2));
    luminance.zip(&structure, |l, s| l * s).mean_within(RADIUS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_are_alike_and_small_ones_have_no_window() {
        let picture: Vec<f64> = (0..12 * 12 * 3).map(|i| f64::from(i % 7) / 7.0).collect();
        assert!((ssim(&picture, &picture, [12, 12]).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(ssim(&picture[..12 * 10 * 3], &picture[..12 * 10 * 3], [12, 10]), None);
        let inverted: Vec<f64> = picture.iter().map(|v| 1.0 - v).collect();
        assert!(ssim(&picture, &inverted, [12, 12]).unwrap() < -0.5);
    }
}
