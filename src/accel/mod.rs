//! Who is hit: the accelerator boundary, and the backends behind it.
//!
//! Knows nothing but `geometry`, so it is tested and timed without a scene. A backend decides only which
//! primitive is hit; [`resolve()`] computes t, u, v and the error bound from the ray and the vertices,
//! so that all backends give the same bits wherever they agree. A batch is the interface: one ray is
//! a batch of one. A ray's answer never depends on what else is in its batch.

mod brute;
#[cfg(feature = "bvh")]
pub mod bvh;
#[cfg(feature = "embree")]
pub mod embree;
mod options;
pub mod oracle;
mod resolve;

pub use brute::BruteForce;
pub use options::{BuildOptions, Quality};
pub use resolve::{resolve, resolve_all};

use crate::geometry::{Hit, Ray};
use crate::ledger::FeatureTotals;

/// Answers batches of rays.
pub trait Accelerator: Sync {
    /// The closest accepted hit of each ray. `hits` is as long as `rays`.
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]);

    /// Whether any accepted surface blocks each ray. `blocked` is as long as `rays`.
    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]);

    /// What building it took.
    fn build_stats(&self) -> BuildStats;
}

/// Decides which candidates count: cut-outs. Asked only about meshes marked `filtered`.
///
/// Must be a pure function of its arguments: backends ask it in any order and more than once.
pub trait HitFilter: Sync {
    /// Whether it refuses anything at all: if not, it need not be asked.
    const REFUSES: bool = true;

    /// Whether the surface is there for this ray.
    fn accept(&self, ray: &Ray, candidate: &Hit) -> bool;

    /// What it has cost so far, where that is counted.
    fn cost(&self) -> FeatureTotals {
        FeatureTotals::default()
    }
}

/// The filter of scenes without cut-outs: compiles away.
#[derive(Clone, Copy, Debug, Default)]
pub struct AcceptAll;

impl HitFilter for AcceptAll {
    const REFUSES: bool = false;

    #[inline]
    fn accept(&self, _: &Ray, _: &Hit) -> bool {
        true
    }
}

/// What a build took and made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStats {
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Bytes of nodes and leaves, without the geometry buffers.
    pub bytes: usize,
    /// What it made, where the backend says so.
    pub shape: Option<TreeShape>,
}

/// What a hierarchy is made of: its trees over triangles together, each object's once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeShape {
    /// Inner nodes.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Longest way from a root to an inner node, in nodes.
    pub depth: usize,
    /// Steps that a random ray through the box of everything is expected to take: the surface of all nodes and leaves
    /// of a tree over that of its root, of the costliest tree.
    pub sah_cost: f64,
}

impl TreeShape {
    /// Both together.
    pub fn add(&mut self, other: &Self) {
        self.nodes += other.nodes;
        self.leaves += other.leaves;
        self.depth = self.depth.max(other.depth);
        self.sah_cost = self.sah_cost.max(other.sah_cost);
    }
}
