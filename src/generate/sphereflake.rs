//! Eric Haines' sphereflake: every sphere carries nine of a third of its size.
//!
//! Source: E. Haines, "A Proposal for Standard Graphics Environments", 1987 (the Standard Procedural
//! Databases). Six children stand around the equator and three above, where a close packing of spheres would
//! have them. Levels are filled from the largest spheres to the smallest; the last one may be sparse.

use super::Model;
use super::obj_writer::ObjWriter;
use super::shapes::{Ball, FLOOR_TRIANGLES, floor};
use crate::math::{Frame, Vec3, fun};
use crate::sampling::CounterRng;
use std::io;

/// Radius of the largest sphere.
const RADIUS: f32 = 100.0;
/// A ball of level i has 8 n² triangles; later levels are like the last.
const SUBDIVISIONS: [u32; 5] = [12, 8, 6, 5, 4];
/// Sine and cosine of the angle between the axis and the upper three children.
const UPPER: (f32, f32) = (0.577_350_26, 0.816_496_6);

/// Writes the flake.
pub(super) fn write(obj: &mut ObjWriter<'_>, model: &Model) -> io::Result<()> {
    let turn = CounterRng::new(model.seed).unit();
    let mut left = model.triangles - FLOOR_TRIANGLES;
    let mut in_level = 1;
    for level in 0.. {
        let ball = Ball::new(SUBDIVISIONS[SUBDIVISIONS.len().min(level + 1) - 1]);
        let count = (left / ball.triangles()).min(in_level);
        if count > 0 {
            obj.material(if level % 2 == 0 { "even" } else { "odd" });
            let normals = ball.normals(obj);
            for index in 0..count {
                let (centre, radius) = sphere(level, index, turn);
                ball.place(obj, centre, radius, normals)?;
            }
        }
        left -= count * ball.triangles();
        if count < in_level {
            break;
        }
        in_level *= 9;
    }
    obj.material("floor");
    floor(obj, -RADIUS, 2.6 * RADIUS, left + FLOOR_TRIANGLES)
}

/// Centre and radius of a sphere. The digits of `index` to base 9 lead to it, the last digit first: spheres
/// with consecutive numbers are on different branches, so a level that is not complete is evenly sparse.
fn sphere(level: usize, mut index: u64, turn: f32) -> (Vec3, f32) {
    let (mut centre, mut radius, mut axis) = (Vec3::ZERO, RADIUS, Vec3::Y);
    for _ in 0..level {
        let child = (index % 9) as f32;
        index /= 9;
        let (sin, cos) = if child < 6.0 { (1.0, 0.0) } else { UPPER };
        let turns = if child < 6.0 { child / 6.0 } else { (child - 6.0) / 3.0 + 1.0 / 12.0 };
        let (y, x) = fun::sin_cos_turns(turns + turn);
        axis = Frame::from_normal(axis).world_from_local(Vec3::new(sin * x, sin * y, cos));
        centre += axis * (radius * 4.0 / 3.0);
        radius /= 3.0;
    }
    (centre, radius)
}
