//! Horizontal bars with whiskers, as inline SVG.

use super::html::Html;

/// A bar chart.
pub(super) struct Chart<'a> {
    /// Above it.
    pub(super) title: String,
    /// From top to bottom.
    pub(super) bars: Vec<Bar<'a>>,
}

/// A bar.
pub(super) struct Bar<'a> {
    pub(super) name: String,
    /// Style of the bar.
    pub(super) class: &'a str,
    /// Smallest, middle and largest value; none for what was not measured.
    pub(super) values: Option<[f64; 3]>,
    /// At its end.
    pub(super) label: String,
}

const WIDTH: f64 = 660.0;
const NAMES: f64 = 325.0;
const LABELS: f64 = 100.0;
const ROW: f64 = 21.0;
const HEAD: f64 = 24.0;

impl Chart<'_> {
    /// Adds it to a page.
    pub(super) fn draw(&self, html: &mut Html) {
        let largest = self.bars.iter().filter_map(|bar| bar.values).map(|values| values[2]);
        let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
        let x = |value: f64| NAMES + (WIDTH - NAMES - LABELS) * value / largest;
        let height = HEAD + ROW * self.bars.len() as f64;
        html.open("svg", &[("viewBox", &format!("0 0 {WIDTH} {height}")), ("role", &"img")]);
        html.element("title", &[], &self.title);
        html.element("text", &[("x", &0), ("y", &14), ("font-weight", &600)], &self.title);
        for (bar, i) in self.bars.iter().zip(0_u32..) {
            let top = HEAD + ROW * f64::from(i);
            let middle = top + 0.5 * ROW - 1.5;
            let baseline = middle + 4.0;
            html.element(
                "text",
                &[("x", &(NAMES - 8.0)), ("y", &baseline), ("text-anchor", &"end")],
                &bar.name,
            );
            let mut end = NAMES;
            if let Some([low, median, high]) = bar.values {
                let width = format!("{:.1}", x(median) - NAMES);
                html.element(
                    "rect",
                    &[
                        ("class", &bar.class),
                        ("x", &NAMES),
                        ("y", &(top + 1.0)),
                        ("width", &width),
                        ("height", &(ROW - 5.0)),
                    ],
                    "",
                );
                let [from, to] = [low, high].map(|value| format!("{:.1}", x(value)));
                html.element(
                    "line",
                    &[
                        ("class", &"whisker"),
                        ("x1", &from),
                        ("x2", &to),
                        ("y1", &middle),
                        ("y2", &middle),
                    ],
                    "",
                );
                end = x(high);
            }
            let place = format!("{:.1}", end + 6.0);
            html.element("text", &[("x", &place), ("y", &baseline)], &bar.label);
        }
        html.close("svg");
    }
}
