//! A region of an image, and the developed pixels of one.

use crate::math::Rgb;

/// A rectangle of pixels, `start` inclusive and `end` exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left and top.
    pub start: [u32; 2],
    /// One past right and bottom.
    pub end: [u32; 2],
}

impl Region {
    /// The whole of an image.
    pub const fn full([width, height]: [u32; 2]) -> Self {
        Self { start: [0, 0], end: [width, height] }
    }

    /// Pixels a row.
    pub const fn width(&self) -> u32 {
        self.end[0] - self.start[0]
    }

    /// Rows.
    pub const fn height(&self) -> u32 {
        self.end[1] - self.start[1]
    }

    /// Number of pixels.
    pub const fn pixels(&self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// Row-major place of a pixel, given in image coordinates.
    #[inline]
    pub const fn index(&self, [x, y]: [u32; 2]) -> usize {
        (y - self.start[1]) as usize * self.width() as usize + (x - self.start[0]) as usize
    }

    /// Every pixel, row by row, in image coordinates.
    pub fn iter(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Self { start, end } = *self;
        (start[1]..end[1]).flat_map(move |y| (start[0]..end[0]).map(move |x| [x, y]))
    }

    /// Cuts it into tiles of at most `size` x `size` pixels, row by row.
    pub fn tiles(&self, size: u32) -> Vec<Self> {
        let Self { start, end } = *self;
        let mut tiles = Vec::new();
        for y in (start[1]..end[1]).step_by(size as usize) {
            for x in (start[0]..end[0]).step_by(size as usize) {
                tiles.push(Self {
                    start: [x, y],
                    end: [(x + size).min(end[0]), (y + size).min(end[1])],
                });
            }
        }
        tiles
    }
}

/// A developed picture: row-major over its region.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// What it covers.
    pub region: Region,
    /// Mean radiance, linear Rec. 709.
    pub radiance: Vec<Rgb>,
    /// Share of the pixel that surfaces cover, in [0, 1].
    pub alpha: Vec<f32>,
    /// Variance of the mean radiance, a channel.
    pub variance: Vec<Rgb>,
}

impl Pixels {
    /// All black and transparent.
    pub fn black(region: Region) -> Self {
        let n = region.pixels();
        Self {
            region,
            radiance: vec![Rgb::BLACK; n],
            alpha: vec![0.0; n],
            variance: vec![Rgb::BLACK; n],
        }
    }

    /// The pixels, in image coordinates, whose radiance or alpha differs in any bit from those of another picture of
    /// the same region.
    pub fn differing(&self, other: &Self) -> Vec<[u32; 2]> {
        let bits = |picture: &Self, i: usize| {
            (picture.radiance[i].to_array().map(f32::to_bits), picture.alpha[i].to_bits())
        };
        let pixels = self.region.iter().enumerate();
        pixels.filter(|&(i, _)| bits(self, i) != bits(other, i)).map(|(_, pixel)| pixel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_that_differ_in_any_bit_are_found_where_they_are() {
        let region = Region { start: [2, 3], end: [5, 7] };
        let black = Pixels::black(region);
        assert!(black.differing(&black).is_empty());
        let mut other = black.clone();
        other.radiance[region.index([4, 3])].b = -0.0;
        other.alpha[region.index([2, 6])] = f32::from_bits(1);
        // What the pixel shows is compared, not how sure it is.
        other.variance[0] = Rgb::WHITE;
        assert_eq!(black.differing(&other), [[4, 3], [2, 6]]);
    }
}
