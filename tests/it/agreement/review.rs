//! Answers side by side: where any two differ the oracle judges both, and some where all agree.

use super::answers::Answers;
use super::scenes::Holes;
use glint::accel::oracle::{Class, Judgement, Oracle};
use glint::geometry::{Geometry, Hit, PrimitiveId, Ray};
use glint::sampling::CounterRng;
use rayon::prelude::*;

/// How one backend, asked in one way, did.
#[derive(Clone)]
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) ours: bool,
    pub(crate) rays: usize,
    pub(crate) hits: usize,
    /// Rays on which not all name the same triangle.
    pub(crate) disputed: usize,
    /// Answers that the oracle has seen: all of those, and a sample of the others.
    pub(crate) judged: usize,
    /// Of those, how many in each class.
    pub(crate) classes: [usize; Class::ALL.len()],
    /// Of those, how many the rounding of the in-house kernel does not excuse.
    pub(crate) unlawful: usize,
    /// Of those, how many missed a surface that is closed around the ray.
    pub(crate) leaks: usize,
    /// The largest distance from an edge on whose wrong side an answer is, as a part of the band.
    pub(crate) farthest: f64,
    /// Rays that are blocked and meet nothing, or the other way round.
    pub(crate) any_hit_differs: usize,
    /// Rays whose hit is not that of the first of our ways, bit by bit.
    pub(crate) way_matters: usize,
    /// Hits that are nearer or farther than every corner of their triangle: seen edge-on, just past an edge, its plane
    /// is met anywhere.
    pub(crate) astray: usize,
    /// The first answer that is not excused, in words.
    pub(crate) first: Option<String>,
}

impl Row {
    fn new(answers: &Answers) -> Self {
        Self {
            name: answers.name.clone(),
            ours: answers.ours,
            rays: answers.hits.len(),
            hits: answers.hits.iter().filter(|hit| hit.is_hit()).count(),
            disputed: 0,
            judged: 0,
            classes: [0; Class::ALL.len()],
            unlawful: 0,
            leaks: 0,
            farthest: 0.0,
            any_hit_differs: 0,
            way_matters: 0,
            astray: 0,
            first: None,
        }
    }

    fn note(&mut self, ray: &Ray, answer: PrimitiveId, judgement: &Judgement) {
        self.judged += 1;
        self.classes[judgement.class as usize] += 1;
        // Which of several at one distance is our rule alone.
        if !self.ours && matches!(judgement.class, Class::Tie | Class::NearTie) {
            return;
        }
        let edges = [judgement.outside, judgement.overlooked.map(|o| o.edge)];
        let ratios = edges.iter().flatten().map(|edge| edge.ratio());
        self.farthest = ratios.fold(self.farthest, f64::max);
        if !judgement.is_lawful() {
            self.unlawful += 1;
            self.leaks += usize::from(judgement.overlooked.is_some_and(|o| !o.silhouette));
            self.first.get_or_insert_with(|| format!("{ray:?}: {answer:?}: {judgement:?}"));
        }
    }

    pub(crate) fn count(&self, class: Class) -> usize {
        self.classes[class as usize]
    }

    /// Together with the same backend's answers to other rays.
    pub(crate) fn add(&mut self, other: &Self) {
        assert_eq!(self.name, other.name);
        self.rays += other.rays;
        self.hits += other.hits;
        self.disputed += other.disputed;
        self.judged += other.judged;
        self.classes.iter_mut().zip(other.classes).for_each(|(n, more)| *n += more);
        self.unlawful += other.unlawful;
        self.leaks += other.leaks;
        self.farthest = self.farthest.max(other.farthest);
        self.any_hit_differs += other.any_hit_differs;
        self.way_matters += other.way_matters;
        self.astray += other.astray;
        self.first = self.first.take().or_else(|| other.first.clone());
    }

    /// What one of ours has done that none may.
    pub(crate) fn complaint(&self) -> Option<String> {
        let Self { name, unlawful, leaks, any_hit_differs, .. } = self;
        let is_clean = unlawful + any_hit_differs == 0;
        (self.ours && !is_clean).then(|| {
            format!(
                "{name}: {unlawful} not excused, {leaks} of them leaks; {any_hit_differs} times any hit is not the \
                 closest. {:?}",
                self.first
            )
        })
    }
}

