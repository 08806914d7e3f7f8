//! How far reading models has come: bytes read so far, and of how many.
//!
//! Only the bytes of OBJ files are counted: beside large models everything else is soon read.

use std::cell::Cell;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Counts what is read of the models of one scene; by default it tells nobody.
#[derive(Default)]
pub(super) struct Progress<'a> {
    report: Option<&'a dyn Fn(u64, u64)>,
    read: Cell<u64>,
    total: u64,
}

impl<'a> Progress<'a> {
    /// Reading all of `files`, which `report` is told of as bytes read and bytes in all.
    pub(super) fn of(
        files: impl IntoIterator<Item: AsRef<Path>>,
        report: Option<&'a dyn Fn(u64, u64)>,
    ) -> Self {
        let sizes = files.into_iter().filter_map(|f| Some(f.as_ref().metadata().ok()?.len()));
        Self { report, read: Cell::new(0), total: sizes.sum() }
    }

    fn add(&self, bytes: u64) {
        // A file may grow while it is read.
        self.read.set((self.read.get() + bytes).min(self.total));
        if let Some(report) = self.report {
            report(self.read.get(), self.total);
        }
    }
}

/// A file whose reading counts.
pub(super) struct Counted<'p, 'a> {
    pub(super) file: File,
    pub(super) progress: &'p Progress<'a>,
}

impl Read for Counted<'_, '_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = self.file.read(buffer)?;
        self.progress.add(bytes as u64);
        Ok(bytes)
    }
}
