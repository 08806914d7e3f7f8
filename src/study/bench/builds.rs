//! Building what takes part, several times in turn, and what that costs.

use super::Tell;
use super::contestant::Contestant;
use super::result::Build;
use super::statistics::Spread;
use crate::accel::BuildStats;
use crate::error::Result;
use std::time::{Duration, Instant};

/// How to build a structure.
pub(super) struct Recipe<'g> {
    pub(super) backend: &'static str,
    pub(super) variant: String,
    pub(super) build: Box<dyn Fn() -> Result<Box<dyn Structure>> + 'g>,
}

/// Something that rays can be traced through.
pub(super) trait Structure {
    fn stats(&self) -> BuildStats;

    /// Every way in which it takes part.
    fn contestants(&self) -> Vec<Contestant<'_>>;
}

/// Each structure is built so often at least, unless that would take a quarter of the time of the whole bench.
const FEWEST_ROUNDS: usize = 3;

/// And so often at most, while all of it takes next to no time.
const MOST_ROUNDS: usize = 11;

/// A structure that was built, several times.
pub(super) struct Built {
    backend: &'static str,
    variant: String,
    /// The last one.
    pub(super) structure: Box<dyn Structure>,
    /// What each took.
    seconds: Vec<f64>,
}

/// Builds everything again and again, in turn. `time` is what the whole bench should take.
pub(super) fn build_all(
    recipes: &[Recipe<'_>],
    time: Duration,
    tell: Tell<'_>,
) -> Result<Vec<Built>> {
    let start = Instant::now();
    let mut slots: Vec<_> = recipes.iter().map(|_| (None, Vec::new())).collect();
    for round in 0..MOST_ROUNDS {
        let spent = start.elapsed();
        if spent > time / 4 || round >= FEWEST_ROUNDS && spent > time / 20 {
            break;
        }
        for (i, (recipe, (structure, seconds))) in recipes.iter().zip(&mut slots).enumerate() {
            let done = (round * recipes.len() + i) as f64;
            tell("building", (done / (FEWEST_ROUNDS * recipes.len()) as f64).min(1.0));
            // Never two of a kind at once: memory is for the scene.
            *structure = None;
            let start = Instant::now();
            *structure = Some((recipe.build)()?);
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let built = |(recipe, (structure, seconds)): (&Recipe<'_>, (Option<_>, Vec<f64>))| {
        let (backend, variant) = (recipe.backend, recipe.variant.clone());
        Some(Built { backend, variant, structure: structure?, seconds })
    };
    Ok(recipes.iter().zip(slots).filter_map(built).collect())
}

impl Built {
    /// What there is to tell of it; `triangles` are those stored, `threads` those that built.
    pub(super) fn tell(&self, scene: &str, triangles: usize, threads: usize) -> Option<Build> {
        let seconds = Spread::of(&self.seconds)?;
        let BuildStats { bytes, shape, .. } = self.structure.stats();
        Some(Build {
            scene: scene.to_owned(),
            backend: self.backend,
            variant: self.variant.clone(),
            threads,
            seconds: seconds.median,
            seconds_min: seconds.min,
            seconds_max: seconds.max,
            repetitions: self.seconds.len(),
            bytes,
            bytes_per_triangle: bytes as f64 / triangles as f64,
            nodes: shape.map(|shape| shape.nodes),
            leaves: shape.map(|shape| shape.leaves),
            depth: shape.map(|shape| shape.depth),
            sah_cost: shape.map(|shape| shape.sah_cost),
        })
    }
}
