//! The error of an image, estimated from the spread of its replicates.
//!
//! The error is relative: `sqrt(mean((I - R)^2 / (R^2 + (0.1 m)^2)))` over pixels and channels, with R the limit of the image and
//! m its mean. `(I - R)^2` is expected to be the variance of the image, which two replicates tell by their difference. R is
//! taken from the *other* replicates: one bright sample that raised both would hide itself. Noise in R makes the
//! quotient too large; as there is twice as much with one replicate as with two, it is extrapolated to none (L. Richardson and
//! J. Gaunt, The deferred approach to the limit, Philosophical Transactions A 226, 1927).

use super::{Film, PixelSums};
use crate::sampling::REPLICATES;
use rayon::prelude::*;
use serde::Serialize;

/// How far an image is from its limit, with an interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ErrorEstimate {
    /// Expected relative root mean square error: 0.01 is one percent.
    pub relative_rmse: f64,
    /// With this probability it is between `low` and `high`.
    pub confidence: f64,
    /// The lower end of the interval.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// Whether enough pixels and samples are behind it; if not, a few bright samples decide, and may be missing.
    pub certain: bool,
}

/// Standard errors to either side that hold 95 % of a normal distribution.
const QUANTILE: f64 = 1.959_963_985;

/// A certain estimate rests on at least so many pixels, as if all were equally strong.
const FEWEST_PIXELS: f64 = 400.0;

/// A certain estimate was changed by less than this part of it when the noise in R was extrapolated away.
const MOST_NOISE: f64 = 0.5;

/// A certain estimate is less: of an image that is mostly noise, the others know nothing of R.
const MOST_ERROR: f64 = 0.5;

impl Film {
    /// The error to be expected of the image; `None` while not every pixel has samples of two replicates, and of a black image.
    ///
    /// Replicates must be independent: the samples of a grid are not.
    pub fn error(&self) -> Option<ErrorEstimate> {
        let count = self.sums.len() as f64;
        let [sum] = self.sum_of_pixels(|sums| [PixelMeans::new(sums).mean.iter().sum()]);
        let mean = sum / (3.0 * count);
        if self.samples().0 < 2 || mean == 0.0 {
            return None;
        }

        // Errors of pixels are independent of each other; most are small, and some large.
        let floor = (0.1 * mean) * (0.1 * mean);
        let [sum, sum_of_squares, noisy] = self.sum_of_pixels(|sums| {
            let SquaredError { extrapolated, noisy } = PixelMeans::new(sums).squared_error(floor);
            [extrapolated, extrapolated * extrapolated, noisy]
        });
        let (squared, noisy) = (sum / count, noisy / count);
        let variance = (sum_of_squares / count - squared * squared).max(0.0) / count;
        let statistical = QUANTILE * variance.sqrt();

        // What extrapolation leaves is of the order of the square of what it took.
        let noise = if squared > 0.0 { (noisy - squared).abs() / squared } else { noisy / floor };
        let (squared, systematic) = match noise < MOST_NOISE {
            true => (squared, 2.0 * noise * noise * squared),
            false => (noisy, (noisy - squared).abs()),
        };
        let is_broad = sum_of_squares == 0.0 || sum * sum >= FEWEST_PIXELS * sum_of_squares;
        let root = |squared: f64| squared.max(0.0).sqrt();
        Some(ErrorEstimate {
            relative_rmse: root(squared),
            confidence: 0.95,
            low: root(squared - statistical - systematic),
            high: root(squared + statistical + systematic),
            certain: is_broad && noise < MOST_NOISE && root(squared) < MOST_ERROR,
        })
    }

    /// Sums over all pixels, the same for any number of threads.
    fn sum_of_pixels<const N: usize>(
        &self,
        terms: impl Fn(&PixelSums) -> [f64; N] + Sync,
    ) -> [f64; N] {
        let add = |mut sums: [f64; N], terms: [f64; N]| {
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            sums
        };
        let of_part = |part: &[PixelSums]| part.iter().map(&terms).fold([0.0; N], add);
        let parts: Vec<[f64; N]> = self.sums.par_chunks(1024).map(of_part).collect();
        parts.into_iter().fold([0.0; N], add)
    }
}

/// A squared relative error.
#[derive(Clone, Copy, Default)]
struct SquaredError {
    /// Over noisy denominators.
    noisy: f64,
    /// Over denominators without noise, as far as can be told.
    extrapolated: f64,
}

/// What the samples of one pixel say.
struct PixelMeans {
    /// Of all samples, by channel.
    mean: [f64; 3],
    /// Of each replicate that has samples, and how many it has.
    replicates: [([f64; 3], f64); REPLICATES],
    used: usize,
    samples: f64,
}

impl PixelMeans {
    fn new(sums: &PixelSums) -> Self {
        let mut found = Self {
            mean: [0.0; 3],
            replicates: [([0.0; 3], 0.0); REPLICATES],
            used: sums.samples.min(REPLICATES as u64) as usize,
            samples: sums.samples as f64,
        };
        for k in 0..found.used {
            let n = sums.samples_of(k) as f64;
            let total = sums.radiance[k].map(|sum| sum.to_f64());
            found.replicates[k] = (total.map(|sum| sum / n), n);
            for (mean, sum) in found.mean.iter_mut().zip(total) {
                *mean += sum / found.samples;
            }
        }
        found
    }

