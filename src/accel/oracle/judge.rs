//! What to think of a backend's answer.
//!
//! The class says how the answer stands to the truth. Whether the in-house BVH may give it is another
//! question, which [`Judgement::is_lawful`] answers: its kernel finds some set of triangles, all that are met
//! farther from their edges than the band, none that are missed by more, and where a surface is closed around the ray
//! at least one of it (`band`, `patch`). Of that set it reports the one with the smallest `f32` distance by
//! [`crate::accel::resolve()`], or of several the one of the smallest id.

use super::band::EdgeDistance;
use super::patch::Surroundings;
use super::{Oracle, Verdict};
use crate::accel::{HitFilter, resolve};
use crate::geometry::{NONE, PrimitiveId, Ray};

/// How an answer stands to the exact truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// The one triangle that is met first, or a miss where nothing is met.
    Right,
    /// One of several that are met first at exactly equal distance.
    Tie,
    /// Met, behind the first by no more than one ulp of the `f32` distance.
    NearTie,
    /// Passed by, but connected by edges in the band with one that is met first.
    Neighbour,
    /// Met along its plane, or without area: may be reported or not.
    Grazed,
    /// Met, but not strictly within the ray's interval; or a miss where all that is met is so close to an end of
    /// the interval that its `f32` distance is not within.
    End,
    /// A miss where something is met.
    Missed,
    /// Passed by.
    FalseHit,
    /// Met, but behind another one.
    WrongOrder,
    /// No such triangle, or none that the filter accepts.
    Refused,
}

impl Class {
    /// Every class with its name, for tables.
    pub const ALL: [(&'static str, Self); 10] = [
        ("right", Self::Right),
        ("tie", Self::Tie),
        ("near tie", Self::NearTie),
        ("neighbour", Self::Neighbour),
        ("grazed", Self::Grazed),
        ("end", Self::End),
        ("missed", Self::Missed),
        ("false hit", Self::FalseHit),
        ("wrong order", Self::WrongOrder),
        ("refused", Self::Refused),
    ];
}

/// A triangle that should have been reported instead of the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlooked {
    /// Which one.
    pub id: PrimitiveId,
    /// How far inside its edges the ray passes.
    pub edge: EdgeDistance,
    /// Whether the surface ends or turns back at that edge, seen along the ray. If not, it is closed around the ray,
    /// and none of it was reported: a leak, which no rounding excuses.
    pub silhouette: bool,
}

impl Overlooked {
    /// Whether the rounding of the in-house kernel excuses it.
    pub fn is_excused(&self) -> bool {
        self.silhouette && self.edge.is_in_band()
    }
}

/// What there is to say about an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// How it stands to the truth.
    pub class: Class,
    /// How far outside of the edges of the answer the ray passes; `None` if it meets the answer, or it is a miss.
    pub outside: Option<EdgeDistance>,
    /// Of the triangles that are met and whose `f32` distance (or at equal distances, id) is smaller than that of the
    /// answer, the one whose omission is hardest to excuse. Not looked for if the answer is right, or the first of a tie.
    pub overlooked: Option<Overlooked>,
    /// How far the answer is behind the first that is met, or from the end of the interval that it is not within: in ulps
    /// of the `f32` distance. 0 where that is not the question.
    pub ulps: f64,
    /// Whether its distance is within the interval, and in the right order as far as can be seen.
    in_order: bool,
}

impl Judgement {
    /// Whether the in-house BVH may give this answer.
    pub fn is_lawful(&self) -> bool {
        self.in_order
            && self.outside.is_none_or(|edge| edge.is_in_band())
            && self.overlooked.is_none_or(|other| other.is_excused())
    }

    fn of(class: Class) -> Self {
        let in_order = class != Class::Refused;
        Self { class, outside: None, overlooked: None, ulps: 0.0, in_order }
    }
}

impl Oracle {
    /// Judges what a backend answered: a triangle, or [`PrimitiveId::MISS`].
    pub fn judge<F: HitFilter>(&self, ray: &Ray, filter: &F, answer: PrimitiveId) -> Judgement {
        let verdict = self.closest(ray, filter);
        match verdict.nearest.as_slice() {
            [] if answer == PrimitiveId::MISS => return Judgement::of(Class::Right),
            [(only, _)] if answer == *only => return Judgement::of(Class::Right),
            // Of several that are equally near the rule wants the first.
            [(first, _), ..] if answer == *first => return Judgement::of(Class::Tie),
            _ => {}
        }
        if answer == PrimitiveId::MISS {
            let overlooked =
                self.overlooked(&self.surroundings(ray, filter), answer, f32::INFINITY);
            let class = if overlooked.is_some() { Class::Missed } else { Class::End };
            return Judgement { overlooked, ..Judgement::of(class) };
        }
        if !self.exists(answer) || !self.accepts(ray, filter, answer) {
            return Judgement::of(Class::Refused);
        }
        self.judge_triangle(ray, filter, answer, &verdict)
    }

