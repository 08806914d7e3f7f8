//! Light told apart by transport class, in the watched pixels: who brings the energy, and who the noise.
//!
//! The energy share of a class is its part of the mean luminance. Its variance share is Cov(class, image) / Var(image)
//! over the replicates, each pixel and channel weighted as the relative error weighs it, 1 / (R^2 + (0.1 m)^2) with R the
//! pixel's mean and m the mean of all: the shares add up to 1, since the classes add up to the image, and one that
//! cancels the noise of another is negative. Sums are exact, as the film's are.

use super::fixed::Fixed;
use super::{Film, PixelSums};
use crate::ledger::{Class, Watch};
use crate::math::Rgb;
use crate::sampling::REPLICATES;

/// Relative variance of a pixel below which it is the rounding of means, and of nothing that was sampled.
const NOISE_OF_ROUNDING: f64 = 1e-20;

/// Sums of one watched pixel, by replicate, class and channel.
type CellSums = [[[Fixed; 3]; Class::COUNT]; REPLICATES];

/// Light of one class in one sample of a watched pixel.
#[derive(Clone, Copy, Debug)]
pub struct ClassSample {
    /// The pixel's cell.
    pub cell: u32,
    /// The sample's number.
    pub sample: u64,
    /// The class.
    pub class: Class,
    /// Finite radiance times the filter's weight.
    pub radiance: Rgb,
}

/// Sums of all watched pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassFilm {
    watch: Watch,
    cells: Vec<CellSums>,
}

/// What a class brings to an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassShare {
    /// The class.
    pub class: Class,
    /// Its part of the light.
    pub energy: f64,
    /// Its part of the noise; `None` where there is none, or fewer than two replicates to tell it from.
    pub variance: Option<f64>,
}

impl ClassFilm {
    /// At most as many pixels are watched: 8 MB of sums, and shares to some hundredths of themselves.
    pub const PIXELS: u64 = 4096;

    /// Empty sums over an image `height` pixels high.
    pub fn new(watch: Watch, height: u32) -> Self {
        let empty = [[[Fixed::default(); 3]; Class::COUNT]; REPLICATES];
        Self { watch, cells: vec![empty; watch.cells(height)] }
    }

    /// Bytes of all sums.
    pub fn bytes(&self) -> usize {
        self.cells.len() * size_of::<CellSums>()
    }

    /// Adds samples; neither their order nor how they are divided matters.
    pub fn add(&mut self, samples: &[ClassSample]) {
        for light in samples {
            let replicate = (light.sample % REPLICATES as u64) as usize;
            let sums = &mut self.cells[light.cell as usize][replicate][light.class as usize];
            for (sum, value) in sums.iter_mut().zip(light.radiance.to_array()) {
                sum.add(Fixed::from_f32(value));
            }
        }
    }

    /// The number of watched pixels, and the shares of all classes that brought any light, in their order. `film` has
    /// all samples of the same render.
    pub fn shares(&self, film: &Film) -> (usize, Vec<ClassShare>) {
        let of = |(pixel, sums): ([u32; 2], &PixelSums)| {
            let cell = self.watch.cell(pixel)?;
            Some(CellMeans::new(&self.cells[cell as usize], sums))
        };
        let cells: Vec<CellMeans> = film.region.iter().zip(&film.sums).filter_map(of).collect();
        let mut energy = [0.0; Class::COUNT];
        for cell in &cells {
            for (sum, mean) in energy.iter_mut().zip(cell.mean) {
                *sum += luminance(mean);
            }
        }
        let of_cell = |cell: &CellMeans| total(&cell.mean).iter().sum::<f64>();
        let image_mean = cells.iter().map(of_cell).sum::<f64>() / (3 * cells.len()) as f64;
        let mut covariance = [0.0; Class::COUNT];
        for cell in &cells {
            cell.add_covariances(image_mean, &mut covariance);
        }
        let (light, noise): (f64, f64) = (energy.iter().sum(), covariance.iter().sum());
        let is_noisy = noise > NOISE_OF_ROUNDING * cells.len() as f64;
        let none = [Fixed::default(); 3];
        let is_lit =
            |&&class: &&Class| self.cells.iter().flatten().any(|sums| sums[class as usize] != none);
        let of = |&class: &Class| ClassShare {
            class,
            energy: if light == 0.0 { 0.0 } else { energy[class as usize] / light },
            variance: is_noisy.then(|| covariance[class as usize] / noise),
        };
        (cells.len(), Class::ALL.iter().filter(is_lit).map(of).collect())
    }
}

/// Means of one pixel, by class and channel.
struct CellMeans {
    /// Over all samples.
    mean: [[f64; 3]; Class::COUNT],
    /// For each replicate that has samples.
    replicates: Vec<[[f64; 3]; Class::COUNT]>,
}