/// A row for each of the `answers` to `rays`. The oracle judges all that differ and about `sample` of the others.
pub(crate) fn review(
    geometry: &Geometry,
    oracle: &Oracle,
    rays: &[Ray],
    answers: &[Answers],
    sample: usize,
) -> Vec<Row> {
    let mut rows: Vec<_> = answers.iter().map(Row::new).collect();
    let ours = answers.iter().find(|a| a.ours);
    let mut rng = CounterRng::new(0);
    let share = sample as f32 / rays.len() as f32;
    // Rays to be judged, each with the triangles that were named.
    let mut cases = Vec::new();
    for (i, ray) in rays.iter().enumerate() {
        for (row, its) in rows.iter_mut().zip(answers) {
            row.any_hit_differs += usize::from(its.blocked[i] != its.hits[i].is_hit());
            row.astray += usize::from(is_astray(geometry, ray, &its.hits[i]));
            if let Some(ours) = ours.filter(|ours| its.ours && its.hits[i] != ours.hits[i]) {
                row.way_matters += 1;
                let both = [ours.hits[i], its.hits[i]];
                row.first.get_or_insert_with(|| format!("{ray:?}: {both:?}"));
            }
        }
        let mut named: Vec<_> = answers.iter().map(|its| its.hits[i].id).collect();
        named.sort_unstable();
        named.dedup();
        let is_disputed = named.len() > 1;
        rows.iter_mut().for_each(|row| row.disputed += usize::from(is_disputed));
        if is_disputed || rng.unit() < share {
            cases.extend(named.into_iter().map(|id| (i, id)));
        }
    }
    let judge = |&(i, id): &(usize, PrimitiveId)| oracle.judge(&rays[i], &Holes, id);
    let judgements: Vec<_> = cases.par_iter().map(judge).collect();
    for ((i, id), judgement) in cases.into_iter().zip(judgements) {
        let theirs = rows.iter_mut().zip(answers).filter(|(_, its)| its.hits[i].id == id);
        theirs.for_each(|(row, _)| row.note(&rays[i], id, &judgement));
    }
    rows
}

/// See [`Row::astray`].
fn is_astray(geometry: &Geometry, ray: &Ray, hit: &Hit) -> bool {
    if !hit.is_hit() {
        return false;
    }
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let corners = geometry.world_vertices(hit.id).0.map(|p| (p - o) / d.length());
    let depths = corners.map(|p| p.dot(d.normalize()));
    // Four ulps of the largest number in it.
    let off =
        corners.iter().fold(0.0, |m: f64, p| m.max(p.length())) * f64::from(2.0 * f32::EPSILON);
    let t = f64::from(hit.t);
    depths.iter().all(|&depth| t < depth - off) || depths.iter().all(|&depth| t > depth + off)
}

/// A line for each row under `title`; those of the same numbers share one.
#[expect(clippy::print_stdout, reason = "the table is what the run is for")]
pub(crate) fn print(title: &str, rows: &[Row]) {
    let numbers = |row: &Row| {
        let Row { rays, hits, disputed, judged, unlawful, leaks, farthest, .. } = row;
        let Row { any_hit_differs, way_matters, astray, .. } = row;
        let counts = row.classes.map(|n| format!("{n:>11}")).concat();
        format!(
            "{rays:>9} {hits:>9} {disputed:>8} {judged:>8}{counts} {unlawful:>8} {leaks:>6} {any_hit_differs:>7} \
             {way_matters:>5} {astray:>6} {farthest:>7.2}"
        )
    };
    for alike in rows.chunk_by(|a, b| numbers(a) == numbers(b)) {
        let more =
            if alike.len() > 1 { format!(" and {} more", alike.len() - 1) } else { "".into() };
        println!("{title:<23} {:<28}{}", format!("{}{more}", alike[0].name), numbers(&alike[0]));
    }
}

/// The names of the columns of [`print`].
#[expect(clippy::print_stdout, reason = "as above")]
pub(crate) fn print_head() {
    let classes = Class::ALL.map(|(name, _)| format!("{name:>11}")).concat();
    println!(
        "{:52}{:>9} {:>9} {:>8} {:>8}{classes} {:>8} {:>6} {:>7} {:>5} {:>6} {:>7}",
        "",
        "rays",
        "hits",
        "disputed",
        "judged",
        "unlawful",
        "leaks",
        "any hit",
        "way",
        "astray",
        "of band"
    );
}
