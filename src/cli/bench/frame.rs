//! `glint bench --frame`: the scene as `glint render` would have it, and a race of whole frames of it.

use super::super::args::{Bench, Render};
use super::super::report;
use super::super::select::{self, Settings};
use crate::camera::Camera;
use crate::error::Result;
use crate::filter::FilterSampler;
use crate::plan::Plan;
use crate::study::bench::{self, FrameFindings, FrameSettings, Tell, frame};
use crate::world::World;
use std::path::Path;

/// A scene, its camera, and how renders of it are set.
pub(super) struct FrameScene {
    world: World,
    plan: Plan,
    camera: Camera,
    settings: Settings,
}

impl FrameScene {
    /// The scene at `path`, as `glint render SCENE --size WIDTHxHEIGHT --spp N` has it.
    pub(super) fn load(args: &Bench, path: &Path) -> Result<Self> {
        let said = Render {
            scene: path.to_owned(),
            size: Some(args.size),
            spp: Some(args.spp),
            sampler: args.sampler,
            up: args.up,
            quiet: args.quiet,
            ..Render::default()
        };
        let (mut scene, settings) = select::scene(&said, None)?;
        let (cameras, up) = (std::mem::take(&mut scene.cameras), scene.up);
        let world = World::compile(scene)?;
        report::warnings(&said, &world.warnings);
        let (camera, description) = select::camera(&said, &cameras, up, &world, settings.size)?;
        let (world, plan) = settings.plan(&world, &description)?;
        Ok(Self { world, plan, camera, settings })
    }

    /// Races frames of it; `name` is what the findings call it.
    pub(super) fn race(
        &self,
        name: &str,
        race: &bench::Settings,
        tell: Tell<'_>,
    ) -> Result<FrameFindings> {
        let Self { world, plan, camera, settings } = self;
        let filter = FilterSampler::new(settings.filter);
        let frames = FrameSettings {
            size: settings.size,
            samples_per_pixel: settings.samples_per_pixel,
            threads: race.threads.clone(),
            isa: race.isa,
            repetitions: race.repetitions,
            time: race.time,
            build: race.build,
        };
        frame(name, &settings.tracer(world, plan, camera, &filter), &frames, tell)
    }
}
