//! How dark a picture is where: 12-bit levels on the grid that cells are summed over, and points drawn from
//! them.
//!
//! Cells are sums over samples. Where pixels are too few for the points, each is cut into 4^k samples; where
//! they are far more than the points can show, 4^k are averaged into one texel. Knows nothing of cells'
//! shapes.

use super::lloyd::Cell;
use super::nearest::FRACTION;
use crate::math::{Rgb, fun};
use crate::sampling::hash::combine;
use rayon::prelude::*;

/// The level of black. Its square has 24 bits.
const BLACK: u32 = 4095;

/// A picture of no more pixels than this is never averaged.
const ENOUGH_TEXELS: u64 = 1 << 24;
/// As many texels a point are enough.
const ENOUGH_TEXELS_PER_POINT: u64 = 256;
/// Texels, and samples made by cutting, at most.
const MOST_SAMPLES: u64 = 1 << 26;
/// A cell in the black has at least as many samples, if pixels may be cut so far: of few, the centroid jumps.
const SAMPLES_PER_CELL: u64 = 64;
/// A side of a texel is cut into 2^4 samples at most.
const MOST_REFINEMENT: u32 = 4;

/// What counts as dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Luminance is raised to 1 / `gamma` before it is taken for the part of the paper that stays white. 1 is
    /// linear light.
    pub gamma: f32,
    /// Whether light is drawn on black paper, instead of shade on white.
    pub inverted: bool,
}

impl Tone {
    /// The part of the paper to cover, 0 to 1, for a linear colour, by which alpha is not multiplied. Where
    /// the picture is transparent the paper shows through.
    pub fn darkness(self, color: Rgb, alpha: f32) -> f32 {
        let luminance = color.luminance().clamp(0.0, 1.0);
        // The exponent of linear light must not cost a digit.
        let tone =
            if self.gamma == 1.0 { luminance } else { fun::pow(luminance, 1.0 / self.gamma) };
        alpha.clamp(0.0, 1.0) * if self.inverted { tone } else { 1.0 - tone }
    }
}

/// A density of points: the darkness of a picture.
#[derive(Clone, Debug)]
pub struct Density {
    /// Pixels of the picture.
    size: [u32; 2],
    /// Texels.
    columns: u32,
    rows: u32,
    /// A texel is 2^reduction pixels wide and high; the last ones may reach beyond the picture.
    reduction: u32,
    /// A texel is cut into 2^refinement by 2^refinement samples.
    refinement: u32,
    /// Level of each texel, row-major, 0 to [`BLACK`].
    levels: Vec<u16>,
    /// Sum of the levels.
    total: u64,
}

impl Density {
    /// The density of a picture of `width` by `height` pixels with `darkness(x, y)` from 0 to 1 (which it is
    /// clamped to; NaN is 0), on a grid that is fine enough for so many points. `None` if there is nothing
    /// dark in it.
    pub fn new(
        [width, height]: [u32; 2],
        points: usize,
        darkness: impl Fn(u32, u32) -> f32 + Sync,
    ) -> Option<Self> {
        let texels = |k: u32| [width, height].map(|side| side.div_ceil(1 << k));
        let count = |k| texels(k).iter().map(|&side| u64::from(side)).product::<u64>();
        let enough = ENOUGH_TEXELS_PER_POINT * points as u64;
        let reduction = (0..31).find(|&k| {
            count(k) <= MOST_SAMPLES && (count(k) <= ENOUGH_TEXELS || count(k + 1) < enough)
        })?;
        let [columns, rows] = texels(reduction);

        let level = |x, y| (darkness(x, y).clamp(0.0, 1.0) * BLACK as f32 + 0.5) as u32;
        let block = |at: u32, end: u32| at << reduction..((at + 1) << reduction).min(end);
        let mut levels = vec![0_u16; columns as usize * rows as usize];
        levels.par_chunks_mut(columns.max(1) as usize).zip(0..rows).for_each(|(row, y)| {
            for (texel, x) in row.iter_mut().zip(0..columns) {
                let pixels = block(y, height).flat_map(|y| block(x, width).map(move |x| (x, y)));
                let sum: u64 = pixels.map(|(x, y)| u64::from(level(x, y))).sum();
                // What lies beyond the picture is white.
                *texel = ((sum + (1 << (2 * reduction) >> 1)) >> (2 * reduction)) as u16;
            }
        });
        let total: u64 = levels.par_iter().map(|&level| u64::from(level)).sum();
        let wanted = SAMPLES_PER_CELL * points as u64 * u64::from(BLACK);
        let refinement = (0..MOST_REFINEMENT).find(|&k| {
            total << (2 * k) >= wanted || count(reduction) << (2 * k + 2) > MOST_SAMPLES
        });
        let refinement = refinement.unwrap_or(MOST_REFINEMENT);
        let size = [width, height];
        (total > 0).then_some(Self { size, columns, rows, reduction, refinement, levels, total })
    }

    /// Pixels of the picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Samples a row, and rows of samples.
    pub fn samples(&self) -> [u32; 2] {
        [self.columns << self.refinement, self.rows << self.refinement]
    }

