//! A drawing as pixels: 8 x 8 samples in each, one bit a sample, so that dots that overlap are one and their
//! order does not matter. What is covered is mixed with the paper in linear light. Knows nothing of files.

use super::{Dot, Drawing};
use crate::error::{Error, Result};
use crate::image::srgb;
use rayon::prelude::*;

/// The most pixels of a picture of a drawing.
pub const MAX_PIXELS: u64 = 1 << 28;

/// Dots that would cover the paper more often than this are refused: they would take their time and show
/// nothing.
const MOST_COVERINGS: f64 = 64.0;

/// Samples along a side of a pixel. The eight bits of a byte are those of a pixel in one row of samples.
const SAMPLES: usize = 8;

/// Rows of pixels that are drawn by one thread at a time.
const BAND: usize = 16;

impl Drawing {
    /// sRGB-encoded greys of `scale` pixels for each of the picture's, along each side; row-major, top row
    /// first.
    ///
    /// # Errors
    /// A usage error for more than [`MAX_PIXELS`], and for dots so large that together they have 64 times the
    /// area of the paper.
    pub fn pixels(&self, scale: u32) -> Result<Vec<[u8; 1]>> {
        Self::check_scale(self.size, scale)?;
        Self::check_coverings(
            self.size,
            self.dots.iter().map(|dot| dot.radius * dot.radius).sum(),
        )?;
        let [width, height] = self.size.map(|side| side as usize * scale as usize);
        let factor = f64::from(scale) * SAMPLES as f64;
        let in_samples = |dot: &Dot| Disc {
            centre: dot.centre.map(|x| x * factor),
            radius: dot.radius * factor,
        };
        let discs: Vec<_> = self.dots.iter().map(in_samples).collect();

        // Which discs touch which band.
        let rows = BAND * SAMPLES;
        let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
        for (disc, index) in discs.iter().zip(0_u32..) {
            let [first, end] = disc.rows(height * SAMPLES);
            if first < end {
                bands[first / rows..=(end - 1) / rows].iter_mut().for_each(|b| b.push(index));
            }
        }

        let greys = self.greys();
        let mut pixels = vec![[0]; width * height];
        pixels.par_chunks_mut(width.max(1) * BAND).zip(&bands).enumerate().for_each(
            |(band, (pixels, touching))| {
                let top = band * rows;
                let mut bits = vec![0_u8; pixels.len() * SAMPLES];
                for disc in touching.iter().map(|&i| &discs[i as usize]) {
                    let [first, end] = disc.rows(top + bits.len() / width);
                    for y in first.max(top)..end {
                        let row = &mut bits[(y - top) * width..][..width];
                        disc.cover(y, row);
                    }
                }
                for (row, bits) in
                    pixels.chunks_exact_mut(width).zip(bits.chunks_exact(width * SAMPLES))
                {
                    for (x, pixel) in row.iter_mut().enumerate() {
                        let ones = |y: usize| bits[y * width + x].count_ones() as usize;
                        *pixel = [greys[(0..SAMPLES).map(ones).sum::<usize>()]];
                    }
                }
            },
        );
        Ok(pixels)
    }

    /// # Errors
    /// A usage error where paper of `size` has more than [`MAX_PIXELS`] at `scale`.
    pub fn check_scale(size: [u32; 2], scale: u32) -> Result<()> {
        let [width, height] = size.map(|side| u128::from(side) * u128::from(scale));
        if (1..=u128::from(MAX_PIXELS)).contains(&(width * height)) {
            return Ok(());
        }
        let message = format!(
            "--scale {scale}: {width}x{height} pixels are too many or none; at most {MAX_PIXELS} can \
             be drawn, or write .svg only"
        );
        Err(Error::Usage(message))
    }

    /// # Errors
    /// A usage error where dots whose squared radii add up to `squares` have 64 times the area of the paper.
    pub fn check_coverings(size: [u32; 2], squares: f64) -> Result<()> {
        let [width, height] = size.map(f64::from);
        // Three is nearly pi. A NaN is not below anything.
        if 3.0 * squares <= MOST_COVERINGS * width * height {
            return Ok(());
        }
        let message = format!(
            "--radius: the dots would cover the paper {MOST_COVERINGS} times over; make them smaller"
        );
        Err(Error::Usage(message))
    }

    /// The code of a pixel by how many of its samples are covered.
    fn greys(&self) -> [u8; SAMPLES * SAMPLES + 1] {
        let all = (SAMPLES * SAMPLES) as f32;
        std::array::from_fn(|covered| {
            let ink = covered as f32 / all;
            srgb::encode8(if self.inverted { ink } else { 1.0 - ink })
        })
    }
}

/// A dot in units of samples; sample i is at i + 1/2.
struct Disc {
    centre: [f64; 2],
    radius: f64,
}

