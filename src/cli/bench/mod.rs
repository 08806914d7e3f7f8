//! `glint bench`: scenes in, tables of builds and rays per second out, or of whole frames.

mod frame;
mod frame_table;
mod table;

use super::args::{Bench, Up};
use super::progress::{BAR, style};
use super::select;
use super::statistics::command;
use super::{DONE, NOT_MET, instructions};
use crate::error::{Error, Result};
use crate::image::{check_writable, write_whole};
use crate::load::{self, LoadOptions, Surroundings};
use crate::math::Rgb;
use crate::scene::{self, ColorInput, Environment, Material, Surface};
use crate::study::bench::{DifferingPixels, RayKind, Report, Settings, Tell, bench, most_threads};
use crate::study::report;
use crate::world::World;
use frame::FrameScene;
use indicatif::{ProgressBar, ProgressDrawTarget};
use std::io::{self, Write};
use std::path::Path;

/// Benches as told; the exit code.
pub(super) fn run(args: &Bench) -> Result<u8> {
    let settings = settings(args)?;
    if let Some(path) = &args.output {
        if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("html")) {
            let message = format!("-o {}: the ending must be .html", path.display());
            return Err(Error::Usage(message));
        }
        check_writable(path)?;
    }
    // Not after an hour of the others.
    args.scenes.iter().try_for_each(|path| load::check_scene(path))?;
    let mut report = Report::new(command())?;
    say(args, &table::head(&report, &about(args, &settings)));
    for (path, n) in args.scenes.iter().zip(1..) {
        let place = match args.scenes.len() {
            1 => String::new(),
            all => format!("scene {n} of {all}, "),
        };
        let name = path.display().to_string();
        if args.frame {
            let scene = FrameScene::load(args, path)?;
            let findings = watched(args, &place, |tell| scene.race(&name, &settings, tell))?;
            say(args, &frame_table::findings(&findings));
            report.add_frames(findings);
        } else {
            let (world, cameras) = load(args, path)?;
            let findings =
                watched(args, &place, |tell| bench(&name, &world, &cameras, &settings, tell))?;
            say(args, &table::findings(&findings));
            report.add(findings);
        }
    }
    if let Some(path) = &args.output {
        let page = report::bench_page(&report);
        write_whole(path, |file| file.write_all(page.as_bytes()))?;
        say(args, &format!("wrote {}", path.display()));
    }
    if args.json {
        let json = serde_json::to_string_pretty(&report)
            .map_err(|e| Error::Usage(format!("the findings cannot be written: {e}")))?;
        let _ = writeln!(io::stdout(), "{json}");
    }
    Ok(exit_code(&report))
}

/// Done, or done but with answers that were wrong.
fn exit_code(report: &Report) -> u8 {
    let is_wrong = report.disqualified().next().is_some()
        || report.frames.iter().any(|frame| frame.seconds.is_none())
        || report.differing_pixels.iter().any(DifferingPixels::is_too_many);
    if is_wrong { NOT_MET } else { DONE }
}

/// What is raced, in a line.
fn about(args: &Bench, settings: &Settings) -> String {
    let ([width, height], spp) = (args.size, args.spp);
    if args.frame {
        format!(
            "Whole frames of {width}x{height}, {spp} samples a pixel, as glint render makes them."
        )
    } else {
        let rays = settings.rays;
        format!(
            "Geometry alone: materials are not read, cut-outs are solid. {rays} rays of each kind."
        )
    }
}

/// Prints lines where they do not get in the way of JSON.
fn say(args: &Bench, lines: &str) {
    if args.quiet {
        return;
    }
    // A closed stream is nobody's error.
    let _ = if args.json {
        writeln!(io::stderr(), "{lines}")
    } else {
        writeln!(io::stdout(), "{lines}")
    };
}

fn settings(args: &Bench) -> Result<Settings> {
    let isa = instructions(args.isa)?;
    let said = if args.threads.is_empty() { &[1, 0][..] } else { &args.threads };
    let mut threads: Vec<_> =
        said.iter().map(|&n| if n == 0 { most_threads() } else { n }).collect();
    threads.sort_unstable();
    threads.dedup();
    let kinds = if args.kinds.is_empty() {
        RayKind::ALL.map(|(_, kind)| kind).to_vec()
    } else {
        args.kinds.clone()
    };
    let rays = usize::try_from(args.rays).ok().filter(|rays| *rays <= 1 << 28);
    let rays = rays.ok_or_else(|| Error::Usage("--rays: at most 268435456".into()))?;
    Ok(Settings {
        rays,
        kinds,
        threads,
        isa,
        repetitions: args.repetitions.map(|n| n as usize),
        time: args.time,
        all_calls: args.all_calls,
        build: args.build.options(0),
    })
}

/// The geometry of a scene, in grey, and the cameras to look at it: its own first one, or the automatic one
/// and the same from half as far.
fn load(args: &Bench, path: &Path) -> Result<(World, Vec<scene::Camera>)> {
    let albedo = ColorInput::constant(Rgb::splat(0.5));
    let options = LoadOptions {
        material: Some(Material::new("bench", Surface::Lambert { albedo })),
        surroundings: Some(Surroundings::computed(Environment::Constant { radiance: Rgb::WHITE })),
        progress: None,
    };
    let mut scene = load::load_scene_with(path, options)?;
    let up = args.up.map_or(scene.up, Up::direction);
    let cameras = std::mem::take(&mut scene.cameras);
    let world = World::compile(scene)?;
    for warning in &world.warnings {
        if !args.quiet {
            let _ = writeln!(io::stderr(), "warning: {warning}");
        }
    }
    let cameras = match cameras.into_iter().next() {
        Some(camera) => vec![camera],
        None => {
            let whole = select::automatic(&world, up, 16.0 / 9.0, select::DEFAULT_FOV)?;
            let from = whole.to + 0.5 * (whole.from - whole.to);
            vec![whole.clone(), scene::Camera { from, ..whole }]
        }
    };
    Ok((world, cameras))
}

/// Does `work`, and shows meanwhile how far it is; `place` says in which scene.
fn watched<T>(args: &Bench, place: &str, work: impl FnOnce(Tell<'_>) -> T) -> T {
    const STEPS: u64 = 10_000;
    let bar = if args.quiet {
        ProgressBar::hidden()
    } else {
        let target = ProgressDrawTarget::stderr_with_hz(5);
        ProgressBar::with_draw_target(Some(STEPS), target)
    };
    bar.set_style(style(&format!("{BAR}  {{msg}}")));
    let outcome = work(&|step, done| {
        bar.set_message(format!("{place}{step}"));
        bar.set_position((done * STEPS as f64) as u64);
    });
    bar.finish_and_clear();
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::bench::{Agreement, Run, Spread};

    #[test]
    fn wrong_answers_have_an_exit_code() {
        let mut report = Report::new(String::new()).expect("a machine");
        assert_eq!(exit_code(&report), DONE);
        let spread = Spread { median: 1e6, min: 1e6, max: 1e6 };
        for (rays_per_second, code) in [(Some(spread), DONE), (None, NOT_MET)] {
            report.runs.push(Run {
                scene: "a.obj".into(),
                backend: "bvh",
                variant: "batches".into(),
                isa: "avx2",
                threads: 1,
                ray_kind: "primary",
                rays_per_second,
                hits: 0,
                agreement: Agreement::default(),
                busy_turns: 0,
            });
            assert_eq!(exit_code(&report), code);
        }
    }
}
