//! Filter importance sampling: positions from |f|, weights of one constant size.
//!
//! Source: M. Ernst et al., "Filter Importance Sampling", IEEE Symposium on Interactive Ray Tracing 2006.
//! Weights are never renormalised, so a pixel is an unbiased estimate of the filtered image.

use super::Filter;
use super::inverse::InverseTable;
use crate::math::ONE_MINUS_EPSILON;

/// Draws positions with density |f(x) f(y)| / c and gives them the weight +c or -c, the sign of f(x) f(y),
/// where f is normalised and c = (integral of |f|)^2, so that the expected weight is 1.
///
/// f has a positive part P and a negative part N (empty for most filters). The first number chooses
/// among N x P, P x N, N x N and P x P, in this order, and is then stretched over the choice to be the
/// position in x: the sign is a single threshold on one coordinate. Hence of n stratified samples the
/// number of negative ones is within 1 of its expectation, and the noise that the sign gives a constant
/// image falls as 1/n; a sign taken from both coordinates would fall more slowly.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    radius: f32,
    positive: InverseTable,
    negative: InverseTable,
    /// Where the choices of the first number end, except the last, which ends at 1.
    ends: [f32; 3],
    weight: f32,
}

impl FilterSampler {
    /// Tabulates `filter`: f becomes constant in each of 1024 cells along an axis, where it has the mean of
    /// the filter. Densities and weights are those of the table, so they agree exactly.
    pub fn new(filter: Filter) -> Self {
        const CELLS: usize = 1024;
        const POINTS: usize = 8;
        let spacing = 2.0 * f64::from(filter.radius) / (CELLS * POINTS) as f64;
        let position = |i: usize| (i as f64 + 0.5) * spacing - f64::from(filter.radius);
        let mean = |cell: usize| {
            (0..POINTS).map(|i| filter.evaluate(position(cell * POINTS + i))).sum::<f64>()
        };
        let values: Vec<f64> = (0..CELLS).map(mean).collect();
        let positive: Vec<f64> = values.iter().map(|v| v.max(0.0)).collect();
        let negative: Vec<f64> = values.iter().map(|v| (-v).max(0.0)).collect();

        let (p, n): (f64, f64) = (positive.iter().sum(), negative.iter().sum());
        let (p, n) = (p / (p + n), n / (p + n));
        // Along one axis (integral of |f|) / (integral of f) = 1 / (p - n).
        let weight = (1.0 / ((p - n) * (p - n))) as f32;
        let ends = [n * p, 2.0 * n * p, 2.0 * n * p + n * n].map(|end| end as f32);
        Self {
            radius: filter.radius,
            positive: InverseTable::new(&positive),
            negative: InverseTable::new(&negative),
            ends,
            weight,
        }
    }

    /// The size of every weight, at least 1. Its square is the factor by which the filter's negative lobes
    /// raise the second moment of a sample.
    pub fn weight(&self) -> f32 {
        self.weight
    }

    /// (offset from the pixel's centre in pixels, within the radius; weight) for `u` in [0, 1)^2, which is
    /// best the sampler's film dimension.
    #[inline]
    pub fn sample(&self, [u, v]: [f32; 2]) -> ([f32; 2], f32) {
        let [end_np, end_pn, end_nn] = self.ends;
        let (start, end, x, y, weight) = if u >= end_nn {
            (end_nn, 1.0, &self.positive, &self.positive, self.weight)
        } else if u >= end_pn {
            (end_pn, end_nn, &self.negative, &self.negative, self.weight)
        } else if u >= end_np {
            (end_np, end_pn, &self.positive, &self.negative, -self.weight)
        } else {
            (0.0, end_np, &self.negative, &self.positive, -self.weight)
        };
        let u = ((u - start) / (end - start)).min(ONE_MINUS_EPSILON);
        let offset = |part: &InverseTable, u| (2.0 * part.sample(u) - 1.0) * self.radius;
        ([offset(x, u), offset(y, v)], weight)
    }
}
