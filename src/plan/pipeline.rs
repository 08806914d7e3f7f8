//! What runs: the decisions that the stages of a path ask for, from what the scene calls for and what the user allows.
//!
//! Two kinds of decisions. Some only spare work that cannot change the picture: the census proves that what is left
//! out would add exactly nothing. One changes the estimator: which lights are sampled. Both ways of finding a light
//! are unbiased, so the picture changes in its noise alone.

use super::Wishes;
use crate::ledger::{Events, Stage};
use crate::light::LightKind;
use crate::scene::{Effect, Style};
use crate::world::{Census, Details, Feature, Finding, LightSampler, World};

/// What the stages ask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pipeline {
    /// Path segments; `u32::MAX` is unbounded.
    pub max_depth: u32,
    /// Points on the lens are drawn.
    pub lens: bool,
    /// Hit filters are asked.
    pub hit_filter: bool,
    /// Where texture coordinates and normal maps are worked out.
    pub details: Details,
    /// The camera sees emissive surfaces.
    pub emission_seen: bool,
    /// The camera sees the surroundings.
    pub environment_seen: bool,
    /// What may happen to a path.
    pub events: Events,
    /// Light that is scattered once counts.
    pub direct: bool,
    /// Surfaces that rays meet are asked for emission.
    pub emission: bool,
    /// Rays that leave the scene are shown what surrounds it.
    pub environment: bool,
    /// A kind of lights that rays can meet, if they can meet any.
    pub met_light: LightKind,
    /// Lights are sampled.
    pub light_sampling: bool,
    /// More than one light is, so that one must be chosen.
    pub light_choice: bool,
    /// Sampled lights can be behind something.
    pub shadows: bool,
    /// Lights that scattered rays meet count.
    pub scatter_sampling: bool,
    /// Some lights can be found in both ways, so that the two must share them.
    pub combination: bool,
    /// Media keep light.
    pub absorption: bool,
    /// Paths may have to end at a surface, for what they were allowed.
    pub bounded: bool,
    /// Paths end at random.
    pub roulette: bool,
    /// Nothing is spared: every stage runs, if only to find that there is nothing to do.
    pub everything: bool,
}

impl Pipeline {
    /// The cheapest pipeline that gives what `wishes` allow of what is in the scene, and how it samples lights.
    pub(super) fn new(
        world: &World,
        census: &Census,
        has_lens: bool,
        wishes: &Wishes,
    ) -> (Self, LightSampler) {
        let everything = wishes.effects.style == Style::All;
        let allowed = |effect| wishes.effects.allowed.has(effect);
        let has = |features: &[Feature]| everything || census.has_any(features);
        let is_rough = has(&[Feature::Diffuse, Feature::Glossy, Feature::RoughRefraction]);
        let is_sharp = has(&[Feature::Mirror, Feature::Refraction]);

        let events = [
            (Effect::Diffuse, Events::DIFFUSE),
            (Effect::Glossy, Events::GLOSSY),
            (Effect::Mirror, Events::MIRROR),
            (Effect::Refraction, Events::REFRACTION),
            (Effect::Caustics, Events::CAUSTIC),
        ]
        .into_iter()
        .filter(|(effect, _)| allowed(*effect))
        .fold(Events::NONE, |all, (_, event)| all.and(event));

        // No surface scatters, or what it scatters is not wanted: nothing but the lights themselves is seen.
        let is_followed = allowed(Effect::Direct) || events != Events::NONE;
        let scatters = is_followed && (is_rough || is_sharp);
        let max_depth = if scatters { wishes.max_depth } else { 1 };

        // Unshadowed light cannot be found by rays, which surfaces stop.
        let scatter_sampling = allowed(Effect::ScatterSampling) && allowed(Effect::Shadows);
        let sharp_events = events.meet(Events::MIRROR.and(Events::REFRACTION));
        let is_met = scatter_sampling || sharp_events && is_sharp;
        let emission_seen = allowed(Effect::Emission);
        let environment_seen = allowed(Effect::Environment) && !wishes.hide_background;
        let emission = has(&[Feature::Emission]) && (emission_seen || is_met);
        let surroundings = [Feature::Sun, Feature::Constant, Feature::Image];
        let environment = has(&surroundings) && (environment_seen || is_met);

        // A constant environment is found by scattering at least as well: sampling it would choose among
        // directions that all are alike, half of them below the surface.
        let finding = |kind| match kind {
            _ if !allowed(Effect::LightSampling) => Finding::Ignored,
            LightKind::Constant if scatter_sampling && !everything => Finding::Scattered,
            _ => Finding::Sampled,
        };
        let lights = LightSampler::new(world, finding);
        let light_sampling = allowed(Effect::LightSampling)
            && (everything || !lights.is_empty() && is_rough && max_depth > 1);
        let has_images = allowed(Effect::Textures) && has(&[Feature::Texture])
            || allowed(Effect::NormalMaps) && has(&[Feature::NormalMap]);
        let pipeline = Self {
            max_depth,
            lens: allowed(Effect::DepthOfField) && (everything || has_lens),
            hit_filter: allowed(Effect::CutOuts) && has(&[Feature::CutOut]),
            details: match has_images {
                _ if everything => Details::Everywhere,
                true => Details::WhereNeeded,
                false => Details::Nowhere,
            },
            emission_seen,
            environment_seen,
            events,
            direct: allowed(Effect::Direct),
            emission,
            environment,
            met_light: match () {
                () if emission => LightKind::Surface,
                () if has(&[Feature::Image]) => LightKind::Image,
                () if has(&[Feature::Constant]) => LightKind::Constant,
                () => LightKind::Disc,
            },
            light_sampling,
            light_choice: light_sampling && (everything || lights.needs_choice()),
            shadows: allowed(Effect::Shadows),
            scatter_sampling,
            combination: light_sampling && scatter_sampling && (everything || lights.has_extent()),
            absorption: allowed(Effect::Absorption) && has(&[Feature::Absorption]),
            bounded: everything || max_depth < u32::MAX || events != Events::ALL,
            roulette: everything || max_depth > FREE_SEGMENTS,
            everything,
        };
        (pipeline, lights)
    }

    /// Whether light that arrives without a sharp reflection counts, `events` having happened before.
    #[inline]
    pub fn counts(&self, events: Events) -> bool {
        events.are_within(self.events) && (self.direct || events != Events::NONE)
    }

    /// Whether paths are followed beyond what the camera sees.
    pub fn scatters(&self) -> bool {
        self.everything || self.max_depth > 1
    }

    /// Whether a stage runs.
    pub fn runs(&self, stage: Stage) -> bool {
        match stage {
            Stage::Lens => self.lens,
            Stage::Environment => self.environment,
            Stage::Details | Stage::Textures => self.details != Details::Nowhere,
            Stage::Emit => self.emission || self.bounded,
            Stage::Materials | Stage::Scatter => self.scatters(),
            Stage::SampleLights => self.light_sampling,
            Stage::Shadow => self.light_sampling && self.shadows,
            Stage::Roulette => self.scatters() && self.roulette,
            Stage::Generate | Stage::Intersect | Stage::Interact | Stage::Accumulate => true,
        }
    }
}

/// Segments that no path is denied by Russian roulette: it plays from the third vertex on.
const FREE_SEGMENTS: u32 = 3;
