//! The page of the sampling laboratory: every set as a drawing, with its measures beside it, and all of them in a table.

use super::html::Html;
use super::panel::figure;
use crate::lab::exhibit::Exhibit;
use crate::lab::listing::COLUMNS;

const NOTES: &str = "Drawings: the points in their Voronoi cells, with a tick for each point along both axes; the mean \
    periodogram (up to ten sets of the strategy; paper is no power, full ink four times that of random points, half ink once) and its mean \
    over rings, where the dashed line is the power of random points. Discrepancies: smaller is more even. Distances are \
    on the torus, relative to those of the hexagonal lattice. x and y strata: the part of n strata along each axis that holds \
    a point. t: the quality of the (t, m, 2)-net in base 2, where the points are one. Anisotropy: variance over squared mean of the \
    periodogram along rings, in decibels; 0 where the spectrum has no direction.";

/// How the energy of a relaxation falls to that of hexagons, 5 / (18 sqrt 3), over its steps.
fn energy(html: &mut Html, energies: &[f64]) {
    const WIDTH: f64 = 620.0;
    const HEIGHT: f64 = 90.0;
    let hexagons = 5.0 / (18.0 * 3.0_f64.sqrt());
    let (Some(first), Some(last)) = (energies.first(), energies.last()) else { return };
    let x = |i: usize| WIDTH * i as f64 / (energies.len() - 1).max(1) as f64;
    let y = |energy: f64| HEIGHT - (HEIGHT - 8.0) * (energy - hexagons) / (first - hexagons);
    let points: Vec<String> =
        energies.iter().enumerate().map(|(i, e)| format!("{:.1},{:.1}", x(i), y(*e))).collect();
    html.open("svg", &[("viewBox", &format!("0 0 {WIDTH} {}", HEIGHT + 20.0)), ("role", &"img")]);
    html.element("title", &[], "energy by step");
    html.element("polyline", &[("class", &"curve"), ("points", &points.join(" "))], "");
    html.element(
        "line",
        &[("class", &"even"), ("x1", &0), ("x2", &WIDTH), ("y1", &HEIGHT), ("y2", &HEIGHT)],
        "",
    );
    let text = format!(
        "energy over {} steps: {:.4} to {:.4} times that of hexagons (dashed)",
        energies.len(),
        first / hexagons,
        last / hexagons
    );
    html.element("text", &[("x", &0), ("y", &(HEIGHT + 15.0))], text);
    html.close("svg");
}

/// The page of these sets.
pub fn samples_page(exhibits: &[Exhibit]) -> String {
    let mut html = Html::page("glint samples");
    html.markup("<table><tr><th>set</th><th>n</th>");
    for (heading, _) in COLUMNS {
        html.element("th", &[], heading);
    }
    html.markup("</tr>\n");
    for Exhibit { measures, .. } in exhibits {
        html.markup("<tr>").element("td", &[], &measures.name).element("td", &[], measures.count);
        for (_, value) in COLUMNS {
            html.element("td", &[], value(measures));
        }
        html.markup("</tr>\n");
    }
    html.markup("</table>\n").element("p", &[("class", &"soft")], NOTES);
    html.markup("<div class=\"charts\">\n");
    for (i, exhibit) in exhibits.iter().enumerate() {
        html.markup("<section>\n").element("h3", &[], &exhibit.measures.name);
        html.element("p", &[("class", &"soft")], exhibit.description);
        figure(&mut html, exhibit, i);
        let measures: Vec<String> = COLUMNS
            .iter()
            .map(|(heading, value)| format!("{heading} {}", value(&exhibit.measures)))
            .collect();
        html.element("p", &[], measures.join(" \u{b7} "));
        let facts: Vec<String> =
            exhibit.facts.iter().map(|(name, value)| format!("{name} {value:.6}")).collect();
        let facts: Vec<&str> =
            facts.iter().map(|fact| fact.trim_end_matches('0').trim_end_matches('.')).collect();
        html.element("p", &[("class", &"soft")], facts.join(", ")).markup("\n");
        energy(&mut html, &exhibit.energies);
        html.markup("</section>\n");
    }
    html.markup("</div>\n");
    html.finish()
}
