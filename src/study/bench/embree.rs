//! Embree's side of a bench: its variants, and every call that it has for rays.

use super::builds::{Recipe, Structure};
use super::contestant::{Answer, Batch, Contestant, Law, Role, Tracer};
use super::rays::Query;
use crate::accel::BuildStats;
use crate::accel::embree::{BareEmbree, BareRays, EmbreeCall, EmbreeVariant};
use crate::geometry::{Geometry, Ray};
use crate::os::Isa;
use std::sync::Arc;

/// A scene of Embree's.
struct Variant {
    name: &'static str,
    variant: EmbreeVariant,
    isa: Isa,
    embree: BareEmbree,
}

/// How to build each variant, for instructions up to those of `isa`.
pub(super) fn recipes(
    geometry: &Arc<Geometry>,
    threads: usize,
    isa: Isa,
) -> impl Iterator<Item = Recipe<'_>> {
    EmbreeVariant::ALL.into_iter().map(move |(name, variant)| Recipe {
        backend: "embree",
        variant: name.to_owned(),
        build: Box::new(move || {
            let embree = BareEmbree::build(geometry.clone(), threads, variant, isa)?;
            Ok(Box::new(Variant { name, variant, isa, embree }))
        }),
    })
}

impl Structure for Variant {
    fn stats(&self) -> BuildStats {
        self.embree.build_stats()
    }

    /// A ray at a time, and every call for several.
    fn contestants(&self) -> Vec<Contestant<'_>> {
        let is_production = self.variant.robust;
        let single = if is_production { Role::Baseline } else { Role::Rival };
        let several = EmbreeCall::for_several().into_iter().map(|call| (call, Role::Heat));
        std::iter::once((EmbreeCall::Single, single))
            .chain(several)
            .map(|(call, role)| Contestant {
                backend: "embree",
                variant: format!("{}, {}", self.name, call.name()),
                isa: self.isa,
                law: Law::Approximate,
                role,
                tracer: Box::new(Called { embree: &self.embree, call }),
            })
            .collect()
    }
}

/// Embree, called in one way.
struct Called<'a> {
    embree: &'a BareEmbree,
    call: EmbreeCall,
}

impl Tracer for Called<'_> {
    fn batch(&self, query: Query) -> Option<Box<dyn Batch + '_>> {
        Some(Box::new(match query {
            Query::Closest => self.embree.closest(self.call),
            Query::AnyHit => self.embree.occluded(self.call)?,
        }))
    }
}

impl Batch for BareRays<'_> {
    fn load(&mut self, rays: &[Ray]) {
        self.load(rays);
    }

    fn trace(&mut self) {
        self.trace();
    }

    fn read(&self, answers: &mut Vec<Answer>) {
        answers.extend(self.read().into_iter().map(|(hit, id)| Answer { hit, id }));
    }
}
