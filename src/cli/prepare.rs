//! From the command line to a world, a camera and a plan: what `glint render` and `glint plan` begin with.

use super::args::Render;
use super::backend::{self, Chosen};
use super::output::Outputs;
use super::select::{self, Settings};
use super::{instructions, progress, report};
use crate::camera::Camera;
use crate::error::Result;
use crate::film::Region;
use crate::load;
use crate::math::DVec3;
use crate::plan::Plan;
use crate::scene::{self, Effects};
use crate::world::World;
use indicatif::ProgressBar;
use std::time::Instant;

/// A scene that only needs an accelerator.
pub(super) struct Prepared {
    pub(super) settings: Settings,
    pub(super) outputs: Outputs,
    pub(super) chosen: Chosen,
    /// With everything in it.
    pub(super) whole: World,
    /// With what is wanted of it.
    pub(super) world: World,
    pub(super) plan: Plan,
    pub(super) camera: Camera,
    pub(super) description: scene::Camera,
    /// Of the scene, not of the camera.
    pub(super) up: DVec3,
    pub(super) fingerprint: String,
    /// Still turning: the accelerator is next.
    pub(super) busy: ProgressBar,
    /// Seconds of reading, and when building began.
    pub(super) load_seconds: f64,
    pub(super) build_start: Instant,
}

impl Prepared {
    /// Reads and compiles what the command line names.
    ///
    /// # Errors
    /// Usage errors, and what reading and compiling a scene can end with.
    pub(super) fn new(args: &Render) -> Result<Self> {
        select::check(args)?;
        instructions(args.isa)?.limit();
        let chosen = backend::choose(args.accel)?;
        // Loading, the sky and the PNG use the global pool; a second call in one process may fail, harmlessly.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build_global();

        // Files to a scene; what the command line says goes over what the file says.
        let start = Instant::now();
        let busy = progress::busy(args, "loading");
        let outputs = Outputs::check(args)?;
        let reading = |done, total| progress::reading(&busy, done, total);
        let (mut scene, settings) = select::scene(args, Some(&reading))?;
        outputs.check_against(args, &scene.inputs)?;
        let load_seconds = start.elapsed().as_secs_f64();

        // A scene to a world, and the camera in it.
        let build_start = Instant::now();
        busy.set_message("building");
        let (cameras, up) = (std::mem::take(&mut scene.cameras), scene.up);
        let (inputs, environment) = (std::mem::take(&mut scene.inputs), scene.environment);
        let whole = World::compile(scene)?;
        busy.suspend(|| report::warnings(args, &whole.warnings));
        let (camera, description) = select::camera(args, &cameras, up, &whole, settings.size)?;

        // The effects that it calls for, and what runs for them.
        let (world, plan) = settings.plan(&whole, &description)?;
        let overrides = (args.background, &args.override_material, environment, up);
        let described = format!("{settings:?} {description:?} {overrides:?}");
        let fingerprint = load::fingerprint(&inputs, &described)?;
        busy.suspend(|| report::choices(args, &settings, &description, &world, up));
        Ok(Self {
            settings,
            outputs,
            chosen,
            whole,
            world,
            plan,
            camera,
            description,
            up,
            fingerprint,
            busy,
            load_seconds,
            build_start,
        })
    }

    /// The world in which everything runs, with its plan, and the camera for a small picture of it.
    ///
    /// # Errors
    /// None that a user could cause.
    pub(super) fn everything(&self, size: [u32; 2]) -> Result<(World, Plan, Camera)> {
        let settings = Settings { effects: Effects::EVERYTHING, ..self.settings.clone() };
        let (world, plan) = settings.plan(&self.whole, &self.description)?;
        let camera = self.world.camera(&self.description, size)?;
        Ok((world, plan, camera))
    }

    /// Paths of the whole render.
    pub(super) fn paths(&self) -> u64 {
        let region: Region = self.settings.region;
        (region.pixels() as u64).saturating_mul(self.settings.samples_per_pixel)
    }
}
