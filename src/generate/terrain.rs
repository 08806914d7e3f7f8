//! Mountains: a height field on a grid.
//!
//! Sources: gradient noise with the quintic blend of K. Perlin, "Improving Noise" (2002); its octaves are
//! weighted by those before them as in the ridged multifractal of F. K. Musgrave ("Texturing and Modeling: A
//! Procedural Approach", chapter 16): rough peaks, smooth valleys.

use super::Model;
use super::obj_writer::{Corner, ObjWriter};
use crate::math::{Vec3, fun};
use crate::sampling::hash::{combine, unit_f32};
use std::io;

/// Length of the side along x.
const SIDE: f64 = 1000.0;
/// Height of the highest mountains.
const HEIGHT: f64 = 190.0;
/// Noise cells of the first octave along x.
const CELLS: f64 = 3.5;
/// The finest octave has at least this many vertices a cell.
const FINEST: f64 = 3.0;
/// Width of the coast, where the land comes down to zero.
const COAST: f64 = 160.0;

/// Writes the terrain.
pub(super) fn write(obj: &mut ObjWriter<'_>, model: &Model) -> io::Result<()> {
    let quads = model.triangles / 2;
    let columns = quads.isqrt();
    let rows = quads / columns;
    // What a grid cannot have: these cells of the last row get a vertex in the middle, for two more; and
    // an odd triangle comes from one more vertex on the border.
    let starred = quads % columns;
    let is_odd = model.triangles % 2 == 1;

    let step = SIDE / columns as f64;
    let depth = step * rows as f64;
    let point = |column: f64, row: f64| {
        let (x, z) = (column * step, row * step);
        let from_border = x.min(SIDE - x).min(z).min(depth - z);
        let coast = blend((from_border / COAST).clamp(0.0, 1.0));
        let height = HEIGHT * coast * height(model.seed, [x, z], columns);
        Vec3::new((x - SIDE / 2.0) as f32, height as f32, (z - depth / 2.0) as f32)
    };
    obj.material("rock");
    for column in 0..=columns {
        obj.position(point(column as f64, 0.0));
    }
    // Numbers of the vertices at the left of the rows above and below.
    let mut above = 1;
    for row in 0..rows {
        let mut below = 0;
        for column in 0..=columns {
            let number = obj.position(point(column as f64, (row + 1) as f64));
            below = number - column;
        }
        let is_last = row + 1 == rows;
        for column in 0..columns {
            let [a, b] = [above + column, below + column];
            let corners = [a, b, b + 1, a + 1].map(Corner::Plain);
            if is_last && column < starred {
                let centre = obj.position(point(column as f64 + 0.5, row as f64 + 0.5));
                for i in 0..4 {
                    obj.triangle([corners[i], corners[(i + 1) % 4], Corner::Plain(centre)])?;
                }
            } else if is_last && is_odd && column + 1 == columns {
                let [a, b, c, d] = corners;
                let border =
                    Corner::Plain(obj.position(point((column + 1) as f64, row as f64 + 0.5)));
                obj.triangle([a, b, border])?;
                obj.triangle([b, c, border])?;
                obj.triangle([a, border, d])?;
            } else {
                obj.quad(corners)?;
            }
        }
        above = below;
    }
    Ok(())
}

/// Height in about [0, 1], with as much detail as `columns` show.
fn height(seed: u64, [x, z]: [f64; 2], columns: u64) -> f64 {
    let (mut frequency, mut amplitude, mut weight, mut sum) = (CELLS, 0.5, 1.0, 0.0);
    let mut octave = 0_u32;
    while octave == 0 || frequency * FINEST < columns as f64 {
        // Every octave elsewhere: noise is zero on its grid, and these zeros must not meet.
        let shift = f64::from(octave) * 0.381_966;
        let at = [x, z].map(|c| c / SIDE * frequency + shift);
        let ridge = 1.0 - 1.6 * noise(combine(seed, u64::from(octave)), at).abs();
        let signal = ridge * ridge * weight;
        sum += amplitude * signal;
        weight = (2.0 * signal).clamp(0.0, 1.0);
        amplitude *= 0.45;
        frequency *= 2.0;
        octave += 1;
    }
    sum
}

/// From 0 to 1 with two derivatives that are 0 at both ends.
fn blend(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Gradient noise at a point that is not negative: smooth, zero on the integers, within about 0.7 of zero.
fn noise(key: u64, [x, z]: [f64; 2]) -> f64 {
    let [column, row] = [x, z].map(|c| c as u64);
    let (dx, dz) = (x - column as f64, z - row as f64);
    let keys = [combine(key, row), combine(key, row + 1)];
    let corner = |i: usize, j: usize| {
        let hash = combine(keys[j], column + i as u64);
        let (sin, cos) = fun::sin_cos_turn(unit_f32((hash >> 32) as u32));
        f64::from(cos) * (dx - i as f64) + f64::from(sin) * (dz - j as f64)
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let (u, v) = (blend(dx), blend(dz));
    mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v)
}
