//! Small scenes built in code, and a render of any of them in one call.

#![cfg(feature = "embree")]

use glint::accel::embree::EmbreeAccelerator;
use glint::accel::{Accelerator, AcceptAll, HitFilter};
use glint::camera::{Camera, View};
use glint::film::{Pixels, Region};
use glint::filter::{Filter, FilterKind, FilterSampler};
use glint::ledger::Watch;
use glint::math::{DAffine3, DMat3, DVec3, Rgb};
use glint::plan::{Plan, Wishes};
use glint::render::{RenderJob, Rendered, render};
use glint::sampling::{Sampler, SamplerKind};
use glint::scene::{
    self, ColorInput, Effects, Emission, Environment, Light, Material, MaterialId, MeshData, Model,
    ModelId, Placement, Projection, ScalarInput, Scene, Style, Surface,
};
use glint::trace::{Block, PixelSample, Tracer, Wavefront, naive};
use glint::world::{CutOuts, World};
use std::sync::Arc;

/// A scene under construction.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) scene: Scene,
}

impl Builder {
    pub(crate) fn material(&mut self, surface: Surface) -> MaterialId {
        self.scene.materials.push(Material::new("test", surface));
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    pub(crate) fn lambert(&mut self, r: f32, g: f32, b: f32) -> MaterialId {
        self.material(Surface::Lambert { albedo: ColorInput::constant(Rgb::new(r, g, b)) })
    }

    pub(crate) fn emitter(&mut self, albedo: f32, radiance: Rgb) -> MaterialId {
        let id = self.lambert(albedo, albedo, albedo);
        let emission = Emission { radiance: ColorInput::constant(radiance) };
        self.scene.materials[id.index()].emission = Some(emission);
        id
    }

    pub(crate) fn environment(&mut self, radiance: Rgb) {
        self.scene.environment = Some(Environment::Constant { radiance });
    }

    /// Adds a mesh of triangles, placed as it is.
    pub(crate) fn mesh(&mut self, mesh: MeshData) -> ModelId {
        self.scene.models.push(Model { name: "test".into(), meshes: vec![Arc::new(mesh)] });
        let model = ModelId(self.scene.models.len() as u32 - 1);
        self.place(model, DAffine3::IDENTITY);
        model
    }

    pub(crate) fn place(&mut self, model: ModelId, world_from_object: DAffine3) {
        let placement = Placement { model, world_from_object, material_override: None };
        self.scene.placements.push(placement);
    }

    /// The parallelogram corner, corner + a, corner + a + b, corner + b; its winding faces a x b.
    pub(crate) fn quad(&mut self, corner: [f32; 3], a: [f32; 3], b: [f32; 3], m: MaterialId) {
        let add = |p: [f32; 3], q: [f32; 3]| [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
        let positions = vec![corner, add(corner, a), add(add(corner, a), b), add(corner, b)];
        self.mesh(MeshData {
            positions,
            uvs: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            materials: vec![m; 2],
            ..MeshData::default()
        });
    }

    /// A closed sphere of 2 n (n - 1) triangles, winding outward, with smooth normals if asked for.
    pub(crate) fn sphere(
        &mut self,
        center: [f32; 3],
        radius: f32,
        n: u32,
        smooth: bool,
        m: MaterialId,
    ) {
        let mut mesh = sphere_mesh(radius, n, smooth, m);
        for p in &mut mesh.positions {
            (0..3).for_each(|k| p[k] += center[k]);
        }
        self.mesh(mesh);
    }

    pub(crate) fn build(self) -> World {
        World::compile(self.scene).expect("the scene compiles")
    }
}

pub(crate) fn sphere_mesh(radius: f32, n: u32, smooth: bool, m: MaterialId) -> MeshData {
    use std::f64::consts::PI;
    let mut unit = vec![[0.0_f32, 0.0, 1.0]];
    for i in 1..n {
        for j in 0..2 * n {
            let (theta, phi) = (PI * f64::from(i) / f64::from(n), PI * f64::from(j) / f64::from(n));
            let p = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            unit.push(p.map(|x| x as f32));
        }
    }
    unit.push([0.0, 0.0, -1.0]);
    let last = unit.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * 2 * n + j % (2 * n);
    let mut triangles = Vec::new();
    for j in 0..2 * n {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        for i in 1..n - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        triangles.push([at(n - 1, j), last, at(n - 1, j + 1)]);
    }
    MeshData {
        positions: unit.iter().map(|p| p.map(|x| x * radius)).collect(),
        normals: if smooth { unit } else { Vec::new() },
        materials: vec![m; triangles.len()],
        triangles,
        ..MeshData::default()
    }
}

/// How a test scene is rendered.
#[derive(Clone)]
pub(crate) struct Shot {
    pub(crate) view: View,
    pub(crate) fov: f64,
    pub(crate) size: [u32; 2],
    pub(crate) spp: u64,
    pub(crate) seed: u64,
    pub(crate) max_depth: u32,
    pub(crate) kind: SamplerKind,
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
            kind: SamplerKind::Sobol,
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
        let census = match self.effects.style {
            Style::AmbientOcclusion => world.census(),
            Style::Auto | Style::All => whole.census(),
        };
        let plan = Plan::new(&world, &census, &camera, &wishes);
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
            sampler: Sampler::new(self.kind, self.seed),
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

/// Mean of all pixels.
pub(crate) fn mean(pixels: &Pixels) -> [f64; 3] {
    [0, 1, 2].map(|c| {
        pixels.radiance.iter().map(|p| f64::from(p[c])).sum::<f64>() / pixels.radiance.len() as f64
    })
}

/// The Cornell box in metres: 2 x 2 x 2 around (0, 1, 0), open towards +z, with a lamp and two boxes' worth
/// of spheres.
pub(crate) fn cornell() -> Builder {
    let mut b = Builder::default();
    let white = b.lambert(0.73, 0.73, 0.73);
    let red = b.lambert(0.63, 0.06, 0.05);
    let green = b.lambert(0.12, 0.45, 0.09);
    let lamp = b.emitter(0.0, Rgb::new(18.0, 13.0, 5.0));
    b.quad([-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    b.quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], white);
    b.quad([-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], white);
    b.quad([-1.0, 0.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], red);
    b.quad([1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0], green);
    b.quad([-0.3, 1.99, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6], lamp);
    b.sphere([-0.4, 0.4, -0.3], 0.4, 16, true, white);
    b.sphere([0.45, 0.3, 0.3], 0.3, 12, false, white);
    b
}

/// A view into [`cornell`].
pub(crate) fn cornell_shot(size: [u32; 2], spp: u64) -> Shot {
    Shot::new([0.0, 1.0, 4.8], [0.0, 1.0, 0.0], 30.0, size, spp)
}

/// One of everything: every surface, cut-outs, instances, and every kind of light.
pub(crate) fn zoo() -> Builder {
    let mut b = Builder::default();
    let c = |r, g, b| ColorInput::constant(Rgb::new(r, g, b));
    let n = ScalarInput::constant;
    let floor = b.material(Surface::OrenNayar { albedo: c(0.5, 0.5, 0.45), sigma: 0.5 });
    b.quad([-5.0, 0.0, -5.0], [0.0, 0.0, 10.0], [10.0, 0.0, 0.0], floor);
    let glass = |roughness, absorption| Surface::Dielectric {
        eta: 1.5,
        roughness: n(roughness),
        absorption,
        transmittance: Rgb::WHITE,
        thin: false,
    };
    let surfaces = [
        Surface::Lambert { albedo: c(0.7, 0.3, 0.2) },
        Surface::Mirror { reflectance: c(0.9, 0.9, 0.9) },
        glass(0.0, Rgb::new(0.1, 0.5, 1.0)),
        glass(0.4, Rgb::BLACK),
        Surface::Conductor {
            eta: Rgb::new(0.2, 0.9, 1.1),
            k: Rgb::new(3.9, 2.4, 2.2),
            roughness: n(0.4),
            anisotropy: 0.3,
        },
        Surface::Plastic { albedo: c(0.1, 0.3, 0.7), eta: 1.5, roughness: n(0.2) },
        Surface::Principled {
            base_color: c(0.8, 0.6, 0.1),
            metallic: n(0.5),
            roughness: n(0.3),
            specular: c(0.04, 0.04, 0.04),
            anisotropy: 0.0,
            clearcoat: 0.5,
            clearcoat_roughness: 0.1,
            sheen: 0.3,
        },
    ];
    for (i, surface) in surfaces.into_iter().enumerate() {
        let m = b.material(surface);
        let x = i as f32 - 3.0;
        b.sphere([x, 0.45, 0.2 * x], 0.45, 12, i % 2 == 0, m);
    }
    // Half-covered quads in front, as instances of one model.
    let leaf = b.lambert(0.2, 0.6, 0.2);
    b.scene.materials[leaf.index()].opacity = n(0.5);
    b.quad([-0.4, 0.0, 0.0], [0.8, 0.0, 0.0], [0.0, 0.8, 0.0], leaf);
    let model = b.scene.placements.pop().expect("the quad was placed").model;
    for i in 0..5 {
        let at = DVec3::new(f64::from(i) * 1.2 - 2.4, 0.0, 1.5);
        let turn =
            DMat3::from_cols(DVec3::new(0.8, 0.0, -0.6), DVec3::Y, DVec3::new(0.6, 0.0, 0.8));
        b.place(model, DAffine3 { matrix3: turn, translation: at });
    }
    let lamp = b.emitter(0.0, Rgb::new(8.0, 6.0, 4.0));
    b.quad([-1.0, 3.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.2, 1.0], lamp);
    let position = DVec3::new(2.0, 3.0, 2.0);
    b.scene.lights = vec![
        Light::Point { position, intensity: Rgb::splat(3.0) },
        Light::Spot {
            position,
            direction: -position,
            intensity: Rgb::splat(20.0),
            outer_angle: 30.0,
            inner_angle: 10.0,
        },
        Light::Directional {
            direction: DVec3::new(1.0, -1.0, 0.5),
            irradiance: Rgb::splat(1.0),
            angular_diameter: 3.0,
        },
    ];
    b.scene.environment = Some(Environment::Sky {
        elevation: 30.0,
        azimuth: 45.0,
        turbidity: 3.0,
        ground_albedo: Rgb::splat(0.3),
        scale: 0.5,
    });
    b
}

/// A view of [`zoo`].
pub(crate) fn zoo_shot(size: [u32; 2], spp: u64) -> Shot {
    Shot::new([0.0, 2.0, 8.0], [0.0, 0.6, 0.0], 35.0, size, spp)
}
