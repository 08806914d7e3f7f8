//! A deliberately naive path tracer: one path, recursively, for the tests to hold the wavefront against.
//!
//! It draws the same named numbers, so the two agree path by path. It shares the models and the world
//! with the wavefront, and nothing of its control flow: of the plan it takes only what a user may leave out and which
//! lights are sampled, and spares nothing. Not for rendering.

use super::{RayKind, SCATTERED_SPREAD, Tracer, power_heuristic, survival_probability};
use crate::accel::{Accelerator, HitFilter};
use crate::bsdf::{LobeKind, Scatter};
use crate::geometry::{Hit, Ray};
use crate::ledger::Events;
use crate::math::{Rgb, Vec3, fun};
use crate::plan::Pipeline;
use crate::sampling::{Dimension, SampleKey};

/// What a ray carries along in the recursion.
#[derive(Clone)]
struct State {
    bounce: u32,
    /// What happened at each vertex so far.
    history: Vec<LobeKind>,
    throughput: Rgb,
    eta_scale: f32,
    /// Density of the ray's direction; `None` where light sampling could not have found it.
    pdf: Option<f32>,
    cone: [f32; 2],
    absorption: Rgb,
}

/// Radiance times filter weight of one sample of one pixel.
pub fn radiance<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    pixel: [u32; 2],
    sample: u64,
) -> Rgb {
    let start = tracer.camera_ray(pixel, sample);
    let state = State {
        bounce: 0,
        history: Vec::new(),
        throughput: Rgb::WHITE,
        eta_scale: 1.0,
        pdf: None,
        cone: [start.camera.initial_width, start.camera.spread],
        absorption: Rgb::BLACK,
    };
    incoming(tracer, filter, start.key, start.camera.ray, state) * start.weight
}