impl CellMeans {
    fn new(cell: &CellSums, pixel: &PixelSums) -> Self {
        let sums = cell.map(|classes| classes.map(|channels| channels.map(Fixed::to_f64)));
        let mut mean = [[0.0; 3]; Class::COUNT];
        let mut replicates = Vec::new();
        let samples: u64 = (0..REPLICATES).map(|k| pixel.samples_of(k)).sum();
        for (k, sums) in sums.iter().enumerate() {
            let n = pixel.samples_of(k);
            if n > 0 {
                replicates.push(sums.map(|channels| channels.map(|sum| sum / n as f64)));
            }
            for (mean, sum) in mean.as_flattened_mut().iter_mut().zip(sums.as_flattened()) {
                *mean += sum / samples.max(1) as f64;
            }
        }
        Self { mean, replicates }
    }

    /// Adds the weighted covariance of each class with the image.
    fn add_covariances(&self, image_mean: f64, covariance: &mut [f64; Class::COUNT]) {
        let n = self.replicates.len() as f64;
        let mut middle = [[0.0; 3]; Class::COUNT];
        for replicate in &self.replicates {
            for (mean, value) in middle.as_flattened_mut().iter_mut().zip(replicate.as_flattened())
            {
                *mean += value / n;
            }
        }
        let (image, image_middle) = (total(&self.mean), total(&middle));
        for replicate in &self.replicates {
            let of_image = total(replicate);
            for c in 0..3 {
                let floor = 0.1 * image_mean;
                let denominator = image[c] * image[c] + floor * floor;
                if denominator > 0.0 {
                    let weight = (of_image[c] - image_middle[c]) / denominator;
                    for (k, covariance) in covariance.iter_mut().enumerate() {
                        *covariance += (replicate[k][c] - middle[k][c]) * weight;
                    }
                }
            }
        }
    }
}

/// All classes together.
fn total(classes: &[[f64; 3]; Class::COUNT]) -> [f64; 3] {
    [0, 1, 2].map(|c| classes.iter().map(|class| class[c]).sum())
}

/// Rec. 709.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Region;

    /// (pixel, sample, light of the sun, light of the mirror).
    fn shares(samples: &[(u32, u64, f32, f32)]) -> Vec<ClassShare> {
        let (start, end) = ([0, 0], [2, 1]);
        let mut film = Film::new(Region { start, end });
        let mut classes = ClassFilm::new(Watch::new(start, end, 2), 1);
        for &(cell, sample, sun, mirror) in samples {
            film.add([cell, 0], sample, Rgb::splat(sun + mirror), 1.0);
            for (class, light) in [(Class::DirectSun, sun), (Class::Mirror, mirror)] {
                let radiance = Rgb::splat(light);
                classes.add(&[ClassSample { cell, sample, class, radiance }]);
            }
        }
        let (pixels, shares) = classes.shares(&film);
        assert_eq!(pixels, 2);
        shares
    }

    #[test]
    fn energy_and_noise_go_to_whom_they_belong() {
        // The sun is steady, the mirror is not.
        let steady = (0..8).map(|s| ((s / 4) as u32, s % 4, 3.0, (s % 2) as f32 * 2.0));
        let shares = shares(&steady.collect::<Vec<_>>());
        assert_eq!(shares.len(), 2);
        assert_eq!(shares[0].class, Class::DirectSun);
        assert!(
            (shares[0].energy - 0.75).abs() < 1e-12 && shares[0].variance.unwrap().abs() < 1e-12
        );
        assert!((shares[1].energy - 0.25).abs() < 1e-12);
        assert!((shares[1].variance.unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn light_is_that_of_all_samples_whatever_their_number() {
        // The fifth sample makes a replicate of two: means of replicates would weigh it half.
        let samples = (0..10).map(|s| ((s / 5) as u32, s % 5, 1.0, ((s % 5) == 4) as u8 as f32));
        let shares = shares(&samples.collect::<Vec<_>>());
        assert!((shares[1].energy - 1.0 / 6.0).abs() < 1e-12, "{shares:?}");
    }

    #[test]
    fn one_sample_says_nothing_of_noise() {
        let shares = shares(&[(0, 0, 1.0, 0.0), (1, 0, 1.0, 2.0)]);
        assert!(shares.iter().all(|share| share.variance.is_none()), "{shares:?}");
    }

    #[test]
    fn what_cancels_noise_has_a_negative_share() {
        // Twice up and once down: the image goes up by one where the sun goes up by two.
        let values = [(0.0, 2.0), (2.0, 1.0), (0.0, 2.0), (2.0, 1.0)];
        let samples = (0..4).map(|s| (0, s, values[s as usize].0, values[s as usize].1));
        let shares = shares(&samples.collect::<Vec<_>>());
        assert!((shares[0].variance.unwrap() - 2.0).abs() < 1e-12, "{shares:?}");
        assert!((shares[1].variance.unwrap() + 1.0).abs() < 1e-12, "{shares:?}");
    }
}
