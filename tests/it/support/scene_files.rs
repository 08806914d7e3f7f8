//! The scene files of `scenes/`, and small renders of them with any plan on any backend.

#![cfg(feature = "embree")]

use glint::accel::Accelerator;
use glint::accel::embree::EmbreeAccelerator;
use glint::film::Region;
use glint::filter::{Filter, FilterSampler};
use glint::load::load_scene;
use glint::plan::{Pipeline, Plan, Wishes};
use glint::render::{RenderJob, Rendered, render};
use glint::sampling::{Sampler, Strategy};
use glint::scene::{self, Effects};
use glint::trace::{Tracer, Wavefront};
use glint::world::World;
use std::path::{Path, PathBuf};

/// A scene file, read.
pub(crate) struct FileScene {
    pub(crate) name: String,
    pub(crate) whole: World,
    pub(crate) cameras: Vec<scene::Camera>,
}

/// Backends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Backend {
    Embree,
    #[cfg(feature = "bvh")]
    Bvh,
}

impl Backend {
    pub(crate) const ALL: &[Self] = &[
        Self::Embree,
        #[cfg(feature = "bvh")]
        Self::Bvh,
    ];
}

/// How small a scene is rendered.
#[derive(Clone, Copy)]
pub(crate) struct Small {
    pub(crate) size: [u32; 2],
    pub(crate) spp: u64,
    pub(crate) seed: u64,
    pub(crate) strategy: Strategy,
}

/// Every scene file of the repository.
pub(crate) fn paths() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = |path: PathBuf| std::fs::read_dir(path).expect("a folder");
    let mut paths: Vec<PathBuf> = files(folder)
        .filter_map(|entry| entry.ok().map(|entry| entry.path()).filter(|path| path.is_dir()))
        .flat_map(files)
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    assert!(paths.len() > 10, "where are the scenes?");
    paths
}

/// The plan `spared` with the estimator of `all`.
pub(crate) fn with_lights_of(spared: Plan, all: Plan) -> Plan {
    let pipeline = Pipeline {
        light_sampling: all.pipeline.light_sampling,
        combination: all.pipeline.combination,
        light_choice: all.lights.needs_choice(),
        ..spared.pipeline
    };
    Plan { pipeline, lights: all.lights, rows: spared.rows }
}

impl FileScene {
    pub(crate) fn load(path: &Path) -> Self {
        let mut scene = load_scene(path).expect("a scene of the repository");
        let cameras = std::mem::take(&mut scene.cameras);
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        Self { name, whole: World::compile(scene).expect("it compiles"), cameras }
    }

    pub(crate) fn plan(&self, effects: &str) -> (World, Plan) {
        let effects: Effects = effects.parse().expect("effects");
        self.plan_for(&Wishes { effects, max_depth: u32::MAX, hide_background: false })
    }

    pub(crate) fn plan_for(&self, wishes: &Wishes) -> (World, Plan) {
        let world = self.whole.with_effects(&wishes.effects).expect("a world with less in it");
        let plan = Plan::new(&world, &self.cameras[0], wishes);
        (world, plan)
    }

    /// The plan of `auto` with the estimator of `all`: the same lights are sampled, and share with scattered rays.
    pub(crate) fn plan_with_all_lights(&self) -> (World, Plan) {
        let (world, auto) = self.plan("auto");
        (world, with_lights_of(auto, self.plan("all").1))
    }

    pub(crate) fn render(
        &self,
        world: &World,
        plan: &Plan,
        backend: Backend,
        small: Small,
    ) -> Rendered {
        let geometry = world.geometry.clone();
        match backend {
            Backend::Embree => {
                let embree = EmbreeAccelerator::build(geometry, 2).expect("embree builds");
                self.render_on(world, plan, &embree, small)
            }
            #[cfg(feature = "bvh")]
            Backend::Bvh => {
                let bvh = glint::accel::bvh::Bvh::build(geometry, 2);
                self.render_on(world, plan, &bvh.expect("it builds"), small)
            }
        }
    }

    pub(crate) fn render_on<A: Accelerator>(
        &self,
        world: &World,
        plan: &Plan,
        accelerator: &A,
        small: Small,
    ) -> Rendered {
        let camera = world.camera(&self.cameras[0], small.size).expect("a camera");
        let filter = FilterSampler::new(Filter::default());
        let sampler = Sampler::new(small.strategy, small.seed, small.spp);
        let tracer = Tracer { world, accelerator, camera: &camera, filter: &filter, sampler, plan };
        let job = RenderJob {
            region: Region::full(small.size),
            samples_per_pixel: small.spp,
            threads: 2,
            batch: Wavefront::DEFAULT_BATCH,
            stop: None,
        };
        render(&tracer, &job, &|_| ()).expect("it renders")
    }
}