/// Radiance arriving along a ray.
fn incoming<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    key: SampleKey,
    ray: Ray,
    mut state: State,
) -> Rgb {
    let world = tracer.world;
    let bounce = state.bounce;
    let mut hit = [Hit::MISS];
    tracer.accelerator.closest(&[ray], filter, &mut hit);
    let hit = hit[0];
    let (pipeline, lights) = (&tracer.plan.pipeline, &tracer.plan.lights);
    let mis = |pdf_light: f32| state.pdf.map_or(1.0, |pdf| power_heuristic(pdf, pdf_light));
    let met = |is_seen: bool| match state.history.split_last() {
        None => is_seen,
        Some((LobeKind::Diffuse | LobeKind::Glossy, before)) => {
            counts(before, pipeline) && pipeline.scatter_sampling
        }
        Some(_) => {
            counts(&state.history, pipeline) && (state.pdf.is_none() || pipeline.scatter_sampling)
        }
    };
    if !hit.is_hit() {
        if !met(pipeline.environment_seen) {
            return Rgb::BLACK;
        }
        let seen = lights.at_infinity(world, ray.direction);
        return seen.fold(Rgb::BLACK, |sum, (_, l, pdf)| sum + l * mis(pdf));
    }
    let transmitted = (state.absorption * -hit.t).map(fun::exp);
    state.cone[0] += state.cone[1] * hit.t;
    let at = world.interact(&ray, &hit, state.cone[0], true);

    // Emission.
    let distance = (at.point - ray.origin).length();
    let cos_theta = at.n_geometric.dot(ray.direction);
    let pdf_light = lights.pdf_of_emitter(at.material, distance, cos_theta);
    let is_seen = met(pipeline.emission_seen);
    let mut radiance = if is_seen { world.emitted(&at) * mis(pdf_light) } else { Rgb::BLACK };
    if bounce + 1 >= pipeline.max_depth || !is_allowed(&state.history, pipeline) {
        return transmitted * radiance;
    }

    // The medium behind the surface.
    let inside = world.absorption(at.material).filter(|_| at.entering && pipeline.absorption);
    let medium = |wi: Vec3| match wi.z < 0.0 {
        true => inside.unwrap_or(Rgb::BLACK),
        false => state.absorption,
    };

    // Direct light.
    let bsdf = world.bsdf(&at);
    let wo = at.frame.local_from_world(-ray.direction);
    if !bsdf.is_delta() && pipeline.light_sampling {
        let select = tracer.sampler.one(key, Dimension::LightSelect { bounce });
        let position = tracer.sampler.two(key, Dimension::LightPosition { bounce });
        if let Some(light) = lights.sample(world, at.point, select, position) {
            let wi = at.frame.local_from_world(light.direction);
            let value = bsdf.evaluate(wo, wi);
            let same_side = (wi.z > 0.0) == (at.n_geometric.dot(light.direction) > 0.0);
            let origin = at.origin_towards(light.direction);
            let segment = match light.end {
                Some(end) => Ray::between(origin, end),
                None => Ray::new(origin, light.direction),
            };
            let id = tracer.ray_id(key, bounce, RayKind::Shadow);
            let mut blocked = [false];
            tracer.accelerator.occluded(&[Ray { id, ..segment }], filter, &mut blocked);
            let mut history = state.history.clone();
            history.extend((wi.z < 0.0).then_some(LobeKind::Refraction));
            let is_blocked = blocked[0] && pipeline.shadows;
            if same_side && !is_blocked && counts(&history, pipeline) {
                let weight = match light.is_delta || !pipeline.scatter_sampling {
                    true => 1.0,
                    false => power_heuristic(light.pdf_solid_angle, value.pdf_solid_angle),
                };
                let distance = light.end.map_or(0.0, |end| (end - origin).length());
                let arrives = light.radiance * (medium(wi) * -distance).map(fun::exp);
                radiance += value.f_cos * arrives * (weight / light.pdf_solid_angle);
            }
        }
    }

    // Scattered light.
    let lobe = tracer.sampler.one(key, Dimension::ScatterLobe { bounce });
    let direction = tracer.sampler.two(key, Dimension::ScatterDirection { bounce });
    let Some(sample) = bsdf.sample(wo, lobe, direction) else {
        return transmitted * radiance;
    };
    let wi = at.frame.world_from_local(sample.wi);
    if (sample.wi.z > 0.0) != (at.n_geometric.dot(wi) > 0.0) || sample.weight.is_black() {
        return transmitted * radiance;
    }
    let throughput = state.throughput * transmitted * sample.weight;
    let eta_scale = state.eta_scale * sample.eta_scale;
    let survival = survival_probability(throughput, eta_scale, bounce);
    if survival < 1.0 && tracer.sampler.one(key, Dimension::Roulette { bounce }) >= survival {
        return transmitted * radiance;
    }
    let mut history = state.history.clone();
    history.push(sample.kind);
    let spread = if sample.is_delta { 0.0 } else { SCATTERED_SPREAD };
    let next = State {
        bounce: bounce + 1,
        history,
        throughput: throughput * (1.0 / survival),
        eta_scale,
        pdf: (!sample.is_delta).then_some(sample.pdf_solid_angle),
        cone: [state.cone[0], state.cone[1] + spread],
        absorption: medium(sample.wi),
    };
    let id = tracer.ray_id(key, bounce + 1, RayKind::Path);
    let ray = Ray { id, ..Ray::new(at.origin_towards(wi), wi) };
    let scattered = incoming(tracer, filter, key, ray, next);
    transmitted * (radiance + sample.weight * scattered * (1.0 / survival))
}

/// Whether all of this may happen to one path.
fn is_allowed(history: &[LobeKind], pipeline: &Pipeline) -> bool {
    let is_rough = |kind: &LobeKind| matches!(kind, LobeKind::Diffuse | LobeKind::Glossy);
    let first_rough = history.iter().position(is_rough).unwrap_or(history.len());
    let has_caustic = history[first_rough..].iter().any(|kind| !is_rough(kind));
    let has = |event: Events| event.are_within(pipeline.events);
    let each = history.iter().all(|kind| match kind {
        LobeKind::Diffuse => has(Events::DIFFUSE),
        LobeKind::Glossy => has(Events::GLOSSY),
        LobeKind::Mirror => has(Events::MIRROR),
        LobeKind::Refraction => has(Events::REFRACTION),
    });
    each && (!has_caustic || has(Events::CAUSTIC))
}

/// Whether light that then arrives by a rough reflection, or straight, counts.
fn counts(history: &[LobeKind], pipeline: &Pipeline) -> bool {
    is_allowed(history, pipeline) && (pipeline.direct || !history.is_empty())
}
