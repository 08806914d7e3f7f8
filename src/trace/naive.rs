//! A deliberately naive path tracer: one path, recursively, for the tests to hold the wavefront against.
//!
//! It draws the same named numbers, so the two agree path by path. It shares the models and the world
//! with the wavefront, and nothing of its control flow. Not for rendering.

use super::{RayKind, SCATTERED_SPREAD, Tracer, power_heuristic, survival_probability};
use crate::accel::{Accelerator, HitFilter};
use crate::bsdf::Scatter;
use crate::geometry::{Hit, Ray};
use crate::math::{Rgb, fun};
use crate::sampling::{Dimension, PathSampler};

/// What a ray carries along in the recursion.
#[derive(Clone, Copy)]
struct State {
    bounce: u32,
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
        throughput: Rgb::WHITE,
        eta_scale: 1.0,
        pdf: None,
        cone: [start.camera.initial_width, start.camera.spread],
        absorption: Rgb::BLACK,
    };
    incoming(tracer, filter, &start.sampler, start.camera.ray, state) * start.weight
}

/// Radiance arriving along a ray.
fn incoming<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    numbers: &PathSampler,
    ray: Ray,
    mut state: State,
) -> Rgb {
    let world = tracer.world;
    let bounce = state.bounce;
    let mut hit = [Hit::MISS];
    tracer.accelerator.closest(&[ray], filter, &mut hit);
    let hit = hit[0];
    let mis = |pdf_light: f32| state.pdf.map_or(1.0, |pdf| power_heuristic(pdf, pdf_light));
    if !hit.is_hit() {
        if tracer.hide_background && bounce == 0 {
            return Rgb::BLACK;
        }
        let seen = world.lights.at_infinity(ray.direction);
        return seen.fold(Rgb::BLACK, |sum, (l, pdf)| sum + l * mis(pdf));
    }
    let transmitted = (state.absorption * -hit.t).map(fun::exp);
    state.cone[0] += state.cone[1] * hit.t;
    let at = world.interact(&ray, &hit, state.cone[0]);

    // Emission.
    let distance = (at.point - ray.origin).length();
    let cos_theta = at.n_geometric.dot(ray.direction);
    let pdf_light = world.lights.pdf_of_emitter(at.material, distance, cos_theta);
    let mut radiance = world.emitted(&at) * mis(pdf_light);
    if bounce + 1 >= tracer.max_depth {
        return transmitted * radiance;
    }

    // Direct light.
    let bsdf = world.bsdf(&at);
    let wo = at.frame.local_from_world(-ray.direction);
    if !bsdf.is_delta() && !world.lights.is_empty() {
        let select = numbers.one(Dimension::LightSelect { bounce });
        let position = numbers.two(Dimension::LightPosition { bounce });
        if let Some(light) = world.lights.sample(world, at.point, select, position) {
            let wi = at.frame.local_from_world(light.direction);
            let value = bsdf.evaluate(wo, wi);
            let same_side = (wi.z > 0.0) == (at.n_geometric.dot(light.direction) > 0.0);
            let origin = at.origin_towards(light.direction);
            let segment = match light.end {
                Some(end) => Ray::between(origin, end),
                None => Ray::new(origin, light.direction),
            };
            let id = tracer.ray_id(numbers, bounce, RayKind::Shadow);
            let mut blocked = [false];
            tracer.accelerator.occluded(&[Ray { id, ..segment }], filter, &mut blocked);
            if same_side && !blocked[0] {
                let weight = match light.is_delta {
                    true => 1.0,
                    false => power_heuristic(light.pdf_solid_angle, value.pdf_solid_angle),
                };
                radiance += value.f_cos * light.radiance * (weight / light.pdf_solid_angle);
            }
        }
    }

    // Scattered light.
    let lobe = numbers.one(Dimension::ScatterLobe { bounce });
    let direction = numbers.two(Dimension::ScatterDirection { bounce });
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
    if survival < 1.0 && numbers.one(Dimension::Roulette { bounce }) >= survival {
        return transmitted * radiance;
    }
    let crossed = sample.wi.z < 0.0;
    let inside = world.absorption(at.material).filter(|_| at.entering).unwrap_or(Rgb::BLACK);
    let spread = if sample.is_delta { 0.0 } else { SCATTERED_SPREAD };
    let next = State {
        bounce: bounce + 1,
        throughput: throughput * (1.0 / survival),
        eta_scale,
        pdf: (!sample.is_delta).then_some(sample.pdf_solid_angle),
        cone: [state.cone[0], state.cone[1] + spread],
        absorption: if crossed { inside } else { state.absorption },
    };
    let id = tracer.ray_id(numbers, bounce + 1, RayKind::Path);
    let ray = Ray { id, ..Ray::new(at.origin_towards(wi), wi) };
    let scattered = incoming(tracer, filter, numbers, ray, next);
    transmitted * (radiance + sample.weight * scattered * (1.0 / survival))
}
