//! The findings of a bench as tables for a terminal, at most 100 columns wide.

use crate::study::bench::{
    Agreement, Build, Comparison, Findings, Ratio, Report, Run, SLOW, Scene, Spread,
};

/// Columns of names.
const NAMES: usize = 54;

/// On what, and what is raced.
pub(super) fn head(report: &Report, about: &str) -> String {
    let machine = &report.machine;
    let embree = machine.embree.as_ref().map_or(String::new(), |v| format!(", Embree {v}"));
    format!(
        "{}, {} threads; glint {}{embree}; {}\n{about}",
        machine.cpu, machine.threads, report.version, machine.date
    )
}

/// Everything about a scene.
pub(super) fn findings(findings: &Findings) -> String {
    let mut lines = scene(&findings.scene);
    lines.push(findings.scene.verdict());
    builds(&findings.builds, &mut lines);
    for (i, run) in findings.runs.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| &findings.runs[i]);
        if before.is_none_or(|b| (b.ray_kind, b.threads) != (run.ray_kind, run.threads)) {
            heading(findings, run, &mut lines);
        }
        lines.push(row(findings, run));
    }
    busy(findings.runs.iter().map(|run| run.busy_turns).sum(), &mut lines);
    summary(findings, &mut lines);
    lines.join("\n")
}

/// The scene, how often it was raced on, and how busy the machine was.
pub(super) fn scene(scene: &Scene) -> Vec<String> {
    let mut lines = vec![
        String::new(),
        format!(
            "{}: {} triangles{}, {:.1} MB; {} repetitions, {} turns repeated, {:.0} s",
            scene.scene,
            scene.triangles,
            if scene.stored_triangles == scene.triangles {
                String::new()
            } else {
                format!(" ({} stored)", scene.stored_triangles)
            },
            scene.geometry_bytes as f64 / 1e6,
            scene.repetitions,
            scene.repeated_turns,
            scene.seconds
        ),
    ];
    for probe in &scene.probes {
        lines.push(format!(
            "probe of the machine, {}: median {:.2}, 95 % below {:.2}, slowest {:.2} (busy from {SLOW})",
            threads(probe.threads),
            probe.median,
            probe.p95,
            probe.max
        ));
    }
    lines
}

pub(super) fn threads(n: usize) -> String {
    if n == 1 { "1 thread".into() } else { format!("{n} threads") }
}

fn builds(builds: &[Build], lines: &mut Vec<String>) {
    let Some(first) = builds.first() else { return };
    let title = format!("builds, {}", threads(first.threads));
    lines.push(String::new());
    lines.push(format!(
        "{title:30} {:>24} {:>10} {:>14}  against {}",
        "seconds (min-max)", "MB", "bytes/triangle", first.variant
    ));
    for build in builds {
        let name = format!("  {} {}", build.backend, build.variant);
        let seconds =
            format!("{:.3} ({:.3}-{:.3})", build.seconds, build.seconds_min, build.seconds_max);
        let (time, memory) =
            (build.seconds / first.seconds, build.bytes as f64 / first.bytes as f64);
        lines.push(format!(
            "{name:30} {seconds:>24} {:>10.1} {:>14.1}  {time:.2}x time, {memory:.2}x memory",
            build.bytes as f64 / 1e6,
            build.bytes_per_triangle,
        ));
    }
}

fn heading(findings: &Findings, run: &Run, lines: &mut Vec<String>) {
    let count = findings.scene.rays.iter().find(|count| count.ray_kind == run.ray_kind);
    let (rays, hits) = count.map_or((0, 0), |count| (count.rays, count.hits));
    let title = format!(
        "{}: {rays} rays, {:.1} % hit; {}",
        run.ray_kind,
        100.0 * hits as f64 / rays.max(1) as f64,
        threads(run.threads)
    );
    lines.push(String::new());
    lines.push(format!(
        "{title:NAMES$} {:>22} {:>9} {:>9}  {}",
        "M rays/s (min-max)", "/ robust", "/ best", "answers"
    ));
}

