//! Filter importance sampling: positions from |f|, weights of one constant size.
//!
//! Source: M. Ernst et al., "Filter Importance Sampling", IEEE Symposium on Interactive Ray Tracing 2006.
//! Weights are never renormalised, so a pixel is an unbiased estimate of the filtered image.

use super::Filter;
use super::quantiles::{SHARES, quantiles};

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
    /// Stretches the first number from its own range to the table's.
    scale: f32,
    /// Where the table of x begins.
    x: u32,
    /// Where the table of y begins.
    y: u32,
    /// Of the choice's samples.
    weight: f32,
}

/// A power of two, so that an index is cut to it and needs no check.
const TABLE: usize = 4 * SHARES;
const NEGATIVE: usize = 2 * SHARES;
const _: () = assert!(TABLE.is_power_of_two() && SHARES < NEGATIVE);

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
        table[..=SHARES].copy_from_slice(&quantiles(&positive));
        table[NEGATIVE..=NEGATIVE + SHARES].copy_from_slice(&quantiles(&negative));

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
            let scale = (SHARES as f64 / probability) as f32;
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
        let (shares, weight) = choose(&self.choices, u);
        let offsets = shares.map(|Share { place, within }| {
            self.offset(
                self.table[place as usize % TABLE],
                self.table[(place as usize + 1) % TABLE],
                within,
            )
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
        let mut places = [[0; N]; 2];
        let mut withins = [[0.0; N]; 2];
        for i in 0..N {
            let ([x, y], weight) = choose(&choices, [u[i], v[i]]);
            (places[0][i], places[1][i]) = (x.place, y.place);
            (withins[0][i], withins[1][i]) = (x.within, y.within);
            weights[i] = weight;
        }
        for ((places, withins), offsets) in places.iter().zip(&withins).zip(offsets) {
            let mut low = [0.0; N];
            let mut high = [0.0; N];
            for i in 0..N {
                low[i] = self.table[places[i] as usize % TABLE];
                high[i] = self.table[(places[i] as usize + 1) % TABLE];
            }
            for i in 0..N {
                offsets[i] = self.offset(low[i], high[i], withins[i]);
            }
        }
    }

    /// The offset a part `within` of the way from one quantile to the next.
    #[inline(always)]
    fn offset(&self, low: f32, high: f32, within: f32) -> f32 {
        let position = (low + (high - low) * within).max(0.0).min(1.0);
        (2.0 * position - 1.0) * self.radius
    }
}

/// A place between two quantiles.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// Of the lower quantile in the table.
    place: u32,
    /// How far from it to the next, in [0, 1] but for rounding.
    within: f32,
}

/// Where in the table x and y are looked up, and the sample's weight. Without branches.
#[inline(always)]
fn choose(choices: &[Choice; 4], [u, v]: [f32; 2]) -> ([Share; 2], f32) {
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
    let x = share(chosen.x, (u - chosen.start) * chosen.scale);
    ([x, share(chosen.y, v * SHARES as f32)], chosen.weight)
}

/// `number`, in [0, [`SHARES`]] but for rounding, in the table that begins at `base`.
#[inline(always)]
fn share(base: u32, number: f32) -> Share {
    // Rounds down by adding a number whose last bit counts ones; a whole number may round to the share
    // before, at whose end it is. The last share goes on to its end where `number` has rounded up.
    const ONES: f32 = 8_388_608.0;
    let rounded = (number - 0.5).max(0.0).min((SHARES - 1) as f32) + ONES;
    Share { place: base + (rounded.to_bits() - ONES.to_bits()), within: number - (rounded - ONES) }
}
