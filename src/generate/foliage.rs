//! A grove: trees whose leaves are rectangles with a cut-out texture, the hard case for hit filters.
//!
//! Source: trees stand where seeds stand in a sunflower (H. Vogel, "A Better Way to Construct the Sunflower
//! Head", 1979), so the grove grows evenly around its centre and ends where the triangles do.

use super::Model;
use super::obj_writer::{Corner, ObjWriter};
use super::shapes::{FLOOR_TRIANGLES, Tube, floor};
use crate::math::{Frame, Vec3, fun};
use crate::sampling::hash::combine;
use crate::sampling::{CounterRng, warp};
use std::io;

/// The golden section of a turn.
const GOLDEN: f32 = 0.381_966;
/// Distance of neighbours, in metres.
const SPACING: f32 = 3.4;
/// Sides and segments of a trunk, and of a branch.
const TRUNK: (u64, u64) = (6, 4);
const BRANCH: (u64, u64) = (3, 2);
/// Branches of a tree, and leaves of a branch.
const BRANCHES: u64 = 22;
const LEAVES: u64 = 34;
/// Triangles of a tree without leaves.
const WOOD_TRIANGLES: u64 = 2 * (TRUNK.0 * TRUNK.1 + BRANCHES * BRANCH.0 * BRANCH.1);
/// What a leaf can be.
const GREENS: [&str; 3] = ["leaf_dark", "leaf", "leaf_light"];

/// Writes the grove.
pub(super) fn write(obj: &mut ObjWriter<'_>, model: &Model) -> io::Result<()> {
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|uv| obj.uv(uv));
    let mut left = model.triangles - FLOOR_TRIANGLES;
    let mut trees = 0;
    // A last tree with too few leaves would look dead.
    while left >= WOOD_TRIANGLES + BRANCHES * LEAVES / 2 {
        let leaves = ((left - WOOD_TRIANGLES) / 2).min(BRANCHES * LEAVES);
        let mut rng = CounterRng::new(combine(model.seed, trees));
        let radius = SPACING * ((trees as f32) + 0.3).sqrt();
        let (sin, cos) = fun::sin_cos_turns(trees as f32 * GOLDEN);
        let jitter = warp::disc([rng.unit(), rng.unit()]) * (0.25 * SPACING);
        let foot = Vec3::new(radius * sin + jitter.x, 0.0, radius * cos + jitter.y);
        tree(obj, &mut rng, foot, leaves, uvs)?;
        left -= WOOD_TRIANGLES + 2 * leaves;
        trees += 1;
    }
    obj.material("soil");
    floor(obj, 0.0, SPACING * (((trees + 1) as f32).sqrt() + 0.5), left + FLOOR_TRIANGLES)
}

/// Writes a tree with so many leaves.
fn tree(
    obj: &mut ObjWriter<'_>,
    rng: &mut CounterRng,
    foot: Vec3,
    leaves: u64,
    uvs: [u64; 4],
) -> io::Result<()> {
    let height = 4.5 + 3.0 * rng.unit();
    let lean = warp::disc([rng.unit(), rng.unit()]) * 0.5;
    let trunk = |t: f32| foot + Vec3::new(lean.x * t * t, height * t, lean.y * t * t);
    obj.material("bark");
    let mut tube = Tube::new(TRUNK.0, Vec3::X);
    for ring in 0..=TRUNK.1 {
        let t = ring as f32 / TRUNK.1 as f32;
        tube.ring(obj, trunk(t), Vec3::Y, 0.16 * (1.0 - 0.85 * t))?;
    }

    let mut branches = Vec::new();
    for branch in 0..BRANCHES {
        let t = (branch as f32 + 0.5) / BRANCHES as f32;
        let (sin, cos) = fun::sin_cos_turns(branch as f32 * GOLDEN + 0.1 * rng.unit());
        // The lowest branches are the longest and the flattest.
        let direction = Vec3::new(sin, 0.25 + 1.2 * t, cos).normalize();
        let length = (0.7 + 0.3 * rng.unit()) * height * (0.36 - 0.2 * t);
        let from = trunk(0.3 + 0.68 * t);
        let mut tube = Tube::new(BRANCH.0, Vec3::new(-cos, 0.0, sin));
        for ring in 0..=BRANCH.1 {
            let s = ring as f32 / BRANCH.1 as f32;
            tube.ring(obj, from + direction * (length * s), direction, 0.045 * (1.0 - 0.8 * s))?;
        }
        branches.push((from, direction * length));
    }

    // Leaves of a colour together: fewer changes of material.
    for (green, material) in GREENS.iter().enumerate() {
        obj.material(material);
        let share = |i: usize| leaves * i as u64 / GREENS.len() as u64;
        for index in share(green)..share(green + 1) {
            let (from, along) = branches[(index % BRANCHES) as usize];
            let around = warp::sphere([rng.unit(), rng.unit()]) * (0.5 * rng.unit());
            let stalk = from + along * (0.3 + 0.75 * rng.unit()) + around;
            // Upwards rather than downwards, as leaves grow.
            let normal = warp::sphere([rng.unit(), rng.unit()]) + Vec3::Y * 0.9;
            leaf(obj, stalk, normal.normalize_or(Vec3::Y), 0.24 + 0.18 * rng.unit(), uvs)?;
        }
    }
    Ok(())
}

/// Writes a leaf that hangs on `stalk` and faces `normal`.
fn leaf(
    obj: &mut ObjWriter<'_>,
    stalk: Vec3,
    normal: Vec3,
    length: f32,
    uvs: [u64; 4],
) -> io::Result<()> {
    let frame = Frame::from_normal(normal);
    let across = frame.world_from_local(Vec3::X) * (0.6 * length);
    let along = frame.world_from_local(Vec3::Y) * length;
    let corner = stalk - across * 0.5;
    let corners = [corner, corner + across, corner + across + along, corner + along];
    let positions = corners.map(|p| obj.position(p));
    obj.quad([0, 1, 2, 3].map(|i| Corner::Textured(positions[i], uvs[i])))
}

/// Texels along a side of [`leaf_shape`].
pub(super) const SHAPE_SIDE: u32 = 128;

/// The opacity of a leaf: an outline with a point and a serrated edge; row-major, top row first.
pub(super) fn leaf_shape() -> Vec<[u8; 1]> {
    /// Samples of a texel along each side.
    const FINER: u32 = 4;
    let inside = |x: u32, y: u32| {
        let [u, v] = [x, y].map(|c| (c as f32 + 0.5) / (FINER * SHAPE_SIDE) as f32);
        let height = 1.0 - v;
        // Widest below the middle; the stalk is a thin strip at the bottom.
        let outline = 0.47 * fun::sin(std::f32::consts::PI * fun::pow(height, 0.75));
        let teeth = 1.0 - 0.12 * (height * 11.0).fract();
        let half_width = if height < 0.97 { (outline * teeth).max(0.012) } else { 0.0 };
        (u - 0.5).abs() < half_width
    };
    let texel = |x: u32, y: u32| {
        let samples = (0..FINER * FINER)
            .filter(|i| inside(FINER * x + i % FINER, FINER * y + i / FINER))
            .count();
        [(samples * 255 / (FINER * FINER) as usize) as u8]
    };
    (0..SHAPE_SIDE * SHAPE_SIDE).map(|i| texel(i % SHAPE_SIDE, i / SHAPE_SIDE)).collect()
}
