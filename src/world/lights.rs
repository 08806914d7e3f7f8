//! All lights of a world in one list, chosen in proportion to their power.
//!
//! Emissive triangles and the lights of `light` share one alias table, whose weights are estimates of
//! emitted (or, at infinity, received) power; picking one costs the same for one light and for a
//! million. Source: pbrt 4th ed., section 12.6.2 (power light sampler).

use super::World;
use crate::error::Result;
use crate::geometry::{NONE, PrimitiveId, offset_distance};
use crate::image::Image;
use crate::light::{
    ConstantEnvironment, DirectionalLight, ImageEnvironment, Light, PointLight, Sky, SkyParameters,
    SpotLight, orientation, triangle,
};
use crate::math::{DVec3, Rgb, Vec3};
use crate::sampling::AliasTable;
use crate::scene::{self, Environment, MaterialId, Scene};

/// An emissive triangle in world space.
struct Emitter {
    vertices: [Vec3; 3],
    id: PrimitiveId,
    material: MaterialId,
}

/// Every light, and how to choose one.
#[derive(Default)]
pub struct Lights {
    /// Lights without a surface; choices below their number mean them.
    lights: Vec<Light>,
    /// Emissive triangles; choices from there on.
    emitters: Vec<Emitter>,
    selection: AliasTable,
    /// For each material: the density per area with which a point of its triangles is chosen.
    pdf_area: Vec<f32>,
}

/// A light as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct LightToSample {
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

impl Lights {
    /// Collects the lights of `scene`, whose surfaces are compiled in `world`.
    pub(super) fn compile(world: &World, scene: &Scene) -> Result<Self> {
        let mut lights = Vec::new();
        for light in &scene.lights {
            lights.push(compile_light(light, world.origin)?);
        }
        if let Some(environment) = &scene.environment {
            lights.extend(compile_environment(environment, scene)?);
        }
        let emitters = emitters(world);

        // One weight a choice: power, so that what lights more is asked more often.
        let radius = world.bounds.bounding_radius();
        let luminance: Vec<f32> = (0..world.materials.len())
            .map(|i| world.mean_emission(MaterialId(i as u32)).luminance())
            .collect();
        let of_lights = lights.iter().map(|l| f64::from(l.power_estimate(radius)));
        let of_emitters = emitters.iter().map(|e| {
            let area = triangle::area(&e.vertices);
            f64::from(triangle::power_estimate(area, luminance[e.material.index()]))
        });
        let weights: Vec<f64> = of_lights.chain(of_emitters).collect();
        let total: f64 = weights.iter().sum();
        // Power is linear in area, so the density per area depends on the material alone.
        let pdf_area = luminance
            .iter()
            .map(|&l| (f64::from(triangle::power_estimate(1.0, l)) / total) as f32)
            .map(|pdf| if pdf.is_finite() { pdf } else { 0.0 })
            .collect();
        Ok(Self { lights, emitters, selection: AliasTable::new(&weights), pdf_area })
    }

    /// Whether light sampling can find nothing.
    pub fn is_empty(&self) -> bool {
        self.selection.is_empty()
    }

    /// Whether [`Lights::sample`] depends on `select`: not where there is one light only.
    #[inline]
    pub fn needs_choice(&self) -> bool {
        self.selection.len() > 1
    }

    /// Number of emissive triangles.
    pub fn emitter_count(&self) -> usize {
        self.emitters.len()
    }

    /// Chooses a light by `select`, and a direction to it from `point` by `position`. `None` where the
    /// chosen light sends nothing. There must be a light.
    #[inline(always)]
    pub fn sample(
        &self,
        world: &World,
        point: Vec3,
        select: f32,
        position: [f32; 2],
    ) -> Option<LightToSample> {
        let (choice, probability) = self.selection.sample(select);
        if choice >= self.lights.len() {
            return sample_emitter(
                world,
                &self.emitters[choice - self.lights.len()],
                point,
                probability,
                position,
            );
        }
        let sample = self.lights[choice].sample(point, position)?;
        Some(LightToSample {
            direction: sample.direction,
            end: sample.distance.is_finite().then(|| point + sample.direction * sample.distance),
            radiance: sample.radiance,
            pdf_solid_angle: sample.pdf_solid_angle * probability,
            is_delta: sample.is_delta,
        })
    }

