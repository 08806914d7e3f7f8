//! `glint bench`: scenes in, tables of builds and rays per second out.

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
use crate::study::bench::{RayKind, Report, Settings, bench, most_threads};
use crate::study::report;
use crate::world::World;
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
    say(args, &table::head(&report, &settings));
    for (path, n) in args.scenes.iter().zip(1..) {
        let place = match args.scenes.len() {
            1 => String::new(),
            all => format!("scene {n} of {all}, "),
        };
        let (world, cameras) = load(args, path)?;
        let bar = bar(args);
        let tell = |step: &'static str, done: f64| {
            bar.set_message(format!("{place}{step}"));
            bar.set_position((done * bar.length().unwrap_or(0) as f64) as u64);
        };
        let findings = bench(&path.display().to_string(), &world, &cameras, &settings, &tell);
        bar.finish_and_clear();
        let findings = findings?;
        say(args, &table::findings(&findings));
        report.add(findings);
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
    if report.disqualified().next().is_some() { NOT_MET } else { DONE }
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

fn bar(args: &Bench) -> ProgressBar {
    if args.quiet {
        return ProgressBar::hidden();
    }
    let target = ProgressDrawTarget::stderr_with_hz(5);
    let bar = ProgressBar::with_draw_target(Some(10_000), target);
    bar.set_style(style(&format!("{BAR}  {{msg}}")));
    bar
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
