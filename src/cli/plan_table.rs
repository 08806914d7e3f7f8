//! The plan as a table for a terminal, at most 100 columns wide.

use crate::plan::{Plan, Row};

/// Columns of the table.
const WIDTH: usize = 100;
/// Columns of an effect's name.
const NAME: usize = 30;

/// The effects that are on, each with its reason, and in a few lines those that are off.
pub(super) fn lines(plan: &Plan) -> Vec<String> {
    let mut lines = vec!["effects that the scene calls for:".to_owned()];
    lines.extend(plan.rows.iter().filter(|row| row.on).map(on));
    let off: Vec<&str> = plan.rows.iter().filter(|row| !row.on).map(|row| row.effect).collect();
    if !off.is_empty() {
        lines.extend(wrapped(&format!("spared ({}): {}", reasons_are_in(), off.join(", "))));
    }
    lines
}

/// Where the reasons of what is off are to be read.
const fn reasons_are_in() -> &'static str {
    "`glint plan` says why"
}

fn on(row: &Row) -> String {
    let source = row.source.as_ref().map_or(String::new(), |source| format!("  ({source})"));
    format!("  {:NAME$} {}{source}", row.effect, row.reason)
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
