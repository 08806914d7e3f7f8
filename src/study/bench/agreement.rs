//! Whether answers are right: every ray's, against those of a reference.
//!
//! Where the two differ, [`judge`] decides by arithmetic in `f64` which of them is wrong, if any: rays that
//! pass an edge, or an end of their segment, within the rounding errors of `f32` may go either way.

use super::contestant::Answer;
use super::rays::Query;
use crate::accel::resolve;
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use crate::math::{DVec3, UNIT_ROUNDOFF};
use serde::Serialize;

/// How the answers to one set of rays compare with the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Agreement {
    /// Rays.
    pub compared: usize,
    /// The reference met a surface, the contestant none.
    pub missed: usize,
    /// The contestant met a surface, the reference none.
    pub false_hits: usize,
    /// Another primitive at the same distance, bit by bit.
    pub ties: usize,
    /// Another primitive, as far to one part in 100 000.
    pub near: usize,
    /// Another primitive at another distance.
    pub different: usize,
    /// Of all these, those where the reference is wrong.
    pub reference_wrong: usize,
    /// Of all these, those where the contestant is wrong.
    pub unexplained: usize,
    /// Timed turns whose answers were not those that had been compared.
    pub unsteady_turns: usize,
}

impl Agreement {
    /// Rays that were answered otherwise.
    pub fn differing(&self) -> usize {
        self.missed + self.false_hits + self.ties + self.near + self.different
    }

    /// Both together.
    pub fn add(&mut self, other: &Self) {
        self.compared += other.compared;
        self.missed += other.missed;
        self.false_hits += other.false_hits;
        self.ties += other.ties;
        self.near += other.near;
        self.different += other.different;
        self.reference_wrong += other.reference_wrong;
        self.unexplained += other.unexplained;
        self.unsteady_turns += other.unsteady_turns;
    }
}

/// Compares `answers` to `rays` with the closest hits of the `reference`. `witness` is asked for the closest
/// primitive that the contestant finds on a ray, where it said only that something is hit.
pub(super) fn compare(
    geometry: &Geometry,
    query: Query,
    rays: &[Ray],
    reference: &[Hit],
    answers: &[Answer],
    witness: &dyn Fn(&Ray) -> PrimitiveId,
) -> Agreement {
    let mut agreement = Agreement { compared: rays.len(), ..Agreement::default() };
    for ((ray, reference), answer) in rays.iter().zip(reference).zip(answers) {
        let same = match query {
            Query::Closest => answer.id == reference.id,
            Query::AnyHit => answer.hit == reference.is_hit(),
        };
        if same {
            continue;
        }
        let asked = query == Query::AnyHit && answer.hit;
        let id = if asked { witness(ray) } else { answer.id };
        match (reference.is_hit(), answer.hit) {
            (true, false) => agreement.missed += 1,
            (false, _) => agreement.false_hits += 1,
            (true, true) => {
                let t = resolve(geometry, ray, id).t;
                if t == reference.t {
                    agreement.ties += 1;
                } else if (t - reference.t).abs() <= 1e-5 * reference.t {
                    agreement.near += 1;
                } else {
                    agreement.different += 1;
                }
            }
        }
        // Blocked by nothing that the contestant itself could name.
        if answer.hit && id == PrimitiveId::MISS {
            agreement.unexplained += 1;
            continue;
        }
        match judge(geometry, ray, reference.id, id) {
            Verdict::Lawful => {}
            Verdict::ReferenceWrong => agreement.reference_wrong += 1,
            Verdict::Wrong => agreement.unexplained += 1,
        }
    }
    agreement
}

/// Who is to blame for a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// Nobody: rounding decides.
    Lawful,
    /// The reference.
    ReferenceWrong,
    /// The contestant.
    Wrong,
}

/// Decides between the closest primitive according to the reference and according to a contestant (either
/// may be [`PrimitiveId::MISS`]).
fn judge(geometry: &Geometry, ray: &Ray, reference: PrimitiveId, answer: PrimitiveId) -> Verdict {
    let met = |id: PrimitiveId| {
        if id == PrimitiveId::MISS { Meeting::NONE } else { Meeting::of(geometry, ray, id) }
    };
    let (theirs, its) = (met(reference), met(answer));
    if answer != PrimitiveId::MISS && its.certainty == Certainty::No {
        return Verdict::Wrong;
    }
    if reference != PrimitiveId::MISS && theirs.certainty == Certainty::No {
        return Verdict::ReferenceWrong;
    }
    // A surface that is certainly there must not be passed over for what is certainly farther.
    let band = theirs.band + its.band;
    if theirs.certainty == Certainty::Yes && its.t > theirs.t + band {
        Verdict::Wrong
    } else if its.certainty == Certainty::Yes && theirs.t > its.t + band {
        Verdict::ReferenceWrong
    } else {
        Verdict::Lawful
    }
}

/// Whether and where a ray meets a triangle.
struct Meeting {
    certainty: Certainty,
    t: f64,
    /// How far off a computation in `f32` may find `t`.
    band: f64,
}

/// What rounding can do to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Certainty {
    /// The ray passes outside of the triangle, farther than rounding errors reach.
    No,
    /// It passes along an edge, or the triangle lies at an end of the segment, or edge-on.
    Perhaps,
    /// It meets the triangle, farther inside than rounding errors reach.
    Yes,
}

/// Round-offs of the largest number in a computation that its result may be off by: three components of
/// differences, of a cross product and of a dot product, rounded up to a power of two.
const ROUND_OFFS: f64 = 16.0;

impl Meeting {
    /// Nothing is met, ever so far away.
    const NONE: Self = Self { certainty: Certainty::No, t: f64::INFINITY, band: 0.0 };

