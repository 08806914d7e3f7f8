//! Command line over scene file over defaults: what a render will really use.

use super::args::{Render, Up, numbers, rgb};
use crate::camera::{Camera, frame_points};
use crate::error::{Error, Result, unknown_name};
use crate::film::Region;
use crate::filter::Filter;
use crate::image::ToneMap;
use crate::load;
use crate::math::{DVec3, Rgb};
use crate::render::Aov;
use crate::sampling::SamplerKind;
use crate::scene::{self, ColorInput, Effects, Environment, Material, Projection, Scene, Surface};
use crate::world::World;
use std::path::Path;

/// Every setting of a render, resolved.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    pub(super) size: [u32; 2],
    pub(super) region: Region,
    pub(super) samples_per_pixel: u64,
    pub(super) max_depth: u32,
    pub(super) effects: Effects,
    pub(super) sampler: SamplerKind,
    pub(super) seed: u64,
    pub(super) filter: Filter,
    pub(super) exposure: Option<f32>,
    pub(super) tonemap: ToneMap,
    pub(super) aovs: Vec<Aov>,
}

impl Settings {
    /// # Errors
    /// A usage error for a name that does not exist or a crop outside the image.
    pub(super) fn resolve(args: &Render, scene: &Scene) -> Result<Self> {
        let file = &scene.settings;
        let size = args.size.or(file.size).unwrap_or([1280, 720]);
        let region = match args.crop {
            None => Region::full(size),
            Some([x0, y0, x1, y1]) if x1 <= size[0] && y1 <= size[1] => {
                Region { start: [x0, y0], end: [x1, y1] }
            }
            Some(_) => {
                let [w, h] = size;
                return Err(Error::Usage(format!("--crop reaches beyond the image of {w}x{h}")));
            }
        };
        let effects = args.effects.as_ref().or(file.effects.as_ref());
        let sampler = args.sampler.as_ref().or(file.sampler.as_ref());
        let tonemap = args.tonemap.as_ref().or(file.tonemap.as_ref());
        let filter = args.filter.as_ref().or(file.filter.as_ref());
        Ok(Self {
            size,
            region,
            samples_per_pixel: args.spp.or(file.samples_per_pixel).unwrap_or(128),
            max_depth: args.max_depth.or(file.max_depth).unwrap_or(u32::MAX),
            effects: named_or_default(effects, &Effects::ALL, "effects")?,
            sampler: named_or_default(sampler, &SamplerKind::ALL, "sampler")?,
            seed: args.seed.or(file.seed).unwrap_or(0),
            filter: filter.map_or(Ok(Filter::default()), |text| Filter::parse(text))?,
            exposure: args.exposure.or(file.exposure),
            tonemap: named_or_default(tonemap, &ToneMap::ALL, "tone map")?,
            aovs: args.aov.iter().map(|n| named(n, &Aov::ALL, "AOV")).collect::<Result<_>>()?,
        })
    }
}

/// The value called `name`, or a usage error that lists the names and suggests one.
fn named<T: Copy>(name: &str, all: &[(&str, T)], kind: &str) -> Result<T> {
    all.iter()
        .find(|(n, _)| *n == name)
        .map(|(_, value)| *value)
        .ok_or_else(|| Error::Usage(unknown_name(kind, name, all.iter().map(|(n, _)| *n))))
}

fn named_or_default<T>(name: Option<&String>, all: &[(&str, T)], kind: &str) -> Result<T>
where
    T: Copy + Default,
{
    name.map_or(Ok(T::default()), |name| named(name, all, kind))
}

/// The material that `--override-material` gives to every surface.
///
/// # Errors
/// A usage error where it cannot be understood.
pub(super) fn override_material(args: &Render) -> Result<Option<Material>> {
    let Some(material) = &args.override_material else { return Ok(None) };
    let usage = |e| Error::Usage(format!("--override-material {material}: {e}"));
    let albedo = material
        .strip_prefix("diffuse:")
        .ok_or_else(|| usage("expected diffuse:R,G,B".into()))
        .and_then(|values| rgb(values).map_err(usage))?;
    let surface = Surface::Lambert { albedo: ColorInput::constant(albedo) };
    Ok(Some(Material::new("override", surface)))
}

/// Applies `--up` and `--env`.
///
/// # Errors
/// A usage error where one cannot be understood; an image error where the environment cannot be read.
pub(super) fn override_scene(args: &Render, scene: &mut Scene) -> Result<()> {
    match args.up {
        Some(Up::Y) => scene.up = DVec3::Y,
        Some(Up::Z) => scene.up = DVec3::Z,
        None => {}
    }
    if let Some(env) = &args.env {
        scene.environment = Some(environment(env, scene)?);
    }
    Ok(())
}

fn environment(text: &str, scene: &mut Scene) -> Result<Environment> {
    let usage = |e| Error::Usage(format!("--env {text}: {e}"));
    if let Some(values) = text.strip_prefix("constant:") {
        return Ok(Environment::Constant { radiance: rgb(values).map_err(usage)? });
    }
    if let Some(values) = text.strip_prefix("sky:") {
        let [elevation, azimuth] = numbers(values).map_err(usage)?;
        return Ok(Environment::Sky {
            elevation,
            azimuth,
            turbidity: 3.0,
            ground_albedo: Rgb::splat(0.3),
            scale: 1.0,
        });
    }
    let image = load::add_environment_image(scene, Path::new(text))?;
    Ok(Environment::Image { image, scale: Rgb::WHITE, rotation: 0.0 })
}

/// The camera to render with, and its description for the user.
///
/// # Errors
/// A usage error for a camera that does not exist; [`Error::Scene`] for an impossible one.
pub(super) fn camera(
    args: &Render,
    cameras: &[scene::Camera],
    up: DVec3,
    world: &World,
    size: [u32; 2],
) -> Result<(Camera, scene::Camera)> {
    let mut camera = match &args.camera {
        Some(name) => {
            let all: Vec<_> = cameras.iter().map(|c| (c.name.as_str(), ())).collect();
            named(name, &all, "camera")?;
            cameras.iter().find(|c| c.name == *name).cloned()
        }
        None => cameras.first().cloned(),
    };
    if camera.is_none() {
        // Said nothing, or not all: frame the whole scene, and let the options move that camera.
        let vertical_fov = args.fov.unwrap_or(DEFAULT_FOV);
        let bounds = [world.bounds.min, world.bounds.max].map(|p| p.as_dvec3());
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let points = world.geometry.hull_points().map(|p| p.as_dvec3());
        let view = frame_points(bounds, points, up, aspect, vertical_fov)?;
        camera = Some(scene::Camera {
            name: "automatic".into(),
            from: view.from + world.origin,
            to: view.to + world.origin,
            up: view.up,
            projection: Projection::Perspective { vertical_fov },
        });
    }
    let mut camera = camera.ok_or_else(|| Error::Scene("there is no camera".into()))?;
    if let Some(from) = args.camera_from {
        camera.from = from;
    }
    if let Some(to) = args.camera_to {
        camera.to = to;
    }
    if let Some(up) = args.camera_up {
        camera.up = up;
    }
    if let Some(fov) = args.fov {
        match &mut camera.projection {
            Projection::Perspective { vertical_fov }
            | Projection::ThinLens { vertical_fov, .. } => {
                *vertical_fov = fov;
            }
            Projection::Orthographic { .. } | Projection::Panoramic => {
                return Err(Error::Usage("--fov: this camera has no field of view".into()));
            }
        }
    }
    Ok((world.camera(&camera, size)?, camera))
}

/// Vertical field of view of automatic cameras, degrees.
const DEFAULT_FOV: f64 = 35.0;
