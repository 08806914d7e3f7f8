//! The page of a render: which effects it simulated and why, and the bill as stacked bars.

use super::html::Html;
use super::stack::{Part, Stack};
use crate::plan::Plan;
use crate::render::{Bill, ClassRow};

/// What shares mean.
const NOTES: &str = "Time is that of all threads together. A class of transport has the time of its rays, by their number; \
    its light is its part of the mean luminance; its noise is the covariance with the image over the image's variance, \
    over independent replicates, each pixel weighted as the relative error is. Shares of noise can be negative: what \
    cancels the noise of another class has less than none.";

/// The page; `title` names the scene, `facts` are lines about the render.
pub fn render_page(title: &str, facts: &[String], plan: &Plan, bill: &Bill) -> String {
    let mut html = Html::page("glint render");
    html.element("h2", &[], title);
    for fact in facts {
        html.element("p", &[("class", &"soft")], fact);
    }
    stacks(&mut html, bill);
    html.element("p", &[("class", &"soft")], NOTES);
    effects(&mut html, plan);
    html.finish()
}

/// Stacked bars, and the numbers in them.
fn stacks(html: &mut Html, bill: &Bill) {
    let stack = |name: &str, parts| Stack { name: name.into(), parts };
    let stages = bill.ran().map(|row| Part { name: row.stage, share: row.time_share });
    html.element("h3", &[], "Where the time goes");
    Stack::draw(html, &[stack("by stage", stages.collect())]);

    let parts = |share: &dyn Fn(&ClassRow) -> f64| -> Vec<Part> {
        bill.classes.iter().map(|row| Part { name: row.class, share: share(row) }).collect()
    };
    html.element("h3", &[], "Who brings the light, and who the noise");
    let stacks = [
        stack("time", parts(&|row| row.time_share)),
        stack("light", parts(&|row| row.energy_share)),
        stack("noise", parts(&|row| row.variance_share.unwrap_or(0.0))),
    ];
    Stack::draw(html, &stacks);
    html.markup(
        "<table><tr><th>light</th><th>rays</th><th>time</th><th>light</th><th>noise</th></tr>\n",
    );
    for row in &bill.classes {
        html.markup("<tr>").element("td", &[], row.class).element("td", &[], row.rays);
        let [time, light] = [row.time_share, row.energy_share].map(percent);
        let noise = row.variance_share.map_or("-".into(), percent);
        html.element("td", &[], time).element("td", &[], light).element("td", &[], noise);
        html.markup("</tr>\n");
    }
    html.markup("</table>\n");
    let pixels = format!("light and noise: {} pixels", bill.watched_pixels);
    html.element("p", &[("class", &"soft")], pixels);
    html.markup("<table><tr><th>stage</th><th>seconds</th><th>time</th><th>calls</th><th>ns a ray</th><th>mean batch</th></tr>\n");
    for row in bill.ran() {
        html.markup("<tr>").element("td", &[], row.stage);
        html.element("td", &[], format!("{:.3}", row.seconds));
        html.element("td", &[], percent(row.time_share)).element("td", &[], row.calls);
        let cost = row.nanoseconds_per_ray().map_or("-".into(), |ns| format!("{ns:.1}"));
        html.element("td", &[], cost);
        html.element("td", &[], format!("{:.0}", row.mean_batch)).markup("</tr>\n");
    }
    html.markup("</table>\n");
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// The table of effects.
fn effects(html: &mut Html, plan: &Plan) {
    html.element("h3", &[], "Effects, and why");
    html.markup(
        "<table class=\"words\"><tr><th>effect</th><th></th><th>because</th><th>source</th></tr>\n",
    );
    for row in &plan.rows {
        let (class, on) = if row.on { ("better", "on") } else { ("soft", "off") };
        let source = row.source.as_ref().map_or(String::new(), ToString::to_string);
        html.markup("<tr>").element("td", &[], row.effect);
        html.element("td", &[("class", &class)], on);
        html.element("td", &[], &row.reason).element("td", &[], source).markup("</tr>\n");
    }
    html.markup("</table>\n");
}
