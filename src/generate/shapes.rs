//! What several models are made of: discs, balls and tubes.

use super::obj_writer::{Corner, ObjWriter};
use crate::math::{Frame, Vec3, fun};
use std::io;

/// What every floor has at least; what a model cannot use for anything else makes its edge rounder.
pub(super) const FLOOR_TRIANGLES: u64 = 24;

/// A horizontal disc of `triangles`, at least 3, around the axis y.
pub(super) fn floor(
    obj: &mut ObjWriter<'_>,
    height: f32,
    radius: f32,
    triangles: u64,
) -> io::Result<()> {
    let rim = |i: u64| {
        let (sin, cos) = fun::sin_cos_turns((i as f64 / triangles as f64) as f32);
        Vec3::new(radius * sin, height, radius * cos)
    };
    let centre = obj.position(Vec3::new(0.0, height, 0.0));
    let first = obj.position(rim(0));
    let mut last = first;
    for i in 1..triangles {
        let next = obj.position(rim(i));
        obj.triangle([centre, last, next].map(Corner::Plain))?;
        last = next;
    }
    obj.triangle([centre, last, first].map(Corner::Plain))
}

/// A unit sphere of 8 n² triangles of similar size: rings with four vertices more each, like an octahedron
/// whose faces are cut into n² and blown up.
pub(super) struct Ball {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Ball {
    /// The ball of 8 `n`² triangles, n at least 1.
    pub(super) fn new(n: u32) -> Self {
        let mut points = Vec::new();
        let mut starts = Vec::new();
        for ring in 0..=2 * n {
            starts.push(points.len() as u32);
            let count = (4 * ring.min(2 * n - ring)).max(1);
            let (sin, cos) = fun::sin_cos_turns(ring as f32 / (4 * n) as f32);
            for i in 0..count {
                let (x, z) = fun::sin_cos_turns(i as f32 / count as f32);
                points.push(Vec3::new(sin * x, cos, sin * z));
            }
        }
        let mut triangles = Vec::new();
        // Ring k of either half has k edges in each quadrant, the next one towards the equator k + 1.
        for k in 0..n {
            for (ring, next) in [(k, k + 1), (2 * n - k, 2 * n - k - 1)] {
                let inner = |i: u32| starts[ring as usize] + if k == 0 { 0 } else { i % (4 * k) };
                let outer = |i: u32| starts[next as usize] + i % (4 * (k + 1));
                let mut add = |[a, b, c]: [u32; 3]| {
                    triangles.push(if ring < next { [a, b, c] } else { [a, c, b] });
                };
                for quadrant in 0..4 {
                    let (i, o) = (quadrant * k, quadrant * (k + 1));
                    for j in 0..=k {
                        add([inner(i + j), outer(o + j), outer(o + j + 1)]);
                        if j < k {
                            add([inner(i + j), outer(o + j + 1), inner(i + j + 1)]);
                        }
                    }
                }
            }
        }
        Self { points, triangles }
    }

    /// How many triangles it has.
    pub(super) fn triangles(&self) -> u64 {
        self.triangles.len() as u64
    }

    /// Writes the normals, which balls of any size share; the number of the first.
    pub(super) fn normals(&self, obj: &mut ObjWriter<'_>) -> u64 {
        let numbers = self.points.iter().map(|&p| obj.normal(p));
        numbers.reduce(u64::min).unwrap_or(1)
    }

    /// Writes a ball with the normals from `normals` on.
    pub(super) fn place(
        &self,
        obj: &mut ObjWriter<'_>,
        centre: Vec3,
        radius: f32,
        normals: u64,
    ) -> io::Result<()> {
        let numbers = self.points.iter().map(|&p| obj.position(centre + radius * p));
        let first = numbers.reduce(u64::min).unwrap_or(1);
        for corners in &self.triangles {
            obj.triangle(
                corners.map(|c| Corner::Smooth(first + u64::from(c), normals + u64::from(c))),
            )?;
        }
        Ok(())
    }
}

/// A tube, written ring by ring; its ends are open.
pub(super) struct Tube {
    sides: u64,
    tangent: Vec3,
    last_ring: Option<u64>,
}

impl Tube {
    /// A tube of `sides` sides that begins across `tangent`.
    pub(super) fn new(sides: u64, tangent: Vec3) -> Self {
        Self { sides, tangent, last_ring: None }
    }

    /// Writes the ring around `centre`, and the `2 * sides` triangles that join it to the one before.
    pub(super) fn ring(
        &mut self,
        obj: &mut ObjWriter<'_>,
        centre: Vec3,
        direction: Vec3,
        radius: f32,
    ) -> io::Result<()> {
        // The tangent is carried along, so that the tube does not twist.
        let frame = Frame::from_normal_tangent(direction, self.tangent);
        self.tangent = frame.world_from_local(Vec3::X);
        let mut first = None;
        for side in 0..self.sides {
            let (sin, cos) = fun::sin_cos_turns(side as f32 / self.sides as f32);
            let offset = frame.world_from_local(Vec3::new(radius * cos, radius * sin, 0.0));
            let number = obj.position(centre + offset);
            first = first.or(Some(number));
        }
        if let (Some(below), Some(above)) = (self.last_ring, first) {
            for side in 0..self.sides {
                let next = (side + 1) % self.sides;
                let quad = [below + side, below + next, above + next, above + side];
                obj.quad(quad.map(Corner::Plain))?;
            }
        }
        self.last_ring = first;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_its_triangles_look_outwards() {
        for n in [1, 2, 3, 8] {
            let ball = Ball::new(n);
            assert_eq!(ball.triangles(), 8 * u64::from(n * n));
            assert_eq!(ball.points.len(), 4 * (n * n) as usize + 2);
            let mut edges = std::collections::HashSet::new();
            for corners in &ball.triangles {
                let [a, b, c] = corners.map(|i| ball.points[i as usize]);
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "{n}: {corners:?}");
                for i in 0..3 {
                    assert!(edges.insert([corners[i], corners[(i + 1) % 3]]), "{n}: an edge twice");
                }
            }
            assert!(edges.iter().all(|&[from, to]| edges.contains(&[to, from])), "{n}: a hole");
        }
    }
}
