//! A pyramid of ever smaller versions of an image, looked up at the size of the ray's footprint.
//!
//! Source: L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983. Levels are box-filtered in linear light,
//! each from the unrounded one before, and stored as compactly as the image: 8 bits stay 8 bits. All
//! levels together take a third more memory than the image alone.

use crate::image::{Image, Pixels, srgb};
use crate::math::{Rgb, fun};
use rayon::prelude::*;
use std::f32::consts::LN_2;
use std::sync::Arc;

/// What lies beyond the edge of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The edge's texels.
    Clamp,
}

/// An image with its smaller versions, down to one texel.
#[derive(Clone, Debug)]
pub struct MipMap {
    /// The image itself, shared with whoever read it.
    finest: Arc<Image>,
    /// Level i + 1 has half the sides of level i, rounded down, at least 1.
    coarser: Vec<Image>,
    average: [f32; 4],
}

impl MipMap {
    /// Builds every level of `image`.
    pub fn new(image: Arc<Image>) -> Self {
        let mut coarser = Vec::new();
        let mut level = Level::halved(image.width(), image.height(), |x, y| {
            let (color, alpha) = image.texel(x, y);
            [color.r, color.g, color.b, alpha]
        });
        coarser.push(level.stored_like(&image));
        while level.width.max(level.height) > 1 {
            let Level { width, height, texels } = level;
            level = Level::halved(width, height, |x, y| {
                texels[y as usize * width as usize + x as usize]
            });
            coarser.push(level.stored_like(&image));
        }
        Self { finest: image, coarser, average: level.texels[0] }
    }

    /// Linear colour and alpha at `uv`, v upward (0 is the bottom edge of the image), averaged over a
    /// footprint `footprint` wide in units of uv.
    ///
    /// Up to a texel's width the finest level is interpolated bilinearly; beyond it the two levels next to
    /// the footprint's size, and between them: choosing one alone would draw a line where the choice
    /// changes. The size is measured along the shorter side of the image, so that a footprint never blurs
    /// beyond itself: what is left is for the samples to average. Non-finite coordinates count as 0, a
    /// non-finite footprint as a point.
    #[inline]
    pub fn lookup(&self, uv: [f32; 2], footprint: f32, wrap: Wrap) -> (Rgb, f32) {
        let texels = footprint * self.finest.width().min(self.finest.height()) as f32;
        // A NaN fails the comparison.
        let blurred = texels > 1.0 && texels < f32::INFINITY;
        if blurred { self.trilinear(uv, texels, wrap) } else { bilinear(&self.finest, uv, wrap) }
    }

    /// Interpolated between levels for a footprint of `texels` > 1 texels of the finest one.
    fn trilinear(&self, uv: [f32; 2], texels: f32, wrap: Wrap) -> (Rgb, f32) {
        let level = (fun::ln(texels) / LN_2).min(self.coarser.len() as f32);
        let lower = level as usize;
        let fraction = level - lower as f32;
        let (color, alpha) = bilinear(self.level(lower), uv, wrap);
        if fraction == 0.0 {
            return (color, alpha);
        }
        let (upper_color, upper_alpha) = bilinear(self.level(lower + 1), uv, wrap);
        (color.lerp(upper_color, fraction), alpha + (upper_alpha - alpha) * fraction)
    }

    /// Level `i`; 0 is the image.
    fn level(&self, i: usize) -> &Image {
        if i == 0 { &self.finest } else { &self.coarser[i - 1] }
    }

    /// The image that the pyramid was built from.
    pub fn image(&self) -> &Image {
        &self.finest
    }

    /// Mean linear colour of the whole image, not rounded to the storage.
    pub fn average(&self) -> Rgb {
        let [r, g, b, _] = self.average;
        Rgb::new(r, g, b)
    }

    /// Mean alpha of the whole image.
    pub fn average_alpha(&self) -> f32 {
        self.average[3]
    }

    /// Bytes of memory of all levels, the image included.
    pub fn bytes(&self) -> usize {
        let coarser: usize = self.coarser.iter().map(|level| level.pixels().bytes()).sum();
        self.finest.pixels().bytes() + coarser
    }
}

