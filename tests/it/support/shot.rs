//! How a test scene is rendered, in one call: whole, path by path, or by the naive integrator.

#![cfg(feature = "embree")]

use glint::accel::embree::EmbreeAccelerator;
use glint::accel::{Accelerator, AcceptAll, HitFilter};
use glint::camera::{Camera, View};
use glint::film::{Pixels, Region};
use glint::filter::{Filter, FilterKind, FilterSampler};
use glint::ledger::Watch;
use glint::math::{DVec3, Rgb};
use glint::plan::{Plan, Wishes};
use glint::render::{RenderJob, Rendered, render};
use glint::sampling::{Sampler, Strategy};
use glint::scene::{self, Effects, Projection};
use glint::trace::{Block, PixelSample, Tracer, Wavefront, naive};
use glint::world::{CutOuts, World};

/// How a test scene is rendered.
#[derive(Clone)]
pub(crate) struct Shot {
    pub(crate) view: View,
    pub(crate) fov: f64,
    pub(crate) size: [u32; 2],
    pub(crate) spp: u64,
    pub(crate) seed: u64,
    pub(crate) max_depth: u32,
    pub(crate) kind: Strategy,
    pub(crate) batch: usize,
    pub(crate) threads: usize,
    pub(crate) region: Option<Region>,
    pub(crate) effects: Effects,
}

impl Shot {
    pub(crate) fn new(from: [f64; 3], to: [f64; 3], fov: f64, size: [u32; 2], spp: u64) -> Self {
        let view = View { from: from.into(), to: to.into(), up: DVec3::Y };
        Self {
            view,
            fov,
            size,
            spp,
            seed: 0,
            max_depth: u32::MAX,
            kind: Strategy::Sobol,
            batch: Wavefront::DEFAULT_BATCH,
            threads: 2,
            region: None,
            effects: Effects::AUTO,
        }
    }

    pub(crate) fn with_effects(&self, effects: &str) -> Self {
        Self { effects: effects.parse().expect("effects"), ..self.clone() }
    }

    /// The world that this shot is of, and the plan for it.
    pub(crate) fn plan(&self, whole: &World) -> (World, Plan) {
        let world = whole.with_effects(&self.effects).expect("a world with less in it");
        let camera = scene::Camera {
            name: "test".into(),
            location: None,
            from: self.view.from,
            to: self.view.to,
            up: self.view.up,
            projection: Projection::Perspective { vertical_fov: self.fov },
        };
        let wishes =
            Wishes { effects: self.effects, max_depth: self.max_depth, hide_background: false };
        let plan = Plan::new(&world, &camera, &wishes);
        (world, plan)
    }

    pub(crate) fn camera(&self, world: &World) -> Camera {
        let view = View {
            from: self.view.from - world.origin,
            to: self.view.to - world.origin,
            up: self.view.up,
        };
        Camera::perspective(&view, self.size, self.fov).expect("a valid camera")
    }

    /// Calls `f` with everything that is needed to trace this shot on Embree.
    pub(crate) fn with_tracer<T>(
        &self,
        world: &World,
        f: impl FnOnce(&Tracer<'_, EmbreeAccelerator>) -> T,
    ) -> T {
        let embree = self.embree(world);
        self.with_tracer_on(world, &embree, f)
    }

    /// Embree over the geometry that these effects need.
    pub(crate) fn embree(&self, whole: &World) -> EmbreeAccelerator {
        EmbreeAccelerator::build(self.plan(whole).0.geometry, 2).expect("embree builds")
    }

    /// The same on any backend.
    pub(crate) fn with_tracer_on<A: Accelerator, T>(
        &self,
        world: &World,
        accelerator: &A,
        f: impl FnOnce(&Tracer<'_, A>) -> T,
    ) -> T {
        let (world, plan) = self.plan(world);
        let (world, camera) = (&world, self.camera(&world));
        let filter = FilterSampler::new(Filter { kind: FilterKind::Box, radius: 0.5 });
        f(&Tracer {
            world,
            accelerator,
            camera: &camera,
            filter: &filter,
            sampler: Sampler::new(self.kind, self.seed, self.spp),
            plan: &plan,
        })
    }

    pub(crate) fn render(&self, world: &World) -> Rendered {
        let embree = self.embree(world);
        self.render_on(world, &embree)
    }

    pub(crate) fn render_on<A: Accelerator>(&self, world: &World, accelerator: &A) -> Rendered {
        let job = self.job();
        self.with_tracer_on(world, accelerator, |tracer| {
            render(tracer, &job, &|_| ()).expect("it renders")
        })
    }

    fn job(&self) -> RenderJob<'static> {
        RenderJob {
            region: self.region.unwrap_or(Region::full(self.size)),
            samples_per_pixel: self.spp,
            threads: self.threads,
            batch: self.batch,
            stop: None,
        }
    }

    pub(crate) fn pixels(&self, world: &World) -> Pixels {
        self.render(world).film.develop()
    }

    /// Every path of the shot by the wavefront, in the order of the block.
    pub(crate) fn wavefront_samples(&self, world: &World) -> Vec<PixelSample> {
        let block = self.block();
        let mut samples = Vec::new();
        self.with_tracer(world, |tracer| {
            let mut wavefront = Wavefront::new(self.batch);
            if tracer.plan.pipeline.hit_filter {
                let filter = CutOuts::new(tracer.world);
                wavefront.run(tracer, &filter, &block, |s, _| samples.push(*s));
            } else {
                wavefront.run(tracer, &AcceptAll, &block, |s, _| samples.push(*s));
            }
        });
        samples.sort_by_key(|s| (s.pixel[1], s.pixel[0], s.sample));
        samples
    }

    /// All paths of the shot.
    pub(crate) fn block(&self) -> Block {
        let watch = Watch::NONE;
        let (start, end) = ([0, 0], self.size);
        Block { start, end, first_sample: 0, end_sample: self.spp, watch }
    }

    /// The same paths by the naive integrator.
    pub(crate) fn naive_samples(&self, world: &World) -> Vec<Rgb> {
        fn all<F: HitFilter>(
            shot: &Shot,
            tracer: &Tracer<'_, EmbreeAccelerator>,
            f: &F,
        ) -> Vec<Rgb> {
            Region::full(shot.size)
                .iter()
                .flat_map(|p| (0..shot.spp).map(move |s| naive::radiance(tracer, f, p, s)))
                .collect()
        }
        self.with_tracer(world, |tracer| match tracer.plan.pipeline.hit_filter {
            true => all(self, tracer, &CutOuts::new(tracer.world)),
            false => all(self, tracer, &AcceptAll),
        })
    }
}
