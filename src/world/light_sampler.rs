//! Choosing a light in proportion to its power, and a direction towards it.
//!
//! Emissive triangles and all other lights share one alias table: picking one costs the same for one light and for a
//! million. Kinds that are not to be sampled have weight 0: rays may still meet them, and then they count in full,
//! since the density with which they are sampled is 0. Where such a kind lights the scene, sampling the rest at every
//! vertex may not be worth its rays, so that no light at all is one of the choices. Source: pbrt 4th ed., section 12.6.2
//! (power light sampler); the choice of none is measured in `benches/results/`.

use super::World;
use super::lights::Emitter;
use crate::geometry::offset_distance;
use crate::light::{LightKind, triangle};
use crate::math::{Rgb, Vec3};
use crate::sampling::AliasTable;
use crate::scene::MaterialId;

/// How lights are sampled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightSampler {
    /// One entry a light, those without a surface first; then perhaps one for no light.
    selection: AliasTable,
    /// For each material: the density per area with which a point of its triangles is chosen; empty where none is.
    pdf_area: Vec<f32>,
    /// How many lights can be chosen.
    choices: usize,
    /// Probability that none is.
    idle: f32,
    /// Whether any of them can be met by a ray, too.
    has_extent: bool,
}

/// A light as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct LightToSample {
    /// What kind of light it is.
    pub kind: LightKind,
    /// Unit direction to it.
    pub direction: Vec3,
    /// The end of the shadow segment, already clear of the light's own surface; `None` at infinity.
    pub end: Option<Vec3>,
    /// Radiance from there; of a delta light, the irradiance on a facing surface.
    pub radiance: Rgb,
    /// Density per solid angle, with the choice of the light in it; of a delta light, the probability
    /// of the choice alone.
    pub pdf_solid_angle: f32,
    /// No other strategy can find it.
    pub is_delta: bool,
}

/// How the lights of a kind are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// They are sampled.
    Sampled,
    /// Scattered rays find them well enough.
    Scattered,
    /// They are not looked for.
    Ignored,
}

/// Of the weight of lights that are left to scattering, the part that the choice of no light gets.
const IDLE_SHARE: f64 = 0.05;

/// The most that it gets, as a multiple of the weight of all lights that are sampled: a light may matter more
/// than its power says, as a lamp does in a closed room, so that a quarter of the vertices sample one whatever the
/// powers are.
const IDLE_LIMIT: f64 = 3.0;

impl LightSampler {
    /// Samples the lights of `world` as it says for their kinds.
    pub fn new(world: &World, finding: impl Fn(LightKind) -> Finding) -> Self {
        let lights = &world.lights;
        let of = |wanted: Finding| -> Vec<f64> {
            let weigh = |(i, weight)| if finding(lights.kind(i)) == wanted { weight } else { 0.0 };
            lights.weights().enumerate().map(weigh).collect()
        };
        let mut weights = of(Finding::Sampled);
        let chosen = |&i: &usize| weights[i] > 0.0;
        let has_extent = (0..weights.len()).filter(chosen).any(|i| !lights.kind(i).is_delta());
        let choices = (0..weights.len()).filter(chosen).count();

        // The choice of no light.
        let sampled: f64 = weights.iter().sum();
        let scattered: f64 = of(Finding::Scattered).iter().sum();
        let idle = (IDLE_SHARE * scattered).min(IDLE_LIMIT * sampled);
        let total = sampled + idle;
        if idle > 0.0 {
            weights.push(idle);
        }

        let density = |weight: f64| (weight / total) as f32;
        let finite = |pdf: f32| if pdf.is_finite() { pdf } else { 0.0 };
        let is_sampled = finding(LightKind::Surface) == Finding::Sampled;
        let pdf_area = match is_sampled && !lights.emitters.is_empty() {
            true => lights.weights_per_area().map(density).map(finite).collect(),
            false => Vec::new(),
        };
        let idle = if idle > 0.0 { density(idle) } else { 0.0 };
        Self { selection: AliasTable::new(&weights), pdf_area, choices, idle, has_extent }
    }

    /// Whether there is nothing to sample.
    pub fn is_empty(&self) -> bool {
        self.selection.is_empty()
    }

    /// How many lights can be chosen; each emissive triangle is one.
    pub fn choices(&self) -> usize {
        self.choices
    }