    /// The mean of the channels.
    fn squared_error(&self, floor: f64) -> SquaredError {
        let replicates = &self.replicates[..self.used];
        let mut sum = SquaredError::default();
        for c in 0..3 {
            for (j, (mine, n)) in replicates.iter().enumerate() {
                for (k, (other, m)) in replicates.iter().enumerate().skip(j + 1) {
                    let difference = mine[c] - other[c];
                    if difference != 0.0 {
                        let weight = self.weight(c, [j, k], floor);
                        sum.noisy += difference * difference * n * m * weight.noisy;
                        sum.extrapolated += difference * difference * n * m * weight.extrapolated;
                    }
                }
            }
        }
        // Pairs of replicates to the variance of a sample, and that to the variance of the mean of all.
        let scale = 3.0 * self.samples * self.samples * (self.used - 1) as f64;
        SquaredError { noisy: sum.noisy / scale, extrapolated: sum.extrapolated / scale }
    }

    /// `1 / (R^2 + floor)`, R without the replicates `but`.
    fn weight(&self, c: usize, but: [usize; 2], floor: f64) -> SquaredError {
        let weight = |radiance: f64| 1.0 / (radiance * radiance + floor);
        let (mut sum, mut weights, mut count) = (0.0, 0.0, 0.0);
        for k in (0..self.used).filter(|k| !but.contains(k)) {
            let radiance = self.replicates[k].0[c];
            sum += radiance;
            weights += weight(radiance);
            count += 1.0;
        }
        if count < 2.0 {
            let noisy = if count == 0.0 { weight(self.mean[c]) } else { weights };
            return SquaredError { noisy, extrapolated: noisy };
        }
        // The mean of n has an n-th of the noise of one.
        let (of_mean, mean) = (weight(sum / count), weights / count);
        SquaredError { noisy: of_mean, extrapolated: (count * of_mean - mean) / (count - 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Region;
    use crate::math::Rgb;
    use crate::sampling::CounterRng;

    const SIDE: u32 = 64;

    /// A film of `samples` samples a pixel: `radiance` of pixel and random numbers.
    fn film(samples: u64, radiance: impl Fn([u32; 2], &mut CounterRng) -> f32) -> Film {
        let mut film = Film::new(Region::full([SIDE, SIDE]));
        let mut rng = CounterRng::new(0);
        for pixel in film.region().iter() {
            for sample in 0..samples {
                let [r, g, b] = [(); 3].map(|()| radiance(pixel, &mut rng));
                film.add(pixel, sample, Rgb::new(r, g, b), 1.0);
            }
        }
        film
    }

    /// Radiance 1 and 2 in turns, times uniform numbers of mean 1 and of variance 1/3.
    fn noisy([x, _]: [u32; 2], rng: &mut CounterRng) -> f32 {
        (1 + x % 2) as f32 * 2.0 * rng.unit()
    }

    /// Of the image above, for a variance of the mean that is this part of the squared radiance.
    fn expected(variance: f64) -> f64 {
        let floor = 0.15 * 0.15;
        (0.5 * variance * (1.0 / (1.0 + floor) + 4.0 / (4.0 + floor))).sqrt()
    }

    /// 12 288 channels of 3 degrees of freedom tell variances to 0.8 %, errors to 0.4 %; six of that are 2.5 %. Where samples are
    /// few, extrapolation leaves some of the noise, within the interval.
    #[test]
    fn the_error_of_known_noise_is_found() {
        for (samples, tolerance) in [(256, 0.025), (64, 0.025), (19, 0.06), (16, 0.06)] {
            let found = film(samples, noisy).error().unwrap();
            let expected = expected(1.0 / 3.0 / samples as f64);
            let off = found.relative_rmse / expected - 1.0;
            assert!(off.abs() < tolerance, "{samples}: {found:?} {expected}");
            assert!(found.certain && found.low < expected && expected < found.high, "{found:?}");
            assert!(found.high / found.low < 1.25, "{found:?}");
        }
    }

    /// Pixels of replicates with one, two or three samples are weighed alike.
    #[test]
    fn few_samples_are_enough_for_a_rough_answer() {
        for samples in [2, 3, 5] {
            let found = film(samples, |_, rng| 1.0 + 0.1 * (rng.unit() - 0.5)).error().unwrap();
            let expected = (0.01_f64 / 12.0 / samples as f64 / 1.01).sqrt();
            assert!((found.relative_rmse / expected - 1.0).abs() < 0.05, "{found:?} {expected}");
        }
    }

    #[test]
    fn the_unit_of_light_does_not_matter() {
        let expected = film(16, noisy).error().unwrap();
        for scale in [2.0_f32.powi(-20), 2.0_f32.powi(20)] {
            let found = film(16, |pixel, rng| scale * noisy(pixel, rng)).error().unwrap();
            let off = found.relative_rmse / expected.relative_rmse - 1.0;
            assert!(off.abs() < 1e-6, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn a_few_bright_samples_make_it_uncertain() {
        let fireflies = |pixel, rng: &mut CounterRng| match rng.unit() < 1e-4 {
            true => 1000.0,
            false => noisy(pixel, rng),
        };
        let found = film(16, fireflies).error().unwrap();
        assert!(!found.certain, "{found:?}");
        assert!(found.relative_rmse > film(16, noisy).error().unwrap().relative_rmse);
        // So does noise that is as large as the image.
        let rare = |_, rng: &mut CounterRng| if rng.unit() < 0.1 { 10.0 } else { 0.0 };
        assert!(!film(8, rare).error().unwrap().certain);
    }

    #[test]
    fn nothing_is_said_of_nothing() {
        assert_eq!(film(1, noisy).error(), None);
        assert_eq!(film(16, |_, _| 0.0).error(), None);
        let exact = film(4, |_, _| 0.5).error().unwrap();
        assert_eq!([exact.relative_rmse, exact.low, exact.high], [0.0; 3]);
        assert!(exact.certain);
    }
}
