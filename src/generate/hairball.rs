//! A ball of hair: thin curved tubes in all directions, whose long triangles overlap in every box: the hard
//! case for hierarchies of boxes.
//!
//! After the model of S. Laine and T. Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion" (2010).

use super::Model;
use super::obj_writer::ObjWriter;
use super::shapes::{Ball, FLOOR_TRIANGLES, Tube, floor};
use crate::math::{Frame, Vec3, fun};
use crate::sampling::hash::combine;
use crate::sampling::{CounterRng, warp};
use std::io;

/// Radius of the ball that the hair grows on.
const RADIUS: f32 = 50.0;
/// Sides of a hair.
const SIDES: u64 = 3;

/// Writes the ball.
pub(super) fn write(obj: &mut ObjWriter<'_>, model: &Model) -> io::Result<()> {
    let skin = Ball::new(7);
    obj.material("skin");
    let normals = skin.normals(obj);
    skin.place(obj, Vec3::ZERO, RADIUS, normals)?;

    let mut left = model.triangles - FLOOR_TRIANGLES - skin.triangles();
    // Many triangles make more hairs, and smoother ones.
    let segments = (model.triangles.isqrt() / 20).clamp(8, 40);
    let hairs = left / (2 * SIDES * segments);
    let radius = (20.0 / (hairs.max(1) as f32).sqrt()).clamp(0.05, 0.6);
    obj.material("hair");
    for hair in 0..hairs {
        write_hair(obj, &mut CounterRng::new(combine(model.seed, hair)), segments, radius)?;
    }
    left -= hairs * 2 * SIDES * segments;
    obj.material("floor");
    floor(obj, -2.2 * RADIUS, 2.6 * RADIUS, left + FLOOR_TRIANGLES)
}

/// Writes a hair from the skin outwards: a helix that bends to one side.
fn write_hair(
    obj: &mut ObjWriter<'_>,
    rng: &mut CounterRng,
    segments: u64,
    radius: f32,
) -> io::Result<()> {
    let out = warp::sphere([rng.unit(), rng.unit()]);
    let frame = Frame::from_normal(out);
    let (sin, cos) = fun::sin_cos_turns(rng.unit());
    let aside = frame.world_from_local(Vec3::new(cos, sin, 0.0));
    let length = RADIUS * (0.7 + 0.5 * rng.unit());
    let bend = 0.2 + 0.8 * rng.unit();
    let (phase, turns, width) = (rng.unit(), 1.0 + 1.5 * rng.unit(), 0.07 * length);
    let point = |t: f32| {
        // Zero at the root, where the hair leaves the skin.
        let (sin, cos) = fun::sin_cos_turns(phase + turns * t);
        let helix = frame.world_from_local(Vec3::new(cos, sin, 0.0)) * (width * t);
        out * RADIUS
            + out * (length * t * (1.0 - 0.4 * bend * t))
            + aside * (length * bend * t * t)
            + helix
    };
    let step = 1.0 / segments as f32;
    let mut tube = Tube::new(SIDES, aside);
    for ring in 0..=segments {
        let t = ring as f32 * step;
        let direction = (point(t + 0.5 * step) - point(t - 0.5 * step)).normalize_or(out);
        tube.ring(obj, point(t), direction, radius * (1.0 - 0.8 * t))?;
    }
    Ok(())
}
