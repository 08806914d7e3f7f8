//! Command line over scene file over defaults: what a render will really use.

use super::args::{Render, Up};
use super::values::{self, Env};
use crate::camera::{Camera, View, frame_points};
use crate::error::{Error, Result, unknown_name};
use crate::film::Region;
use crate::filter::{Filter, FilterSampler};
use crate::image::ToneMap;
use crate::load::{self, LoadOptions, Surroundings};
use crate::math::{DVec3, Rgb};
use crate::plan::{Plan, Wishes};
use crate::render::Aov;
use crate::sampling::{Sampler, Strategy};
use crate::scene::{self, Effects, Projection, Scene, SceneSettings};
use crate::trace::Tracer;
use crate::world::World;

/// Every setting of a render, resolved.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    pub(super) size: [u32; 2],
    pub(super) region: Region,
    pub(super) samples_per_pixel: u64,
    pub(super) max_depth: u32,
    pub(super) effects: Effects,
    /// The camera does not see the surroundings.
    pub(super) hide_background: bool,
    pub(super) sampler: Strategy,
    pub(super) seed: u64,
    pub(super) filter: Filter,
    pub(super) exposure: Option<f32>,
    pub(super) tonemap: ToneMap,
    pub(super) aovs: Vec<Aov>,
}

impl Settings {
    /// # Errors
    /// A usage error for a name that does not exist, and for pixels outside the image.
    pub(super) fn resolve(args: &Render, file: &SceneSettings) -> Result<Self> {
        let size = args.size.or(file.size).unwrap_or([1280, 720]);
        check_pixels(args, size)?;
        let filter = file.filter.as_deref().map(Filter::parse).transpose()?;
        let sampler = file.sampler.as_deref().map(Strategy::sampler).transpose()?;
        Ok(Self {
            size,
            region: args.crop.map_or(Region::full(size), |[x0, y0, x1, y1]| Region {
                start: [x0, y0],
                end: [x1, y1],
            }),
            samples_per_pixel: args.spp.or(file.samples_per_pixel).unwrap_or(128),
            max_depth: args.max_depth.or(file.max_depth).unwrap_or(u32::MAX),
            effects: args.effects.map_or_else(|| effects_in_file(file), Ok)?,
            hide_background: args.background.is_some(),
            sampler: args.sampler.or(sampler).unwrap_or_default(),
            seed: args.seed.or(file.seed).unwrap_or(0),
            filter: args.filter.or(filter).unwrap_or_default(),
            exposure: args.exposure.or(file.exposure),
            tonemap: said(args.tonemap, &file.tonemap, &ToneMap::ALL, "tone map")?,
            aovs: args.aov.clone(),
        })
    }

    /// The world that is rendered, and the plan for it. `whole` is the world with everything in it, `camera` the one
    /// that it is seen with.
    ///
    /// # Errors
    /// None that a user could cause.
    pub(super) fn plan(&self, whole: &World, camera: &scene::Camera) -> Result<(World, Plan)> {
        let Self { effects, max_depth, hide_background, .. } = *self;
        let world = whole.with_effects(&effects)?;
        let plan = Plan::new(&world, camera, &Wishes { effects, max_depth, hide_background });
        Ok((world, plan))
    }

    /// What is traced, but for the accelerator: `on` brings it.
    pub(super) fn tracer<'a>(
        &self,
        world: &'a World,
        plan: &'a Plan,
        camera: &'a Camera,
        filter: &'a FilterSampler,
    ) -> Tracer<'a, ()> {
        Tracer {
            world,
            accelerator: &(),
            camera,
            filter,
            sampler: Sampler::new(self.sampler, self.seed, self.samples_per_pixel),
            plan,
        }
    }
}

/// Reads the scene, with what the command line says over what its file says; and its settings. `progress` is told
/// bytes read, and bytes in all.
///
/// # Errors
/// What reading a scene can end with; usage errors as [`Settings::resolve`].
pub(super) fn scene(
    args: &Render,
    progress: Option<&dyn Fn(u64, u64)>,
) -> Result<(Scene, Settings)> {
    let options = LoadOptions {
        material: args.override_material.clone(),
        surroundings: surroundings(args)?,
        progress,
    };
    let mut scene = load::load_scene_with(&args.scene, options)?;
    scene.up = args.up.map_or(scene.up, Up::direction);
    let settings = Settings::resolve(args, &scene.settings)?;
    Ok((scene, settings))
}