    /// Area to cover in square pixels.
    pub fn darkness(&self) -> f64 {
        self.total as f64 / f64::from(BLACK) * (self.pixels_per_texel() * self.pixels_per_texel())
    }

    /// Area that the dot of `cell` would have to cover in square pixels.
    pub(super) fn darkness_of(&self, cell: &Cell) -> f64 {
        let per_sample = self.pixels_per_texel() / f64::from(1_u32 << self.refinement);
        cell.levels as f64 / f64::from(BLACK) * (per_sample * per_sample)
    }

    /// Where a site is in pixels.
    pub(super) fn pixel_position(&self, site: [i64; 2]) -> [f64; 2] {
        // Powers of two: exact.
        [0, 1].map(|axis| {
            let pixels = site[axis] as f64 * self.pixels_per_unit();
            pixels.clamp(0.0, f64::from(self.size[axis]))
        })
    }

    /// Side of the unit of sites' coordinates in pixels.
    pub(super) fn pixels_per_unit(&self) -> f64 {
        self.pixels_per_texel() / f64::from(1_u32 << (self.refinement + FRACTION))
    }

    fn pixels_per_texel(&self) -> f64 {
        f64::from(1_u32 << self.reduction)
    }

    /// log2 of the samples along a side of a texel.
    #[inline]
    pub(super) fn refinement(&self) -> u32 {
        self.refinement
    }

    /// The levels of the texels that row `y` of the samples crosses.
    #[inline]
    pub(super) fn levels_of_row(&self, y: u32) -> &[u16] {
        let columns = self.columns as usize;
        &self.levels[(y >> self.refinement) as usize * columns..][..columns]
    }

    /// The sum of weight times squared distance from the origin, over all samples, in the units of sites.
    pub(super) fn second_moment(&self) -> u128 {
        let square = |level: u16| u128::from(level) * u128::from(level);
        let columns = self.columns as usize;
        let mut by_column = vec![0_u128; columns];
        let mut sum = 0;
        for (row, y) in self.levels.chunks_exact(columns).zip(0..) {
            by_column.iter_mut().zip(row).for_each(|(sum, &level)| *sum += square(level));
            sum += row.iter().map(|&level| square(level)).sum::<u128>() * self.squares_in(y);
        }
        sum += by_column.iter().zip(0..).map(|(sum, x)| sum * self.squares_in(x)).sum::<u128>();
        // A texel's samples have each coordinate as often as there are samples along the other.
        sum << self.refinement
    }

    /// Sum of the squared coordinates of the samples along a side of texel `i`.
    fn squares_in(&self, i: u32) -> u128 {
        let samples = i << self.refinement..(i + 1) << self.refinement;
        let centre = |i: u32| (2 * u128::from(i) + 1) << (FRACTION - 1);
        samples.map(|i| centre(i) * centre(i)).sum()
    }

    /// `points` sites, one drawn from each of as many equal parts of the darkness. The parts follow each
    /// other along a Z-curve, so that they are compact: the sites are spread better than independent ones
    /// from the beginning.
    pub(super) fn stratified(&self, points: usize, key: u64) -> Vec<[i64; 2]> {
        let targets = (0..points as u64).map(|i| {
            let within = combine(key, 2 * i) >> 32;
            let place = (u128::from(i) << 32 | u128::from(within)) * u128::from(self.total);
            ((place / points as u128) >> 32) as u64
        });
        self.sites_at(targets, key)
    }

    /// `points` independent sites.
    pub(super) fn independent(&self, points: usize, key: u64) -> Vec<[i64; 2]> {
        let place = |i| (u128::from(combine(key, 2 * i)) * u128::from(self.total)) >> 64;
        let mut targets: Vec<_> = (0..points as u64).map(|i| place(i) as u64).collect();
        targets.sort_unstable();
        self.sites_at(targets.into_iter(), key)
    }

    /// Inverts the sum of the levels along a Z-curve: a site for each of the ascending `targets`, all below
    /// the total, anywhere in the texel where the sum first exceeds the target.
    fn sites_at(&self, targets: impl Iterator<Item = u64>, key: u64) -> Vec<[i64; 2]> {
        let mut targets = targets.peekable();
        let (mut sites, mut sum) = (Vec::new(), 0);
        let bits = self.refinement + FRACTION;
        let within = |random: u64| (random & ((1 << bits) - 1)) as i64;
        let side = self.columns.max(self.rows).next_power_of_two();
        self.along_z_curve([0, 0], side, &mut |[x, y], level| {
            sum += u64::from(level);
            while targets.next_if(|&target| target < sum).is_some() {
                let random = combine(key, 2 * sites.len() as u64 + 1);
                sites.push([
                    (i64::from(x) << bits) + within(random),
                    (i64::from(y) << bits) + within(random >> 32),
                ]);
            }
        });
        sites
    }

    fn along_z_curve(&self, [x, y]: [u32; 2], side: u32, visit: &mut impl FnMut([u32; 2], u16)) {
        if x >= self.columns || y >= self.rows {
            return;
        }
        if side == 1 {
            let texel = y as usize * self.columns as usize + x as usize;
            return visit([x, y], self.levels[texel]);
        }
        let half = side / 2;
        for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            self.along_z_curve([x + i * half, y + j * half], half, visit);
        }
    }
}
