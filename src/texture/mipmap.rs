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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    fn grey(width: u32, height: u32, texels: impl Iterator<Item = f32>) -> MipMap {
        let pixels = Pixels::Float(texels.map(Rgb::splat).collect());
        MipMap::new(Arc::new(Image::new(width, height, pixels, false).unwrap()))
    }

    #[test]
    fn up_is_v_and_centres_are_exact() {
        // Top row 1 2 3, bottom row 4 5 6.
        let map = grey(3, 2, (1..7).map(|v| v as f32));
        let at = |u: f32, v: f32| map.lookup([u, v], 0.0, Wrap::Clamp).0.r;
        assert!((at(0.5 / 3.0, 0.25) - 4.0).abs() < 1e-6);
        assert!((at(2.5 / 3.0, 0.75) - 3.0).abs() < 1e-6);
        assert!((at(0.5, 0.5) - 3.5).abs() < 1e-6);
        assert_eq!((at(0.0, 0.0), at(1.0, 1.0), at(-9.0, 9.0)), (4.0, 3.0, 1.0));
    }

    #[test]
    fn wraps() {
        let map = grey(2, 1, [0.0, 1.0].into_iter());
        let at = |u: f32, wrap| map.lookup([u, 0.5], 0.0, wrap).0.r;
        assert_eq!([at(0.0, Wrap::Repeat), at(1.0, Wrap::Repeat)], [0.5; 2]);
        assert_eq!([at(0.0, Wrap::Clamp), at(1.0, Wrap::Clamp)], [0.0, 1.0]);
        for i in -40..40 {
            let u = i as f32 * 0.0625;
            assert_eq!(at(u, Wrap::Repeat), at(u + 3.0, Wrap::Repeat));
        }
    }

    /// Bilinear interpolation is continuous across the edges of texels and of the image.
    #[test]
    fn continuous() {
        let mut rng = CounterRng::new(0);
        let map = grey(7, 5, std::iter::repeat_with(move || rng.unit()).take(35));
        for footprint in [0.0, 0.3, 0.7] {
            for wrap in [Wrap::Repeat, Wrap::Clamp] {
                let at = |i: i32| {
                    map.lookup([i as f32 * 1e-3 - 2.0, i as f32 * 7e-4], footprint, wrap).0.r
                };
                for i in 0..4000 {
                    assert!((at(i + 1) - at(i)).abs() < 0.02);
                }
            }
        }
    }

    #[test]
    fn any_coordinate_is_safe() {
        let map = grey(5, 3, (0..15).map(|v| v as f32));
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, -1e-9, f32::MAX, 0.3];
        for u in odd {
            for v in odd {
                for footprint in odd {
                    for wrap in [Wrap::Repeat, Wrap::Clamp] {
                        let (color, alpha) = map.lookup([u, v], footprint, wrap);
                        assert!((0.0..=14.0).contains(&color.r), "{u} {v} {footprint}");
                        assert!((alpha - 1.0).abs() < 1e-6);
                    }
                }
            }
        }
    }

    /// Every level of every size has the mean of the image, so a box filter loses and invents no light.
    #[test]
    fn levels_keep_the_mean() {
        let mut rng = CounterRng::new(0);
        for (width, height) in
            [(1, 1), (2, 2), (3, 3), (7, 5), (1, 13), (64, 1), (100, 37), (255, 129)]
        {
            let texels: Vec<f32> = (0..width * height).map(|_| rng.unit()).collect();
            let mean = texels.iter().sum::<f32>() / texels.len() as f32;
            let map = grey(width, height, texels.into_iter());
            assert!((map.average().g - mean).abs() < 1e-5, "{width} x {height}");
            assert_eq!(map.average_alpha(), 1.0);
            for level in &map.coarser {
                let Pixels::Float(texels) = level.pixels() else { panic!("storage changed") };
                let sum: f32 = texels.iter().map(|c| c.g).sum();
                assert!((sum / texels.len() as f32 - mean).abs() < 1e-5, "{width} x {height}");
            }
            let wide = map.lookup([0.3, 0.9], 1e9, Wrap::Repeat).0.g;
            assert!((wide - mean).abs() < 1e-5);
        }
    }

    /// Averaging is in linear light: half black and half white is 0.5, which sRGB encodes as 188.
    #[test]
    fn eight_bits_stay_eight_bits_in_linear_light() {
        let texels =
            (0..64 * 64).map(|i| if i % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] }).collect();
        let image = Image::new(64, 64, Pixels::Srgb8(texels), false).unwrap();
        let map = MipMap::new(Arc::new(image));
        assert_eq!(map.average(), Rgb::splat(0.5));
        assert_eq!(*map.coarser[2].pixels(), Pixels::Srgb8(vec![[188, 188, 188, 255]; 64]));
        // 64^2 + 32^2 + ... + 1 texels of 4 bytes: a third more than the image.
        assert_eq!(map.bytes(), 4 * 5461);
        assert_eq!(map.image().width(), 64);
    }

    /// A constant texture is the same constant at every level, to the bit of its storage.
    #[test]
    fn constants_stay() {
        for code in 0..=255_u8 {
            let texels = vec![[code, code, code, 255 - code]; 6 * 11];
            for pixels in [Pixels::Srgb8(texels.clone()), Pixels::Linear8(texels)] {
                let map = MipMap::new(Arc::new(Image::new(6, 11, pixels, true).unwrap()));
                let first = map.finest.texel(0, 0);
                assert!(map.coarser.iter().all(|level| level.texel(0, 0) == first));
            }
        }
    }

    /// The footprint chooses the level: stripes one texel wide are kept at a point and gone at two texels,
    /// and the change between is continuous.
    #[test]
    fn footprint_blurs() {
        let map = grey(64, 64, (0..64 * 64).map(|i| (i % 2) as f32));
        let contrast = |texels: f32| {
            let at = |x: f32| map.lookup([x / 64.0, 0.5], texels / 64.0, Wrap::Repeat).0.r;
            at(1.5) - at(0.5)
        };
        assert_eq!((contrast(0.0), contrast(1.0), contrast(2.0)), (1.0, 1.0, 0.0));
        assert!((contrast(fun::pow(2.0, 0.25)) - 0.75).abs() < 1e-5);
        assert!(contrast(1.001) > 0.998);
    }
}
