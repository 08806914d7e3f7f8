//! How much of a render is ray tracing: the render itself against the very same rays through Embree alone.
//!
//! A render is recorded batch by batch, then replayed through Embree in the same batches, order and calls.
//! The two are timed in turn, so a drifting machine touches both; ratios are of medians. `cargo bench --bench
//! overhead -- MODEL.obj ...` (default: a generated sphere field); prints a Markdown table.

use glint::accel::embree::EmbreeAccelerator;
use glint::accel::{Accelerator, AcceptAll, BuildStats, HitFilter};
use glint::camera::frame;
use glint::error::Result;
use glint::film::Region;
use glint::filter::{Filter, FilterSampler};
use glint::geometry::{Hit, PrimitiveId, Ray};
use glint::ledger::{Ledger, Stage};
use glint::load::load_scene;
use glint::math::{DVec3, Rgb};
use glint::plan::{Plan, Wishes};
use glint::render::{RenderJob, render};
use glint::sampling::{Sampler, Strategy};
use glint::scene::{
    self, ColorInput, Effects, Environment, Material, MaterialId, Projection, Surface,
};
use glint::trace::{Tracer, Wavefront};
use glint::world::World;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const SIZE: [u32; 2] = [640, 360];
const SAMPLES: u64 = 16;
const REPETITIONS: usize = 7;

/// A batch of rays as the render traced it.
enum Batch {
    Closest(Vec<Ray>),
    Occluded(Vec<Ray>),
}

/// Passes batches on, and keeps a copy.
struct Recorder<'a> {
    inner: &'a EmbreeAccelerator,
    batches: Mutex<Vec<Batch>>,
}

impl Recorder<'_> {
    fn keep(&self, batch: Batch) {
        self.batches.lock().expect("no panics while recording").push(batch);
    }
}

impl Accelerator for Recorder<'_> {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        self.keep(Batch::Closest(rays.to_vec()));
        self.inner.closest(rays, filter, hits);
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        self.keep(Batch::Occluded(rays.to_vec()));
        self.inner.occluded(rays, filter, blocked);
    }

    fn build_stats(&self) -> BuildStats {
        self.inner.build_stats()
    }
}

/// Seconds of tracing all batches with `threads` threads, through Embree alone or with our hit records.
fn replay(embree: &EmbreeAccelerator, batches: &[Batch], threads: usize, alone: bool) -> f64 {
    let next = AtomicUsize::new(0);
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let mut ids = vec![PrimitiveId::MISS; Wavefront::DEFAULT_BATCH];
                let mut hits = vec![Hit::MISS; Wavefront::DEFAULT_BATCH];
                let mut blocked = vec![false; Wavefront::DEFAULT_BATCH];
                while let Some(batch) = batches.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match batch {
                        Batch::Closest(rays) if alone => embree.closest_ids(rays, &mut ids),
                        Batch::Closest(rays) => {
                            embree.closest(rays, &AcceptAll, &mut hits[..rays.len()]);
                        }
                        Batch::Occluded(rays) => {
                            embree.occluded(rays, &AcceptAll, &mut blocked[..rays.len()]);
                        }
                    }
                }
            });
        }
    });
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A closed view of the model, white in a white environment.
fn world_of(path: &Path) -> Result<World> {
    let mut scene = load_scene(path)?;
    let albedo = ColorInput::constant(Rgb::splat(0.7));
    scene.materials = vec![Material::new("override", Surface::Lambert { albedo })];
    scene.placements.iter_mut().for_each(|p| p.material_override = Some(MaterialId(0)));
    scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    World::compile(scene)
}

