//! Warnings in the order of their discovery, with repetitions of one kind cut short.
//!
//! A broken exporter breaks every line: the first few of a kind are worth reading, then their number.

use crate::error::{Location, Warning};

/// How many warnings of one kind are listed one by one.
const LISTED: usize = 10;

/// Collects warnings of a load.
#[derive(Debug, Default)]
pub(super) struct WarningList {
    listed: Vec<Warning>,
    /// Each kind with the number of its warnings, in order of appearance.
    counts: Vec<(&'static str, usize)>,
}

impl WarningList {
    /// Adds a warning; `kind` names in the plural what is counted ("faces dropped").
    ///
    /// The message is only made when it is listed.
    pub(super) fn add(
        &mut self,
        kind: &'static str,
        location: Location,
        message: impl FnOnce() -> String,
    ) {
        let position = self.counts.iter().position(|(k, _)| *k == kind).unwrap_or_else(|| {
            self.counts.push((kind, 0));
            self.counts.len() - 1
        });
        let count = &mut self.counts[position].1;
        *count += 1;
        if *count <= LISTED {
            self.listed.push(Warning { location: Some(location), message: message() });
        }
    }

    /// All warnings; kinds that were cut short end with their number. `path` is the file that they are about.
    pub(super) fn finish(self, path: &std::path::Path) -> Vec<Warning> {
        let mut all = self.listed;
        for (kind, count) in self.counts {
            if count > LISTED {
                all.push(Warning::at(path, 0, format!("and {} more {kind}", count - LISTED)));
            }
        }
        all
    }
}
