//! A point set as a drawing: the points in their Voronoi cells, both projections, the periodogram and its radial mean.

use super::html::Html;
use crate::lab::exhibit::Exhibit;
use crate::lab::measure::Periodogram;
use crate::sampling::voronoi::cells;
use std::fmt::Write;

/// Size of the drawing, and of the square with the points in it.
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 372.0;
const SQUARE: f64 = 330.0;
const LEFT: f64 = 26.0;
const TOP: f64 = 6.0;
/// Where the periodogram is, and the chart below it.
const SPECTRUM_LEFT: f64 = 392.0;
const SPECTRUM: f64 = 210.0;
const CHART_TOP: f64 = 246.0;
const CHART: f64 = 90.0;

/// How the drawing looks by itself; in a page, the page's colours take part.
const STYLE: &str = "\
text { font: 11px system-ui, sans-serif; } .frame { fill: none; stroke: currentColor; stroke-opacity: .35; }
.cells { fill: none; stroke: currentColor; stroke-opacity: .22; stroke-width: .7; }
.points { fill: currentColor; } .ticks { stroke: currentColor; stroke-opacity: .55; stroke-width: .8; }
.power { stroke: currentColor; stroke-width: 1.04; fill: none; } .curve { fill: none; stroke: currentColor; stroke-width: 1.4; }
.even { stroke: currentColor; stroke-opacity: .35; stroke-dasharray: 3 3; }
";

/// An SVG file of the set.
pub fn panel(exhibit: &Exhibit) -> String {
    let mut html = Html::default();
    let name = format!("{}, {} points", exhibit.measures.name, exhibit.points.len());
    html.open(
        "svg",
        &[
            ("xmlns", &"http://www.w3.org/2000/svg"),
            ("viewBox", &format!("0 -22 {WIDTH} {}", HEIGHT + 22.0)),
            ("style", &"background:#fff;color:#14181c"),
        ],
    );
    html.element("text", &[("x", &LEFT), ("y", &-8), ("font-weight", &"bold")], name);
    draw(&mut html, exhibit, 0);
    html.close("svg");
    html.into_text()
}

/// The same inside of a page; `number` tells it from the page's others.
pub(super) fn figure(html: &mut Html, exhibit: &Exhibit, number: usize) {
    let view = format!("0 0 {WIDTH} {HEIGHT}");
    html.open("svg", &[("viewBox", &view), ("role", &"img")]);
    html.element("title", &[], &exhibit.measures.name);
    draw(html, exhibit, number);
    html.close("svg");
}

fn draw(html: &mut Html, exhibit: &Exhibit, number: usize) {
    html.element("style", &[], STYLE);
    points(html, exhibit, number);
    projections(html, exhibit);
    periodogram(html, &exhibit.spectrum);
    radial_mean(html, &exhibit.spectrum, exhibit.points.len());
}

/// From the unit square to the drawing, y upwards.
fn place([x, y]: [f64; 2]) -> [f64; 2] {
    [LEFT + SQUARE * x, TOP + SQUARE * (1.0 - y)]
}

fn points(html: &mut Html, exhibit: &Exhibit, number: usize) {
    let clip = format!("square-{number}");
    let square = [("x", LEFT), ("y", TOP), ("width", SQUARE), ("height", SQUARE)];
    let square: Vec<(&'static str, &dyn std::fmt::Display)> =
        square.iter().map(|(name, value)| (*name, value as _)).collect();
    html.open("clipPath", &[("id", &clip)]).element("rect", &square, "").close("clipPath");

    // Cells of sets on the torus leave the square; beyond some thousand they would be a grey area.
    if exhibit.points.len() <= 4096 {
        let mut path = String::new();
        for cell in cells(&exhibit.points, exhibit.domain) {
            for (i, corner) in cell.corners.iter().enumerate() {
                let [x, y] = place(*corner);
                // Writing to a string does not fail.
                let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { "M" } else { "L" });
            }
            if !cell.corners.is_empty() {
                path.push('Z');
            }
        }
        let clip = format!("url(#{clip})");
        html.element("path", &[("class", &"cells"), ("clip-path", &clip), ("d", &path)], "");
    }
    let radius = (0.22 * SQUARE / (exhibit.points.len().max(1) as f64).sqrt()).clamp(0.5, 3.0);
    html.open("g", &[("class", &"points")]);
    for point in &exhibit.points {
        let [x, y] = place(*point).map(|c| format!("{c:.2}"));
        html.element("circle", &[("cx", &x), ("cy", &y), ("r", &radius)], "");
    }
    html.close("g");
    let mut frame = square;
    frame.push(("class", &"frame"));
    html.element("rect", &frame, "");
}

