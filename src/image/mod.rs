//! Images: decoded pictures for textures and environments, and files written for the user.
//!
//! A decoded picture keeps its 8 bits in memory and is decoded to linear light on lookup, so that a scene's
//! textures take a quarter of what floats would. Knows nothing of scenes, materials or films.

mod atomic;
mod exr;
mod open;
mod read;
pub mod srgb;
mod tonemap;
mod write;

pub use self::exr::{Attribute, ExrImage, Samples, read_exr_channels, write_exr};
pub use atomic::{check_writable, write_whole};
pub use open::open_regular;
pub use read::{ColorSpace, MAX_BYTES, MAX_SIDE, is_radiance, read};
pub use tonemap::{ToneMap, auto_exposure, develop};
pub use write::{write_hdr, write_png};

use crate::math::Rgb;

/// Texels in the most compact form that holds what the file says; row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// sRGB-encoded colour and linear alpha, 4 bytes a texel.
    Srgb8(Vec<[u8; 4]>),
    /// Linear data in four channels (normal maps, packed data), 4 bytes a texel.
    Linear8(Vec<[u8; 4]>),
    /// Linear grey without alpha (opacity, roughness and height maps), 1 byte a texel.
    Grey8(Vec<u8>),
    /// Linear floats without alpha (HDR, EXR and 16-bit files), 12 bytes a texel.
    Float(Vec<Rgb>),
    /// Linear floats with alpha, 16 bytes a texel.
    FloatAlpha(Vec<[f32; 4]>),
}

impl Pixels {
    /// Number of texels.
    pub fn len(&self) -> usize {
        match self {
            Self::Srgb8(p) | Self::Linear8(p) => p.len(),
            Self::Grey8(p) => p.len(),
            Self::Float(p) => p.len(),
            Self::FloatAlpha(p) => p.len(),
        }
    }

    /// Whether there is no texel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Srgb8(p) | Self::Linear8(p) => size_of_val(p.as_slice()),
            Self::Grey8(p) => size_of_val(p.as_slice()),
            Self::Float(p) => size_of_val(p.as_slice()),
            Self::FloatAlpha(p) => size_of_val(p.as_slice()),
        }
    }
}

/// A decoded picture of at least one texel.
///
/// Alpha is a channel like the others: colour is not multiplied by it here, whatever the file meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Pixels,
    has_alpha: bool,
}

impl Image {
    /// A picture from its texels, row-major, top row first; `None` unless there are `width * height` of
    /// them, at least one. Without `has_alpha` every alpha must be opaque.
    pub fn new(width: u32, height: u32, pixels: Pixels, has_alpha: bool) -> Option<Self> {
        let texels = width as usize * height as usize;
        (texels > 0 && pixels.len() == texels).then_some(Self { width, height, pixels, has_alpha })
    }

    /// The visible stand-in for an image that cannot be read: one magenta texel.
    pub fn missing() -> Self {
        Self {
            width: 1,
            height: 1,
            pixels: Pixels::Srgb8(vec![[255, 0, 255, 255]]),
            has_alpha: false,
        }
    }

    /// Texels a row, at least 1.
    #[inline]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows, at least 1.
    #[inline]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The texels, row-major, top row first.
    #[inline]
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// Whether the file has an alpha channel that is not opaque everywhere.
    #[inline]
    pub fn has_alpha(&self) -> bool {
        self.has_alpha
    }

    /// Linear colour and alpha (1 where there is none) of column `x` from the left and row `y` from the
    /// top. Both must be in range.
    #[inline]
    pub fn texel(&self, x: u32, y: u32) -> (Rgb, f32) {
        debug_assert!(x < self.width && y < self.height);
        let i = y as usize * self.width as usize + x as usize;
        match &self.pixels {
            Pixels::Srgb8(p) => decode_srgb(p[i]),
            Pixels::Linear8(p) => decode_linear(p[i]),
            Pixels::Grey8(p) => (Rgb::splat(unit(p[i])), 1.0),
            Pixels::Float(p) => (p[i], 1.0),
            Pixels::FloatAlpha(p) => decode_float(p[i]),
        }
    }