    /// Density per solid angle with which [`Lights::sample`] finds a point of an emissive triangle of
    /// `material`, `distance` away, seen under `cos_theta` with its normal.
    #[inline]
    pub fn pdf_of_emitter(&self, material: MaterialId, distance: f32, cos_theta: f32) -> f32 {
        triangle::pdf_solid_angle(self.pdf_area[material.index()], distance, cos_theta)
    }

    /// What a ray that leaves the scene along the unit vector `direction` sees of each light at
    /// infinity: radiance, and the density per solid angle with which [`Lights::sample`] finds it.
    #[inline]
    pub fn at_infinity(&self, direction: Vec3) -> impl Iterator<Item = (Rgb, f32)> {
        self.lights.iter().enumerate().filter(|(_, light)| light.is_seen_at_infinity()).map(
            move |(i, light)| {
                let (radiance, pdf) = light.radiance_and_pdf(direction);
                (radiance, pdf * self.selection.pmf(i))
            },
        )
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
    Some(LightToSample { direction, end: Some(end), radiance, pdf_solid_angle, is_delta: false })
}

/// Every triangle whose material emits.
fn emitters(world: &World) -> Vec<Emitter> {
    let emits: Vec<bool> = (0..world.materials.len())
        .map(|i| world.mean_emission(MaterialId(i as u32)).luminance() > 0.0)
        .collect();
    let mut emitters = Vec::new();
    if !emits.contains(&true) {
        return emitters;
    }
    let mut collect = |instance: u32, geometry: usize, triangles: usize| {
        for primitive in 0..triangles as u32 {
            let id = PrimitiveId { instance, geometry: geometry as u32, primitive };
            let material = world.material_id(id);
            if emits[material.index()] {
                let vertices = world.geometry.world_vertices(id).0.map(|p| p.as_vec3());
                emitters.push(Emitter { vertices, id, material });
            }
        }
    };
    for (geometry, mesh) in world.geometry.meshes.iter().enumerate() {
        collect(NONE, geometry, mesh.triangles.len());
    }
    for (instance, placed) in world.geometry.instances.iter().enumerate() {
        let meshes = &world.geometry.objects[placed.object as usize].meshes;
        for (geometry, mesh) in meshes.iter().enumerate() {
            collect(instance as u32, geometry, mesh.triangles.len());
        }
    }
    emitters
}

fn compile_light(light: &scene::Light, origin: DVec3) -> Result<Light> {
    Ok(match *light {
        scene::Light::Point { position, intensity } => {
            Light::Point(PointLight::new(position - origin, intensity)?)
        }
        scene::Light::Spot { position, direction, intensity, outer_angle, inner_angle } => {
            let position = position - origin;
            Light::Spot(SpotLight::new(position, direction, intensity, [inner_angle, outer_angle])?)
        }
        scene::Light::Directional { direction, irradiance, angular_diameter } => {
            Light::Directional(DirectionalLight::new(direction, irradiance, angular_diameter)?)
        }
    })
}

/// The lights that an environment is made of: a sky is an image and a sun.
fn compile_environment(environment: &Environment, scene: &Scene) -> Result<Vec<Light>> {
    Ok(match *environment {
        Environment::Constant { radiance } => {
            vec![Light::Constant(ConstantEnvironment::new(radiance)?)]
        }
        Environment::Image { image, scale, rotation } => {
            let image: &Image = &scene.images[image.index()];
            let texels = (0..image.height())
                .flat_map(|y| (0..image.width()).map(move |x| image.texel(x, y).0 * scale))
                .collect();
            let axes = orientation(scene.up, rotation);
            vec![Light::Image(ImageEnvironment::new(texels, image.width() as usize, axes)?)]
        }
        Environment::Sky { elevation, azimuth, turbidity, ground_albedo, scale } => {
            let parameters =
                SkyParameters { up: scene.up, elevation, azimuth, turbidity, ground_albedo, scale };
            let sky = Sky::new(&parameters)?;
            vec![Light::Image(sky.environment), Light::Directional(sky.sun)]
        }
    })
}
