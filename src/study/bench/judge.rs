//! The judge of a bench: the exact oracle, built when it is first asked, and gone before anybody races.
//!
//! What it thinks of an answer is not yet whether that is wrong: see [`super::Law`].

use super::Tell;
use crate::accel::AcceptAll;
use crate::accel::oracle::{Judgement, Oracle};
use crate::geometry::{Geometry, PrimitiveId, Ray};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;

/// What the exact oracle did. Its time comes on top of that which the bench was given.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Judging {
    /// Answers that it judged, of trials too: two for each ray on which a contestant differs from the reference, and the
    /// samples of those on which all agree.
    pub judged: usize,
    /// Wall-clock seconds to build it.
    pub build_seconds: f64,
    /// Wall-clock seconds that it took to judge.
    pub judge_seconds: f64,
}

/// An answer to be judged.
#[derive(Clone, Copy)]
pub(super) struct Case {
    pub(super) ray: Ray,
    /// The triangle that is said to be met first, or [`PrimitiveId::MISS`].
    pub(super) answer: PrimitiveId,
}

/// Cases between two signs of progress: a second or less.
const SESSION: usize = 4096;

/// The judge. None of its time is the contestants'.
pub(super) struct Judge<'a> {
    geometry: &'a Arc<Geometry>,
    oracle: Option<Oracle>,
    /// What it has done so far.
    pub(super) work: Judging,
    tell: Tell<'a>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(geometry: &'a Arc<Geometry>, tell: Tell<'a>) -> Self {
        Self { geometry, oracle: None, work: Judging::default(), tell }
    }

    /// What the oracle says of each case. Cut-outs are solid.
    pub(super) fn judge(&mut self, cases: &[Case]) -> Vec<Judgement> {
        if cases.is_empty() {
            return Vec::new();
        }
        let start = Instant::now();
        let oracle = self.oracle.get_or_insert_with(|| {
            (self.tell)("building the oracle", 0.0);
            let oracle = Oracle::build(self.geometry.clone());
            self.work.build_seconds += start.elapsed().as_secs_f64();
            oracle
        });
        let start = Instant::now();
        let mut judgements = Vec::with_capacity(cases.len());
        for session in cases.chunks(SESSION) {
            (self.tell)("judging answers", judgements.len() as f64 / cases.len() as f64);
            let judge = |case: &Case| oracle.judge(&case.ray, &AcceptAll, case.answer);
            judgements.par_extend(session.par_iter().map(judge));
        }
        self.work.judge_seconds += start.elapsed().as_secs_f64();
        self.work.judged += cases.len();
        judgements
    }

    /// Gives back the memory of the oracle.
    pub(super) fn leave(&mut self) {
        self.oracle = None;
    }
}
