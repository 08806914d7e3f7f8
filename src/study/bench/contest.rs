//! A contest on given rays: references, heats, checks, the race, and what came out of it.

use super::contestant::{Contestant, Role};
use super::field::{Event, Field, HeatTime};
use super::judge::Judging;
use super::race::{Entry, Plan, Start, Story, Times, race};
use super::rays::{Query, RaySet};
use super::result::{Comparison, Findings, Heat, RayCount, Run, Scene};
use super::sample::{Sample, sample, wrong_by};
use super::statistics::{Ratio, Spread};
use super::{Settings, Tell};
use crate::geometry::Geometry;
use std::collections::HashSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Has `contestants` trace `sets` of rays through `geometry`. The first of them whose role is
/// [`Role::Baseline`], or else the first of all, is the reference. Nothing is built, so there is nothing in
/// `builds`.
pub fn contest(
    name: &str,
    geometry: &Arc<Geometry>,
    sets: &[RaySet],
    contestants: &[Contestant<'_>],
    settings: &Settings,
    tell: Tell<'_>,
) -> Findings {
    let start = Instant::now();
    let most_threads = settings.threads.iter().copied().max().unwrap_or(1);
    let mut field = Field::new(geometry, contestants, most_threads, tell);

    let reference = field.reference();

    // Who is right, and who may race.
    let (mut starts, mut heats) = (Vec::new(), Vec::new());
    for (i, set) in sets.iter().enumerate().filter(|(_, set)| !set.rays.is_empty()) {
        let tell = |part: f64| tell("checking answers", (i as f64 + part) / sets.len() as f64);
        tell(0.0);
        let event = field.event(set);
        let times = field.heats(&event);
        let mut racing: Vec<_> = (0..contestants.len()).collect();
        let qualified = |i: usize| times.iter().any(|t| t.contestant == i && t.qualified);
        racing.retain(|&i| field.takes_part(i, set.kind));
        racing.retain(|&i| contestants[i].role != Role::Heat || qualified(i));
        heats.extend(
            times.iter().map(|time| heat(name, &contestants[time.contestant], &event, time)),
        );
        let all = racing.len() as f64;
        let entries = racing.into_iter().zip(1..).map(|(contestant, n)| {
            let checked = field.check(contestant, &event);
            tell(f64::from(n) / all);
            let times = vec![Times::default(); settings.threads.len()];
            Entry { contestant, checked, right: true, times }
        });
        let mut entries: Vec<_> = entries.collect();
        let checked = entries.iter().map(|entry: &Entry| &entry.checked);
        let agreed = sample(&mut field.judge, &event, checked);
        // The reference agrees with itself: it is others who find it out.
        let found_out = entries.iter().flat_map(|entry| &entry.checked.compared.reference_wrong);
        let found_out = found_out.collect::<HashSet<_>>().len();
        // Where all agree that something is hit, what that is was said by the reference alone.
        let law_of_agreed = |law| if set.kind.query() == Query::AnyHit { event.law } else { law };
        for entry in &mut entries {
            let law = contestants[entry.contestant].law;
            let agreement = &mut entry.checked.compared.agreement;
            if entry.contestant == reference {
                agreement.unexplained += found_out;
            }
            let of_agreed = law_of_agreed(law);
            entry.right = law.tolerates(agreement.unexplained, agreement.compared)
                && of_agreed.tolerates(wrong_by(&agreed, of_agreed), agreed.len());
        }
        let laws = entries.iter().map(|entry| law_of_agreed(contestants[entry.contestant].law));
        let agreed = Sample::new(&agreed, laws);
        starts.push(Start { event, entries, agreed });
    }
    field.judge.leave();
    let oracle = field.judge.work;

    // The race. What the oracle took is not taken from it.
    let judging = Duration::from_secs_f64(oracle.build_seconds + oracle.judge_seconds);
    let time = settings.time.saturating_add(judging).saturating_sub(start.elapsed());
    let plan = Plan { threads: &settings.threads, repetitions: settings.repetitions, time };
    let story = race(&mut field, &mut starts, &plan, tell);
    let runs = starts.iter().flat_map(|start| runs(name, contestants, start, settings)).collect();
    let ratios = starts.iter().flat_map(|start| ratios(name, contestants, start, settings));
    Findings {
        ratios: ratios.collect(),
        scene: scene(name, geometry, &starts, &story, (oracle, start)),
        builds: Vec::new(),
        heats,
        runs,
    }
}

fn scene(
    name: &str,
    geometry: &Geometry,
    starts: &[Start<'_>],
    story: &Story,
    (oracle, begun): (Judging, Instant),
) -> Scene {
    let count = |Start { event, agreed, .. }: &Start<'_>| RayCount {
        ray_kind: event.set.kind.name(),
        rays: event.set.rays.len(),
        hits: event.reference.iter().filter(|hit| hit.is_hit()).count(),
        agreed: *agreed,
    };
    Scene {
        scene: name.to_owned(),
        triangles: geometry.placed_triangles(),
        stored_triangles: geometry.stored_triangles(),
        geometry_bytes: geometry.bytes(),
        rays: starts.iter().map(count).collect(),
        repetitions: story.repetitions,
        repeated_turns: story.repeated_turns,
        probes: story.probes.iter().map(|probe| probe.spread()).collect(),
        oracle,
        seconds: begun.elapsed().as_secs_f64(),
    }
}

fn heat(name: &str, contestant: &Contestant<'_>, event: &Event<'_>, time: &HeatTime) -> Heat {
    Heat {
        scene: name.to_owned(),
        variant: contestant.variant.clone(),
        ray_kind: event.set.kind.name(),
        rays_per_second: time.rays_per_second,
        qualified: time.qualified,
    }
}

fn runs(
    name: &str,
    contestants: &[Contestant<'_>],
    start: &Start<'_>,
    settings: &Settings,
) -> Vec<Run> {
    let run = |entry: &Entry, slot: usize| {
        let contestant = &contestants[entry.contestant];
        let times = &entry.times[slot];
        Run {
            scene: name.to_owned(),
            backend: contestant.backend,
            variant: contestant.variant.clone(),
            isa: contestant.isa.name(),
            threads: settings.threads[slot],
            ray_kind: start.event.set.kind.name(),
            // No time without agreement.
            rays_per_second: Spread::of(&times.rays_per_second).filter(|_| entry.right),
            hits: entry.checked.hits,
            agreement: entry.checked.compared.agreement,
            busy_turns: times.busy_turns,
        }
    };
    let slots = 0..settings.threads.len();
    slots
        .flat_map(|slot| start.entries.iter().map(move |entry| (entry, slot)))
        .map(|(entry, slot)| run(entry, slot))
        .collect()
}

/// Every challenger against the baseline, and against the rival with the highest median.
fn ratios(
    name: &str,
    contestants: &[Contestant<'_>],
    start: &Start<'_>,
    settings: &Settings,
) -> Vec<Comparison> {
    let mut ratios = Vec::new();
    for (slot, &threads) in settings.threads.iter().enumerate() {
        let of = |entry: &Entry| entry.times[slot].rays_per_second.clone();
        let median = |entry: &&Entry| Spread::of(&of(entry)).map_or(0.0, |spread| spread.median);
        let right = || start.entries.iter().filter(|entry| entry.right);
        let role = |entry: &Entry| contestants[entry.contestant].role;
        let baseline = right().find(|entry| role(entry) == Role::Baseline);
        let best = right()
            .filter(|entry| role(entry) != Role::Challenger)
            .max_by(|a, b| median(a).total_cmp(&median(b)));
        for challenger in right().filter(|entry| role(entry) == Role::Challenger) {
            for (against, rival) in [("baseline", baseline), ("best", best)] {
                let Some(rival) = rival else { continue };
                let Some(ratio) = Ratio::of(&of(challenger), &of(rival)) else { continue };
                let ours = &contestants[challenger.contestant];
                ratios.push(Comparison {
                    scene: name.to_owned(),
                    ray_kind: start.event.set.kind.name(),
                    threads,
                    isa: ours.isa.name(),
                    variant: ours.variant.clone(),
                    against,
                    rival: contestants[rival.contestant].variant.clone(),
                    ratio,
                });
            }
        }
    }
    ratios
}
