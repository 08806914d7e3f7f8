//! Whole frames: one picture, rendered on each backend in turn, and the pixels that differ.
//!
//! Tracing rays is only a part of what a picture takes; this is what a user gains. Structures are built before, and every
//! backend renders the frame once to warm up: these pictures are compared. Then they take turns, in rotating order;
//! a timed frame that is not the backend's first one, byte for byte, ends its hope of a time.
//!
//! A backend decides nothing but which primitives are hit, so the pictures are equal in every pixel none of
//! whose rays hit a different primitive (`tests/it/backends.rs` proves it). Must not print.

use super::Tell;
use super::frame_result::{DifferingPixels, Frame, FrameFindings, FrameRatio};
#[cfg(feature = "bvh")]
use super::in_house::way_name;
use super::judge::Judging;
use super::probe::Probe;
use super::race::Plan;
use super::result::Scene;
use super::statistics::{Ratio, Spread};
#[cfg(feature = "embree")]
use crate::accel::Quality;
#[cfg(feature = "bvh")]
use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::EmbreeAccelerator;
use crate::accel::{Accelerator, BuildOptions};
use crate::error::Result;
use crate::film::{Pixels, Region};
use crate::geometry::Geometry;
use crate::os::Isa;
use crate::render::{RenderJob, Rendered, render};
use crate::trace::{Tracer, Wavefront};
use std::time::{Duration, Instant};

/// What frame, and how often.
#[derive(Clone, Debug)]
pub struct FrameSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Paths begun in every pixel.
    pub samples_per_pixel: u64,
    /// How many threads render it, one race each; structures are built by the largest number.
    pub threads: Vec<usize>,
    /// The widest instructions that anybody may use.
    pub isa: Isa,
    /// Exactly so many repetitions, or as many as there is time for.
    pub repetitions: Option<usize>,
    /// For everything that is done with a scene.
    pub time: Duration,
    /// How structures are built; the threads are those above.
    pub build: BuildOptions,
}

/// A backend that renders a frame.
pub struct Renderer<'a> {
    /// "embree" or "bvh".
    pub backend: &'static str,
    /// How it was built and is called.
    pub variant: String,
    /// Renders the frame on so many threads.
    pub render: Box<dyn Fn(usize) -> Result<Rendered> + 'a>,
}

