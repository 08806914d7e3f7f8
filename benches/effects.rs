//! What it saves to simulate only what a scene calls for: renders with `--effects auto` against `--effects all`.
//!
//! The two take turns, with the same seeds; ratios are of times next to each other, medians with their quartiles. Where
//! `auto` samples lights in another way, the error matters as well: the noise of an image is estimated from the spread
//! of its replicates, and time to equal error is time times noise. `cargo bench --bench effects -- [SCENE.toml ...]`
//! (default: every scene of the repository, and a diffuse ball in a white environment); prints a Markdown table.

mod scenes;

#[cfg(feature = "bvh")]
use glint::accel::bvh::Bvh as Backend;
#[cfg(not(feature = "bvh"))]
use glint::accel::embree::EmbreeAccelerator as Backend;
use glint::error::Result;
use glint::film::{Pixels, Region};
use glint::filter::{Filter, FilterSampler};
use glint::ledger::{Clock, Ledger, Stage};
use glint::load::{LoadOptions, Surroundings, load_scene_with};
use glint::math::Rgb;
use glint::plan::{Plan, Wishes};
use glint::render::{RenderJob, Rendered, render};
use glint::sampling::{Sampler, Strategy};
use glint::scene::{self, ColorInput, Effects, Environment, Material, Scene, Surface};
use glint::trace::{Tracer, Wavefront};
use glint::world::World;
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: [u32; 2] = [320, 180];
const SAMPLES: u64 = 16;
const REPETITIONS: u64 = 11;

/// One way to render a scene.
struct Way {
    world: World,
    plan: Plan,
    backend: Backend,
}

impl Way {
    fn new(whole: &World, camera: &scene::Camera, effects: Effects) -> Result<Self> {
        let world = whole.with_effects(&effects)?;
        let wishes = Wishes { effects, max_depth: u32::MAX, hide_background: false };
        let plan = Plan::new(&world, camera, &wishes);
        let backend = Backend::build(world.geometry.clone(), 0)?;
        Ok(Self { world, plan, backend })
    }

    fn render(&self, camera: &scene::Camera, seed: u64) -> Result<Rendered> {
        let camera = self.world.camera(camera, SIZE)?;
        let filter = FilterSampler::new(Filter::default());
        let tracer = Tracer {
            world: &self.world,
            accelerator: &self.backend,
            camera: &camera,
            filter: &filter,
            sampler: Sampler::new(Strategy::Sobol, seed, SAMPLES),
            plan: &self.plan,
        };
        let job = RenderJob {
            region: Region::full(SIZE),
            samples_per_pixel: SAMPLES,
            threads: 1,
            batch: Wavefront::DEFAULT_BATCH,
            stop: None,
        };
        render(&tracer, &job, &|_| ())
    }
}

/// Mean relative variance of the pixels, weighted as the relative error is.
fn noise(pixels: &Pixels) -> f64 {
    let values = || pixels.radiance.iter().flat_map(|p| p.to_array()).map(f64::from);
    let mean = values().sum::<f64>() / (3 * pixels.radiance.len()) as f64;
    let variances = pixels.variance.iter().flat_map(|p| p.to_array()).map(f64::from);
    let relative = values().zip(variances).map(|(r, v)| v / (r * r + 0.01 * mean * mean));
    relative.sum::<f64>() / (3 * pixels.radiance.len()) as f64
}

/// Lower quartile, median and upper quartile.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|k| values[(values.len() - 1) * k / 4])
}

/// Seconds that reading the clock took in all stages.
fn clock_seconds(ledger: &Ledger) -> f64 {
    const READS: u32 = 100_000;
    let mut scratch = Ledger::default();
    let start = Instant::now();
    let mut clock = Clock::start();
    (0..READS).for_each(|_| clock.lap(&mut scratch, Stage::Emit, 1));
    let one = start.elapsed().as_secs_f64() / f64::from(READS);
    Stage::ALL.iter().map(|&stage| ledger.stage(stage).calls as f64 * one).sum()
}

fn measure(name: &str, mut scene: Scene) -> Result<()> {
    let camera = scene.cameras.remove(0);
    let whole = World::compile(scene)?;
    let [auto, all] = [Effects::AUTO, Effects::EVERYTHING];
    let [auto, all] = [Way::new(&whole, &camera, auto)?, Way::new(&whole, &camera, all)?];
    let (mut ratios, mut of_auto, mut of_all) = (Vec::new(), Vec::new(), Vec::new());
    let (mut noises, mut is_same, mut clock, mut covered) = ([0.0; 2], true, 0.0, Vec::new());
    for seed in 0..REPETITIONS {
        // Whoever is first finds a colder machine.
        let mut rendered = [None, None];
        for way in [seed % 2, 1 - seed % 2] {
            rendered[way as usize] = Some([&auto, &all][way as usize].render(&camera, seed)?);
        }
        let [Some(a), Some(b)] = rendered else { unreachable!("both were rendered") };
        ratios.push(b.seconds / a.seconds);
        of_auto.push(a.seconds);
        of_all.push(b.seconds);
        is_same &= a.film == b.film;
        noises[0] += noise(&a.film.develop());
        noises[1] += noise(&b.film.develop());
        clock = clock_seconds(&a.ledger) / a.ledger.worker_seconds;
        covered.push(a.ledger.seconds() / a.ledger.worker_seconds);
    }
    let [low, median, high] = quartiles(ratios);
    let noise = noises[1] / noises[0];
    print_row(&format!(
        "| {name} | {:.3} | {:.3} | {median:.2} ({low:.2} to {high:.2}) | {} | {:.2} | {:.2} % | {:.1} % |",
        quartiles(of_auto)[1],
        quartiles(of_all)[1],
        if is_same { "same bytes".into() } else { format!("{noise:.2}") },
        median * if is_same { 1.0 } else { noise },
        100.0 * clock,
        100.0 * quartiles(covered)[1],
    ));
    Ok(())
}

fn read(path: &Path, is_white: bool) -> Result<Scene> {
    let albedo = ColorInput::constant(Rgb::splat(0.7));
    let white = Environment::Constant { radiance: Rgb::WHITE };
    load_scene_with(
        path,
        LoadOptions {
            material: is_white.then(|| Material::new("white", Surface::Lambert { albedo })),
            surroundings: is_white.then(|| Surroundings::computed(white)),
            progress: None,
        },
    )
}

#[allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]
fn print_row(row: &str) {
    println!("{row}");
}

fn main() -> Result<()> {
    print_row(
        "| scene | auto, s | all, s | all / auto | noise of all / auto | at equal error | clock | time in stages |",
    );
    print_row("|---|---|---|---|---|---|---|---|");
    // `cargo bench` itself adds --bench.
    let said: Vec<PathBuf> =
        std::env::args().skip(1).filter(|a| !a.starts_with("--")).map(PathBuf::from).collect();
    for path in if said.is_empty() { scenes::all() } else { said } {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        measure(&name, read(&path, false)?)?;
        // Diffuse under a constant environment, where nothing but scattering is needed.
        if ["chess", "metals", "glass"].contains(&name.as_str()) {
            measure(&format!("{name}, all white"), read(&path, true)?)?;
        }
    }
    Ok(())
}
