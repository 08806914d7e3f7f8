//! Whether answers are right: every ray's, against those of a reference, and where they differ, before the judge.

use super::contestant::{Answer, Law};
use super::judge::{Case, Judge};
use super::rays::Query;
use crate::accel::oracle::Class;
use crate::geometry::{Hit, PrimitiveId, Ray};
use serde::Serialize;

/// How the answers to one set of rays compare with the reference.
///
/// Where they differ the exact oracle judges both. An answer is wrong if its law does not allow it: see [`Law`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Agreement {
    /// Rays.
    pub compared: usize,
    /// The reference met a surface, the contestant none.
    pub missed: usize,
    /// The contestant met a surface, the reference none.
    pub false_hits: usize,
    /// Another primitive, and none is nearer than either: their distances are equal as rational numbers.
    pub ties: usize,
    /// Another primitive, and both within rounding of the truth: an ulp behind it, across an edge from it, met along
    /// its plane, or at an end of the ray.
    pub near: usize,
    /// Another primitive, and one of the two is passed by, or behind the nearest by more than an ulp.
    pub different: usize,
    /// Of all these, those where the reference is wrong and the contestant is not.
    pub reference_wrong: usize,
    /// Those where the contestant is wrong: what its law does not allow. Of the reference itself, all rays on which it was
    /// found out by anybody.
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

/// Rays, what was asked about them, and the closest hits of the reference.
#[derive(Clone, Copy)]
pub(super) struct Asked<'r> {
    pub(super) query: Query,
    pub(super) rays: &'r [Ray],
    pub(super) reference: &'r [Hit],
    /// What the reference is held to.
    pub(super) law: Law,
}

/// A ray that was answered otherwise than by the reference.
struct Difference {
    /// Place among the rays.
    place: usize,
    hit: bool,
    /// What is hit; for any hit, the witness.
    id: PrimitiveId,
}

/// What came of a comparison.
pub(super) struct Compared {
    pub(super) agreement: Agreement,
    /// Places of the rays that were answered otherwise, in order.
    pub(super) differing: Vec<usize>,
    /// Of these, those where the reference is wrong, whoever else is.
    pub(super) reference_wrong: Vec<usize>,
}

/// Compares the `answers` of a contestant held to `law` with the reference. `witness` is asked for the closest primitive that the contestant finds on a ray, where it said only that
/// something is hit.
pub(super) fn compare(
    judge: &mut Judge<'_>,
    asked: &Asked<'_>,
    answers: &[Answer],
    law: Law,
    witness: &dyn Fn(&Ray) -> PrimitiveId,
) -> Compared {
    let mut differences = Vec::new();
    for (place, (reference, answer)) in asked.reference.iter().zip(answers).enumerate() {
        let same = match asked.query {
            Query::Closest => answer.id == reference.id,
            Query::AnyHit => answer.hit == reference.is_hit(),
        };
        if !same {
            let is_unnamed = asked.query == Query::AnyHit && answer.hit;
            let id = if is_unnamed { witness(&asked.rays[place]) } else { answer.id };
            differences.push(Difference { place, hit: answer.hit, id });
        }
    }
    let cases = differences.iter().flat_map(|difference| {
        let (ray, reference) = (asked.rays[difference.place], asked.reference[difference.place].id);
        [reference, difference.id].map(|answer| Case { ray, answer })
    });
    let judgements = judge.judge(&cases.collect::<Vec<_>>());

    let mut agreement = Agreement { compared: asked.rays.len(), ..Agreement::default() };
    let mut reference_wrong = Vec::new();
    for (difference, pair) in differences.iter().zip(judgements.chunks_exact(2)) {
        let [theirs, its] = [&pair[0], &pair[1]];
        match (asked.reference[difference.place].is_hit(), difference.hit) {
            (true, false) => agreement.missed += 1,
            (false, _) => agreement.false_hits += 1,
            (true, true) if [theirs, its].iter().all(|j| j.class == Class::Tie) => {
                agreement.ties += 1;
            }
            (true, true) if is_near(theirs.class) && is_near(its.class) => agreement.near += 1,
            (true, true) => agreement.different += 1,
        }
        // Something is hit that the contestant itself cannot name.
        let is_unnamed = difference.hit && difference.id == PrimitiveId::MISS;
        let (is_wrong, theirs_is) = (is_unnamed || !law.allows(its), !asked.law.allows(theirs));
        agreement.unexplained += usize::from(is_wrong);
        agreement.reference_wrong += usize::from(theirs_is && !is_wrong);
        if theirs_is {
            reference_wrong.push(difference.place);
        }
    }
    let differing = differences.into_iter().map(|difference| difference.place).collect();
    Compared { agreement, differing, reference_wrong }
}