/// The four texels around `uv`, weighted by their distance.
#[inline]
fn bilinear(image: &Image, [u, v]: [f32; 2], wrap: Wrap) -> (Rgb, f32) {
    let (x0, x1, fx) = neighbours(u, image.width(), wrap);
    let (y0, y1, fy) = neighbours(v, image.height(), wrap);
    // Rows count from the top, v from the bottom.
    let (y0, y1) = (image.height() - 1 - y0, image.height() - 1 - y1);
    let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
    let texels = [(x0, y0), (x1, y0), (x0, y1), (x1, y1)];
    let mut sum = (Rgb::BLACK, 0.0);
    for (weight, (x, y)) in weights.into_iter().zip(texels) {
        let (color, alpha) = image.texel(x, y);
        sum.0 += color * weight;
        sum.1 += alpha * weight;
    }
    sum
}

/// The texels whose centres enclose the coordinate `t` on an axis of `n`, and how far it is from the first
/// to the second, in [0, 1).
#[inline]
fn neighbours(t: f32, n: u32, wrap: Wrap) -> (u32, u32, f32) {
    let t = if t.is_finite() { t } else { 0.0 };
    let t = match wrap {
        Wrap::Repeat => t - t.floor(),
        Wrap::Clamp => t.clamp(0.0, 1.0),
    };
    // In texels from the centre before the first one, so that truncation rounds down.
    let position = t * n as f32 + 0.5;
    let upper = (position as u32).min(n);
    let fraction = position - upper as f32;
    let before_first = if wrap == Wrap::Repeat { n - 1 } else { 0 };
    let after_last = if wrap == Wrap::Repeat { 0 } else { n - 1 };
    let lower = if upper == 0 { before_first } else { upper - 1 };
    (lower, if upper == n { after_last } else { upper }, fraction)
}

/// A level of the pyramid while it is built: red, green, blue, alpha in linear floats.
struct Level {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
}

impl Level {
    /// Half the size of the picture whose texels `fetch` returns, each texel the mean of what it covers.
    fn halved(width: u32, height: u32, fetch: impl Fn(u32, u32) -> [f32; 4] + Sync) -> Self {
        let (new_width, new_height) = ((width / 2).max(1), (height / 2).max(1));
        let mut texels = vec![[0.0; 4]; new_width as usize * new_height as usize];
        texels.par_chunks_mut(new_width as usize).zip(0..new_height).for_each(|(row, y)| {
            for (texel, x) in row.iter_mut().zip(0..) {
                for (source_y, weight_y) in covered(y, height) {
                    for (source_x, weight_x) in covered(x, width) {
                        let source = fetch(source_x, source_y);
                        for (sum, value) in texel.iter_mut().zip(source) {
                            *sum += weight_x * weight_y * value;
                        }
                    }
                }
            }
        });
        Self { width: new_width, height: new_height, texels }
    }

    /// The level as an image in the storage of `image`.
    fn stored_like(&self, image: &Image) -> Image {
        let round = |value: f32| (value * 255.0).round() as u8;
        let pixels = match image.pixels() {
            Pixels::Srgb8(_) => {
                let encode = |&[r, g, b, a]: &[f32; 4]| {
                    [srgb::encode8(r), srgb::encode8(g), srgb::encode8(b), round(a)]
                };
                Pixels::Srgb8(self.texels.par_iter().map(encode).collect())
            }
            Pixels::Linear8(_) => {
                Pixels::Linear8(self.texels.iter().map(|t| t.map(round)).collect())
            }
            Pixels::Grey8(_) => Pixels::Grey8(self.texels.iter().map(|t| round(t[0])).collect()),
            Pixels::Float(_) => {
                Pixels::Float(self.texels.iter().map(|&[r, g, b, _]| Rgb::new(r, g, b)).collect())
            }
            Pixels::FloatAlpha(_) => Pixels::FloatAlpha(self.texels.clone()),
        };
        Image::new(self.width, self.height, pixels, image.has_alpha())
            .expect("a level has width times height texels, at least one")
    }
}

/// Of an axis of `n` texels halved to n/2: those that new texel `i` covers, with their shares of it. An
/// even axis has pairs; of an odd one each new texel covers 2 + 2/(n-1) texels; one texel stays itself.
fn covered(i: u32, n: u32) -> impl Iterator<Item = (u32, f32)> {
    let shares = match n {
        1 => [1.0, 0.0, 0.0],
        n if n % 2 == 0 => [0.5, 0.5, 0.0],
        n => [n / 2 - i, n / 2, i + 1].map(|covered| covered as f32 / n as f32),
    };
    (2 * i..).zip(shares).filter(|&(_, share)| share > 0.0)
}
