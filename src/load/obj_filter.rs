//! Stands between an OBJ file and the parser: a reader of text in which the parser finds nothing amiss.
//!
//! What is amiss, and everything else that the parser need not see, stays with [`super::obj_scan`].

use super::line_filter::Statements;
use super::obj_scan::Scan;
use crate::error::{Error, Result};
use std::io::{BufRead, Read};

/// Clean text made at a time, in bytes.
const OUTPUT_BYTES: usize = 1 << 15;

/// The clean text of an OBJ file, to be read by the parser.
#[derive(Debug)]
pub(super) struct ObjFilter<R> {
    statements: Statements<R>,
    scan: Scan,
    output: Vec<u8>,
    consumed: usize,
    failure: Option<Error>,
}

impl<R: BufRead> ObjFilter<R> {
    /// Filters `statements`.
    pub(super) fn new(statements: Statements<R>) -> Self {
        let scan = Scan::new(statements.path().to_path_buf());
        Self { statements, scan, output: Vec::new(), consumed: 0, failure: None }
    }

    /// What was found, after everything was read.
    ///
    /// # Errors
    /// What kept the file from being read to its end.
    pub(super) fn finish(self) -> Result<Scan> {
        self.failure.map_or(Ok(self.scan), Err)
    }

    fn refill(&mut self) -> Result<()> {
        self.output.clear();
        self.consumed = 0;
        while self.output.len() < OUTPUT_BYTES {
            let Some(statement) = self.statements.next()? else { break };
            self.scan.accept(statement, &mut self.output);
        }
        Ok(())
    }
}

impl<R: BufRead> BufRead for ObjFilter<R> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.consumed == self.output.len()
            && let Err(error) = self.refill()
        {
            self.failure = Some(error);
            return Err(std::io::Error::other("see ObjFilter::finish"));
        }
        Ok(&self.output[self.consumed..])
    }

    fn consume(&mut self, amount: usize) {
        self.consumed += amount;
    }
}

impl<R: BufRead> Read for ObjFilter<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let available = self.fill_buf()?;
        let n = available.len().min(buffer.len());
        buffer[..n].copy_from_slice(&available[..n]);
        self.consume(n);
        Ok(n)
    }
}
