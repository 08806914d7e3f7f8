//! What backends answer, in every way in which they can be asked.

use super::scenes::Holes;
use glint::accel::Accelerator;
#[cfg(feature = "bvh")]
use glint::accel::{BuildOptions, Quality};
use glint::geometry::{Geometry, Hit, Ray};
use std::sync::Arc;

/// All answers of one backend, asked in one way.
pub(crate) struct Answers {
    pub(crate) name: String,
    /// Whether it keeps our rules, or is only looked at.
    pub(crate) ours: bool,
    pub(crate) hits: Vec<Hit>,
    pub(crate) blocked: Vec<bool>,
}

impl Answers {
    /// Asks with `slice` rays at a time.
    pub(crate) fn of<A: Accelerator>(
        (name, ours): (&str, bool),
        backend: &A,
        rays: &[Ray],
        slice: usize,
    ) -> Self {
        let (mut hits, mut blocked) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
        for (rays, hits) in rays.chunks(slice).zip(hits.chunks_mut(slice)) {
            backend.closest(rays, &Holes, hits);
        }
        for (rays, blocked) in rays.chunks(slice).zip(blocked.chunks_mut(slice)) {
            backend.occluded(rays, &Holes, blocked);
        }
        Self { name: name.into(), ours, hits, blocked }
    }
}

/// Every backend there is, over one scene.
pub(crate) struct Backends {
    #[cfg(feature = "embree")]
    embree: glint::accel::embree::EmbreeAccelerator,
    #[cfg(feature = "bvh")]
    bvh: glint::accel::bvh::Bvh,
    #[cfg(feature = "bvh")]
    compact: glint::accel::bvh::Bvh,
}

impl Backends {
    pub(crate) fn build(geometry: &Arc<Geometry>) -> Self {
        Self {
            #[cfg(feature = "embree")]
            embree: glint::accel::embree::EmbreeAccelerator::build(geometry.clone(), 2)
                .expect("it builds"),
            #[cfg(feature = "bvh")]
            bvh: glint::accel::bvh::Bvh::build(geometry.clone(), 2).expect("it builds"),
            #[cfg(feature = "bvh")]
            compact: {
                let options = BuildOptions { threads: 2, quality: Quality::Fast, is_compact: true };
                glint::accel::bvh::Bvh::with_options(geometry.clone(), &options).expect("it builds")
            },
        }
    }

    /// Embree; and the in-house BVH with every set of instructions that the machine has, many rays at once
    /// and one by one. The limit of instructions is one for the whole program: only one test may ask at a time.
    pub(crate) fn answers(&self, rays: &[Ray]) -> Vec<Answers> {
        let mut answers = Vec::new();
        #[cfg(feature = "embree")]
        answers.push(Answers::of(("embree", false), &self.embree, rays, rays.len().max(1)));
        #[cfg(feature = "bvh")]
        {
            use glint::os::Isa;
            for (name, isa) in Isa::ALL.into_iter().filter(|(_, isa)| *isa <= Isa::detect()) {
                isa.limit();
                for (way, slice) in [("batched", rays.len().max(1)), ("single", 1)] {
                    let name = format!("bvh {name} {way}");
                    answers.push(Answers::of((&name, true), &self.bvh, rays, slice));
                }
            }
            let name = "bvh compact, built fast";
            answers.push(Answers::of((name, true), &self.compact, rays, rays.len().max(1)));
        }
        answers
    }
}