impl Disc {
    /// The rows of samples that it may touch, below `end`.
    fn rows(&self, end: usize) -> [usize; 2] {
        let y = self.centre[1];
        // Casts saturate.
        [(y - self.radius).max(0.0) as usize, ((y + self.radius).max(0.0) as usize + 1).min(end)]
    }

    /// Sets the bits of the samples of row `y` whose centres it covers.
    fn cover(&self, y: usize, row: &mut [u8]) {
        let dy = y as f64 + 0.5 - self.centre[1];
        let square = self.radius * self.radius - dy * dy;
        if square < 0.0 {
            return;
        }
        let half = square.sqrt();
        let first = |x: f64| (x - 0.5).ceil().max(0.0) as usize;
        let start = first(self.centre[0] - half);
        let end = first(self.centre[0] + half).min(row.len() * SAMPLES);
        if start < end {
            set(row, start, end);
        }
    }
}

/// Sets the bits `start..end`, at least one.
fn set(row: &mut [u8], start: usize, end: usize) {
    let (first, last) = (start / SAMPLES, (end - 1) / SAMPLES);
    let from = 0xff << (start % SAMPLES);
    let to = 0xff >> (SAMPLES - 1 - (end - 1) % SAMPLES);
    if first == last {
        row[first] |= from & to;
    } else {
        row[first] |= from;
        row[first + 1..last].fill(0xff);
        row[last] |= to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing(dots: &[(f64, f64, f64)]) -> Drawing {
        let dot = |&(x, y, radius): &(f64, f64, f64)| Dot { centre: [x, y], radius };
        Drawing { size: [40, 30], dots: dots.iter().map(dot).collect(), inverted: true }
    }

    /// Area that is covered in square pixels of the picture. (White on black: light is what is covered.)
    fn area(drawing: &Drawing, scale: u32) -> f64 {
        let pixels = drawing.pixels(scale).unwrap();
        let light = pixels.iter().map(|p| f64::from(srgb::LINEAR[usize::from(p[0])]));
        light.sum::<f64>() / f64::from(scale * scale)
    }

    /// Bits against the definition: a sample is covered if its centre is within a radius of the dot's.
    #[test]
    fn samples_are_covered_by_the_dots_that_contain_them() {
        let dots = [(3.3, 4.7, 2.9), (5.0, 5.0, 0.5), (39.9, 29.5, 3.0), (20.0, -2.0, 4.1)];
        let pixels = drawing(&dots).pixels(1).unwrap();
        let greys = drawing(&dots).greys();
        for (y, x) in (0..30).flat_map(|y| (0..40).map(move |x| (y, x))) {
            let at = |i: usize, k: usize| i as f64 + (k as f64 + 0.5) / 8.0;
            let is_in = |(u, v): (usize, usize)| {
                let near = |&(cx, cy, r): &(f64, f64, f64)| {
                    (at(x, u) - cx).powi(2) + (at(y, v) - cy).powi(2) <= r * r
                };
                dots.iter().any(near)
            };
            let count = (0..64).filter(|i| is_in((i % 8, i / 8))).count();
            assert_eq!(pixels[y * 40 + x], [greys[count]], "{x}, {y}");
        }
    }

    #[test]
    fn areas_are_those_of_discs_and_overlap_counts_once() {
        let disc = |r: f64| std::f64::consts::PI * r * r;
        let close = |found: f64, exact: f64| {
            assert!((found / exact - 1.0).abs() < 0.01, "{found} for {exact}");
        };
        for scale in [1, 2, 3] {
            close(area(&drawing(&[(12.34, 20.1, 7.0)]), scale), disc(7.0));
            close(area(&drawing(&[(12.34, 20.1, 7.0), (12.34, 20.1, 7.0)]), scale), disc(7.0));
            close(
                area(&drawing(&[(9.0, 9.0, 5.0), (30.0, 20.0, 4.0)]), scale),
                disc(41_f64.sqrt()),
            );
            // A half and a quarter are off the paper.
            close(area(&drawing(&[(0.0, 15.0, 8.0)]), scale), disc(8.0) / 2.0);
            close(area(&drawing(&[(40.0, 30.0, 8.0)]), scale), disc(8.0) / 4.0);
        }
        close(area(&drawing(&[(20.0, 15.0, 90.0)]), 1), 1200.0);
        assert_eq!(area(&drawing(&[(-9.0, -9.0, 4.0), (99.0, 99.0, 9.0)]), 1), 0.0);
    }

    #[test]
    fn absurd_pictures_are_refused() {
        assert!(Drawing::check_scale([40, 30], 64).is_ok());
        for (size, scale) in [([40, 30], 0), ([0, 30], 1), ([30_000, 30_000], 1)] {
            assert!(Drawing::check_scale(size, scale).is_err(), "{size:?} {scale}");
        }
        for radius in [1e9, f64::NAN, f64::INFINITY] {
            assert!(drawing(&[(1.0, 1.0, radius)]).pixels(1).is_err());
        }
    }
}
