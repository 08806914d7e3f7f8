//! The zone plate: rings that get finer with their distance from the origin, sampled by any strategy and
//! reconstructed with any filter. Where they are finer than pixels can show, whatever is seen is the sampler's doing.
//!
//! Source: the test image of D. P. Mitchell and A. N. Netravali, "Reconstruction Filters in Computer Graphics", SIGGRAPH
//! 1988. The truth that it is compared with is the integral of the rings times the filter, which for
//! filters that are products is worked out along one axis at a time.

use crate::filter::{Filter, FilterSampler};
use crate::math::fun::double;
use crate::sampling::{Dimension, REPLICATES, Sampler, Strategy};
use rayon::prelude::*;

/// A square picture of `L(x, y) = (1 + sin((x^2 + y^2) / 100)) / 2`, x to the right and y upwards from the lower left
/// corner, in pixels.
#[derive(Clone, Copy, Debug)]
pub struct ZonePlate {
    /// Pixels along a side.
    pub size: u32,
}

/// Phase over squared distance.
const PHASE: f64 = 1.0 / 100.0;

impl ZonePlate {
    /// The radiance at a point, in [0, 1].
    pub fn radiance(x: f64, y: f64) -> f64 {
        0.5 + 0.5 * double::sin(PHASE * (x * x + y * y))
    }

    /// For each pixel the mean of `samples` weighted samples of its filter: one set of a strategy, where a render takes one for
    /// each of its replicates. Row-major, top row first.
    pub fn sampled(
        &self,
        strategy: Strategy,
        seed: u64,
        filter: &FilterSampler,
        samples: u64,
    ) -> Vec<f64> {
        // The samples of one replicate; a grid has but one.
        let replicates = if strategy == Strategy::Grid { 1 } else { REPLICATES as u64 };
        let sampler = Sampler::new(strategy, seed, samples * replicates);
        self.pixels(|column, row| {
            let mut sum = 0.0;
            for sample in 0..samples {
                let key = sampler.path(column, row, sample * replicates);
                let ([dx, dy], weight) = filter.sample(sampler.two(key, Dimension::Film));
                let [x, y] = self.center(column, row);
                sum += f64::from(weight) * Self::radiance(x + f64::from(dx), y - f64::from(dy));
            }
            sum / samples as f64
        })
    }

    /// What the mean of ever more samples comes to: the integral of radiance times filter, to 1e-9 for filters up to three
    /// pixels in radius. Row-major, top row first.
    pub fn exact(&self, filter: Filter) -> Vec<f64> {
        // sin(a + b) = sin a cos b + cos a sin b, a of x alone and b of y alone.
        let axis: Vec<[f64; 2]> =
            (0..self.size).into_par_iter().map(|i| smoothed(f64::from(i) + 0.5, filter)).collect();
        self.pixels(|column, row| {
            let [sin_x, cos_x] = axis[column as usize];
            let [sin_y, cos_y] = axis[(self.size - 1 - row) as usize];
            0.5 + 0.5 * (sin_x * cos_y + cos_x * sin_y)
        })
    }

    fn center(&self, column: u32, row: u32) -> [f64; 2] {
        [f64::from(column) + 0.5, f64::from(self.size - row) - 0.5]
    }

    fn pixels(&self, value: impl Fn(u32, u32) -> f64 + Sync) -> Vec<f64> {
        let size = u64::from(self.size);
        let pixel = |i: u64| value((i % size) as u32, (i / size) as u32);
        (0..size * size).into_par_iter().map(pixel).collect()
    }
}

/// Sine and cosine of the phase around `center`, each the mean under the filter.
fn smoothed(center: f64, filter: Filter) -> [f64; 2] {
    // Gauss-Legendre quadrature with five points, in panels so narrow that the phase turns little in each, and that
    // end where filters have corners: at every half pixel and at their radius.
    const PANELS: u32 = 64;
    const POINTS: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let radius = f64::from(filter.radius);
    let halves = (2.0 * radius).ceil() as u32;
    let (mut sum, mut sin, mut cos) = (0.0, 0.0, 0.0);
    for half in 0..2 * halves {
        let start = (0.5 * (f64::from(half) - f64::from(halves))).clamp(-radius, radius);
        let end = (0.5 * (f64::from(half + 1) - f64::from(halves))).clamp(-radius, radius);
        let width = (end - start) / f64::from(PANELS);
        for panel in 0..PANELS {
            let middle = start + width * (f64::from(panel) + 0.5);
            for (place, share) in POINTS {
                let offset = middle + 0.5 * width * place;
                let weight = 0.5 * width * share * filter.evaluate(offset);
                let phase = PHASE * (center + offset) * (center + offset);
                sum += weight;
                sin += weight * double::sin(phase);
                cos += weight * double::cos(phase);
            }
        }
    }
    [sin / sum, cos / sum]
}

