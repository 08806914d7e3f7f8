//! What each sampler costs and brings: points a second of whole sets, nanoseconds a number drawn in a render, and the
//! error of renders at equal samples.
//!
//! `cargo bench --bench samplers` prints Markdown tables of the first two; with names of scenes behind `--`, or `all`, of the
//! third: relative RMS error against a picture of 2048 Sobol samples of the next seed, mean over seeds 0 to 3. Times are
//! medians of turns that the samplers take one after the other.

mod scenes;

#[cfg(feature = "bvh")]
use glint::accel::bvh::Bvh as Backend;
#[cfg(not(feature = "bvh"))]
use glint::accel::embree::EmbreeAccelerator as Backend;
use glint::error::Result;
use glint::film::Region;
use glint::filter::{Filter, FilterSampler};
use glint::load::load_scene;
use glint::math::Rgb;
use glint::os::{Isa, Kernel};
use glint::plan::{Plan, Wishes};
use glint::render::{RenderJob, render};
use glint::sampling::{Dimension, SampleKeys, Sampler, Strategy};
use glint::scene::Effects;
use glint::study::compare::relative_rmse;
use glint::trace::{Tracer, Wavefront};
use glint::world::World;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: [u32; 2] = [128, 72];
const SAMPLES: [u64; 2] = [16, 64];
const SEEDS: u64 = 4;
const TURNS: usize = 9;

fn samplers() -> impl Iterator<Item = Strategy> + Clone {
    Strategy::ALL.iter().copied().filter(|strategy| strategy.can_render())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Points a second of sets of several sizes.
fn generation() -> Result<()> {
    const COUNTS: [u32; 3] = [64, 1024, 4096];
    row("strategy", COUNTS.iter().map(|n| format!("n = {n}, M points/s")));
    row("---", COUNTS.iter().map(|_| "---".into()));
    for strategy in Strategy::ALL.iter().copied().filter(|strategy| strategy.has_sets()) {
        let mut cells = Vec::new();
        for count in COUNTS {
            let mut rates = Vec::new();
            let mut seed = 0;
            let turns = Instant::now();
            // Slow ones are timed once.
            while rates.len() < TURNS && turns.elapsed().as_secs_f64() < 1.0 {
                let start = Instant::now();
                let mut made = 0;
                while made == 0 || start.elapsed().as_secs_f64() < 2e-3 {
                    seed += 1;
                    made += black_box(strategy.points(count, seed)?).points.len();
                }
                rates.push(made as f64 / start.elapsed().as_secs_f64() / 1e6);
            }
            cells.push(format!("{:.4}", median(rates)));
        }
        row(strategy.name(), cells.into_iter());
    }
    Ok(())
}

/// Paths that draw together, as those of a render do.
const LANES: usize = 64;

struct Draws<'a> {
    sampler: &'a Sampler,
    keys: &'a SampleKeys<LANES>,
    bounce: u32,
    pairs: &'a mut [[f32; LANES]; 2],
}

impl Kernel for Draws<'_> {
    #[inline(always)]
    fn run(self) {
        let bounce = self.bounce;
        self.keys.two(self.sampler, |_| Dimension::ScatterDirection { bounce }, self.pairs);
    }
}

