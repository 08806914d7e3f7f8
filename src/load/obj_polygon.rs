//! Polygons to triangles: a fan where the polygon is convex, ears clipped off where it is not.
//!
//! G. H. Meisters, "Polygons have ears", American Mathematical Monthly 82 (1975): every simple polygon
//! with more than three corners has two corners whose triangle lies inside it. The plane is the one of
//! Newell's normal (the sum of the cross products along the outline), so slightly warped polygons work too.

use crate::math::{DVec2, DVec3};

/// Containment tests allowed a corner: bounds the time of a polygon that seems made to waste it. Simple
/// polygons of up to about 8000 corners stay within.
const TESTS_PER_CORNER: usize = 4096;

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// The triangles cover the polygon.
    Exact,
    /// It has no clear inside (it crosses itself, or has no area): some triangles are a mere fan.
    Fan,
}

/// Cuts polygons; keeps its working memory.
#[derive(Debug, Default)]
pub(super) struct Triangulator {
    /// The corners in the polygon's plane, counter-clockwise.
    flat: Vec<DVec2>,
    /// Corners not yet cut off.
    remaining: Vec<u32>,
}

impl Triangulator {
    /// Appends to `triangles` the n - 2 triangles of the polygon `corners` (n >= 3), as indices into it,
    /// each turning the way the polygon does.
    pub(super) fn cut(&mut self, corners: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> Cut {
        self.remaining.clear();
        self.remaining.extend(0..corners.len() as u32);
        if corners.len() == 3 {
            self.fan(triangles);
            return Cut::Exact;
        }
        self.flatten(corners);
        let n = self.flat.len();
        if (0..n).all(|i| self.turn([(i + n - 1) % n, i, (i + 1) % n].map(|k| k as u32)) > 0.0) {
            self.fan(triangles);
            return Cut::Exact;
        }
        self.clip_ears(triangles);
        let rest = &self.remaining;
        let mut turns = rest.windows(3).map(|t| self.turn([t[0], t[1], t[2]]));
        let is_covered = if rest.len() == 3 {
            turns.all(|turn| turn >= 0.0)
        } else {
            turns.all(|turn| turn == 0.0)
        };
        self.fan(triangles);
        if is_covered { Cut::Exact } else { Cut::Fan }
    }

    /// Projects the corners along the axis that the polygon faces most, keeping its sense of rotation.
    fn flatten(&mut self, corners: &[DVec3]) {
        let origin = corners[0];
        let edges = corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin));
        let normal: DVec3 = edges.sum();
        let size = normal.abs();
        let project = |p: DVec3| {
            let p = p - origin;
            if size.z >= size.x && size.z >= size.y {
                DVec2::new(p.x * normal.z.signum(), p.y)
            } else if size.y >= size.x {
                DVec2::new(p.z * normal.y.signum(), p.x)
            } else {
                DVec2::new(p.y * normal.x.signum(), p.z)
            }
        };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|&p| project(p)));
    }

    /// Cuts ears off until a triangle is left, or no ear is found.
    fn clip_ears(&mut self, triangles: &mut Vec<[u32; 3]>) {
        let mut tests_left = self.flat.len() * TESTS_PER_CORNER;
        let mut at = 0;
        let mut tried = 0;
        while self.remaining.len() > 3 && tried < self.remaining.len() {
            let n = self.remaining.len();
            at %= n;
            let ear = [(at + n - 1) % n, at, (at + 1) % n].map(|i| self.remaining[i]);
            tried += 1;
            if self.turn(ear) > 0.0 {
                if tests_left < n {
                    return;
                }
                tests_left -= n;
                if self.is_empty(ear) {
                    triangles.push(ear);
                    self.remaining.remove(at);
                    tried = 0;
                }
            }
            // The next corner even after a cut, so that ears are taken from all around.
            at += 1;
        }
    }

    /// Whether no other remaining corner lies in the triangle or on its outline. Corners at the same place
    /// as its own do not count: outlines with holes pass twice through the bridge to the hole.
    fn is_empty(&self, triangle: [u32; 3]) -> bool {
        let [a, b, c] = triangle;
        let own = triangle.map(|i| self.flat[i as usize]);
        self.remaining.iter().all(|&p| {
            own.contains(&self.flat[p as usize])
                || self.turn([a, b, p]) < 0.0
                || self.turn([b, c, p]) < 0.0
                || self.turn([c, a, p]) < 0.0
        })
    }

    /// Twice the signed area of a triangle: positive for a left turn.
    fn turn(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.flat[i as usize]);
        (b - a).perp_dot(c - b)
    }

    fn fan(&self, triangles: &mut Vec<[u32; 3]>) {
        let rest = &self.remaining;
        triangles.extend(rest.windows(2).skip(1).map(|pair| [rest[0], pair[0], pair[1]]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[DVec3]) -> (Cut, Vec<[u32; 3]>) {
        let mut triangles = Vec::new();
        let cut = Triangulator::default().cut(corners, &mut triangles);
        assert_eq!(triangles.len(), corners.len() - 2);
        (cut, triangles)
    }

    /// The outline in four planes and from every starting corner: the triangles' area vectors must all
    /// point the way of the polygon's and add up to it.
    fn assert_covered(outline: &[[f64; 2]]) {
        let frames = [
            [DVec3::X, DVec3::Y],
            [DVec3::NEG_X, DVec3::Y],
            [DVec3::Y, DVec3::Z],
            [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 1.0, 0.0)],
        ];
        for [u, v] in frames {
            for start in 0..outline.len() {
                let corners: Vec<DVec3> = (0..outline.len())
                    .map(|i| outline[(i + start) % outline.len()])
                    .map(|[x, y]| u * x + v * y)
                    .collect();
                let expected: DVec3 = corners.windows(2).map(|p| p[0].cross(p[1])).sum::<DVec3>()
                    + corners[corners.len() - 1].cross(corners[0]);
                let (how, triangles) = cut(&corners);
                assert_eq!(how, Cut::Exact);
                let mut covered = 0.0;
                for t in triangles {
                    let [a, b, c] = t.map(|i| corners[i as usize]);
                    let area = (b - a).cross(c - a);
                    assert!(
                        area.dot(expected) > 0.0,
                        "{t:?} of {outline:?} is flat or turned over"
                    );
                    covered += area.length();
                }
                assert!((covered - expected.length()).abs() <= 1e-12 * covered);
            }
        }
    }

    #[test]
    fn concave_polygons_are_covered_exactly() {
        assert_covered(&[[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]]);
        assert_covered(&[
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ]);
        let star: Vec<[f64; 2]> = (0..14)
            .map(|i| {
                let (s, c) = crate::math::fun::sin_cos_turns(i as f32 / 14.0);
                let r = if i % 2 == 0 { 2.0 } else { 0.7 };
                [f64::from(c) * r, f64::from(s) * r]
            })
            .collect();
        assert_covered(&star);
    }

    #[test]
    fn corners_on_an_edge_make_no_flat_triangle() {
        assert_covered(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        assert_covered(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [2.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ]);
    }

    #[test]
    fn a_hole_reached_over_a_bridge_stays_open() {
        assert_covered(&[
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ]);
    }

    #[test]
    fn convex_polygons_are_fans() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::ONE - DVec3::Z, DVec3::Y];
        assert_eq!(cut(&square), (Cut::Exact, vec![[0, 1, 2], [0, 2, 3]]));
        let warped = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
        assert_eq!(cut(&warped).1, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn polygons_without_an_inside_fall_back() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let corners = bow_tie.map(|[x, y]| DVec3::new(x, y, 0.0));
        assert_eq!(cut(&corners).0, Cut::Fan);
        // All on a line, and all at one place: nothing to cover.
        let line: Vec<DVec3> = (0..6).map(|i| DVec3::splat(f64::from(i))).collect();
        assert_eq!(cut(&line).0, Cut::Exact);
        assert_eq!(cut(&[DVec3::ONE; 7]).0, Cut::Exact);
    }

    #[test]
    fn a_polygon_made_to_waste_time_ends() {
        // A comb: a third of its corners is reflex.
        let teeth = 6000;
        let mut corners = Vec::new();
        for i in 0..teeth {
            let x = f64::from(i);
            corners.extend([DVec3::new(x, 0.0, 0.0), DVec3::new(x + 0.5, 9.0, 0.0)]);
        }
        corners.push(DVec3::new(f64::from(teeth), -1.0, 0.0));
        corners.push(DVec3::new(0.0, -1.0, 0.0));
        cut(&corners);
    }
}
