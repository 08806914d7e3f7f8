//! The field of a contest: contestants, their rays and room for them; turns, checks and heats.

use super::Tell;
use super::agreement::{Asked, Compared, compare};
use super::contestant::{Answer, Contestant, Law, Role};
use super::course::{BATCH, Course};
use super::crew::Lap;
use super::judge::Judge;
use super::rays::{Query, RayKind, RaySet};
use crate::accel::resolve_all;
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use crate::sampling::hash::combine;
use std::sync::Arc;

/// Rays that a contestant traces before the clock starts: a few milliseconds, in which its nodes come back to
/// the caches that the contestant before has filled with its own.
const WARM_UP: usize = 16 * BATCH;

/// Rays of a turn, at least: some ten milliseconds.
const TURN: usize = 64 * BATCH;

/// Rays that a worker should have to itself in a turn, at least.
const SHARE: usize = 16 * BATCH;

/// Rays of a heat.
const SAMPLE: usize = 32 * BATCH;

/// How often a heat is run.
const HEATS: usize = 3;

/// Contestants that qualify in a heat.
const QUALIFIERS: usize = 2;

/// Contestants and room for their rays.
pub(super) struct Field<'a> {
    geometry: &'a Geometry,
    contestants: &'a [Contestant<'a>],
    pub(super) judge: Judge<'a>,
    courses: Vec<Course<'a>>,
    most_threads: usize,
    /// Rays of a turn.
    turn: usize,
}

/// Rays with the answers of the reference.
pub(super) struct Event<'a> {
    pub(super) set: &'a RaySet,
    pub(super) reference: Vec<Hit>,
    /// What the reference is held to.
    pub(super) law: Law,
}

/// How fast a contestant was in a heat.
pub(super) struct HeatTime {
    pub(super) contestant: usize,
    /// Of the quickest run; none where answers were wrong.
    pub(super) rays_per_second: Option<f64>,
    pub(super) qualified: bool,
}

/// All answers of a contestant to an event.
pub(super) struct Checked {
    pub(super) compared: Compared,
    pub(super) hits: usize,
    /// Of the answers of each turn, so that later ones can be held against them.
    pub(super) digests: Vec<u64>,
}

