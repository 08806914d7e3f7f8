//! The plan as a table for a terminal.

use super::prepare::Prepared;
use crate::plan::Row;
use crate::render::Forecast;

/// Columns of a paragraph.
const WIDTH: usize = 100;
/// Columns of an effect's name.
const NAME: usize = 31;

/// At the head of a render: the effects that are on, each with its reason, and the names of the others.
pub(super) fn head(prepared: &Prepared, forecast: Option<&Forecast>) -> Vec<String> {
    let rows = &prepared.plan.rows;
    let mut lines = vec![heading(forecast)];
    lines.extend(rows.iter().filter(|row| row.on).map(|row| line(row, forecast)));
    let off: Vec<&str> = rows.iter().filter(|row| !row.on).map(|row| row.effect).collect();
    if !off.is_empty() {
        lines.extend(wrapped(&format!("off (`glint plan` says why): {}", off.join(", "))));
    }
    lines.extend(forecast.iter().flat_map(|forecast| outlook(prepared, forecast)));
    lines
}

/// Of `glint plan`: every row.
pub(super) fn whole(prepared: &Prepared, forecast: &Forecast) -> Vec<String> {
    let of = |is_on: bool| prepared.plan.rows.iter().filter(move |row| row.on == is_on);
    let mut lines = vec![heading(Some(forecast))];
    lines.extend(of(true).map(|row| line(row, Some(forecast))));
    lines.push(format!("{:NAME$} spares  because", "off"));
    lines.extend(of(false).map(|row| line(row, Some(forecast))));
    let stages: Vec<&str> = prepared.plan.stages().map(|stage| stage.name()).collect();
    lines.extend(wrapped(&format!("stages: {}", stages.join(" > "))));
    lines.extend(outlook(prepared, forecast));
    lines
}

fn heading(forecast: Option<&Forecast>) -> String {
    let time = if forecast.is_some() { "  time" } else { "" };
    format!("{:NAME$} {time}  because", "effect")
}

fn line(row: &Row, forecast: Option<&Forecast>) -> String {
    let share = match forecast.map(|forecast| forecast.share(row)) {
        None => String::new(),
        Some(None) => format!("{:6}", ""),
        Some(Some(share)) => format!("{:4.0} %", 100.0 * share),
    };
    let stages: Vec<&str> = row.stages.iter().map(|stage| stage.name()).collect();
    let source = row.source.as_ref().map_or(String::new(), |source| format!("  {source}"));
    let runs = if row.on { format!("  [{}]", stages.join(", ")) } else { String::new() };
    format!("  {:width$} {share}  {}{source}{runs}", row.effect, row.reason, width = NAME - 2)
}

/// How long it will take, and what is lost.
fn outlook(prepared: &Prepared, forecast: &Forecast) -> Vec<String> {
    let seconds = forecast.seconds(prepared.paths());
    let spared = forecast.spared();
    // Within a twentieth it is the machine's noise.
    let spared = match spared > 1.05 {
        true => format!("{spared:.1} times as long if everything ran"),
        false => "about as long if everything ran".into(),
    };
    let mut lines = vec![
        "  (a ray may be in the time of several rows: that of its light, and of shadows)".into(),
        format!("predicted: {seconds:.1} s of all threads together; {spared}"),
    ];
    if let Some(dropped) = forecast.dropped(&prepared.settings.effects) {
        let left: Vec<&str> = prepared.settings.effects.left_out().map(|e| e.name()).collect();
        let what = left.join(", ");
        let about = (100.0 * dropped).max(0.0);
        lines.extend(wrapped(&format!("left out: {what}: about {about:.0} % of the light")));
    }
    lines
}

/// Broken between words.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            Some(_) => lines.push(format!("  {word}")),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}
