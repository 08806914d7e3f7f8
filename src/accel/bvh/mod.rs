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
mod hierarchy;
mod kernel;
mod node;
mod packet;
mod ray;
mod slot;
mod validate;
mod walk;
mod woop;

pub use build::Quality;
pub use kernel::Steps;
pub use validate::TreeStatistics;

use super::{Accelerator, BuildStats, HitFilter};
use crate::error::{Error, Result};
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use answers::{Blocked, FewHits, Hits, Ignored};
use hierarchy::Hierarchy;
use kernel::Count;
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
        Self::with_quality(geometry, threads, Quality::Default)
    }

    /// [`Bvh::build`] with more or less work on the hierarchy.
    ///
    /// # Errors
    /// As there.
    pub fn with_quality(geometry: Arc<Geometry>, threads: usize, quality: Quality) -> Result<Self> {
        let start = Instant::now();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| backend_error(&error.to_string()))?;
        let hierarchy = pool.install(|| Hierarchy::build(&geometry, quality))?;
        if hierarchy.pending() + slot::SPARE > slot::ROOM {
            return Err(backend_error("the hierarchy is too deep"));
        }
        let stats = BuildStats { seconds: start.elapsed().as_secs_f64(), bytes: hierarchy.bytes() };
        let has_filters = geometry.has_filtered_meshes();
        Ok(Self { geometry, hierarchy, has_filters, stats })
    }

    /// What it takes to find the closest hits of `rays`, or if `any`, whether they hit anything.
    pub fn steps<F: HitFilter>(&self, rays: &[Ray], filter: &F, any: bool) -> Steps {
        let steps = Cell::new(Steps::default());
        let (bvh, answers, steps) = (self, &mut Ignored, &steps);
        if any {
            kernel::dispatch(Count {
                task: Batch::<_, _, true> { bvh, rays, filter, answers },
                steps,
            });
        } else {
            kernel::dispatch(Count {
                task: Batch::<_, _, false> { bvh, rays, filter, answers },
                steps,
            });
        }
        steps.get()
    }

    /// Place of a triangle in the order of its tree.
    #[inline(always)]
    fn place(&self, found: Found) -> usize {
        self.hierarchy.block(found.leaf).first as usize + found.lane as usize
    }

    /// The id of a triangle in a leaf; a miss of none.
    #[inline]
    fn id(&self, found: Found) -> PrimitiveId {
        if found.leaf == Reference::NOTHING {
            return PrimitiveId::MISS;
        }
        let tree = self.hierarchy.tree_of(&self.geometry, found.instance);
        tree.numbers.id(tree.order[self.place(found)], found.instance)
    }
}

impl Accelerator for Bvh {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        if rays.len() < flight::FEW {
            let answers = &mut FewHits(hits);
            kernel::dispatch(Batch::<_, _, false> { bvh: self, rays, filter, answers });
        } else {
            let answers = &mut Hits::new(hits);
            kernel::dispatch(Batch::<_, _, false> { bvh: self, rays, filter, answers });
            answers.finish(self, rays);
        }
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        let answers = &mut Blocked(blocked);
        kernel::dispatch(Batch::<_, _, true> { bvh: self, rays, filter, answers });
    }

    fn build_stats(&self) -> BuildStats {
        self.stats
    }
}

fn backend_error(message: &str) -> Error {
    Error::Backend { backend: "bvh", message: message.into() }
}
