//! Filter importance sampling: positions from |f|, weights of one constant size.
//!
//! Source: M. Ernst et al., "Filter Importance Sampling", IEEE Symposium on Interactive Ray Tracing 2006.
//! Weights are never renormalised, so a pixel is an unbiased estimate of the filtered image.

use super::Filter;
use super::quantiles::{Place, QUANTILES, quantiles};

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
    /// Quantiles of the positive part in the first half, of the negative one from [`NEGATIVE`] on.
    table: Box<[f32; TABLE]>,
    /// What the first number may choose, in order. A filter without negative part has the last one only.
    choices: [Choice; 4],
    weight: f32,
}

/// One product of two parts.
#[derive(Clone, Copy, Debug, Default)]
struct Choice {
    /// Where it begins in the first number; it ends where the next one begins.
    start: f32,
    /// Stretches the first number from its own range to [0, 1].
    scale: f32,
    /// Where the table of x begins.
    x: u32,
    /// Where the table of y begins.
    y: u32,
    /// Of the choice's samples.
    weight: f32,
}

/// A power of two, so that an index is cut to it and needs no check.
const TABLE: usize = 2 * NEGATIVE;
const NEGATIVE: usize = 1024;
const _: () = assert!(TABLE.is_power_of_two() && QUANTILES <= NEGATIVE);

impl FilterSampler {
    /// Tabulates `filter`: f takes its mean over each of 8192 cells along an axis, of whose distribution the
    /// table holds the quantiles.
    pub fn new(filter: Filter) -> Self {
        const CELLS: usize = 8192;
        const POINTS: usize = 4;
        let spacing = 2.0 * f64::from(filter.radius) / (CELLS * POINTS) as f64;
        let position = |i: usize| (i as f64 + 0.5) * spacing - f64::from(filter.radius);
        let mean = |cell: usize| {
            (0..POINTS).map(|i| filter.evaluate(position(cell * POINTS + i))).sum::<f64>()
        };
        let values: Vec<f64> = (0..CELLS).map(mean).collect();
        let positive: Vec<f64> = values.iter().map(|v| v.max(0.0)).collect();
        let negative: Vec<f64> = values.iter().map(|v| (-v).max(0.0)).collect();
        let mut table = Box::new([0.0; TABLE]);
        table[..QUANTILES].copy_from_slice(&quantiles(&positive));
        table[NEGATIVE..NEGATIVE + QUANTILES].copy_from_slice(&quantiles(&negative));

        let (p, n): (f64, f64) = (positive.iter().sum(), negative.iter().sum());
        let (p, n) = (p / (p + n), n / (p + n));
        // Along one axis (integral of |f|) / (integral of f) = 1 / (p - n).
        let weight = (1.0 / ((p - n) * (p - n))) as f32;
        let (positive, negative) = (0, NEGATIVE as u32);
        let mut start = 0.0;
        let choices = [
            (n * p, negative, positive, -weight),
            (p * n, positive, negative, -weight),
            (n * n, negative, negative, weight),
            (p * p, positive, positive, weight),
        ]
        .map(|(probability, x, y, weight)| {
            let scale = (1.0 / probability) as f32;
            let choice = Choice { start: start as f32, scale, x, y, weight };
            start += probability;
            choice
        });
        Self { radius: filter.radius, table, choices, weight }
    }

    /// The size of every weight, at least 1. Its square is the factor by which the filter's negative lobes
    /// raise the second moment of a sample.
    pub fn weight(&self) -> f32 {
        self.weight
    }

    /// (offset from the pixel's centre in pixels, within the radius; weight) for `u` in [0, 1)^2, which is
    /// best the sampler's film dimension.
    #[inline(always)]
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (places, weight) = choose(&self.choices, u);
        let offsets = places.map(|(base, place)| {
            let i = (base + place.index) as usize;
            place.position(self.table[i % TABLE], self.table[(i + 1) % TABLE]) * self.radius
        });
        (offsets, weight)
    }

    /// [`FilterSampler::sample`] of `N` numbers at once: offsets and weights. Loops without branches before and
    /// after the look-up, so that the compiler vectorises them.
    #[inline(always)]
    pub fn sample_lanes<const N: usize>(
        &self,
        [u, v]: &[[f32; N]; 2],
        offsets: &mut [[f32; N]; 2],
        weights: &mut [f32; N],
    ) {
        let choices = self.choices;
        let mut indices = [[0; N]; 2];
        for i in 0..N {
            let ([(base_x, x), (base_y, y)], weight) = choose(&choices, [u[i], v[i]]);
            (indices[0][i], indices[1][i]) = (base_x + x.index, base_y + y.index);
            weights[i] = weight;
        }
        let mut quantiles = [[[0.0; N]; 2]; 2];
        for (indices, [low, high]) in indices.iter().zip(&mut quantiles) {
            for i in 0..N {
                low[i] = self.table[indices[i] as usize % TABLE];
                high[i] = self.table[(indices[i] as usize + 1) % TABLE];
            }
        }
        for i in 0..N {
            // Once more, rather than carried past the look-up: it is cheap.
            let ([(_, x), (_, y)], _) = choose(&choices, [u[i], v[i]]);
            let [[low_x, high_x], [low_y, high_y]] = &quantiles;
            offsets[0][i] = x.position(low_x[i], high_x[i]) * self.radius;
            offsets[1][i] = y.position(low_y[i], high_y[i]) * self.radius;
        }
    }
}

/// Where x and y are looked up, each with the start of its table, and the sample's weight. Without branches.
#[inline(always)]
fn choose(choices: &[Choice; 4], [u, v]: [f32; 2]) -> ([(u32, Place); 2], f32) {
    let mut chosen = choices[0];
    for next in &choices[1..] {
        let take = u >= next.start;
        chosen = Choice {
            start: if take { next.start } else { chosen.start },
            scale: if take { next.scale } else { chosen.scale },
            x: if take { next.x } else { chosen.x },
            y: if take { next.y } else { chosen.y },
            weight: if take { next.weight } else { chosen.weight },
        };
    }
    let x = Place::of((u - chosen.start) * chosen.scale);
    ([(chosen.x, x), (chosen.y, Place::of(v))], chosen.weight)
}
