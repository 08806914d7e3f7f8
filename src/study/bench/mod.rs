//! Embree against the in-house BVH on a user's scene: agreement first, then times.
//!
//! What is done, in order: every structure is built several times; rays of every kind are made from the
//! scene; each of Embree's calls for several rays is tried on a sample (the heats), and the best two go on;
//! every answer of every contestant is compared with those of Embree's robust mode, and the exact oracle judges those
//! that differ and some of those that do not; whoever was right races (`race`): turns on the same rays in rotating
//! order, medians over repetitions, and differences inside the noise called ties. Beside it, whole frames (`frame`):
//! their seconds, and the pixels that differ. Must not print.

mod agreement;
mod builds;
mod contest;
mod contestant;
mod course;
mod crew;
#[cfg(feature = "embree")]
mod embree;
mod field;
mod frame;
mod frame_result;
mod in_house;
mod judge;
mod machine;
mod probe;
mod race;
mod rays;
mod result;
mod sample;
mod statistics;

pub use agreement::Agreement;
pub use contest::contest;
pub use contestant::{Answer, Batch, Contestant, Law, Role, Tracer};
pub use course::BATCH;
pub use frame::{FrameSettings, Renderer, frame, frames};
pub use frame_result::{DifferingPixels, Frame, FrameFindings, FrameRatio};
pub use in_house::InHouse;
pub use judge::Judging;
pub use machine::most_threads;
pub use probe::SLOW;
pub use rays::{Query, RayKind, RaySet, RaySource};
pub use result::{
    Build, Comparison, Findings, Heat, Machine, ProbeSpread, RayCount, Report, Run, Scene,
};
pub use sample::Sample;
pub use statistics::{Ratio, Spread};

use crate::accel::BuildOptions;
use crate::error::Result;
use crate::geometry::{Geometry, Ray};
use crate::os::Isa;
use crate::scene;
use crate::world::World;
use builds::{Recipe, build_all};
use course::Course;
use field::closest;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is benched, and how.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Rays of each kind.
    pub rays: usize,
    /// Which kinds.
    pub kinds: Vec<RayKind>,
    /// How many threads trace at once, one race each; structures are built by the largest number.
    pub threads: Vec<usize>,
    /// The widest instructions that anybody may use.
    pub isa: Isa,
    /// Exactly so many repetitions, or as many as there is time for.
    pub repetitions: Option<usize>,
    /// For everything that is done with a scene, except what the exact oracle takes.
    pub time: Duration,
    /// Whether all of Embree's calls race, without heats.
    pub all_calls: bool,
    /// How the in-house BVH is built, by as many threads as above. Embree's variants are what they are: compact, its
    /// packets of 16 may loop for ever.
    pub build: BuildOptions,
}

/// Is told which step is being done, and how much of it is done, from 0 to 1.
pub type Tell<'a> = &'a dyn Fn(&'static str, f64);

/// Benches a scene; `cameras` are those whose pictures the rays are for.
///
/// # Errors
/// Where a structure cannot be built or a camera is impossible.
pub fn bench(
    name: &str,
    world: &World,
    cameras: &[scene::Camera],
    settings: &Settings,
    tell: Tell<'_>,
) -> Result<Findings> {
    let start = Instant::now();
    settings.isa.limit();
    let geometry = &world.geometry;
    let threads = settings.threads.iter().copied().max().unwrap_or(1);
    let options = BuildOptions { threads, ..settings.build };
    let built = build_all(&recipes(geometry, &options, settings.isa), settings.time, tell)?;
    let mut contestants: Vec<_> = built.iter().flat_map(|b| b.structure.contestants()).collect();
    if settings.all_calls {
        let must = contestants.iter_mut().filter(|contestant| contestant.role == Role::Heat);
        must.for_each(|contestant| contestant.role = Role::Rival);
    }

    tell("making rays", 0.0);
    let trusted = |rays: &[Ray]| match contestants.first() {
        Some(first) => closest(geometry, first, &mut Course::default(), rays, threads),
        None => Vec::new(),
    };
    let source = RaySource { world, cameras, closest: &trusted };
    let sets = source.generate(&settings.kinds, settings.rays)?;

    let time = settings.time.saturating_sub(start.elapsed());
    let mut findings =
        contest(name, geometry, &sets, &contestants, &Settings { time, ..settings.clone() }, tell);
    let triangles = geometry.stored_triangles();
    findings.builds = built.iter().filter_map(|b| b.tell(name, triangles, threads)).collect();
    findings.scene.seconds = start.elapsed().as_secs_f64();
    settings.isa.limit();
    Ok(findings)
}

fn recipes<'g>(geometry: &'g Arc<Geometry>, options: &BuildOptions, isa: Isa) -> Vec<Recipe<'g>> {
    let mut recipes = Vec::new();
    #[cfg(feature = "embree")]
    recipes.extend(embree::recipes(geometry, options.threads, isa));
    #[cfg(feature = "bvh")]
    recipes.extend([in_house::recipe(geometry, options, isa)]);
    recipes
}
