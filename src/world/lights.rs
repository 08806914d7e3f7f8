//! All lights of a world in one list.
//!
//! Emissive triangles and the lights of `light` are counted through: those without a surface first. Each has a
//! weight, an estimate of the power that it emits or, at infinity, sends to the scene. Which of them are sampled
//! is not decided here.

use super::World;
use crate::error::{Location, Result};
use crate::geometry::{NONE, PrimitiveId};
use crate::image::Image;
use crate::light::{
    ConstantEnvironment, DirectionalLight, ImageEnvironment, Light, LightKind, PointLight, Sky,
    SkyParameters, SpotLight, orientation, triangle,
};
use crate::math::{DVec3, Rgb, Vec3};
use crate::scene::{self, Environment, MaterialId, Scene};
use std::sync::Arc;

/// An emissive triangle in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emitter {
    pub(super) vertices: [Vec3; 3],
    pub(super) id: PrimitiveId,
    pub(super) material: MaterialId,
}

/// Every light.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Lights without a surface, and where each is defined.
    pub(super) lights: Arc<[(Light, Option<Location>)]>,
    /// Places in `lights` of those that rays which leave the scene see.
    at_infinity: Vec<usize>,
    /// Emissive triangles.
    pub(super) emitters: Arc<[Emitter]>,
    /// Luminance of the power of each of `lights`.
    power: Vec<f32>,
    /// Luminance of the mean emitted radiance of each material.
    luminance: Vec<f32>,
}

impl Lights {
    /// Collects the lights of `scene`, whose surfaces are compiled in `world`.
    pub(super) fn compile(world: &World, scene: &Scene) -> Result<Self> {
        let mut lights = Vec::new();
        for (i, light) in scene.lights.iter().enumerate() {
            let location = scene.light_locations.get(i).cloned();
            lights.push((compile_light(light, world.origin)?, location));
        }
        if let Some(environment) = &scene.environment {
            let location = &scene.environment_location;
            let parts = compile_environment(environment, scene)?.into_iter();
            lights.extend(parts.map(|light| (light, location.clone())));
        }
        Ok(Self::new(lights, emitters(world), world))
    }

    /// A constant environment of radiance 1, and no other light.
    pub(super) fn white_surroundings(world: &World) -> Result<Self> {
        let white = Light::Constant(ConstantEnvironment::new(Rgb::WHITE)?);
        Ok(Self::new(vec![(white, None)], Vec::new(), world))
    }

    fn new(lights: Vec<(Light, Option<Location>)>, emitters: Vec<Emitter>, world: &World) -> Self {
        let radius = world.bounds.bounding_radius();
        let mean = |i: usize| world.mean_emission(MaterialId(i as u32)).luminance();
        let is_far = |&i: &usize| lights[i].0.is_seen_at_infinity();
        Self {
            at_infinity: (0..lights.len()).filter(is_far).collect(),
            power: lights.iter().map(|(light, _)| light.power_estimate(radius)).collect(),
            luminance: (0..world.materials.len()).map(mean).collect(),
            lights: lights.into(),
            emitters: emitters.into(),
        }
    }

    /// Number of emissive triangles.
    pub fn emitter_count(&self) -> usize {
        self.emitters.len()
    }

    /// The lights without a surface that send anything: kind, and where it is defined.
    pub(super) fn lit(&self) -> impl Iterator<Item = (LightKind, &Option<Location>)> {
        let is_lit = |i: &usize| self.power[*i] > 0.0;
        let lit = (0..self.lights.len()).filter(is_lit);
        lit.map(|i| (self.lights[i].0.kind(), &self.lights[i].1))
    }

    /// Kind of the light number `i`.
    pub(super) fn kind(&self, i: usize) -> LightKind {
        self.lights.get(i).map_or(LightKind::Surface, |(light, _)| light.kind())
    }

    /// One weight a light: its power, so that what lights more is asked more often.
    pub(super) fn weights(&self) -> impl Iterator<Item = f64> {
        let of_lights = self.power.iter().map(|&power| f64::from(power));
        of_lights.chain(self.emitters.iter().map(|emitter| {
            let area = triangle::area(&emitter.vertices);
            let luminance = self.luminance[emitter.material.index()];
            f64::from(triangle::power_estimate(area, luminance))
        }))
    }

    /// For each material the weight of a triangle of area 1: weights are linear in area.
    pub(super) fn weights_per_area(&self) -> impl Iterator<Item = f64> {
        self.luminance.iter().map(|&l| f64::from(triangle::power_estimate(1.0, l)))
    }

    /// The lights that rays which leave the scene see, each with its number.
    #[inline]
    pub(super) fn at_infinity(&self) -> impl Iterator<Item = (usize, &Light)> {
        self.at_infinity.iter().map(|&i| (i, &self.lights[i].0))
    }
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
