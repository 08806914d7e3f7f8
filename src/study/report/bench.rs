//! The page of `glint bench`: for each scene what was built, who won by how much, and bars for every race.

use super::bars::{Bar, Chart};
use super::frames;
use super::html::Html;
use crate::study::bench::{Agreement, Build, Comparison, Ratio, Report, Run, SLOW, Scene};

/// The findings as a page.
pub fn bench_page(report: &Report) -> String {
    let mut html = Html::page("glint bench: Embree against the in-house BVH");
    let machine = &report.machine;
    let embree = machine.embree.as_ref().map_or(String::new(), |v| format!(", Embree {v}"));
    html.element(
        "p",
        &[],
        format!(
            "{}, {} threads; glint {}{embree}; {}",
            machine.cpu, machine.threads, report.version, machine.date
        ),
    );
    html.markup("<p class=\"soft\">").element("code", &[], &report.command).markup("</p>\n");
    let notes = if report.frames.is_empty() { NOTES } else { frames::NOTES };
    html.element("p", &[("class", &"soft")], notes);
    for scene in &report.scenes {
        section(&mut html, report, scene);
    }
    html.finish()
}

const NOTES: &str = "Geometry alone: materials are not read, cut-outs are solid. A contestant is timed only if its \
    answers are right, by the exact oracle. Bars are medians over repetitions in which all took turns on the same rays, whiskers \
    reach from the slowest to the fastest. A ratio marked ~ is a tie: the 95 % interval of the median of the \
    repetitions' ratios holds 1. Robust: Embree as renders use it, one ray a call; best call: the fastest of \
    all of Embree's.";

fn section(html: &mut Html, report: &Report, scene: &Scene) {
    let of_scene = |name: &String| *name == scene.scene;
    html.element("h2", &[], &scene.scene);
    let instanced = if scene.stored_triangles == scene.triangles {
        String::new()
    } else {
        format!(" ({} stored)", scene.stored_triangles)
    };
    html.element(
        "p",
        &[],
        format!(
            "{} triangles{instanced}, {:.1} MB; {} repetitions in {:.0} s, {} turns repeated",
            scene.triangles,
            scene.geometry_bytes as f64 / 1e6,
            scene.repetitions,
            scene.seconds,
            scene.repeated_turns
        ),
    );
    for probe in &scene.probes {
        html.element(
            "p",
            &[("class", &"soft")],
            format!(
                "probe of the machine, {}: median {:.2}, 95 % below {:.2}, slowest {:.2} (busy from {SLOW})",
                threads(probe.threads),
                probe.median,
                probe.p95,
                probe.max
            ),
        );
    }
    if !scene.rays.is_empty() {
        html.element("p", &[("class", &"soft")], scene.verdict());
    }
    let ratios: Vec<_> = report.ratios.iter().filter(|r| of_scene(&r.scene)).collect();
    summary(html, scene, &ratios);
    let built: Vec<_> = report.builds.iter().filter(|b| of_scene(&b.scene)).collect();
    builds(html, &built);
    for count in &scene.rays {
        let share = 100.0 * count.hits as f64 / count.rays.max(1) as f64;
        let title = format!("{}: {} rays, {share:.1} % hit", count.ray_kind, count.rays);
        html.element("h3", &[], title).markup("<div class=\"charts\">\n");
        for probe in &scene.probes {
            let runs = report.runs.iter().filter(|r| {
                of_scene(&r.scene) && (r.ray_kind, r.threads) == (count.ray_kind, probe.threads)
            });
            let title = format!("{}, million rays a second", threads(probe.threads));
            Chart { title, bars: runs.map(bar).collect() }.draw(html);
        }
        html.markup("</div>\n");
    }
    frames::section(html, report, scene);
}

pub(super) fn threads(n: usize) -> String {
    if n == 1 { "1 thread".into() } else { format!("{n} threads") }
}

fn bar(run: &Run) -> Bar<'_> {
    let isa = if run.backend == "bvh" { format!("{} ", run.isa) } else { String::new() };
    let speed = run.rays_per_second;
    let label = match speed {
        Some(speed) => format!("{:.2}", speed.median / 1e6),
        None => {
            let Agreement { unexplained, unsteady_turns, .. } = run.agreement;
            format!("wrong: {unexplained} rays, {unsteady_turns} turns")
        }
    };
    Bar {
        name: format!("{} {isa}{}", run.backend, run.variant),
        class: run.backend,
        values: speed.map(|s| [s.min, s.median, s.max]),
        label: if run.busy_turns > 0 { format!("{label} (busy)") } else { label },
    }
}

/// The widest in-house BVH with batches against Embree, all kinds at a glance.
fn summary(html: &mut Html, scene: &Scene, ratios: &[&Comparison]) {
    let Some(first) = ratios.first() else { return };
    html.element("h3", &[], format!("bvh {} {} against Embree", first.isa, first.variant));
    html.markup("<table><tr><th>rays</th>");
    for probe in &scene.probes {
        for against in ["robust", "best call"] {
            html.element("th", &[], format!("{}, {against}", threads(probe.threads)));
        }
    }
    html.markup("</tr>\n");
    for count in &scene.rays {
        html.markup("<tr>").element("td", &[], count.ray_kind);
        for probe in &scene.probes {
            for against in ["baseline", "best"] {
                let found = ratios.iter().find(|r| {
                    (r.isa, &r.variant) == (first.isa, &first.variant)
                        && (r.ray_kind, r.threads) == (count.ray_kind, probe.threads)
                        && r.against == against
                });
                cell(html, found.copied());
            }
        }
        html.markup("</tr>\n");
    }
    html.markup("</table>\n");
}

fn cell(html: &mut Html, comparison: Option<&Comparison>) {
    ratio_cell(html, comparison.map(|found| (&found.ratio, found.rival.as_str())));
}

/// A cell of a table with a ratio to a rival, if there is one.
pub(super) fn ratio_cell(html: &mut Html, found: Option<(&Ratio, &str)>) {
    let Some((ratio, rival)) = found else {
        html.element("td", &[], "-");
        return;
    };
    let class = if !ratio.tie && ratio.median > 1.0 { "better" } else { "" };
    let mark = if ratio.tie { "~" } else { "" };
    let interval = format!("against {rival}; 95 % interval {:.2} to {:.2}", ratio.low, ratio.high);
    html.element(
        "td",
        &[("class", &class), ("title", &interval)],
        format!("{mark}{:.2}x", ratio.median),
    );
}

fn builds(html: &mut Html, builds: &[&Build]) {
    let Some(first) = builds.first() else { return };
    html.element("h3", &[], format!("Building, {}", threads(first.threads)));
    html.markup(
        "<table><tr><th>structure</th><th>seconds</th><th>min-max</th><th>builds</th><th>MB</th>\
         <th>bytes/triangle</th><th>time</th><th>memory</th></tr>\n",
    );
    for build in builds {
        html.markup("<tr>");
        let cells = [
            format!("{} {}", build.backend, build.variant),
            format!("{:.3}", build.seconds),
            format!("{:.3}-{:.3}", build.seconds_min, build.seconds_max),
            build.repetitions.to_string(),
            format!("{:.1}", build.bytes as f64 / 1e6),
            format!("{:.1}", build.bytes_per_triangle),
            format!("{:.2}x", build.seconds / first.seconds),
            format!("{:.2}x", build.bytes as f64 / first.bytes as f64),
        ];
        for cell in cells {
            html.element("td", &[], cell);
        }
        html.markup("</tr>\n");
    }
    html.markup("</table>\n");
}