/// Root of the mean squared difference of two pictures of the same size.
pub fn rms_difference(a: &[f64], b: &[f64]) -> f64 {
    let squared = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    (squared.sum::<f64>() / a.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The box filter's integral along an axis is a Fresnel integral; here against a sum of a million terms.
    #[test]
    fn the_exact_picture_is_the_integral() {
        let plate = ZonePlate { size: 300 };
        for filter in ["box", "tent", "mitchell", "lanczos:3"] {
            let filter = Filter::parse(filter).unwrap();
            let exact = plate.exact(filter);
            for [column, row] in [[0_u32, 299_u32], [17, 200], [299, 0]] {
                const SIDE: u32 = 1200;
                let (mut sum, mut weights) = (0.0, 0.0);
                let radius = f64::from(filter.radius);
                let [x, y] = plate.center(column, row);
                for i in 0..SIDE * SIDE {
                    let place =
                        |k: u32| ((f64::from(k) + 0.5) / f64::from(SIDE) * 2.0 - 1.0) * radius;
                    let (dx, dy) = (place(i % SIDE), place(i / SIDE));
                    let weight = filter.evaluate(dx) * filter.evaluate(dy);
                    sum += weight * ZonePlate::radiance(x + dx, y + dy);
                    weights += weight;
                }
                let found = exact[(row * 300 + column) as usize];
                assert!(
                    (found - sum / weights).abs() < 2e-6,
                    "{filter}: {found} {}",
                    sum / weights
                );
            }
        }
    }

    /// Every sampler but the grid converges to the exact picture: mean difference over 48 x 48 pixels in standard errors from the
    /// pixels' own spread. 5.7 of them are passed by chance in one of 56 comparisons with 7e-7; of random samples a filter that
    /// is two hundredths of a pixel off its place would be found.
    #[test]
    fn samples_are_unbiased() {
        let plate = ZonePlate { size: 48 };
        for filter in ["box", "mitchell"] {
            let filter = Filter::parse(filter).unwrap();
            let (exact, draw) = (plate.exact(filter), FilterSampler::new(filter));
            for strategy in Strategy::ALL.iter().filter(|s| s.can_render() && **s != Strategy::Grid)
            {
                let image = plate.sampled(*strategy, 0, &draw, 32);
                // Against a slope of the picture, so that a displacement shows.
                let slope =
                    |i: usize| exact[(i + 1).min(exact.len() - 1)] - exact[i.saturating_sub(1)];
                for weight in [&|_: usize| 1.0, &slope] as [&dyn Fn(usize) -> f64; 2] {
                    let of = |i: usize| (image[i] - exact[i]) * weight(i);
                    let n = exact.len() as f64;
                    let mean = (0..exact.len()).map(of).sum::<f64>() / n;
                    let squares = (0..exact.len()).map(|i| of(i) * of(i)).sum::<f64>() / n;
                    let error = (squares / n).sqrt();
                    assert!(
                        mean.abs() < 5.7 * error,
                        "{} {filter}: {mean} {error}",
                        strategy.name()
                    );
                }
            }
        }
    }

    /// An unshifted grid shows rings where there are none: around the point where the phase turns once from sample to sample,
    /// 100 pi pixels from the origin, the errors of neighbours are alike. Those of random samples are independent.
    #[test]
    fn the_grid_aliases_and_random_samples_do_not() {
        let plate = ZonePlate { size: 400 };
        let filter = Filter::parse("box").unwrap();
        let (exact, draw) = (plate.exact(filter), FilterSampler::new(filter));
        let correlation = |strategy| {
            let image = plate.sampled(strategy, 0, &draw, 1);
            let error = |x: usize, y: usize| image[y * 400 + x] - exact[y * 400 + x];
            let (mut product, mut square) = (0.0, 0.0);
            for y in 375..400 {
                for x in 300..328 {
                    product += error(x, y) * error(x + 1, y);
                    square += error(x, y) * error(x, y);
                }
            }
            product / square
        };
        let (grid, random) = (correlation(Strategy::Grid), correlation(Strategy::Random));
        assert!(random.abs() < 0.2 && grid > 0.8, "{grid} {random}");
    }
}