impl<'a> Renderer<'a> {
    /// Renders what `tracer` traces.
    pub fn new<A: Accelerator>(
        (backend, variant): (&'static str, String),
        tracer: Tracer<'a, A>,
        settings: &FrameSettings,
    ) -> Self {
        let job = RenderJob {
            region: Region::full(settings.size),
            samples_per_pixel: settings.samples_per_pixel,
            threads: 1,
            batch: Wavefront::DEFAULT_BATCH,
            stop: None,
        };
        let of = move |threads| render(&tracer, &RenderJob { threads, ..job.clone() }, &|_| ());
        Self { backend, variant, render: Box::new(of) }
    }
}

/// Renders the frame of `tracer` on every backend: Embree as renders use it first, where there is Embree.
///
/// # Errors
/// Where a structure cannot be built or threads cannot be started.
pub fn frame(
    name: &str,
    tracer: &Tracer<'_, ()>,
    settings: &FrameSettings,
    tell: Tell<'_>,
) -> Result<FrameFindings> {
    let begin = Instant::now();
    settings.isa.limit();
    let geometry = &tracer.world.geometry;
    let options = BuildOptions { threads: most(&settings.threads), ..settings.build };
    tell("building", 0.0);
    #[cfg(feature = "embree")]
    let embree_name = format!("{} robust, single", embree_quality(&options));
    #[cfg(feature = "embree")]
    let embree = EmbreeAccelerator::with_options(geometry.clone(), &options, settings.isa)?;
    #[cfg(feature = "bvh")]
    let bvh = Bvh::with_options(geometry.clone(), &options)?;
    let renderers = [
        #[cfg(feature = "embree")]
        Renderer::new(("embree", embree_name), tracer.on(&embree), settings),
        #[cfg(feature = "bvh")]
        Renderer::new(("bvh", way_name(&options, "batches")), tracer.on(&bvh), settings),
    ];
    let time = settings.time.saturating_sub(begin.elapsed());
    let settings = FrameSettings { time, ..settings.clone() };
    let mut findings = frames(name, geometry, &renderers, &settings, tell)?;
    findings.scene.seconds = begin.elapsed().as_secs_f64();
    Ok(findings)
}

/// Embree's own word for how it is built; its robust mode knows nothing above medium.
#[cfg(feature = "embree")]
fn embree_quality(options: &BuildOptions) -> String {
    let quality = if options.quality == Quality::Fast { "low" } else { "medium" };
    let compact = if options.is_compact { " compact" } else { "" };
    format!("{quality}{compact}")
}

/// Has `renderers` take turns; the first is the one that the others are held against.
///
/// # Errors
/// Those of the renderers.
pub fn frames(
    name: &str,
    geometry: &Geometry,
    renderers: &[Renderer<'_>],
    settings: &FrameSettings,
    tell: Tell<'_>,
) -> Result<FrameFindings> {
    let begin = Instant::now();
    tell("comparing pictures", 0.0);
    let picture = |renderer: &Renderer<'_>| {
        (renderer.render)(most(&settings.threads)).map(|rendered| rendered.film.develop())
    };
    let pictures = renderers.iter().map(picture).collect::<Result<Vec<_>>>()?;

    let time = settings.time.saturating_sub(begin.elapsed());
    let plan = Plan { threads: &settings.threads, repetitions: settings.repetitions, time };
    let race = race(renderers, &pictures, &plan, tell)?;
    let slots = || race.tallies.iter().zip(&settings.threads);
    let all = |(tallies, &threads): (&Vec<Tally>, &usize)| {
        let of = |(renderer, tally)| told(name, renderer, tally, threads, settings);
        renderers.iter().zip(tallies).map(of).collect::<Vec<_>>()
    };
    Ok(FrameFindings {
        scene: Scene {
            scene: name.to_owned(),
            triangles: geometry.placed_triangles(),
            stored_triangles: geometry.stored_triangles(),
            geometry_bytes: geometry.bytes(),
            rays: Vec::new(),
            oracle: Judging::default(),
            repetitions: race.repetitions,
            repeated_turns: 0,
            probes: race.probes.iter().map(Probe::spread).collect(),
            seconds: begin.elapsed().as_secs_f64(),
        },
        frames: slots().flat_map(all).collect(),
        ratios: slots()
            .flat_map(|(tallies, &threads)| ratios(name, renderers, tallies, threads))
            .collect(),
        differing_pixels: differing(name, renderers, &pictures, settings.samples_per_pixel),
    })
}

/// The largest number of threads.
fn most(threads: &[usize]) -> usize {
    threads.iter().copied().max().unwrap_or(1)
}

/// What was measured of a backend with one number of threads.
#[derive(Clone, Default)]
struct Tally {
    /// Of each repetition.
    seconds: Vec<f64>,
    rays: u64,
    unsteady_turns: usize,
    busy_turns: usize,
}

impl Tally {
    /// No time for pictures that change.
    fn is_right(&self) -> bool {
        self.unsteady_turns == 0
    }
}

/// What came out of the turns.
struct Race {
    repetitions: usize,
    /// For each number of threads, of each renderer.
    tallies: Vec<Vec<Tally>>,
    /// For each number of threads.
    probes: Vec<Probe>,
}

fn race(
    renderers: &[Renderer<'_>],
    pictures: &[Pixels],
    plan: &Plan<'_>,
    tell: Tell<'_>,
) -> Result<Race> {
    let begin = Instant::now();
    let seconds = || begin.elapsed().as_secs_f64();
    let mut probes: Vec<_> = plan.threads.iter().map(|&threads| Probe::new(threads)).collect();
    let mut tallies = vec![vec![Tally::default(); renderers.len()]; plan.threads.len()];
    let turns = (plan.threads.len() * renderers.len()) as f64;
    let mut repetitions = 0;
    while !plan.is_over(repetitions, seconds()) {
        for (slot, (&threads, probe)) in plan.threads.iter().zip(&mut probes).enumerate() {
            for turn in 0..renderers.len() {
                let turns_run = (slot * renderers.len() + turn) as f64;
                tell("rendering", plan.done(repetitions as f64 + turns_run / turns, seconds()));
                let who = (repetitions + turn) % renderers.len();
                let slow_before = probe.was_slow();
                let rendered = (renderers[who].render)(threads)?;
                probe.run();
                let is_steady = rendered.film.develop().differing(&pictures[who]).is_empty();
                let tally = &mut tallies[slot][who];
                tally.seconds.push(rendered.seconds);
                tally.rays = rendered.ledger.rays();
                tally.unsteady_turns += usize::from(!is_steady);
                tally.busy_turns += usize::from(slow_before || probe.was_slow());
            }
        }
        repetitions += 1;
    }
    Ok(Race { repetitions, tallies, probes })
}

fn told(
    scene: &str,
    renderer: &Renderer<'_>,
    tally: &Tally,
    threads: usize,
    settings: &FrameSettings,
) -> Frame {
    let seconds = Spread::of(&tally.seconds).filter(|_| tally.is_right());
    Frame {
        scene: scene.to_owned(),
        backend: renderer.backend,
        variant: renderer.variant.clone(),
        isa: settings.isa.name(),
        threads,
        size: settings.size,
        samples_per_pixel: settings.samples_per_pixel,
        rays: tally.rays,
        seconds,
        rays_per_second: seconds.map(|seconds| tally.rays as f64 / seconds.median.max(1e-9)),
        unsteady_turns: tally.unsteady_turns,
        busy_turns: tally.busy_turns,
    }
}

fn ratios(
    scene: &str,
    renderers: &[Renderer<'_>],
    tallies: &[Tally],
    threads: usize,
) -> Vec<FrameRatio> {
    let mut tallies = renderers.iter().zip(tallies);
    let Some((rival, reference)) = tallies.next() else { return Vec::new() };
    let against = |(renderer, tally): (&Renderer<'_>, &Tally)| {
        let ratio = Ratio::of(&reference.seconds, &tally.seconds)
            .filter(|_| reference.is_right() && tally.is_right())?;
        let (scene, backend) = (scene.to_owned(), renderer.backend);
        Some(FrameRatio { scene, threads, backend, rival: rival.backend, ratio })
    };
    tallies.filter_map(against).collect()
}

fn differing(
    scene: &str,
    renderers: &[Renderer<'_>],
    pictures: &[Pixels],
    samples: u64,
) -> Vec<DifferingPixels> {
    let mut pictures = renderers.iter().zip(pictures);
    let Some((rival, reference)) = pictures.next() else { return Vec::new() };
    let against = |(renderer, picture): (&Renderer<'_>, &Pixels)| {
        let pixels = reference.differing(picture);
        DifferingPixels {
            scene: scene.to_owned(),
            backend: renderer.backend,
            rival: rival.backend,
            count: pixels.len(),
            all: reference.region.pixels(),
            samples_per_pixel: samples,
            pixels,
        }
    };
    pictures.map(against).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{ClassFilm, Film};
    use crate::ledger::{Class, Ledger, Watch};
    use crate::math::Rgb;
    use crate::render::NonFinite;
    use std::cell::{Cell, RefCell};

    const REGION: Region = Region::full([3, 2]);

    /// A black picture but for one white pixel, if any.
    fn rendered(seconds: f64, white: Option<[u32; 2]>) -> Rendered {
        let mut film = Film::new(REGION);
        for pixel in REGION.iter() {
            film.add(pixel, 0, Rgb::splat(f32::from(white == Some(pixel))), 1.0);
        }
        let mut ledger = Ledger::default();
        (0..6).for_each(|_| ledger.count_path_ray(Class::Seen));
        let classes = ClassFilm::new(Watch::NONE, 2);
        let non_finite = NonFinite::default();
        Rendered { film, classes, ledger, seconds, non_finite, interrupted: false }
    }

    fn renderer<'a>(backend: &'static str, render: impl Fn() -> Rendered + 'a) -> Renderer<'a> {
        Renderer { backend, variant: "test".into(), render: Box::new(move |_| Ok(render())) }
    }

    fn race(renderers: &[Renderer<'_>], repetitions: usize) -> FrameFindings {
        let settings = FrameSettings {
            size: [3, 2],
            samples_per_pixel: 1,
            threads: vec![1, 2],
            isa: Isa::Portable,
            repetitions: Some(repetitions),
            time: Duration::ZERO,
            build: BuildOptions::default(),
        };
        frames("test", &Geometry::default(), renderers, &settings, &|_, _| ()).expect("no errors")
    }

    #[test]
    fn everybody_takes_turns_and_is_first_as_often() {
        let calls = RefCell::new(String::new());
        let one = |name: &'static str| {
            let calls = &calls;
            renderer(name, move || {
                calls.borrow_mut().push_str(name);
                rendered(1.0, None)
            })
        };
        let findings = race(&[one("a"), one("b"), one("c")], 3);
        // The pictures; then each order on both numbers of threads.
        assert_eq!(*calls.borrow(), "abc abcabc bcabca cabcab".replace(' ', ""));
        assert_eq!(findings.scene.repetitions, 3);
    }

    #[test]
    fn ratios_are_those_of_the_seconds_and_pixels_that_differ_are_listed() {
        let slow = renderer("slow", || rendered(3.0, None));
        let quick = renderer("quick", || rendered(1.5, Some([2, 1])));
        let findings = race(&[slow, quick], 4);
        let frames: Vec<_> = findings.frames.iter().map(|f| (f.threads, f.backend)).collect();
        assert_eq!(frames, [(1, "slow"), (1, "quick"), (2, "slow"), (2, "quick")]);
        let quick = &findings.frames[1];
        assert_eq!(quick.seconds, Some(Spread { median: 1.5, min: 1.5, max: 1.5 }));
        assert_eq!((quick.rays, quick.rays_per_second), (6, Some(4.0)));
        for (ratio, threads) in findings.ratios.iter().zip([1, 2]) {
            assert_eq!((ratio.threads, ratio.backend, ratio.rival), (threads, "quick", "slow"));
            assert!(ratio.ratio.median == 2.0 && !ratio.ratio.tie, "{ratio:?}");
        }
        let [differing] = &findings.differing_pixels[..] else { panic!("one pair") };
        assert_eq!((differing.count, differing.all), (1, 6));
        assert_eq!(differing.pixels, [[2, 1]]);
    }

    #[test]
    fn who_renders_another_picture_than_before_has_no_time() {
        let frames = Cell::new(0);
        let fickle = renderer("fickle", || {
            frames.set(frames.get() + 1);
            // The first is that of the comparison, and the last one is on two threads.
            rendered(0.1, (frames.get() == 5).then_some([0, 0]))
        });
        let findings = race(&[renderer("steady", || rendered(1.0, None)), fickle], 2);
        let unsteady: Vec<_> = findings.frames.iter().map(|f| f.unsteady_turns).collect();
        assert_eq!(unsteady, [0, 0, 0, 1]);
        let has_time: Vec<_> = findings.frames.iter().map(|f| f.seconds.is_some()).collect();
        assert_eq!(has_time, [true, true, true, false]);
        assert_eq!(findings.frames[3].rays_per_second, None);
        assert_eq!(findings.ratios.iter().map(|r| r.threads).collect::<Vec<_>>(), [1]);
    }

    #[test]
    fn one_backend_alone_has_seconds_and_nothing_else() {
        let findings = race(&[renderer("alone", || rendered(1.0, None))], 1);
        assert_eq!(findings.frames.len(), 2);
        assert!(findings.ratios.is_empty() && findings.differing_pixels.is_empty());
    }
}
