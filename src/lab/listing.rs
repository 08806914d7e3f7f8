//! The measures of sets as the columns of a table, for terminals and pages alike.

use super::measure::{Bracket, Measures};

/// A column of the table: its heading, and what stands in it.
pub type Column = (&'static str, fn(&Measures) -> String);

/// Of every set, in this order.
pub const COLUMNS: [Column; 12] = [
    ("D*", |m| bracket(m.star_discrepancy)),
    ("any box", |m| bracket(m.extreme_discrepancy)),
    ("L2*", |m| number(m.l2_star)),
    ("centred", |m| number(m.centered)),
    ("wrap-around", |m| number(m.wraparound)),
    ("mixture", |m| number(m.mixture)),
    ("smallest distance", |m| optional(m.relative_min_distance)),
    ("mean distance", |m| optional(m.relative_mean_distance)),
    ("x strata", |m| format!("{:.2}", m.projection_x)),
    ("y strata", |m| format!("{:.2}", m.projection_y)),
    ("t", |m| m.t_value.map_or("-".into(), |t| t.to_string())),
    ("anisotropy", |m| m.anisotropy.map_or("-".into(), |a| format!("{a:.1} dB"))),
];

/// As a table for a terminal.
pub fn table<'m>(measures: impl Iterator<Item = &'m Measures> + Clone) -> String {
    let name = measures.clone().map(|m| m.name.chars().count()).max().unwrap_or(0).max(4);
    let mut text = format!("{:name$} {:>7}", "set", "n");
    for (heading, _) in COLUMNS {
        text += &format!("  {:>width$}", heading, width = width(heading));
    }
    for row in measures {
        text += &format!("\n{:name$} {:>7}", row.name, row.count);
        for (heading, value) in COLUMNS {
            text += &format!("  {:>width$}", value(row), width = width(heading));
        }
    }
    text
}

fn width(heading: &str) -> usize {
    heading.len().max(7)
}

fn number(value: f64) -> String {
    format!("{value:.5}")
}

fn optional(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.3}"))
}

fn bracket(Bracket { low, high }: Bracket) -> String {
    // Where there is a gap it is at most a few in the last digit.
    if low == high { number(low) } else { format!("{:.4}~", 0.5 * (low + high)) }
}
