//! The film: exact sums of samples, and the picture made of them.
//!
//! Addition is associative by construction: each sample is rounded once to a fixed-point grid and added
//! as an integer, so threads, tile order, interruption and merging cannot change a byte. There is one
//! sum a replicate: error and variance come from their spread. Knows nothing of paths or scenes.

mod classes;
mod error;
mod fixed;
mod pixels;

pub use classes::{ClassFilm, ClassSample, ClassShare};
pub use error::ErrorEstimate;
pub use pixels::{Pixels, Region};

use crate::math::Rgb;
use crate::sampling::REPLICATES;
use fixed::Fixed;

/// Sums of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PixelSums {
    radiance: [[Fixed; 3]; REPLICATES],
    coverage: Fixed,
    /// Samples in the sums.
    samples: u64,
}

impl PixelSums {
    /// How many of the samples are replicate number `k`'s: sample s belongs to replicate s mod the number of them.
    fn samples_of(&self, k: usize) -> u64 {
        let replicates = REPLICATES as u64;
        (self.samples + replicates - 1 - k as u64) / replicates
    }
}

/// Sums of all pixels of a region of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    region: Region,
    sums: Vec<PixelSums>,
}

impl Film {
    /// Bytes of memory a pixel.
    pub const BYTES_PER_PIXEL: usize = size_of::<PixelSums>();

    /// An empty film over `region`.
    pub fn new(region: Region) -> Self {
        Self { region, sums: vec![PixelSums::default(); region.pixels()] }
    }

    /// The pixels it covers.
    pub fn region(&self) -> Region {
        self.region
    }

    /// Empties it, over another region; keeps its memory.
    pub fn restart(&mut self, region: Region) {
        self.region = region;
        self.sums.clear();
        self.sums.resize(region.pixels(), PixelSums::default());
    }

    /// Adds sample number `sample` of `pixel`; its radiance and coverage carry the filter's weight. The
    /// radiance must be finite.
    #[inline]
    pub fn add(&mut self, pixel: [u32; 2], sample: u64, radiance: Rgb, coverage: f32) {
        let sums = &mut self.sums[self.region.index(pixel)];
        let replicate = &mut sums.radiance[(sample % REPLICATES as u64) as usize];
        for (sum, value) in replicate.iter_mut().zip(radiance.to_array()) {
            sum.add(Fixed::from_f32(value));
        }
        sums.coverage.add(Fixed::from_f32(coverage));
        sums.samples += 1;
    }

    /// Adds the sums of another film, whose region lies within this one's.
    pub fn merge(&mut self, other: &Self) {
        for (pixel, theirs) in other.region.iter().zip(&other.sums) {
            let mine = &mut self.sums[self.region.index(pixel)];
            for (mine, theirs) in mine.radiance.iter_mut().zip(&theirs.radiance) {
                for (mine, theirs) in mine.iter_mut().zip(theirs) {
                    mine.add(*theirs);
                }
            }
            mine.coverage.add(theirs.coverage);
            mine.samples += theirs.samples;
        }
    }

    /// Fewest and most samples of any pixel.
    pub fn samples(&self) -> (u64, u64) {
        let count = |s: &PixelSums| s.samples;
        let min = self.sums.iter().map(count).min().unwrap_or(0);
        (min, self.sums.iter().map(count).max().unwrap_or(0))
    }

    /// The picture: means over the samples taken. Pixels without samples are black.
    pub fn develop(&self) -> Pixels {
        let mut pixels = Pixels::black(self.region);
        for (i, sums) in self.sums.iter().enumerate() {
            let n = sums.samples.max(1) as f64;
            let channel = |c: usize| {
                let mut total = Fixed::default();
                sums.radiance.iter().for_each(|replicate| total.add(replicate[c]));
                (total.to_f64() / n) as f32
            };
            pixels.radiance[i] = Rgb::new(channel(0), channel(1), channel(2));
            pixels.alpha[i] = (sums.coverage.to_f64() / n).clamp(0.0, 1.0) as f32;
            pixels.variance[i] = variance_of_mean(sums);
        }
        pixels
    }
}

/// Variance of the pixel's mean, a channel, from the spread of the replicates' means; 0 while fewer
/// than two replicates have samples.
fn variance_of_mean(sums: &PixelSums) -> Rgb {
    let count = |k: usize| sums.samples_of(k);
    let used = (0..REPLICATES).filter(|&k| count(k) > 0).count();
    if used < 2 {
        return Rgb::BLACK;
    }
    let channel = |c: usize| {
        let means: Vec<f64> =
            (0..used).map(|k| sums.radiance[k][c].to_f64() / count(k) as f64).collect();
        let mean = means.iter().sum::<f64>() / used as f64;
        let squares = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>();
        (squares / ((used - 1) * used) as f64) as f32
    };
    Rgb::new(channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    const REGION: Region = Region { start: [2, 3], end: [5, 7] };

    /// (pixel, sample, radiance): values over 24 orders of magnitude, of both signs.
    fn samples() -> Vec<([u32; 2], u64, Rgb)> {
        let mut rng = CounterRng::new(0);
        let mut value = move || {
            let magnitude = crate::math::fun::exp(55.0 * rng.unit() - 27.0);
            if rng.unit() < 0.2 { -magnitude } else { magnitude }
        };
        (0..64)
            .flat_map(|s| REGION.iter().map(move |p| (p, s)))
            .map(|(p, s)| (p, s, Rgb::new(value(), value(), value())))
            .collect()
    }

    fn film_of<'a>(samples: impl IntoIterator<Item = &'a ([u32; 2], u64, Rgb)>) -> Film {
        let mut film = Film::new(REGION);
        samples.into_iter().for_each(|&(p, s, radiance)| film.add(p, s, radiance, 1.0));
        film
    }

    #[test]
    fn no_order_and_no_partition_changes_a_bit() {
        let samples = samples();
        let whole = film_of(&samples);
        assert_eq!(whole, film_of(samples.iter().rev()));
        for parts in [2, 3, 7] {
            let mut merged = Film::new(REGION);
            for part in (0..parts).rev() {
                merged.merge(&film_of(samples.iter().skip(part).step_by(parts)));
            }
            assert_eq!(whole, merged);
        }
    }

    #[test]
    fn means_and_variances_are_those_of_the_samples() {
        let mut film = Film::new(Region { start: [0, 0], end: [1, 1] });
        for s in 0..8 {
            film.add([0, 0], s, Rgb::splat((s % 4) as f32), 0.5);
        }
        let pixels = film.develop();
        assert_eq!(pixels.radiance[0], Rgb::splat(1.5));
        assert_eq!(pixels.alpha[0], 0.5);
        // Replicate means 0, 1, 2, 3: variance 5/3, of the mean of four 5/12.
        assert!((pixels.variance[0].r - 5.0 / 12.0).abs() < 1e-6);
    }
}
