//! Our side of a bench: any [`Accelerator`], called with many rays at once or with one, and the in-house BVH.

#[cfg(feature = "bvh")]
pub(super) use hierarchy::{recipe, way_name};

use super::contestant::{Answer, Batch, Tracer};
use super::rays::Query;
use crate::accel::{Accelerator, AcceptAll};
use crate::geometry::{Hit, PrimitiveId, Ray};

/// Any accelerator, called with slices of `slice` rays. What is timed makes whole hit records: t, u, v, point,
/// normal and offset.
pub struct InHouse<'a, A> {
    /// The backend.
    pub accelerator: &'a A,
    /// Rays in a call.
    pub slice: usize,
}

impl<A: Accelerator> Tracer for InHouse<'_, A> {
    fn batch(&self, query: Query) -> Option<Box<dyn Batch + '_>> {
        let (accelerator, slice, rays) = (self.accelerator, self.slice, Vec::new());
        Some(match query {
            Query::Closest => Box::new(Closest { accelerator, slice, rays, hits: Vec::new() }),
            Query::AnyHit => Box::new(AnyHit { accelerator, slice, rays, blocked: Vec::new() }),
        })
    }
}

struct Closest<'a, A> {
    accelerator: &'a A,
    slice: usize,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
}

impl<A: Accelerator> Batch for Closest<'_, A> {
    fn load(&mut self, rays: &[Ray]) {
        rays.clone_into(&mut self.rays);
        self.hits.clear();
        self.hits.resize(rays.len(), Hit::MISS);
    }

    fn trace(&mut self) {
        for (rays, hits) in self.rays.chunks(self.slice).zip(self.hits.chunks_mut(self.slice)) {
            self.accelerator.closest(rays, &AcceptAll, hits);
        }
    }

    fn read(&self, answers: &mut Vec<Answer>) {
        answers.extend(self.hits.iter().map(|hit| Answer { hit: hit.is_hit(), id: hit.id }));
    }
}

struct AnyHit<'a, A> {
    accelerator: &'a A,
    slice: usize,
    rays: Vec<Ray>,
    blocked: Vec<bool>,
}

impl<A: Accelerator> Batch for AnyHit<'_, A> {
    fn load(&mut self, rays: &[Ray]) {
        rays.clone_into(&mut self.rays);
        self.blocked.clear();
        self.blocked.resize(rays.len(), false);
    }

    fn trace(&mut self) {
        let slices = self.rays.chunks(self.slice).zip(self.blocked.chunks_mut(self.slice));
        for (rays, blocked) in slices {
            self.accelerator.occluded(rays, &AcceptAll, blocked);
        }
    }

    fn read(&self, answers: &mut Vec<Answer>) {
        answers.extend(self.blocked.iter().map(|&hit| Answer { hit, id: PrimitiveId::MISS }));
    }
}

/// The in-house BVH.
#[cfg(feature = "bvh")]
mod hierarchy {
    use super::super::builds::{Recipe, Structure};
    use super::super::contestant::{Contestant, Law, Role};
    use super::super::course::BATCH;
    use super::InHouse;
    use crate::accel::bvh::Bvh;
    use crate::accel::{Accelerator, BuildOptions, BuildStats};
    use crate::geometry::Geometry;
    use crate::os::Isa;
    use std::sync::Arc;

    struct InHouseBvh {
        bvh: Bvh,
        options: BuildOptions,
        isa: Isa,
    }

    /// How to build it, for instructions up to those of `isa`.
    pub(in super::super) fn recipe<'g>(
        geometry: &'g Arc<Geometry>,
        options: &BuildOptions,
        isa: Isa,
    ) -> Recipe<'g> {
        let options = *options;
        Recipe {
            backend: "bvh",
            variant: options.name(),
            build: Box::new(move || {
                let bvh = Bvh::with_options(geometry.clone(), &options)?;
                Ok(Box::new(InHouseBvh { bvh, options, isa }))
            }),
        }
    }

    /// What a way of calling it is called: how it was built is said where that is not the default.
    pub(in super::super) fn way_name(options: &BuildOptions, way: &str) -> String {
        match options.name().as_str() {
            "default" => way.to_owned(),
            built => format!("{built}, {way}"),
        }
    }

    impl Structure for InHouseBvh {
        fn stats(&self) -> BuildStats {
            self.bvh.build_stats()
        }

        /// With every set of instructions, the widest first.
        fn contestants(&self) -> Vec<Contestant<'_>> {
            let sets = Isa::ALL.into_iter().rev().map(|(_, isa)| isa);
            let ways = [("batches", BATCH), ("single", 1)];
            sets.filter(|isa| *isa <= self.isa)
                .flat_map(|isa| ways.map(|way| (isa, way)))
                .map(|(isa, (name, slice))| Contestant {
                    backend: "bvh",
                    variant: way_name(&self.options, name),
                    isa,
                    law: Law::Exact,
                    role: Role::Challenger,
                    tracer: Box::new(InHouse { accelerator: &self.bvh, slice }),
                })
                .collect()
        }
    }
}