    /// The probability that [`LightSampler::sample`] chooses none.
    pub fn idle(&self) -> f32 {
        self.idle
    }

    /// Whether [`LightSampler::sample`] depends on `select`: not where it always chooses the same light.
    pub fn needs_choice(&self) -> bool {
        self.choices > 1 || self.idle > 0.0
    }

    /// Whether a light that is sampled can also be met by a scattered ray.
    pub fn has_extent(&self) -> bool {
        self.has_extent
    }

    /// Chooses a light by `select`, and a direction to it from `point` by `position`. `None` where the
    /// chosen light sends nothing, and where none is chosen.
    #[inline(always)]
    pub fn sample(
        &self,
        world: &World,
        point: Vec3,
        select: f32,
        position: [f32; 2],
    ) -> Option<LightToSample> {
        if self.selection.is_empty() {
            return None;
        }
        let (choice, probability) = self.selection.sample(select);
        let lights = &world.lights.lights;
        if choice >= lights.len() {
            let emitter = world.lights.emitters.get(choice - lights.len())?;
            return sample_emitter(world, emitter, point, probability, position);
        }
        let light = &lights[choice].0;
        let sample = light.sample(point, position)?;
        Some(LightToSample {
            kind: light.kind(),
            direction: sample.direction,
            end: sample.distance.is_finite().then(|| point + sample.direction * sample.distance),
            radiance: sample.radiance,
            pdf_solid_angle: sample.pdf_solid_angle * probability,
            is_delta: sample.is_delta,
        })
    }

    /// Density per solid angle with which [`LightSampler::sample`] finds a point of an emissive triangle of
    /// `material`, `distance` away, seen under `cos_theta` with its normal.
    #[inline]
    pub fn pdf_of_emitter(&self, material: MaterialId, distance: f32, cos_theta: f32) -> f32 {
        match self.pdf_area.get(material.index()) {
            Some(&pdf_area) => triangle::pdf_solid_angle(pdf_area, distance, cos_theta),
            None => 0.0,
        }
    }

    /// What a ray that leaves the scene along the unit vector `direction` sees of each light at
    /// infinity: kind, radiance, and the density per solid angle with which [`LightSampler::sample`] finds it.
    #[inline]
    pub fn at_infinity(
        &self,
        world: &World,
        direction: Vec3,
    ) -> impl Iterator<Item = (LightKind, Rgb, f32)> {
        world.lights.at_infinity().map(move |(i, light)| {
            let probability = if self.selection.is_empty() { 0.0 } else { self.selection.pmf(i) };
            if probability == 0.0 {
                return (light.kind(), light.radiance(direction), 0.0);
            }
            let (radiance, pdf) = light.radiance_and_pdf(direction);
            (light.kind(), radiance, pdf * probability)
        })
    }
}

fn sample_emitter(
    world: &World,
    emitter: &Emitter,
    point: Vec3,
    probability: f32,
    position: [f32; 2],
) -> Option<LightToSample> {
    let [a, b, c] = emitter.vertices;
    let (on_light, [u, v]) = triangle::sample_area(&emitter.vertices, position);
    let area_vector = (b - a).cross(c - a);
    let double_area = area_vector.length();
    let normal = area_vector / double_area;
    let to_light = on_light - point;
    let distance = to_light.length();
    let direction = to_light / distance;
    let cos_theta = direction.dot(normal);
    let pdf_area = probability * 2.0 / double_area;
    let pdf_solid_angle = triangle::pdf_solid_angle(pdf_area, distance, cos_theta);
    // Edge-on, or the point itself: carries nothing.
    if !(pdf_solid_angle.is_finite() && pdf_solid_angle > 0.0) {
        return None;
    }
    let uv = world.uv(emitter.id, u, v);
    let emission = world.material(emitter.material).emission?;
    let radiance = world.color(&emission.radiance, uv, 0.0) * world.opacity(emitter.material, uv);
    // The segment ends on the side of the light that faces the point.
    let offset = offset_distance(on_light, &emitter.vertices.map(Vec3::as_dvec3), 0.0);
    let end = on_light - normal * offset.copysign(cos_theta);
    Some(LightToSample {
        kind: LightKind::Surface,
        direction,
        end: Some(end),
        radiance,
        pdf_solid_angle,
        is_delta: false,
    })
}