fn effects_in_file(file: &SceneSettings) -> Result<Effects> {
    file.effects.as_ref().map_or(Ok(Effects::AUTO), |text| text.parse().map_err(Error::Usage))
}

/// What the command line says, or else the scene file by name, or else the default.
fn said<T: Copy + Default>(
    on_command_line: Option<T>,
    in_file: &Option<String>,
    all: &'static [(&'static str, T)],
    kind: &'static str,
) -> Result<T> {
    match (on_command_line, in_file) {
        (Some(value), _) => Ok(value),
        (None, Some(name)) => values::named(kind, all)(name).map_err(Error::Usage),
        (None, None) => Ok(T::default()),
    }
}

/// What options say against each other, whatever the scene says.
///
/// # Errors
/// A usage error for pixels outside an image of `--size`, and for a camera that sees nothing.
pub(super) fn check(args: &Render) -> Result<()> {
    if let Some(size) = args.size {
        check_pixels(args, size)?;
    }
    if let (Some(from), Some(to)) = (args.camera_from, args.camera_to) {
        // Where no up is said, one that cannot be wrong.
        let up = args.camera_up.unwrap_or_else(|| (to - from).any_orthogonal_vector());
        Camera::perspective(&View { from, to, up }, [1, 1], DEFAULT_FOV)
            .map_err(|error| Error::Usage(error.to_string()))?;
    }
    Ok(())
}

fn check_pixels(args: &Render, [width, height]: [u32; 2]) -> Result<()> {
    let crop = args.crop.map(|[_, _, x1, y1]| ("--crop", [x1, y1]));
    let replay = args.replay.map(|([x, y], _)| ("--replay", [x, y].map(|n| n.saturating_add(1))));
    for (option, [x, y]) in crop.into_iter().chain(replay) {
        if x > width || y > height {
            let message = format!("{option} reaches beyond the image of {width}x{height}");
            return Err(Error::Usage(message));
        }
    }
    Ok(())
}

/// What `--env` puts around the scene.
///
/// # Errors
/// An image error where it cannot be read.
fn surroundings(args: &Render) -> Result<Option<Surroundings>> {
    args.env
        .as_ref()
        .map(|env| match env {
            Env::Computed(environment) => Ok(Surroundings::computed(*environment)),
            Env::File(path) => Surroundings::image(path, Rgb::WHITE, 0.0),
        })
        .transpose()
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
            let found = cameras.iter().find(|c| c.name == *name).cloned();
            let known = cameras.iter().map(|c| c.name.as_str());
            Some(found.ok_or_else(|| Error::Usage(unknown_name("camera", name, known)))?)
        }
        None => cameras.first().cloned(),
    };
    if camera.is_none() {
        // Said nothing, or not all: frame the whole scene, and let the options move that camera.
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        camera = Some(automatic(world, up, aspect, args.fov.unwrap_or(DEFAULT_FOV))?);
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

/// The camera that frames the whole scene.
///
/// # Errors
/// [`Error::Scene`] where there is nothing to frame.
pub(super) fn automatic(
    world: &World,
    up: DVec3,
    aspect: f64,
    vertical_fov: f64,
) -> Result<scene::Camera> {
    let bounds = [world.bounds.min, world.bounds.max].map(|p| p.as_dvec3());
    let points = world.geometry.hull_points().map(|p| p.as_dvec3());
    let view = frame_points(bounds, points, up, aspect, vertical_fov)?;
    Ok(scene::Camera {
        name: "automatic".into(),
        location: None,
        from: view.from + world.origin,
        to: view.to + world.origin,
        up: view.up,
        projection: Projection::Perspective { vertical_fov },
    })
}

/// Vertical field of view of automatic cameras, degrees.
pub(super) const DEFAULT_FOV: f64 = 35.0;