/// A tick for every point, below for x and to the left for y.
fn projections(html: &mut Html, exhibit: &Exhibit) {
    let (mut path, below) = (String::new(), TOP + SQUARE + 6.0);
    for point in &exhibit.points {
        let [x, y] = place(*point);
        let _ = write!(path, "M{x:.2} {below}v12M{} {y:.2}h-12", LEFT - 6.0);
    }
    html.element("path", &[("class", &"ticks"), ("d", &path)], "");
}

/// Power by frequency as shades: none is white, four times that of random points is black.
fn periodogram(html: &mut Html, spectrum: &Periodogram) {
    const SHADES: usize = 12;
    let limit = spectrum.limit() as i64;
    let side = (2 * limit + 1) as f64;
    let shade = |kx, ky| {
        // The origin has the power n of every set: nothing to see.
        let power = if (kx, ky) == (0, 0) { 0.0 } else { spectrum.at(kx, ky).unwrap_or(0.0) };
        ((power / 4.0).sqrt().min(1.0) * SHADES as f64 + 0.5) as usize
    };
    // Runs of one shade along each row.
    let mut paths = vec![String::new(); SHADES + 1];
    for ky in -limit..=limit {
        let mut kx = -limit;
        while kx <= limit {
            let (start, of) = (kx, shade(kx, ky));
            while kx <= limit && shade(kx, ky) == of {
                kx += 1;
            }
            let (x, y) = (start + limit, limit - ky);
            let _ = write!(paths[of], "M{x} {y}.5h{}", kx - start);
        }
    }
    let scale = SPECTRUM / side;
    let transform = format!("translate({SPECTRUM_LEFT} {TOP}) scale({scale})");
    html.open("g", &[("class", &"power"), ("transform", &transform)]);
    for (of, path) in paths.iter().enumerate().skip(1).filter(|(_, path)| !path.is_empty()) {
        let opacity = format!("{:.2}", of as f64 / SHADES as f64);
        html.element("path", &[("stroke-opacity", &opacity), ("d", path)], "");
    }
    html.close("g");
    let frame: [(&'static str, &dyn std::fmt::Display); 5] = [
        ("class", &"frame"),
        ("x", &SPECTRUM_LEFT),
        ("y", &TOP),
        ("width", &SPECTRUM),
        ("height", &SPECTRUM),
    ];
    html.element("rect", &frame, "");
    let below = TOP + SPECTRUM + 14.0;
    html.element(
        "text",
        &[("x", &SPECTRUM_LEFT), ("y", &below)],
        format!("periodogram, to {limit} cycles"),
    );
}

/// Mean power by radius; the dashed line is that of random points.
fn radial_mean(html: &mut Html, spectrum: &Periodogram, count: usize) {
    const HIGHEST: f64 = 3.0;
    let limit = spectrum.limit().max(1) as f64;
    let x = |radius: f64| SPECTRUM_LEFT + SPECTRUM * radius / limit;
    let y = |power: f64| CHART_TOP + CHART * (1.0 - power.min(HIGHEST) / HIGHEST);
    let mut curve = String::new();
    for ring in spectrum.rings() {
        let command = if curve.is_empty() { "M" } else { "L" };
        let _ = write!(curve, "{command}{:.1} {:.1}", x(ring.radius as f64), y(ring.power));
    }
    let frame: [(&'static str, &dyn std::fmt::Display); 5] = [
        ("class", &"frame"),
        ("x", &SPECTRUM_LEFT),
        ("y", &CHART_TOP),
        ("width", &SPECTRUM),
        ("height", &CHART),
    ];
    html.element("rect", &frame, "");
    let (end, even) = (SPECTRUM_LEFT + SPECTRUM, y(1.0));
    let line: [(&'static str, &dyn std::fmt::Display); 5] =
        [("class", &"even"), ("x1", &SPECTRUM_LEFT), ("x2", &end), ("y1", &even), ("y2", &even)];
    html.element("line", &line, "");
    html.element("path", &[("class", &"curve"), ("d", &curve)], "");
    let label = |html: &mut Html, at: f64, anchor: &'static str, text: String| {
        let below = CHART_TOP + CHART + 13.0;
        html.element("text", &[("x", &at), ("y", &below), ("text-anchor", &anchor)], text);
    };
    label(html, SPECTRUM_LEFT, "start", "radial mean".into());
    let root = (count as f64).sqrt();
    label(html, x(root.min(limit)), "middle", format!("\u{221a}n = {root:.0}"));
    label(html, end, "end", format!("{limit:.0}"));
}