    fn of(geometry: &Geometry, ray: &Ray, id: PrimitiveId) -> Self {
        let (vertices, instance_magnitude) = geometry.world_vertices(id);
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let corners = vertices.map(|vertex| vertex - o);
        // What `f32` arithmetic on these vectors is exact to.
        let largest = corners.iter().fold(0.0_f64, |most, corner| most.max(corner.length()));
        let through_instance = f64::from(instance_magnitude);
        let error = ROUND_OFFS * f64::from(UNIT_ROUNDOFF) * (largest + through_instance);

        // On which side of each edge the ray passes: volumes, whose error is that of a distance times
        // the lengths of edge and direction.
        let (mut left, mut right, mut close) = (false, false, false);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let edge = b - a;
            let volume = d.dot(a.cross(edge));
            let uncertain = volume.abs() <= error * edge.length() * d.length();
            close |= uncertain;
            left |= !uncertain && volume > 0.0;
            right |= !uncertain && volume < 0.0;
        }

        let normal: DVec3 = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let det = normal.dot(d);
        let edge_on =
            det.abs() <= ROUND_OFFS * f64::from(UNIT_ROUNDOFF) * normal.length() * d.length();
        if edge_on {
            let t = corners[0].dot(d) / d.length_squared();
            let certainty = if left && right { Certainty::No } else { Certainty::Perhaps };
            return Self { certainty, t, band: f64::INFINITY };
        }
        let t = normal.dot(corners[0]) / det;
        let band = error * normal.length() / det.abs();
        let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
        let beyond = t < t_min - band || t > t_max + band;
        let at_end = t <= t_min + band || t >= t_max - band;
        let certainty = if left && right || beyond {
            Certainty::No
        } else if close || at_end {
            Certainty::Perhaps
        } else {
            Certainty::Yes
        };
        Self { certainty, t, band }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{NONE, TriangleMesh};
    use crate::math::Vec3;

    /// Unit right triangles in the planes z = 0, 1, 2.
    fn geometry() -> Geometry {
        let positions =
            (0..3).flat_map(|z| [[0.0, 0.0, z as f32], [1.0, 0.0, z as f32], [0.0, 1.0, z as f32]]);
        let triangles = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let mesh = TriangleMesh::new(positions.collect(), triangles, false);
        Geometry { meshes: vec![mesh], ..Geometry::default() }
    }

    fn id(primitive: u32) -> PrimitiveId {
        PrimitiveId { instance: NONE, geometry: 0, primitive }
    }

    /// Down through all three, at (x, 0.25).
    fn ray(x: f32) -> Ray {
        Ray::new(Vec3::new(x, 0.25, 5.0), Vec3::new(0.0, 0.0, -1.0))
    }

    #[test]
    fn the_nearest_surface_that_is_certainly_there_is_right() {
        let geometry = geometry();
        let verdict = |x, a, b| judge(&geometry, &ray(x), a, b);
        for (reference, answer, expected) in [
            (id(2), id(1), Verdict::Wrong),
            (id(1), id(2), Verdict::ReferenceWrong),
            (id(2), PrimitiveId::MISS, Verdict::Wrong),
            (PrimitiveId::MISS, id(0), Verdict::ReferenceWrong),
            (id(2), id(2), Verdict::Lawful),
        ] {
            assert_eq!(verdict(0.25, reference, answer), expected, "{reference:?} {answer:?}");
            // Along the border, nobody can tell.
            assert_eq!(verdict(0.75, reference, answer), Verdict::Lawful);
        }
        // Outside, whoever hits is wrong.
        assert_eq!(verdict(0.7501, PrimitiveId::MISS, id(2)), Verdict::Wrong);
        assert_eq!(verdict(0.7501, id(2), PrimitiveId::MISS), Verdict::ReferenceWrong);
    }

    #[test]
    fn ends_of_segments_are_borders_too() {
        let geometry = geometry();
        let short = |t_max| Ray { t_max, ..ray(0.25) };
        for (t_max, expected) in
            [(2.999, Verdict::Wrong), (3.0, Verdict::Lawful), (3.001, Verdict::ReferenceWrong)]
        {
            let verdict = judge(&geometry, &short(t_max), PrimitiveId::MISS, id(2));
            assert_eq!(verdict, expected, "{t_max}");
        }
    }

    #[test]
    fn every_kind_of_difference_is_counted() {
        let geometry = geometry();
        let rays = [ray(0.25); 5];
        let hit = |i| resolve(&geometry, &rays[0], id(i));
        let reference = [hit(2), hit(2), Hit::MISS, hit(2), hit(2)];
        let told = [Some(2), None, Some(0), Some(1), Some(2)];
        let answer = |told: Option<u32>| Answer {
            hit: told.is_some(),
            id: told.map_or(PrimitiveId::MISS, id),
        };
        let answers = told.map(answer);
        let never = |_: &Ray| unreachable!("closest hits name themselves");
        let found = compare(&geometry, Query::Closest, &rays, &reference, &answers, &never);
        let expected = Agreement {
            compared: 5,
            missed: 1,
            false_hits: 1,
            different: 1,
            reference_wrong: 1,
            unexplained: 2,
            ..Agreement::default()
        };
        assert_eq!(found, expected);
        assert_eq!(found.differing(), 3);

        // Any hit: whatever blocks will do, but it must be there.
        let answers =
            [true, false, true, true, true].map(|hit| Answer { hit, id: PrimitiveId::MISS });
        for (witness, unexplained) in [(id(0), 1), (PrimitiveId::MISS, 2)] {
            let found =
                compare(&geometry, Query::AnyHit, &rays, &reference, &answers, &|_| witness);
            assert_eq!((found.missed, found.false_hits), (1, 1));
            assert_eq!(found.unexplained, unexplained, "{witness:?}");
        }
    }
}
