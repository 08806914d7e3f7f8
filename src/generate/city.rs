//! A city at night: blocks of houses whose windows are emissive, thousands of small lights.
//!
//! Lots are filled in a spiral from the centre, so that the city ends where the triangles do.

use super::Model;
use super::obj_writer::{Corner, ObjWriter};
use super::shapes::{FLOOR_TRIANGLES, floor};
use crate::math::{Vec3, fun};
use crate::sampling::CounterRng;
use crate::sampling::hash::combine;
use std::io;

/// Side of a lot, in metres; two by two make a block.
const LOT: f32 = 28.0;
/// Width of the streets between blocks.
const STREET: f32 = 14.0;
/// Height of a floor.
const STOREY: f32 = 3.4;
/// Width of a house for each window.
const BAY: f32 = 3.0;
/// Pavement, four walls and a roof.
const HOUSE_TRIANGLES: u64 = 12;
/// Floors of the tallest houses of the outskirts and, in addition, of the centre.
const STOREYS: (f32, f32) = (5.0, 75.0);
/// Triangles of an average lot, from which the size of the centre follows.
const AVERAGE: f32 = 520.0;

/// What a window can be, and the share of windows that are at most it.
const WINDOWS: [(&str, f32); 4] = [("pane", 0.7), ("warm", 0.88), ("neutral", 0.96), ("cool", 1.0)];
/// What a wall can be.
const WALLS: [&str; 3] = ["brick", "concrete", "plaster"];

/// Writes the city.
pub(super) fn write(obj: &mut ObjWriter<'_>, model: &Model) -> io::Result<()> {
    let mut left = model.triangles - FLOOR_TRIANGLES;
    let lots_across = (model.triangles as f32 / AVERAGE).sqrt();
    let mut spiral = Spiral::default();
    for lot in 0.. {
        let (column, row) = spiral.next();
        let from_centre = ((column * column + row * row) as f32).sqrt() / (0.3 * lots_across);
        let house = House::new(&mut CounterRng::new(combine(model.seed, lot)), from_centre);
        let storeys = house.storeys.min(house.affordable(left));
        if storeys == 0 {
            break;
        }
        let house = House { storeys, ..house };
        house.write(obj, Vec3::new(along(column), 0.0, along(row)))?;
        left -= house.triangles();
    }
    obj.material("asphalt");
    floor(obj, 0.0, 1.45 * along(spiral.radius() + 1), left + FLOOR_TRIANGLES)
}

/// Where lot `index` of a street begins.
fn along(index: i64) -> f32 {
    index as f32 * LOT + index.div_euclid(2) as f32 * STREET
}

/// The whole numbers in two dimensions, in a spiral from zero.
#[derive(Default)]
struct Spiral {
    at: Option<(i64, i64)>,
    step: (i64, i64),
}

impl Spiral {
    fn next(&mut self) -> (i64, i64) {
        let at = match self.at {
            None => {
                self.step = (1, 0);
                (0, 0)
            }
            Some((x, y)) => {
                let at = (x + self.step.0, y + self.step.1);
                let (x, y) = at;
                if x == y || x < 0 && x == -y || x > 0 && x == 1 - y {
                    self.step = (-self.step.1, self.step.0);
                }
                at
            }
        };
        self.at = Some(at);
        at
    }

    /// How far from zero it has come.
    fn radius(&self) -> i64 {
        self.at.map_or(0, |(x, y)| x.abs().max(y.abs()))
    }
}

/// A house on its lot.
#[derive(Clone, Debug)]
struct House {
    key: u64,
    wall: &'static str,
    /// Windows along x and along z.
    bays: [u64; 2],
    storeys: u64,
}

impl House {
    /// A house at `from_centre` radii of the inner city.
    fn new(rng: &mut CounterRng, from_centre: f32) -> Self {
        let mut bays = || 4 + (4.0 * rng.unit()) as u64;
        let bays = [bays(), bays()];
        let tallest = STOREYS.0 + STOREYS.1 * fun::exp(-from_centre * from_centre);
        let u = rng.unit();
        let storeys = 2 + (u * u * tallest) as u64;
        let wall = WALLS[(rng.unit() * WALLS.len() as f32) as usize];
        Self { key: (rng.unit() * 16_777_216.0) as u64, wall, bays, storeys }
    }

    /// Triangles of the windows of a floor.
    fn storey_triangles(&self) -> u64 {
        4 * (self.bays[0] + self.bays[1])
    }

    fn triangles(&self) -> u64 {
        HOUSE_TRIANGLES + self.storeys * self.storey_triangles()
    }

    /// How many floors `triangles` are enough for.
    fn affordable(&self, triangles: u64) -> u64 {
        triangles.saturating_sub(HOUSE_TRIANGLES) / self.storey_triangles()
    }

    /// Writes the house on the lot that begins at `lot`.
    fn write(&self, obj: &mut ObjWriter<'_>, lot: Vec3) -> io::Result<()> {
        obj.material("pavement");
        let kerb = Vec3::Y * 0.15;
        rectangle(obj, lot + kerb, Vec3::Z * (LOT - 0.5), Vec3::X * (LOT - 0.5))?;

        let [x, z] = self.bays.map(|bays| bays as f32 * BAY);
        let up = Vec3::Y * (self.storeys as f32 * STOREY + 1.0);
        let near = lot + Vec3::new(LOT - x, 0.0, LOT - z) * 0.5;
        let far = near + Vec3::new(x, 0.0, z);
        let walls = [
            (near, Vec3::X, self.bays[0]),
            (far, -Vec3::X, self.bays[0]),
            (near, Vec3::Z, self.bays[1]),
            (far, -Vec3::Z, self.bays[1]),
        ];
        obj.material(self.wall);
        for (corner, along, bays) in walls {
            let side = along * (bays as f32 * BAY);
            // Seen from outside, walls along x and along z turn opposite ways.
            if along.x == 0.0 {
                rectangle(obj, corner, side, up)?;
            } else {
                rectangle(obj, corner, up, side)?;
            }
        }
        rectangle(obj, near + up, Vec3::Z * z, Vec3::X * x)?;

        // Windows of a kind together: fewer changes of material.
        for (kind, (material, _)) in WINDOWS.iter().enumerate() {
            obj.material(material);
            let mut rng = CounterRng::new(self.key);
            for (corner, along, bays) in walls {
                let outwards = if along.x == 0.0 { -along.z * Vec3::X } else { -along.x * Vec3::Z };
                for index in 0..bays * self.storeys {
                    let u = rng.unit();
                    if WINDOWS.iter().position(|(_, share)| u < *share) != Some(kind) {
                        continue;
                    }
                    let (bay, storey) = ((index % bays) as f32, (index / bays) as f32);
                    let sill = corner
                        + along * (bay * BAY + 0.6)
                        + Vec3::Y * (storey * STOREY + 1.0)
                        + outwards * 0.04;
                    let (width, height) = (along * (BAY - 1.2), Vec3::Y * 1.7);
                    if along.x == 0.0 {
                        rectangle(obj, sill, width, height)?;
                    } else {
                        rectangle(obj, sill, height, width)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Writes a rectangle that faces along `u` x `v`.
fn rectangle(obj: &mut ObjWriter<'_>, corner: Vec3, u: Vec3, v: Vec3) -> io::Result<()> {
    let corners = [corner, corner + u, corner + u + v, corner + v];
    let quad = corners.map(|p| Corner::Plain(obj.position(p)));
    obj.quad(quad)
}
