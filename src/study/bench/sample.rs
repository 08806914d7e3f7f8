//! Answers on which all agree, before the judge: agreement proves nothing where all are wrong.

use super::contestant::Law;
use super::field::{Checked, Event};
use super::judge::{Case, Judge};
use crate::accel::oracle::Judgement;
use crate::sampling::CounterRng;
use serde::Serialize;
use std::collections::HashSet;

/// What the exact oracle says where all contestants agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Sample {
    /// Rays, spread evenly over all of their kind, of which the reference's closest hit was judged.
    pub judged: usize,
    /// Of those, where it is wrong by the strictest law that anybody is held to.
    pub wrong: usize,
}

impl Sample {
    /// What there is to tell of these judgements, of answers of all who are held to the `laws`.
    pub(super) fn new(judgements: &[Judgement], laws: impl Iterator<Item = Law>) -> Self {
        let wrong = laws.map(|law| wrong_by(judgements, law)).max().unwrap_or(0);
        Self { judged: judgements.len(), wrong }
    }
}

/// How many of those answers a law does not allow.
pub(super) fn wrong_by(judgements: &[Judgement], law: Law) -> usize {
    judgements.iter().filter(|judgement| !law.allows(judgement)).count()
}

/// Rays of a kind, at most.
const MOST: usize = 1000;

/// Has some of the rays judged on which all that were `checked` agree with the reference.
pub(super) fn sample<'c>(
    judge: &mut Judge<'_>,
    event: &Event<'_>,
    checked: impl Iterator<Item = &'c Checked>,
) -> Vec<Judgement> {
    let differing: HashSet<_> = checked.flat_map(|checked| &checked.compared.differing).collect();
    let rays = &event.set.rays;
    let parts = rays.len().min(MOST);
    let mut rng = CounterRng::new(event.set.kind as u64);
    // A random one of each of so many equal parts.
    let places = (0..parts).map(|part| {
        let [start, end] = [part, part + 1].map(|part| part * rays.len() / parts);
        start + ((end - start) as f32 * rng.unit()) as usize
    });
    let agreed = places.filter(|place| !differing.contains(place));
    let case = |place: usize| Case { ray: rays[place], answer: event.reference[place].id };
    judge.judge(&agreed.map(case).collect::<Vec<_>>())
}
