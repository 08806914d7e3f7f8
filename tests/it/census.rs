//! The census against the models themselves: whatever a surface can do to a path, the census must have called for.
//!
//! A decision to spare something rests on what no surface does. So random and extreme materials are sampled from all
//! sides, and every lobe that turns up must be among those that were found. That a lobe is found and never turns up is
//! allowed: it costs time, not light.

use glint::bsdf::{LobeKind, Scatter};
use glint::geometry::{Hit, NONE, PrimitiveId, Ray};
use glint::image::{Image, Pixels};
use glint::math::{DAffine3, Rgb, Vec3};
use glint::sampling::CounterRng;
use glint::scene::{
    Channel, ColorInput, Environment, ImageId, Material, MaterialId, MeshData, Model, ModelId,
    Placement, ScalarInput, Scene, Surface, TextureReference,
};
use glint::world::{Census, Feature, World};
use rand::RngExt;
use rand::seq::IndexedRandom;
use std::sync::Arc;

/// Black, dark, white, one channel, and texels far above 1.
fn images() -> Vec<Arc<Image>> {
    [Rgb::BLACK, Rgb::splat(0.01), Rgb::WHITE, Rgb::new(0.0, 0.0, 0.5), Rgb::splat(40.0)]
        .into_iter()
        .map(|texel| Image::new(1, 1, Pixels::Float(vec![texel]), false).expect("an image"))
        .map(Arc::new)
        .collect()
}

fn any_number(numbers: &mut CounterRng) -> f32 {
    match numbers.random_range(0..3) {
        0 => numbers.random(),
        _ => *[0.0, 0.01, 0.035, 0.5, 1.0].choose(numbers).expect("a number"),
    }
}

fn any_color(numbers: &mut CounterRng) -> Rgb {
    match numbers.random_range(0..3) {
        0 => Rgb::new(numbers.random(), numbers.random(), numbers.random()),
        1 => Rgb::splat(any_number(numbers)),
        _ => Rgb::BLACK,
    }
}

fn any_texture(numbers: &mut CounterRng) -> Option<TextureReference> {
    let image = ImageId(numbers.random_range(0..images().len() as u32));
    let whole = TextureReference { image, scale: [1.0; 2], offset: [0.0; 2], clamp: false };
    numbers.random_bool(0.3).then_some(whole)
}

fn color(numbers: &mut CounterRng) -> ColorInput {
    ColorInput { value: any_color(numbers), texture: any_texture(numbers) }
}

fn scalar(numbers: &mut CounterRng) -> ScalarInput {
    let texture = any_texture(numbers).map(|texture| (texture, Channel::Red));
    ScalarInput { value: any_number(numbers), texture }
}

fn any_surface(numbers: &mut CounterRng) -> Surface {
    let eta = *[1.0, 1.0005, 0.9995, 1.002, 1.33, 0.7].choose(numbers).expect("an index");
    match numbers.random_range(0..7) {
        0 => Surface::Lambert { albedo: color(numbers) },
        1 => Surface::OrenNayar { albedo: color(numbers), sigma: any_number(numbers) },
        2 => Surface::Mirror { reflectance: color(numbers) },
        3 => Surface::Dielectric {
            eta,
            roughness: scalar(numbers),
            absorption: any_color(numbers),
            transmittance: any_color(numbers),
            thin: numbers.random(),
        },
        4 => Surface::Conductor {
            eta: any_color(numbers),
            k: any_color(numbers),
            roughness: scalar(numbers),
            anisotropy: any_number(numbers),
        },
        5 => Surface::Plastic { albedo: color(numbers), eta: 1.5, roughness: scalar(numbers) },
        _ => Surface::Principled {
            base_color: color(numbers),
            metallic: scalar(numbers),
            roughness: scalar(numbers),
            specular: color(numbers),
            anisotropy: any_number(numbers),
            clearcoat: any_number(numbers),
            clearcoat_roughness: any_number(numbers),
            sheen: any_number(numbers),
        },
    }
}

/// A triangle of this surface.
fn world(surface: Surface) -> World {
    let mut scene = Scene::default();
    let mesh = MeshData {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        uvs: vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]],
        triangles: vec![[0, 1, 2]],
        materials: vec![MaterialId(0)],
        ..MeshData::default()
    };
    scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    scene.images = images();
    scene.materials = vec![Material::new("test", surface)];
    let meshes = vec![Arc::new(mesh)];
    scene.models = vec![Model { name: "test".into(), location: None, meshes }];
    let (model, world_from_object) = (ModelId(0), DAffine3::IDENTITY);
    scene.placements = vec![Placement { model, world_from_object, material_override: None }];
    World::compile(scene).expect("it compiles")
}

/// What a surface does that the census has not called for.
fn not_called_for(world: &World, census: &Census, numbers: &mut CounterRng) -> Vec<&'static str> {
    let mut found = Vec::new();
    let mut must = |has: bool, what: &'static str| {
        if !has && !found.contains(&what) {
            found.push(what);
        }
    };
    for view in 0..16 {
        let (height, slant) = ([1.0, -1.0][view % 2], [0.0, 0.3, 1.0, 30.0][view / 4]);
        let origin = Vec3::new(slant, 0.2, height);
        let point = Vec3::new(0.25, 0.25, 0.0);
        let id = PrimitiveId { instance: NONE, geometry: 0, primitive: 0 };
        let hit = Hit { t: 1.0, u: 0.25, v: 0.25, offset: 0.0, point, normal: Vec3::Z, id };
        let ray = Ray::new(origin, (point - origin).normalize());
        let at = world.interact(&ray, &hit, 0.0, true);
        let bsdf = world.bsdf(&at);
        let wo = at.frame.local_from_world(-ray.direction);
        let rough = [Feature::Diffuse, Feature::Glossy, Feature::RoughRefraction];
        let is_rough = census.has_any(&rough);
        for _ in 0..32 {
            let Some(sample) = bsdf.sample(wo, numbers.random(), numbers.random()) else {
                continue;
            };
            if sample.weight.is_black() {
                continue;
            }
            match (sample.kind, sample.is_delta) {
                (LobeKind::Diffuse, _) => must(census.has(Feature::Diffuse), "diffuse"),
                (LobeKind::Glossy, _) => must(census.has(Feature::Glossy), "glossy"),
                (LobeKind::Mirror, _) => must(census.has(Feature::Mirror), "mirror"),
                (LobeKind::Refraction, true) => must(census.has(Feature::Refraction), "clear"),
                (LobeKind::Refraction, false) => {
                    must(census.has(Feature::RoughRefraction), "frosted");
                }
            }
            // Light sampling is planned where something is rough.
            let value = bsdf.evaluate(wo, sample.wi);
            must(value.f_cos.is_black() || is_rough, "light sampling");
        }
    }
    found
}

#[test]
fn whatever_a_surface_does_is_called_for() {
    let mut lobes = 0;
    for seed in 0..4000 {
        let mut numbers = CounterRng::new(seed);
        let surface = any_surface(&mut numbers);
        let world = world(surface);
        let census = world.census();
        let missing = not_called_for(&world, &census, &mut numbers);
        assert!(missing.is_empty(), "{missing:?} of {surface:?}");
        // The mutated run: a census that found nothing is caught wherever there is anything.
        lobes += usize::from(!not_called_for(&world, &Census::default(), &mut numbers).is_empty());
    }
    assert!(lobes > 3000, "{lobes} surfaces do anything");
}