    /// Replaces what no light and no surface can be: what is negative or NaN by 0, and infinity by 65504, the largest
    /// number of the half floats that it overflowed from. Returns the number of texels that had any.
    pub fn replace_impossible(&mut self) -> usize {
        const LARGEST_HALF: f32 = 65504.0;
        let repair = |channels: &mut [f32]| {
            let is_possible = |c: f32| (0.0..f32::INFINITY).contains(&c);
            let broken = channels.iter().any(|&c| !is_possible(c));
            for c in channels.iter_mut().filter(|c| !is_possible(**c)) {
                *c = if *c == f32::INFINITY { LARGEST_HALF } else { 0.0 };
            }
            usize::from(broken)
        };
        match &mut self.pixels {
            Pixels::Srgb8(_) | Pixels::Linear8(_) | Pixels::Grey8(_) => 0,
            Pixels::Float(p) => {
                p.iter_mut().map(|p| repair(bytemuck::cast_mut::<Rgb, [f32; 3]>(p))).sum()
            }
            Pixels::FloatAlpha(p) => p.iter_mut().map(|p| repair(p)).sum(),
        }
    }
}

#[inline]
fn decode_srgb([r, g, b, a]: [u8; 4]) -> (Rgb, f32) {
    let linear = |code: u8| srgb::LINEAR[usize::from(code)];
    (Rgb::new(linear(r), linear(g), linear(b)), unit(a))
}

#[inline]
fn decode_linear(texel: [u8; 4]) -> (Rgb, f32) {
    let [r, g, b, a] = texel.map(unit);
    (Rgb::new(r, g, b), a)
}

#[inline]
fn decode_float([r, g, b, a]: [f32; 4]) -> (Rgb, f32) {
    (Rgb::new(r, g, b), a)
}

/// An 8-bit linear value as a fraction; 255 is exactly 1.
#[inline]
fn unit(value: u8) -> f32 {
    f32::from(value) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_storage_is_looked_up_in_linear_light() {
        let expect = |pixels, has_alpha, color: Rgb, alpha| {
            let image = Image::new(2, 1, pixels, has_alpha).unwrap();
            assert_eq!(image.texel(1, 0), (color, alpha));
        };
        let texel = [0, 51, 255, 102];
        let linear = Rgb::new(0.0, 0.2, 1.0);
        expect(Pixels::Srgb8(vec![[9; 4], texel]), true, linear.map(srgb::decode), 0.4);
        expect(Pixels::Linear8(vec![[9; 4], texel]), true, linear, 0.4);
        expect(Pixels::Grey8(vec![9, 51]), false, Rgb::splat(0.2), 1.0);
        expect(Pixels::Float(vec![Rgb::BLACK, linear]), false, linear, 1.0);
        expect(Pixels::FloatAlpha(vec![[9.0; 4], [0.0, 0.2, 1.0, 0.4]]), true, linear, 0.4);
    }

    #[test]
    fn sizes_must_agree() {
        assert!(Image::new(2, 2, Pixels::Grey8(vec![0; 3]), false).is_none());
        assert!(Image::new(0, 2, Pixels::Grey8(vec![]), false).is_none());
        assert_eq!(Image::missing().texel(0, 0).0, Rgb::new(1.0, 0.0, 1.0));
    }

    #[test]
    fn bytes_are_those_of_the_storage() {
        assert_eq!(Pixels::Grey8(vec![0; 10]).bytes(), 10);
        assert_eq!(Pixels::Srgb8(vec![[0; 4]; 10]).bytes(), 40);
        assert_eq!(Pixels::Float(vec![Rgb::BLACK; 10]).bytes(), 120);
        assert_eq!(Pixels::FloatAlpha(vec![[0.0; 4]; 10]).bytes(), 160);
    }

    #[test]
    fn impossible_texels_are_replaced_and_counted() {
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        let texels = vec![Rgb::new(nan, 1.0, inf), Rgb::new(-2.0, -inf, 0.0), Rgb::WHITE];
        let mut image = Image::new(3, 1, Pixels::Float(texels), false).unwrap();
        assert_eq!(image.replace_impossible(), 2);
        assert_eq!(image.texel(0, 0).0, Rgb::new(0.0, 1.0, 65504.0));
        assert_eq!(image.texel(1, 0).0, Rgb::BLACK);
        assert_eq!(image.replace_impossible(), 0);
    }
}