/// Nanoseconds a number, by pairs in lanes and one by one.
fn drawing() {
    row("sampler", ["ns a number, of pairs", "ns a number, single"].map(String::from).into_iter());
    row("---", ["---", "---"].map(String::from).into_iter());
    let all: Vec<Sampler> = samplers().map(|strategy| Sampler::new(strategy, 0, 128)).collect();
    let mut times = vec![[const { Vec::new() }; 2]; all.len()];
    for turn in 0..TURNS as u64 {
        for (sampler, times) in all.iter().zip(&mut times) {
            let mut keys = SampleKeys::<LANES>::new();
            let columns = std::array::from_fn(|i| i as u32);
            let samples = std::array::from_fn(|i| (i as u64 * 7 + turn) % 128);
            keys.begin(sampler, &[columns, [3; LANES]], &samples);
            let mut pairs = [[0.0; LANES]; 2];
            const ROUNDS: u32 = 2000;
            let start = Instant::now();
            for bounce in 0..ROUNDS {
                let pairs = &mut pairs;
                Isa::detect().run(Draws { sampler, keys: &keys, bounce, pairs });
                black_box(pairs);
            }
            let numbers = f64::from(ROUNDS) * LANES as f64;
            times[0].push(start.elapsed().as_secs_f64() / numbers / 2.0 * 1e9);
            let start = Instant::now();
            let mut sum = 0.0;
            for bounce in 0..ROUNDS {
                for lane in 0..LANES {
                    sum += sampler.one(keys.lane(lane), Dimension::ScatterLobe { bounce });
                }
            }
            black_box(sum);
            times[1].push(start.elapsed().as_secs_f64() / numbers * 1e9);
        }
    }
    for (sampler, times) in all.iter().zip(times) {
        row(sampler.strategy().name(), times.into_iter().map(|t| format!("{:.2}", median(t))));
    }
}

/// The errors of one scene's renders, one row: relative to those of random numbers.
fn errors(path: &Path) -> Result<()> {
    let mut scene = load_scene(path)?;
    let camera = scene.cameras.remove(0);
    let world = World::compile(scene)?;
    let wishes = Wishes { effects: Effects::AUTO, max_depth: u32::MAX, hide_background: false };
    let plan = Plan::new(&world, &camera, &wishes);
    let backend = Backend::build(world.geometry.clone(), 0)?;
    let view = world.camera(&camera, SIZE)?;
    let filter = FilterSampler::new(Filter::default());
    let picture = |strategy, seed, samples_per_pixel| -> Result<Vec<Rgb>> {
        let tracer = Tracer {
            world: &world,
            accelerator: &backend,
            camera: &view,
            filter: &filter,
            sampler: Sampler::new(strategy, seed, samples_per_pixel),
            plan: &plan,
        };
        let job = RenderJob {
            region: Region::full(SIZE),
            samples_per_pixel,
            threads: 0,
            batch: Wavefront::DEFAULT_BATCH,
            stop: None,
        };
        Ok(render(&tracer, &job, &|_| ())?.film.develop().radiance)
    };
    let truth = picture(Strategy::Sobol, SEEDS, 2048)?;
    let values = |picture: &[Rgb]| -> Vec<f64> {
        picture.iter().flat_map(|p| p.to_array()).map(f64::from).collect()
    };
    let truth = values(&truth);
    let error = |picture: &[Rgb]| relative_rmse(&values(picture), &truth).powi(2);
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    for samples in SAMPLES {
        let mut found = Vec::new();
        for strategy in samplers() {
            let mut squared = 0.0;
            for seed in 0..SEEDS {
                squared += error(&picture(strategy, seed, samples)?) / SEEDS as f64;
            }
            found.push((strategy, squared.sqrt()));
        }
        let random = found.iter().find(|(s, _)| *s == Strategy::Random).map_or(1.0, |(_, e)| *e);
        let of = |(strategy, error): &(Strategy, f64)| match strategy {
            Strategy::Random => format!("{:.2} %", 100.0 * error),
            _ => format!("{:.2}", error / random),
        };
        row(&format!("{name}, {samples} spp"), found.iter().map(of));
    }
    Ok(())
}

#[allow(clippy::print_stdout, reason = "a benchmark reports on the terminal")]
fn row(first: &str, cells: impl Iterator<Item = String>) {
    println!("| {first} | {} |", cells.collect::<Vec<_>>().join(" | "));
}

fn main() -> Result<()> {
    // `cargo bench` itself adds --bench.
    let said: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    if said.is_empty() {
        generation()?;
        drawing();
        return Ok(());
    }
    row("scene", samplers().map(|strategy| strategy.name().into()));
    row("---", samplers().map(|_| "---".into()));
    let paths =
        if said == ["all"] { scenes::all() } else { said.iter().map(PathBuf::from).collect() };
    paths.iter().try_for_each(|path| errors(path))
}
