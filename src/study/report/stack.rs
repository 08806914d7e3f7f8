//! Stacked bars of shares, as inline SVG, with a legend of what is in them.

use super::html::Html;

/// A bar of parts that add up to 1; a negative part is drawn to the left of 0.
pub(super) struct Stack {
    pub(super) name: String,
    pub(super) parts: Vec<Part>,
}

/// A part of a bar; parts of one name have one colour.
pub(super) struct Part {
    pub(super) name: &'static str,
    pub(super) share: f64,
}

const WIDTH: f64 = 1000.0;
const NAMES: f64 = 80.0;
const ROW: f64 = 34.0;
/// A part narrower than this is in the legend alone.
const LABELLED: f64 = 60.0;

impl Stack {
    /// Adds bars of the same parts, under each other on one scale, and their legend.
    pub(super) fn draw(html: &mut Html, stacks: &[Self]) {
        let below = |stack: &Self| stack.parts.iter().map(|p| p.share.min(0.0)).sum::<f64>();
        let above = |stack: &Self| stack.parts.iter().map(|p| p.share.max(0.0)).sum::<f64>();
        let low = stacks.iter().map(below).fold(0.0, f64::min);
        let high = stacks.iter().map(above).fold(1.0, f64::max);
        let scale = (WIDTH - NAMES) / (high - low);
        let height = ROW * stacks.len() as f64;
        html.open("svg", &[("viewBox", &format!("0 0 {WIDTH} {height}")), ("role", &"img")]);
        for (i, stack) in stacks.iter().enumerate() {
            let top = ROW * i as f64;
            let baseline = top + 0.5 * ROW + 1.0;
            html.element("text", &[("x", &0), ("y", &baseline)], &stack.name);
            let zero = NAMES - low * scale;
            let (mut left, mut right) = (zero, zero);
            for (k, part) in stack.parts.iter().enumerate() {
                let width = part.share.abs() * scale;
                let x = if part.share < 0.0 {
                    left -= width;
                    left
                } else {
                    right += width;
                    right - width
                };
                segment(html, k, part, [x, top, width]);
            }
        }
        html.close("svg");
        html.markup("<p class=\"legend\">");
        let parts = stacks.first().map_or(&[][..], |stack| &stack.parts);
        for (k, part) in parts.iter().enumerate() {
            if stacks.iter().any(|stack| stack.parts[k].share != 0.0) {
                html.element("span", &[("style", &format!("background:{}", color(k)))], "");
                html.text(part.name).markup(" ");
            }
        }
        html.markup("</p>\n");
    }
}

fn segment(html: &mut Html, k: usize, part: &Part, [x, top, width]: [f64; 3]) {
    if width < 0.05 {
        return;
    }
    let (x, w) = (format!("{x:.1}"), format!("{width:.1}"));
    let percent = format!("{:.0} %", 100.0 * part.share);
    html.open(
        "rect",
        &[
            ("x", &x),
            ("y", &(top + 3.0)),
            ("width", &w),
            ("height", &(ROW - 10.0)),
            ("style", &format!("fill:{}", color(k))),
        ],
    );
    html.element("title", &[], format!("{}: {percent}", part.name)).close("rect");
    if width > LABELLED {
        let baseline = top + 0.5 * ROW + 2.0;
        html.element("text", &[("x", &x), ("dx", &5), ("y", &baseline), ("class", &"in")], percent);
    }
}

/// Colours that neighbours can be told by, in either scheme: hues a golden angle apart.
fn color(k: usize) -> String {
    let hue = (k as f64 * 137.508 + 25.0) % 360.0;
    let lightness = if k.is_multiple_of(2) { 62 } else { 48 };
    format!("hsl({hue:.0} 55% {lightness}%)")
}