impl<'a> Field<'a> {
    pub(super) fn new(
        geometry: &'a Arc<Geometry>,
        contestants: &'a [Contestant<'a>],
        most_threads: usize,
        tell: Tell<'a>,
    ) -> Self {
        Self {
            geometry,
            contestants,
            judge: Judge::new(geometry, tell),
            courses: contestants.iter().map(|_| Course::default()).collect(),
            most_threads,
            turn: TURN.max(SHARE * most_threads),
        }
    }

    /// Whether a contestant answers what is asked about rays of this kind.
    pub(super) fn takes_part(&self, contestant: usize, kind: RayKind) -> bool {
        self.contestants[contestant].tracer.batch(kind.query()).is_some()
    }

    /// Whose answers are the reference.
    pub(super) fn reference(&self) -> usize {
        self.contestants.iter().position(|c| c.role == Role::Baseline).unwrap_or(0)
    }

    /// Rays with the answers of the baseline, or of the first contestant where there is none.
    pub(super) fn event(&mut self, set: &'a RaySet) -> Event<'a> {
        let baseline = self.reference();
        let (reference, law) = match self.contestants.get(baseline) {
            Some(contestant) => {
                let course = &mut self.courses[baseline];
                let hits = closest(self.geometry, contestant, course, &set.rays, self.most_threads);
                (hits, contestant.law)
            }
            None => (vec![Hit::MISS; set.rays.len()], Law::Exact),
        };
        Event { set, reference, law }
    }

    /// Number of turns in which a contestant traces all rays.
    pub(super) fn turns(&self, set: &RaySet) -> usize {
        set.rays.len().div_ceil(self.turn)
    }

    /// The rays of a turn.
    fn stretch<'r, T>(&self, all: &'r [T], turn: usize) -> &'r [T] {
        &all[turn * self.turn..all.len().min((turn + 1) * self.turn)]
    }

    /// Has a contestant trace the rays of a turn: how long it took, and the answers.
    pub(super) fn run(
        &mut self,
        contestant: usize,
        set: &RaySet,
        turn: usize,
        threads: usize,
    ) -> (Lap, Vec<Answer>) {
        // The rays that come before: for the first turn, those of the last.
        let end = if turn == 0 { set.rays.len() } else { turn * self.turn };
        let warm_up = &set.rays[end.saturating_sub(WARM_UP)..end];
        let rays = self.stretch(&set.rays, turn);
        let course = &mut self.courses[contestant];
        let query = set.kind.query();
        let lap = course.run(&self.contestants[contestant], query, (warm_up, rays), threads);
        (lap, course.answers(query, warm_up.len(), rays.len()))
    }

    /// Compares all answers of a contestant. Nothing is timed.
    pub(super) fn check(&mut self, contestant: usize, event: &Event<'_>) -> Checked {
        let (mut hits, mut digests, mut answers) = (0, Vec::new(), Vec::new());
        for turn in 0..self.turns(event.set) {
            let (_, those) = self.run(contestant, event.set, turn, self.most_threads);
            hits += those.iter().filter(|answer| answer.hit).count();
            digests.push(digest(&those));
            answers.extend(those);
        }
        let Event { set, reference, law } = event;
        let query = set.kind.query();
        let asked = Asked { query, rays: &set.rays, reference, law: *law };
        Checked { compared: self.compare(contestant, &asked, &answers), hits, digests }
    }

    fn compare(&mut self, contestant: usize, asked: &Asked<'_>, answers: &[Answer]) -> Compared {
        let Contestant { tracer, law, isa, .. } = &self.contestants[contestant];
        let witness = |ray: &Ray| {
            let mut answers = Vec::new();
            if let Some(mut batch) = tracer.batch(Query::Closest) {
                batch.load(std::slice::from_ref(ray));
                batch.trace();
                batch.read(&mut answers);
            }
            answers.first().map_or(PrimitiveId::MISS, |answer| answer.id)
        };
        isa.limit();
        compare(&mut self.judge, asked, answers, *law, &witness)
    }

    /// Times every contestant that must qualify on a sample of the rays, on one thread.
    pub(super) fn heats(&mut self, event: &Event<'_>) -> Vec<HeatTime> {
        let (query, all) = (event.set.kind.query(), event.set.rays.len());
        // From the middles of both halves, in which some kinds of rays differ.
        let part = all.min(SAMPLE).div_ceil(2);
        let parts = [all / 4, 3 * all / 4].map(|middle| {
            let start = middle.saturating_sub(part / 2);
            start..(start + part).min(all)
        });
        let rays = parts.clone().map(|part| &event.set.rays[part]).concat();
        let reference = parts.map(|part| &event.reference[part]).concat();

        let must = |i: &usize| {
            self.contestants[*i].role == Role::Heat && self.takes_part(*i, event.set.kind)
        };
        let entrants: Vec<_> = (0..self.contestants.len()).filter(must).collect();
        let mut best = vec![f64::INFINITY; entrants.len()];
        for _ in 0..HEATS {
            for (&i, best) in entrants.iter().zip(&mut best) {
                let contestant = &self.contestants[i];
                *best = best.min(self.courses[i].run(contestant, query, (&[], &rays), 1).seconds);
            }
        }
        let mut times: Vec<_> = entrants
            .iter()
            .zip(best)
            .map(|(&i, seconds)| {
                let answers = self.courses[i].answers(query, 0, rays.len());
                let asked = Asked { query, rays: &rays, reference: &reference, law: event.law };
                let agreement = self.compare(i, &asked, &answers).agreement;
                let law = self.contestants[i].law;
                let right = law.tolerates(agreement.unexplained, agreement.compared);
                let rays_per_second = right.then(|| rays.len() as f64 / seconds);
                HeatTime { contestant: i, rays_per_second, qualified: false }
            })
            .collect();
        // The quickest first; those without a time last.
        let speed = |time: &HeatTime| time.rays_per_second.unwrap_or(0.0);
        times.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
        for time in times.iter_mut().take(QUALIFIERS) {
            time.qualified = time.rays_per_second.is_some();
        }
        times
    }
}

/// The closest hits that a contestant finds.
pub(super) fn closest<'a>(
    geometry: &Geometry,
    contestant: &'a Contestant<'a>,
    course: &mut Course<'a>,
    rays: &[Ray],
    threads: usize,
) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    for (rays, hits) in rays.chunks(TURN).zip(hits.chunks_mut(TURN)) {
        course.run(contestant, Query::Closest, (&[], rays), threads);
        let answers = course.answers(Query::Closest, 0, rays.len());
        let ids: Vec<_> = answers.iter().map(|answer| answer.id).collect();
        resolve_all(geometry, rays, &ids, hits);
    }
    hits
}

/// Tells answers apart.
pub(super) fn digest(answers: &[Answer]) -> u64 {
    answers.iter().fold(0, |hash, answer| {
        let PrimitiveId { instance, geometry, primitive } = answer.id;
        let hash = combine(hash, u64::from(instance) << 32 | u64::from(geometry));
        combine(hash, u64::from(primitive) << 1 | u64::from(answer.hit))
    })
}