fn row(findings: &Findings, run: &Run) -> String {
    let isa = if run.backend == "bvh" { format!("{} ", run.isa) } else { String::new() };
    let name = format!("  {} {isa}{}", run.backend, run.variant);
    let against = |which: &str| {
        let ratio = findings.ratios.iter().find(|r| is_of(r, run) && r.against == which);
        ratio.map_or(String::new(), |r| times(&r.ratio))
    };
    let Some(speed) = &run.rays_per_second else {
        return format!("{name:NAMES$} WRONG: {}", answers(&run.agreement));
    };
    let speed = rate(speed);
    let (robust, best) = (against("baseline"), against("best"));
    let answers = answers(&run.agreement);
    format!("{name:NAMES$} {speed:>22} {robust:>9} {best:>9}  {answers}").trim_end().to_owned()
}

fn is_of(ratio: &Comparison, run: &Run) -> bool {
    run.backend == "bvh"
        && (ratio.ray_kind, ratio.threads) == (run.ray_kind, run.threads)
        && (ratio.isa, &ratio.variant) == (run.isa, &run.variant)
}

fn rate(speed: &Spread) -> String {
    let [median, min, max] = [speed.median, speed.min, speed.max].map(|speed| speed / 1e6);
    format!("{median:.2} ({min:.2}-{max:.2})")
}

/// A ratio, marked where it is a tie.
pub(super) fn times(ratio: &Ratio) -> String {
    let mark = if ratio.tie { "~" } else { "" };
    format!("{mark}{:.2}x", ratio.median)
}

/// What differs from the reference, in words.
fn answers(agreement: &Agreement) -> String {
    let list = |parts: &[(usize, &str)]| {
        let said = parts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}"));
        said.collect::<Vec<_>>().join(", ")
    };
    let differing = list(&[
        (agreement.missed, "missed"),
        (agreement.false_hits, "falsely hit"),
        (agreement.different, "elsewhere"),
        (agreement.near, "near"),
        (agreement.ties, "tied"),
        (agreement.unsteady_turns, "turns unlike the first"),
    ]);
    let to_blame = list(&[
        (agreement.unexplained, "wrong"),
        (agreement.reference_wrong, "where the reference is wrong"),
    ]);
    match (differing.as_str(), to_blame.as_str()) {
        ("", _) => "same".into(),
        (_, "") => differing,
        _ => format!("{differing}: {to_blame}"),
    }
}

/// Says so if `turns` were timed on a busy machine.
pub(super) fn busy(turns: usize, lines: &mut Vec<String>) {
    if turns > 0 {
        lines.push(String::new());
        lines.push(format!(
            "busy: {turns} turns were timed while the machine did something else; figures may be low"
        ));
    }
}

/// The widest in-house BVH with batches against Embree, all kinds at a glance.
fn summary(findings: &Findings, lines: &mut Vec<String>) {
    let Some(first) = findings.ratios.first() else { return };
    let ours = |r: &&Comparison| (r.isa, &r.variant) == (first.isa, &first.variant);
    let all_threads: Vec<_> = findings.scene.probes.iter().map(|probe| probe.threads).collect();
    lines.push(String::new());
    let title = format!("bvh {} {} against Embree", first.isa, first.variant);
    let mut heading = format!("{title:32}");
    for &n in &all_threads {
        let n = threads(n);
        heading += &format!(" {:>16} {:>12}", format!("{n}, robust"), "best call");
    }
    lines.push(heading);
    for count in &findings.scene.rays {
        let mut line = format!("  {:30}", count.ray_kind);
        for &n in &all_threads {
            for (against, width) in [("baseline", 16), ("best", 12)] {
                let mut all = findings.ratios.iter().filter(ours);
                let found = all
                    .find(|r| (r.ray_kind, r.threads, r.against) == (count.ray_kind, n, against));
                line += &format!(" {:>width$}", found.map_or("-".into(), |r| times(&r.ratio)));
            }
        }
        lines.push(line);
    }
    lines.push(
        "robust: Embree as renders use it, one ray a call. best call: the fastest of all of Embree's.\n\
         ~: a tie; the 95 % interval of the median of the repetitions' ratios holds 1."
            .into(),
    );
}