/// Whether a triangle of this class is the nearest one but for rounding.
fn is_near(class: Class) -> bool {
    match class {
        Class::Right
        | Class::Tie
        | Class::NearTie
        | Class::Neighbour
        | Class::Grazed
        | Class::End => true,
        Class::Missed | Class::FalseHit | Class::WrongOrder | Class::Refused => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::resolve;
    use crate::geometry::{Geometry, NONE, TriangleMesh};
    use crate::math::Vec3;
    use std::sync::Arc;

    /// Half of a unit square at height z.
    fn half(z: f32) -> [[f32; 3]; 3] {
        [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]
    }

    fn geometry(triangles: &[[[f32; 3]; 3]]) -> Arc<Geometry> {
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let mesh = TriangleMesh::new(triangles.concat(), indices.collect(), false);
        Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() })
    }

    fn id(primitive: u32) -> PrimitiveId {
        PrimitiveId { instance: NONE, geometry: 0, primitive }
    }

    /// Down at (x, 0.25).
    fn ray(x: f32) -> Ray {
        Ray::new(Vec3::new(x, 0.25, 5.0), Vec3::new(0.0, 0.0, -1.0))
    }

    /// What becomes of an answer under its law, and of the reference's under that of the reference; nothing is a miss.
    fn closest(
        geometry: &Arc<Geometry>,
        ray: &Ray,
        (reference, their_law): (Option<u32>, Law),
        (answer, its_law): (Option<u32>, Law),
    ) -> Agreement {
        let reference = reference.map_or(Hit::MISS, |i| resolve(geometry, ray, id(i)));
        let answer = Answer { hit: answer.is_some(), id: answer.map_or(PrimitiveId::MISS, id) };
        let asked = Asked {
            query: Query::Closest,
            rays: std::slice::from_ref(ray),
            reference: &[reference],
            law: their_law,
        };
        let mut judge = Judge::new(geometry, &|_, _| ());
        let never = |_: &Ray| unreachable!("closest hits name themselves");
        compare(&mut judge, &asked, &[answer], its_law, &never).agreement
    }

    /// Of a difference: whether the contestant is wrong, and whether the reference is instead.
    fn blame(
        geometry: &Arc<Geometry>,
        ray: &Ray,
        reference: Option<u32>,
        answer: Option<u32>,
    ) -> (bool, bool) {
        let found = closest(geometry, ray, (reference, Law::Exact), (answer, Law::Exact));
        assert!(found.unexplained + found.reference_wrong <= 1);
        (found.unexplained == 1, found.reference_wrong == 1)
    }

    const NOBODY: (bool, bool) = (false, false);
    const CONTESTANT: (bool, bool) = (true, false);
    const REFERENCE: (bool, bool) = (false, true);

    #[test]
    fn the_nearest_surface_is_right_except_along_its_border() {
        let geometry = geometry(&[0.0, 1.0, 2.0].map(half));
        for (reference, answer, expected) in [
            (Some(2), Some(1), CONTESTANT),
            (Some(1), Some(2), REFERENCE),
            (Some(2), None, CONTESTANT),
            (None, Some(2), REFERENCE),
            // Both are: that is the contestant's fault too.
            (None, Some(0), CONTESTANT),
            (Some(2), Some(2), NOBODY),
        ] {
            let found = blame(&geometry, &ray(0.25), reference, answer);
            assert_eq!(found, expected, "{reference:?} {answer:?}");
            // Along the border, rounding decides; two ulps from it on either side too.
            for x in [0.75_f32, 0.75 + 1.2e-7, 0.75 - 1.2e-7] {
                assert_eq!(blame(&geometry, &ray(x), reference, answer), NOBODY, "{x}");
            }
        }
        // Outside, whoever hits is wrong; twenty ulps are outside.
        for x in [0.7501, 0.75 + 6e-6] {
            assert_eq!(blame(&geometry, &ray(x), None, Some(2)), CONTESTANT, "{x}");
            assert_eq!(blame(&geometry, &ray(x), Some(2), None), REFERENCE, "{x}");
        }
        // No such triangle, no such instance: wrong, not a panic.
        let asked = (Some(2), Law::Exact);
        let found = closest(&geometry, &ray(0.25), asked, (Some(77), Law::Approximate));
        assert_eq!((found.different, found.unexplained), (1, 1));
    }

    #[test]
    fn at_the_ends_of_a_ray_the_rounded_distance_decides() {
        let geometry = geometry(&[half(2.0)]);
        let short = |t_max| Ray { t_max, ..ray(0.25) };
        for (t_max, expected) in
            [(2.999, CONTESTANT), (3.0, CONTESTANT), (3.0_f32.next_up(), REFERENCE)]
        {
            let found = blame(&geometry, &short(t_max), None, Some(0));
            assert_eq!(found, expected, "{t_max}");
        }
        // Met before the end by less than rounding hides: the distance says no, the truth says yes.
        let mut hidden = 0;
        for speed in (1..100).map(|i| 1.0 + i as f32 / 100.0) {
            let ray = Ray { direction: Vec3::new(0.0, 0.0, -speed), ..ray(0.25) };
            let ray = Ray { t_max: resolve(&geometry, &ray, id(0)).t, ..ray };
            if 3.0 < f64::from(ray.t_max) * f64::from(speed) {
                assert_eq!(blame(&geometry, &ray, None, Some(0)), NOBODY, "{speed}");
                assert_eq!(blame(&geometry, &ray, Some(0), None), NOBODY, "{speed}");
                hidden += 1;
            }
        }
        assert!(hidden > 20, "{hidden}");
    }

    #[test]
    fn ties_are_exact_and_whose_law_they_break_is_told_apart() {
        let (exact, free) = (Law::Exact, Law::Approximate);
        // The same triangle twice; and one behind by half an ulp of the distance.
        for (behind, is_tie) in [(2.0_f32, true), (2.0_f32.next_down(), false)] {
            let geometry = geometry(&[half(2.0), half(behind)]);
            for ((first, its_law), (second, their_law), [unexplained, reference_wrong]) in [
                ((0, exact), (1, free), [0, 0]),
                ((0, exact), (1, exact), [0, 1]),
                ((1, exact), (0, free), [1, 0]),
                ((1, free), (0, exact), [0, 0]),
            ] {
                let (its, theirs) = ((Some(first), its_law), (Some(second), their_law));
                let found = closest(&geometry, &ray(0.25), theirs, its);
                let counts = (found.ties, found.near, found.different);
                assert_eq!(counts, if is_tie { (1, 0, 0) } else { (0, 1, 0) });
                let blame = [found.unexplained, found.reference_wrong];
                assert_eq!(blame, [unexplained, reference_wrong], "{its:?} {theirs:?}");
            }
        }
    }

    #[test]
    fn the_other_side_of_an_edge_is_near_and_farther_off_it_is_not() {
        let other = [[1.0, 0.0, 2.0], [1.0, 1.0, 2.0], [0.0, 1.0, 2.0]];
        let geometry = geometry(&[half(2.0), other]);
        for (x, near, unexplained) in [(0.75 - 1.2e-7, 1, 0), (0.74, 0, 1)] {
            let found = closest(&geometry, &ray(x), (Some(0), Law::Exact), (Some(1), Law::Exact));
            assert_eq!((found.near, found.different), (near, 1 - near), "{x}");
            assert_eq!((found.unexplained, found.reference_wrong), (unexplained, 0), "{x}");
        }
        // But one of them is there: no rounding excuses a miss.
        let miss = (None, Law::Exact);
        let found = closest(&geometry, &ray(0.75), (Some(0), Law::Exact), miss);
        assert_eq!((found.missed, found.unexplained), (1, 1));
    }

    #[test]
    fn every_kind_of_difference_is_counted() {
        let geometry = geometry(&[0.0, 1.0, 2.0].map(half));
        let mut judge = Judge::new(&geometry, &|_, _| ());
        let rays = [ray(0.25); 5];
        let hit = |i| resolve(&geometry, &rays[0], id(i));
        let reference = [hit(2), hit(2), Hit::MISS, hit(2), hit(2)];
        let told = [Some(2), None, Some(2), Some(1), Some(2)];
        let answer = |told: Option<u32>| Answer {
            hit: told.is_some(),
            id: told.map_or(PrimitiveId::MISS, id),
        };
        let answers = told.map(answer);
        let never = |_: &Ray| unreachable!("closest hits name themselves");
        let asked =
            Asked { query: Query::Closest, rays: &rays, reference: &reference, law: Law::Exact };
        let Compared { agreement: found, differing: places, .. } =
            compare(&mut judge, &asked, &answers, Law::Exact, &never);
        let expected = Agreement {
            compared: 5,
            missed: 1,
            false_hits: 1,
            different: 1,
            reference_wrong: 1,
            unexplained: 2,
            ..Agreement::default()
        };
        assert_eq!((found, places), (expected, vec![1, 2, 3]));
        assert_eq!(found.differing(), 3);

        // Any hit: whatever blocks will do, but it must be there.
        let answers =
            [true, false, true, true, true].map(|hit| Answer { hit, id: PrimitiveId::MISS });
        let asked = Asked { query: Query::AnyHit, ..asked };
        for (witness, unexplained) in [(id(2), 1), (PrimitiveId::MISS, 2)] {
            let Compared { agreement: found, differing: places, .. } =
                compare(&mut judge, &asked, &answers, Law::Exact, &|_| witness);
            assert_eq!((found.missed, found.false_hits, places), (1, 1, vec![1, 2]));
            assert_eq!(found.unexplained, unexplained, "{witness:?}");
        }
    }
}
