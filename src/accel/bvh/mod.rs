//! The in-house BVH: binary by binned SAH, collapsed to sixteen children a node, many rays in flight.
//!
//! Two levels: one hierarchy for the meshes that stand in the world, one for each object, and one over the
//! instances. Which primitive is hit is decided by the conservative boxes of `ray`, by the watertight
//! edge test of `woop`, and among those that pass by the distance that [`super::resolve()`] computes in `f64`:
//! exact ties go to the smallest id. Knows nothing but `geometry`.
#![allow(unsafe_code)]

mod answers;
mod block;
mod build;
mod collapse;
mod convoy;
mod cut;
mod flight;
mod gather;
mod hierarchy;
mod kernel;
mod leaves;
mod node;
mod packet;
mod ray;
mod slot;
mod validate;
mod walk;
mod woop;

pub use kernel::Steps;
pub use validate::TreeStatistics;

use super::{Accelerator, BuildOptions, BuildStats, HitFilter};
use crate::error::{Error, Result};
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use answers::{Answers, Blocked, FewHits, Hits, Ignored};
use hierarchy::Hierarchy;
use kernel::Count;
use leaves::{Gathered, Kept};
use node::Reference;
use slot::Found;
use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;
use walk::Batch;

/// The in-house hierarchy over a geometry.
pub struct Bvh {
    geometry: Arc<Geometry>,
    hierarchy: Hierarchy,
    /// Whether any mesh has its hits filtered.
    has_filters: bool,
    stats: BuildStats,
}

impl Bvh {
    /// Builds with at most `threads` threads (0: all); the result does not depend on their number.
    ///
    /// # Errors
    /// When there are 2^30 triangles or more, not enough memory, or no threads.
    pub fn build(geometry: Arc<Geometry>, threads: usize) -> Result<Self> {
        Self::with_options(geometry, &BuildOptions { threads, ..BuildOptions::default() })
    }

    /// [`Bvh::build`] with more or less work on the hierarchy, or more or less memory for it. The hits are the same.
    ///
    /// # Errors
    /// As there.
    pub fn with_options(geometry: Arc<Geometry>, options: &BuildOptions) -> Result<Self> {
        let start = Instant::now();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(options.threads)
            .build()
            .map_err(|error| backend_error(&error.to_string()))?;
        let hierarchy = pool.install(|| Hierarchy::build(&geometry, options))?;
        if hierarchy.pending() + slot::SPARE > slot::ROOM {
            return Err(backend_error("the hierarchy is too deep"));
        }
        let stats = BuildStats {
            seconds: start.elapsed().as_secs_f64(),
            bytes: hierarchy.bytes(),
            shape: Some(hierarchy.shape),
        };
        let has_filters = geometry.has_filtered_meshes();
        Ok(Self { geometry, hierarchy, has_filters, stats })
    }

    /// What it takes to find the closest hits of `rays`, or if `any`, whether they hit anything.
    pub fn steps<F: HitFilter>(&self, rays: &[Ray], filter: &F, any: bool) -> Steps {
        let steps = Cell::new(Steps::default());
        match any {
            false => self.count::<_, false>(rays, filter, &steps),
            true => self.count::<_, true>(rays, filter, &steps),
        }
        steps.get()
    }

    fn count<F: HitFilter, const ANY: bool>(&self, rays: &[Ray], filter: &F, steps: &Cell<Steps>) {
        let answers = &mut Ignored;
        if self.hierarchy.is_compact {
            // SAFETY: the hierarchy is compact.
            let task = unsafe { Batch::<_, _, Gathered, ANY>::new(self, rays, filter, answers) };
            kernel::dispatch(Count { task, steps });
        } else {
            // SAFETY: the hierarchy is not compact.
            let task = unsafe { Batch::<_, _, Kept, ANY>::new(self, rays, filter, answers) };
            kernel::dispatch(Count { task, steps });
        }
    }

    /// Does what is asked about rays, for the way in which leaves are kept.
    #[inline(always)]
    fn run<F: HitFilter, A: Answers, const ANY: bool>(
        &self,
        rays: &[Ray],
        filter: &F,
        answers: &mut A,
    ) {
        if self.hierarchy.is_compact {
            // SAFETY: the hierarchy is compact.
            let task = unsafe { Batch::<_, _, Gathered, ANY>::new(self, rays, filter, answers) };
            kernel::dispatch(task);
        } else {
            // SAFETY: the hierarchy is not compact.
            let task = unsafe { Batch::<_, _, Kept, ANY>::new(self, rays, filter, answers) };
            kernel::dispatch(task);
        }
    }

    /// The id of a triangle in a leaf; a miss of none.
    #[inline]
    fn id(&self, found: Found) -> PrimitiveId {
        if found.leaf == Reference::NOTHING {
            return PrimitiveId::MISS;
        }
        let tree = self.hierarchy.tree_of(&self.geometry, found.instance);
        let triangle = self.hierarchy.triangle(found.leaf, found.lane as usize);
        tree.numbers.id(triangle, found.instance)
    }
}

impl Accelerator for Bvh {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        if rays.len() < flight::FEW {
            self.run::<_, _, false>(rays, filter, &mut FewHits(hits));
        } else {
            let answers = &mut Hits::new(hits);
            self.run::<_, _, false>(rays, filter, answers);
            answers.finish(self, rays);
        }
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        self.run::<_, _, true>(rays, filter, &mut Blocked(blocked));
    }

    fn build_stats(&self) -> BuildStats {
        self.stats
    }
}

fn backend_error(message: &str) -> Error {
    Error::Backend { backend: "bvh", message: message.into() }
}
