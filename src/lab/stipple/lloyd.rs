//! One iteration of Lloyd's: the moments of all cells, their energy, and the move to their centroids.
//!
//! Source: S. Lloyd, Least Squares Quantization in PCM, 1982; A. Secord, NPAR 2002, section 3. All sums are
//! of integers and exact, so their order does not matter. A centroid is rounded to the nearest point of the
//! grid that the site was on already, so it is at least as near to the exact centroid: the energy cannot
//! rise. Knows nothing of pixels.

use super::density::Density;
use super::nearest::{FRACTION, Run, Tile, tiles};
use rayon::prelude::*;

/// What is nearest to one site.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cell {
    /// Sum of the samples' levels.
    pub(super) levels: u64,
    /// Sum of their weights, the squares of the levels.
    pub(super) weight: u64,
    /// Sum of weight times position, in units of half a sample: the centre of sample i is at 2 i + 1.
    first: [u128; 2],
}

/// All cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Partition {
    pub(super) cells: Vec<Cell>,
    /// Weighted mean of the squared distance to the site, in square pixels.
    pub(super) energy: f64,
    /// The sum that the energy is the mean of, in square units of the sites' coordinates.
    pub(super) exact_energy: i128,
}

/// Sums within a tile, whose first sample is (0, 0): 24 bits of weight, 16 of samples and 8 of position.
#[derive(Clone, Copy, Default)]
struct Sums {
    levels: u64,
    weight: u64,
    first: [u64; 2],
}

/// The cells of `sites`, of which there is at least one.
pub(super) fn partition(density: &Density, sites: &[[i64; 2]]) -> Partition {
    let tiles = tiles(density.samples(), sites);
    let sums: Vec<_> = tiles.par_iter().map(|tile| tile_sums(density, tile)).collect();
    let mut cells = vec![Cell::default(); sites.len()];
    for (tile, sums) in tiles.iter().zip(sums) {
        let origin = tile.origin();
        for (&site, sums) in tile.sites.iter().zip(sums) {
            let cell = &mut cells[site as usize];
            cell.levels += sums.levels;
            cell.weight += sums.weight;
            for axis in [0, 1] {
                let from_origin = 2 * sums.first[axis] + sums.weight;
                let of_origin = u128::from(sums.weight) * (2 * u128::from(origin[axis]));
                cell.first[axis] += u128::from(from_origin) + of_origin;
            }
        }
    }
    let exact_energy = energy(density, sites, &cells);
    let weight: u128 = cells.iter().map(|cell| u128::from(cell.weight)).sum();
    let unit = density.pixels_per_unit();
    let energy = exact_energy as f64 / weight as f64 * (unit * unit);
    Partition { cells, energy, exact_energy }
}

fn tile_sums(density: &Density, tile: &Tile) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); tile.sites.len()];
    let [left, top] = tile.origin();
    let refinement = density.refinement();
    tile.runs(&mut |Run { y, start, end, slot }| {
        let row = density.levels_of_row(y);
        let (mut levels, mut weight, mut first) = (0, 0, 0);
        for x in start..end {
            let level = u64::from(row[(x >> refinement) as usize]);
            levels += level;
            weight += level * level;
            first += level * level * u64::from(x - left);
        }
        let sums = &mut sums[slot as usize];
        sums.levels += levels;
        sums.weight += weight;
        sums.first[0] += first;
        sums.first[1] += weight * u64::from(y - top);
    });
    sums
}

/// The sum of weight times squared distance, by |x - s|^2 = |x|^2 - 2 x.s + |s|^2: the first term knows no
/// cells, and the others ask for their moments only.
fn energy(density: &Density, sites: &[[i64; 2]], cells: &[Cell]) -> i128 {
    let mut sum = density.second_moment() as i128;
    for (site, cell) in sites.iter().zip(cells) {
        for axis in [0, 1] {
            let s = i128::from(site[axis]);
            // Half a sample is 2^(FRACTION - 1) units.
            let first = (cell.first[axis] << (FRACTION - 1)) as i128;
            sum += i128::from(cell.weight) * s * s - 2 * first * s;
        }
    }
    sum
}

/// Moves every site to the centroid of its cell; those that have no weight are drawn again.
pub(super) fn move_sites(
    density: &Density,
    partition: &Partition,
    sites: &mut [[i64; 2]],
    key: u64,
) {
    let cells = &partition.cells;
    for (site, cell) in sites.iter_mut().zip(cells).filter(|(_, cell)| cell.weight > 0) {
        let weight = u128::from(cell.weight);
        *site = cell.first.map(|first| (((first << FRACTION) + weight) / (2 * weight)) as i64);
    }
    let homeless = sites.iter_mut().zip(cells).filter(|(_, cell)| cell.weight == 0);
    let homeless: Vec<_> = homeless.map(|(site, _)| site).collect();
    if !homeless.is_empty() {
        let drawn = density.independent(homeless.len(), key);
        homeless.into_iter().zip(drawn).for_each(|(site, new)| *site = new);
    }
}
