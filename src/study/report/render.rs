//! The page of a render: which effects it simulated and why, and the bill as stacked bars.

use super::html::Html;
use super::stack::{Part, Stack};
use crate::ledger::{Class, Stage};
use crate::plan::Plan;
use crate::render::Rendered;

/// What shares mean.
const NOTES: &str = "Time is that of all threads together. A class of transport has the time of its rays, by their number; \
    its light is its part of the mean luminance; its noise is the covariance with the image over the image's variance, \
    over independent replicates, each pixel weighted as the relative error is. Shares of noise can be negative: what \
    cancels the noise of another class has less than none.";

/// The page; `title` names the scene, `facts` are lines about the render.
pub fn render_page(title: &str, facts: &[String], plan: &Plan, rendered: &Rendered) -> String {
    let mut html = Html::page("glint render");
    html.element("h2", &[], title);
    for fact in facts {
        html.element("p", &[("class", &"soft")], fact);
    }
    bill(&mut html, rendered);
    html.element("p", &[("class", &"soft")], NOTES);
    effects(&mut html, plan);
    html.finish()
}

/// Stacked bars, and the numbers in them.
fn bill(html: &mut Html, rendered: &Rendered) {
    let ledger = &rendered.ledger;
    let whole = ledger.worker_seconds.max(1e-9);
    let part = |name: &'static str, share: f64| Part { name, share };
    let stages = Stage::ALL.iter().map(|&s| part(s.name(), ledger.stage(s).seconds / whole));
    html.element("h3", &[], "Where the time goes");
    let by_stage = Stack { name: "by stage".into(), parts: stages.collect() };
    Stack::draw(html, &[by_stage]);

    let (pixels, shares) = rendered.classes.shares(&rendered.film);
    let of = |class: Class| shares.iter().find(|share| share.class == class);
    let classes = |share: &dyn Fn(Class) -> f64| -> Vec<Part> {
        Class::ALL.iter().map(|&class| part(class.name(), share(class))).collect()
    };
    let stack = |name: &str, share: &dyn Fn(Class) -> f64| Stack {
        name: name.into(),
        parts: classes(share),
    };
    html.element("h3", &[], "Who brings the light, and who the noise");
    let time = |class| ledger.class_seconds(class) / whole;
    let energy = |class| of(class).map_or(0.0, |share| share.energy);
    let variance = |class| of(class).map_or(0.0, |share| share.variance);
    let stacks = [stack("time", &time), stack("light", &energy), stack("noise", &variance)];
    Stack::draw(html, &stacks);
    html.markup(
        "<table><tr><th>light</th><th>rays</th><th>time</th><th>light</th><th>noise</th></tr>\n",
    );
    for &class in Class::ALL {
        let rays = ledger.class_rays(class);
        if rays.path + rays.shadow > 0 || of(class).is_some() {
            html.markup("<tr>").element("td", &[], class.name());
            html.element("td", &[], rays.path + rays.shadow);
            for share in [time(class), energy(class), variance(class)] {
                html.element("td", &[], format!("{:.1} %", 100.0 * share));
            }
            html.markup("</tr>\n");
        }
    }
    html.markup("</table>\n");
    html.element("p", &[("class", &"soft")], format!("light and noise: {pixels} pixels"));
    html.markup("<table><tr><th>stage</th><th>seconds</th><th>time</th><th>calls</th><th>ns a ray</th><th>mean batch</th></tr>\n");
    for &stage in Stage::ALL {
        let totals = ledger.stage(stage);
        if totals.calls > 0 {
            html.markup("<tr>").element("td", &[], stage.name());
            html.element("td", &[], format!("{:.3}", totals.seconds));
            html.element("td", &[], format!("{:.1} %", 100.0 * totals.seconds / whole));
            html.element("td", &[], totals.calls);
            let per_ray = 1e9 * totals.seconds / totals.items.max(1) as f64;
            html.element("td", &[], format!("{per_ray:.1}"));
            html.element("td", &[], format!("{:.0}", totals.items as f64 / totals.calls as f64));
            html.markup("</tr>\n");
        }
    }
    html.markup("</table>\n");
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