fn measure(path: &Path) -> Result<()> {
    let world = world_of(path)?;
    let embree = EmbreeAccelerator::build(world.geometry.clone(), 0)?;
    let bounds = [world.bounds.min, world.bounds.max].map(|p| p.as_dvec3());
    let view = frame(bounds, DVec3::Y, 16.0 / 9.0, 35.0)?;
    // Half as far away as the automatic camera: the model fills the picture.
    let from = world.origin + view.to + (view.from - view.to) * 0.5;
    let camera = scene::Camera {
        name: "bench".into(),
        location: None,
        from,
        to: world.origin + view.to,
        up: view.up,
        projection: Projection::Perspective { vertical_fov: 35.0 },
    };
    let effects = Effects::AUTO;
    let wishes = Wishes { effects, max_depth: u32::MAX, hide_background: false };
    let plan = &Plan::new(&world, &camera, &wishes);
    let camera = world.camera(&camera, SIZE)?;
    let filter = FilterSampler::new(Filter::parse("blackman-harris")?);
    let job = |threads| RenderJob {
        region: Region::full(SIZE),
        samples_per_pixel: SAMPLES,
        threads,
        batch: Wavefront::DEFAULT_BATCH,
        stop: None,
    };
    let sampler = Sampler::new(Strategy::Sobol, 0, SAMPLES);

    let recorder = Recorder { inner: &embree, batches: Mutex::default() };
    let recording = Tracer {
        world: &world,
        accelerator: &recorder,
        camera: &camera,
        filter: &filter,
        sampler: sampler.clone(),
        plan,
    };
    let rays = render(&recording, &job(1), &|_| ())?.ledger.rays();
    let batches = recorder.batches.into_inner().expect("no panics while recording");

    let tracer = Tracer {
        world: &world,
        accelerator: &embree,
        camera: &camera,
        filter: &filter,
        sampler,
        plan,
    };
    // [threads - 1][render, Embree alone, Embree with our hit records]
    let mut seconds = [[const { Vec::new() }; 3], [const { Vec::new() }; 3]];
    let mut ledgers = Vec::new();
    for _ in 0..REPETITIONS {
        for threads in [1, 2] {
            let row: &mut [Vec<f64>; 3] = &mut seconds[threads - 1];
            let rendered = render(&tracer, &job(threads), &|_| ())?;
            row[0].push(rendered.seconds);
            if threads == 1 {
                ledgers.push(rendered.ledger);
            }
            row[1].push(replay(&embree, &batches, threads, true));
            row[2].push(replay(&embree, &batches, threads, false));
        }
    }
    print_stages(&ledgers);
    let medians = seconds.map(|row| row.map(median));
    let speed = |s: f64| rays as f64 / s / 1e6;
    let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    for (i, [render, alone, records]) in medians.into_iter().enumerate() {
        print_row(&format!(
            "| {name} | {} | {} | {:.2} | {:.2} | {:.2} | {:.1} % | {:.1} % |",
            world.geometry.placed_triangles(),
            i + 1,
            speed(render),
            speed(alone),
            speed(records),
            100.0 * alone / render,
            100.0 * records / render,
        ));
    }
    let scaling = [0, 1].map(|k| medians[0][k] / medians[1][k]);
    print_row(&format!(
        "| {name} scaling | | 1 to 2 | {:.2} | {:.2} | | | |",
        scaling[0], scaling[1]
    ));
    Ok(())
}

/// Where one thread's time goes, by the ledgers of several renders: median nanoseconds a ray of any kind, and
/// an item (path or ray) of the stage.
fn print_stages(ledgers: &[Ledger]) {
    for &stage in Stage::ALL {
        let per = |items: fn(&Ledger, Stage) -> u64| {
            let cost = |l: &Ledger| 1e9 * l.stage(stage).seconds / items(l, stage).max(1) as f64;
            median(ledgers.iter().map(cost).collect())
        };
        let (per_ray, per_item) = (per(|l, _| l.rays()), per(|l, s| l.stage(s).items));
        print_row(&format!("  {:14} {per_ray:6.1} ns a ray, {per_item:6.1} an item", stage.name()));
    }
}

#[allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]
fn print_row(row: &str) {
    println!("{row}");
}

fn main() -> Result<()> {
    print_row(
        "| model | triangles | threads | render, M rays/s | Embree alone | with hit records | render / alone | render / records |",
    );
    print_row("|---|---|---|---|---|---|---|---|");
    // `cargo bench` itself adds --bench.
    for path in std::env::args().skip(1).filter(|a| !a.starts_with("--")) {
        measure(Path::new(&path))?;
    }
    Ok(())
}
