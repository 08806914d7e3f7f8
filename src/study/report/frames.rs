//! The part of the bench's page that whole frames have: who rendered them how fast, and which pixels differ.

use super::bars::{Bar, Chart};
use super::bench::{ratio_cell, threads};
use super::html::Html;
use crate::study::bench::{DifferingPixels, Frame, Report, Scene};

/// What frames are, and how they were timed.
pub(super) const NOTES: &str = "Whole frames, as renders make them, with materials, lights and cut-outs: seconds from the first path \
    to the last; structures are built before. Bars are medians over repetitions in which both backends took turns, \
    whiskers reach from the fastest to the slowest. A ratio marked ~ is a tie: the 95 % interval of the median of the \
    repetitions' ratios holds 1. A backend whose pictures changed has no time. Robust: Embree as renders use it, one \
    ray a call.";

/// Pixels that are shown; the JSON has all.
const SHOWN: usize = 200;

/// Adds the frames of a scene, if there are any.
pub(super) fn section(html: &mut Html, report: &Report, scene: &Scene) {
    let of_scene = |name: &String| *name == scene.scene;
    let frames: Vec<_> = report.frames.iter().filter(|frame| of_scene(&frame.scene)).collect();
    let Some(first) = frames.first() else { return };
    let ([width, height], spp) = (first.size, first.samples_per_pixel);
    html.element("h3", &[], format!("Frame of {width}x{height}, {spp} samples a pixel"));
    html.markup(
        "<table><tr><th>backend</th><th>threads</th><th>seconds</th><th>min-max</th>\
         <th>million rays a second</th><th>against Embree</th></tr>\n",
    );
    for frame in &frames {
        row(html, report, frame);
    }
    html.markup("</table>\n<div class=\"charts\">\n");
    for probe in &scene.probes {
        let of_threads = frames.iter().filter(|frame| frame.threads == probe.threads);
        let title = format!("{}, seconds", threads(probe.threads));
        Chart { title, bars: of_threads.map(|frame| bar(frame)).collect() }.draw(html);
    }
    html.markup("</div>\n");
    report.differing_pixels.iter().filter(|p| of_scene(&p.scene)).for_each(|p| differing(html, p));
}

fn row(html: &mut Html, report: &Report, frame: &Frame) {
    let (seconds, range) = match frame.seconds {
        Some(s) => (format!("{:.3}", s.median), format!("{:.3}-{:.3}", s.min, s.max)),
        None => ("wrong".into(), format!("{} frames changed", frame.unsteady_turns)),
    };
    html.markup("<tr>");
    html.element("td", &[], name(frame)).element("td", &[], frame.threads);
    html.element("td", &[], seconds).element("td", &[], range);
    let speed = frame.rays_per_second.map_or("-".into(), |speed| format!("{:.2}", speed / 1e6));
    html.element("td", &[], speed);
    let found = report.frame_ratios.iter().find(|ratio| {
        (&ratio.scene, ratio.backend, ratio.threads) == (&frame.scene, frame.backend, frame.threads)
    });
    ratio_cell(html, found.map(|found| (&found.ratio, found.rival)));
    html.markup("</tr>\n");
}

fn name(frame: &Frame) -> String {
    format!("{} {} {}", frame.backend, frame.isa, frame.variant)
}

fn bar(frame: &Frame) -> Bar<'_> {
    let label = frame.seconds.map_or("wrong".into(), |seconds| format!("{:.3}", seconds.median));
    Bar {
        name: name(frame),
        class: frame.backend,
        values: frame.seconds.map(|s| [s.min, s.median, s.max]),
        label: if frame.busy_turns > 0 { format!("{label} (busy)") } else { label },
    }
}

fn differing(html: &mut Html, pixels: &DifferingPixels) {
    let DifferingPixels { backend, rival, count, all, .. } = *pixels;
    let share = 100.0 * count as f64 / all.max(1) as f64;
    html.element("h3", &[], format!("Pixels that differ between {rival} and {backend}"));
    let class = if pixels.is_too_many() { "wrong" } else { "" };
    html.element("p", &[("class", &class)], format!("{count} of {all} ({share:.4} %)"));
    let mut list: Vec<_> =
        pixels.pixels.iter().take(SHOWN).map(|[x, y]| format!("{x},{y}")).collect();
    if count > list.len() {
        list.push(format!("and {} more", count - list.len()));
    }
    html.element("p", &[("class", &"soft")], list.join("  "));
}