    /// Judges a triangle that exists and is accepted.
    fn judge_triangle<F: HitFilter>(
        &self,
        ray: &Ray,
        filter: &F,
        answer: PrimitiveId,
        verdict: &Verdict,
    ) -> Judgement {
        let surroundings = self.surroundings(ray, filter);
        let t = resolve(&self.geometry, ray, answer).t;
        let is_within = t > ray.t_min && t < ray.t_max;
        let overlooked = self.overlooked(&surroundings, answer, t);
        let judgement =
            |class| Judgement { overlooked, in_order: is_within, ..Judgement::of(class) };
        let Some(crossing) = self.cross(ray, answer) else {
            let class = if surroundings.are_connected(answer, verdict) {
                Class::Neighbour
            } else {
                Class::FalseHit
            };
            return Judgement { outside: self.edge_distance(ray, answer), ..judgement(class) };
        };
        if verdict.nearest.iter().any(|(id, _)| *id == answer) {
            return judgement(Class::Tie);
        } else if !crossing.place.is_proper() {
            return judgement(Class::Grazed);
        }
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let own = middle(crossing.t);
        if !crossing.is_within() {
            let end = if crossing.compare_to(ray.t_min).is_gt() { ray.t_max } else { ray.t_min };
            let ulps = (own - f64::from(end)).abs() / ulp(end.into());
            return Judgement { ulps, ..judgement(Class::End) };
        }
        let first = middle(verdict.t);
        let ulps = (own - first) / ulp(first);
        if ulps <= 1.0 {
            return Judgement { ulps, ..judgement(Class::NearTie) };
        }
        // If nothing was overlooked, it is the distances that are wrong.
        let in_order = is_within && overlooked.is_some();
        Judgement { ulps, in_order, ..judgement(Class::WrongOrder) }
    }

    /// The triangle that is hardest to excuse among those that should have been reported before the answer at `t`.
    fn overlooked(
        &self,
        surroundings: &Surroundings,
        answer: PrimitiveId,
        t: f32,
    ) -> Option<Overlooked> {
        let Surroundings { near, patches } = surroundings;
        // A patch must be reported if it is closed, over the ray, and all of it is there before the answer.
        let mut must: Vec<_> = patches.iter().map(|patch| patch.is_odd && !patch.is_open).collect();
        let is_before = |hit: &crate::geometry::Hit| (hit.t, hit.id) < (t, answer);
        for other in near {
            must[other.patch] &= other.counts && is_before(&other.hit);
        }
        let grave = |o: &Overlooked| (!o.silhouette, o.edge.ratio());
        near.iter()
            .filter(|other| other.crossing.as_ref().is_some_and(|c| c.place.is_proper()))
            .filter(|other| other.counts && is_before(&other.hit))
            .map(|o| Overlooked { id: o.id, edge: o.edge, silhouette: !must[o.patch] })
            .max_by(|p, q| grave(p).partial_cmp(&grave(q)).unwrap_or(std::cmp::Ordering::Equal))
    }

    fn exists(&self, id: PrimitiveId) -> bool {
        let meshes = match self.geometry.instances.get(id.instance as usize) {
            Some(instance) => &self.geometry.objects[instance.object as usize].meshes,
            None if id.instance == NONE => &self.geometry.meshes,
            None => return false,
        };
        meshes
            .get(id.geometry as usize)
            .and_then(|mesh| mesh.triangles.get(id.primitive as usize))
            .is_some()
    }
}

impl Surroundings {
    /// Whether the answer is in the patch of a triangle that is met first.
    fn are_connected(&self, answer: PrimitiveId, verdict: &Verdict) -> bool {
        let patch_of = |id| self.near.iter().find(|near| near.id == id).map(|near| near.patch);
        let patch = patch_of(answer);
        patch.is_some() && verdict.nearest.iter().any(|(id, _)| patch_of(*id) == patch)
    }
}

/// Distance of the neighbours of an `f32`.
fn ulp(t: f64) -> f64 {
    let t = (t as f32).abs().min(f32::MAX.next_down());
    f64::from(t.next_up()) - f64::from(t)
}
