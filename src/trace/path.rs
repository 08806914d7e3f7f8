//! The state of one path between two stages of the wavefront.

use super::{CameraStart, ClassRadiance, direct_class, event_of};
use crate::bsdf::LobeKind;
use crate::geometry::{PrimitiveId, Ray};
use crate::ledger::{Class, Events, Ledger};
use crate::light::LightKind;
use crate::math::Rgb;
use crate::plan::Pipeline;
use crate::sampling::SampleKey;

/// State of one path; it stays in its slot while it lives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Path {
    /// The ray to be traced next.
    pub(super) ray: Ray,
    /// Product of the scattering weights so far.
    pub(super) throughput: Rgb,
    /// Radiance gathered so far.
    pub(super) radiance: Rgb,
    /// What its random numbers are drawn with.
    pub(super) key: SampleKey,
    /// Vertices so far: the next hit is vertex number `bounce`.
    pub(super) bounce: u32,
    /// Density per solid angle with which the ray's direction was scattered.
    pub(super) pdf_solid_angle: f32,
    /// What happened to it at the vertices before its last one, and what happened there, unless it is sharp: that
    /// counts only once the ray meets a surface that is no light.
    pub(super) events: Events,
    pub(super) pending: Events,
    /// It may meet a light, and does not go on from where it meets a surface.
    pub(super) only_looks_for_lights: bool,
    /// The class that its ray is counted in, unless it meets a light.
    pub(super) ray_class: Class,
    /// The cell whose light is told apart by class, or [`Path::UNWATCHED`].
    pub(super) cell: u32,
    /// Whether light sampling could not have found the ray's direction: its emission counts in full.
    pub(super) is_delta: bool,
    /// Undoes the radiance factor of refractions for Russian roulette.
    pub(super) eta_scale: f32,
    /// Width of the ray cone at the ray's origin.
    pub(super) cone_width: f32,
    /// Growth of the cone's width per unit length.
    pub(super) cone_spread: f32,
    /// Absorption coefficient of what the ray runs through.
    pub(super) absorption: Rgb,
    /// Where it began.
    pub(super) pixel: [u32; 2],
    /// Which of the pixel's samples it is.
    pub(super) sample: u64,
    /// Filter weight.
    pub(super) weight: f32,
    /// 1 once the camera ray has met a surface.
    pub(super) coverage: f32,
    /// The surface that the ray left or met last.
    pub(super) last_hit: PrimitiveId,
}

impl Path {
    /// No cell.
    pub(super) const UNWATCHED: u32 = u32::MAX;

    /// Adds light of a class; `parts` are those of its slot.
    #[inline(always)]
    pub(super) fn add(&mut self, gain: Rgb, class: Class, parts: &mut ClassRadiance) {
        self.radiance += gain;
        if self.cell != Self::UNWATCHED {
            parts[class as usize] += gain;
        }
    }

    /// Its ray met a light whose light is in `class`: the last one that it meets there has the ray.
    #[inline]
    pub(super) fn met_light(&mut self, class: Class, ledger: &mut Ledger) {
        ledger.recount_path_ray(self.ray_class, class);
        self.ray_class = class;
    }

    /// What has happened to it where it leaves its last vertex for another surface.
    #[inline]
    pub(super) fn confirmed(&self) -> Events {
        self.events.followed_by(self.pending)
    }

    /// Takes down what the path's last vertex does to it; whether it has any use for the next ray.
    #[inline]
    pub(super) fn happens(&mut self, kind: LobeKind, is_delta: bool, pipeline: &Pipeline) -> bool {
        let confirmed = self.confirmed();
        let event = event_of(kind);
        let after = confirmed.followed_by(event);
        // Of a sharp event both ways of finding lights know: it counts whatever the next ray meets.
        let is_sharp = is_delta || kind == LobeKind::Refraction;
        (self.events, self.pending) =
            if is_sharp { (after, Events::NONE) } else { (confirmed, event) };
        self.ray_class = after.class().unwrap_or(Class::Seen);
        if !pipeline.bounded {
            return true;
        }

        let is_allowed = after.are_within(pipeline.events);
        self.only_looks_for_lights = !is_allowed;
        let has_room = self.bounce + 2 < pipeline.max_depth;
        let goes_on = is_allowed && has_room;
        if !goes_on {
            self.ray_class = self.events.class().unwrap_or(direct_class(pipeline.met_light));
        }
        let may_meet_light = pipeline.emission || pipeline.environment;
        let finds_lights = may_meet_light
            && (is_delta || pipeline.scatter_sampling)
            && pipeline.counts(self.events);
        finds_lights || goes_on
    }

    /// The class of the light of this kind that its ray meets; `None` where that does not count.
    #[inline]
    pub(super) fn class_of_met(&self, kind: LightKind, pipeline: &Pipeline) -> Option<Class> {
        if self.bounce == 0 {
            let is_seen = match kind {
                LightKind::Surface => pipeline.emission_seen,
                _ => pipeline.environment_seen,
            };
            return is_seen.then_some(Class::Seen);
        }
        let counts = pipeline.counts(self.events) && (self.is_delta || pipeline.scatter_sampling);
        counts.then(|| self.events.class().unwrap_or(direct_class(kind)))
    }

    /// The path that starts with a camera ray.
    #[inline]
    pub(super) fn begin(start: &CameraStart, pixel: [u32; 2], sample: u64, cell: u32) -> Self {
        Self {
            ray: start.camera.ray,
            throughput: Rgb::WHITE,
            radiance: Rgb::BLACK,
            key: start.key,
            bounce: 0,
            pdf_solid_angle: 0.0,
            // No light is sampled for the camera: what it sees counts in full.
            is_delta: true,
            events: Events::NONE,
            pending: Events::NONE,
            only_looks_for_lights: false,
            ray_class: Class::Seen,
            cell,
            eta_scale: 1.0,
            cone_width: start.camera.initial_width,
            cone_spread: start.camera.spread,
            absorption: Rgb::BLACK,
            pixel,
            sample,
            weight: start.weight,
            coverage: 0.0,
            last_hit: PrimitiveId::MISS,
        }
    }
}
