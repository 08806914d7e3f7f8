//! The page of the sampling laboratory: every set as a drawing, with its measures beside it, and all of them in a table.

use super::html::Html;
use super::panel::figure;
use crate::lab::exhibit::Exhibit;
use crate::lab::listing::COLUMNS;

const NOTES: &str = "Drawings: the points in their Voronoi cells, with a tick for each point along both axes; the mean \
    periodogram (up to ten sets of the strategy; white is no power, black four times that of random points) and its mean \
    over rings, where the dashed line is the power of random points. Discrepancies: smaller is more even. Distances are \
    on the torus, relative to those of the hexagonal lattice. Projections: the part of n strata along x and y that holds \
    a point. t: the quality of the (t, m, 2)-net in base 2, where the points are one. Anisotropy: variance over squared mean of the \
    periodogram along rings, in decibels; 0 where the spectrum has no direction.";

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
        let facts: Vec<String> =
            exhibit.facts.iter().map(|(name, value)| format!("{name} {value:.6}")).collect();
        let facts: Vec<&str> =
            facts.iter().map(|fact| fact.trim_end_matches('0').trim_end_matches('.')).collect();
        html.element("p", &[("class", &"soft")], facts.join(", ")).markup("</section>\n");
    }
    html.markup("</div>\n");
    html.finish()
}
