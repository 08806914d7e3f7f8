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

/// As a table for a terminal, a line each.
pub fn table<'m>(measures: impl Iterator<Item = &'m Measures>) -> String {
    let headings = ["set", "n"].into_iter().chain(COLUMNS.map(|(heading, _)| heading));
    let mut rows: Vec<Vec<String>> = vec![headings.map(str::to_owned).collect()];
    rows.extend(measures.map(|m| {
        let cells = COLUMNS.iter().map(|(_, value)| value(m));
        [m.name.clone(), m.count.to_string()].into_iter().chain(cells).collect()
    }));
    let widest = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(widest).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate();
        let aligned = cells.map(|(k, (cell, &width))| match k {
            0 => format!("{cell:width$}"),
            _ => format!("  {cell:>width$}"),
        });
        aligned.collect::<String>()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Five decimals, and at least three significant digits.
fn number(value: f64) -> String {
    if value == 0.0 || value >= 1e-3 { format!("{value:.5}") } else { format!("{value:.2e}") }
}

fn optional(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.3}"))
}

fn bracket(Bracket { low, high }: Bracket) -> String {
    if low == high { number(low) } else { format!("{}..{}", number(low), number(high)) }
}
