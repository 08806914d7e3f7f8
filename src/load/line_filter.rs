//! Bytes of an OBJ or MTL file to statements: one clean line of text each, with its number.
//!
//! Hides all that editors and exporters do to text: a byte order mark, CR, LF or CRLF ends, lines
//! continued with a backslash, comments, tabs, Latin-1 letters. Reads through a fixed buffer and
//! bounds the length of a line, so memory does not grow with the file. Must not know what a statement means.

use super::progress::{Counted, Progress};
use crate::error::{Error, Result};
use crate::image::open_regular;
use std::borrow::Cow;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};

/// Longest statement, in bytes: a polygon of a million corners fits, a disc image does not.
const LONGEST_STATEMENT: usize = 1 << 24;

/// Bytes read at a time.
const BUFFER_BYTES: usize = 1 << 16;

/// A statement that is neither empty nor a comment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    /// Line that it starts on, from 1.
    pub(super) line: usize,
    /// All of it, without the blanks around it.
    pub(super) text: &'a str,
    /// The first word.
    pub(super) keyword: &'a str,
    /// What follows the keyword, from the blank on.
    rest: &'a str,
}

impl<'a> Statement<'a> {
    fn new(line: usize, text: &'a str) -> Self {
        let text = text.trim();
        let (keyword, rest) = text.split_at(text.find(char::is_whitespace).unwrap_or(text.len()));
        Self { line, text, keyword, rest }
    }

    /// What follows the keyword, as numbers: a `#` after a blank starts a comment.
    pub(super) fn numbers(&self) -> &'a str {
        self.before_comment(|_| true)
    }

    /// What follows the keyword, as a name. Names may contain spaces and `#` ("Material #25"), so a
    /// comment is only what stands behind a `#` between blanks.
    pub(super) fn name(&self) -> &'a str {
        self.before_comment(|after| after.is_empty() || after.starts_with(char::is_whitespace))
    }

    fn before_comment(&self, starts_comment: impl Fn(&str) -> bool) -> &'a str {
        let rest = self.rest;
        let comment = rest.match_indices('#').find(|&(at, _)| {
            rest[..at].ends_with(char::is_whitespace) && starts_comment(&rest[at + 1..])
        });
        comment.map_or(rest, |(at, _)| &rest[..at]).trim()
    }
}

/// Reads the statements of a file one by one.
#[derive(Debug)]
pub(super) struct Statements<R> {
    reader: R,
    path: PathBuf,
    /// Lines read so far.
    line: usize,
    /// The last line ended in CR, so a LF that follows belongs to it.
    after_carriage_return: bool,
    bytes: Vec<u8>,
    text: String,
}

impl Statements<BufReader<File>> {
    /// Opens the regular file `path`.
    pub(super) fn open(path: &Path) -> Result<Self> {
        let file = open_regular(path)?;
        Ok(Self::new(BufReader::with_capacity(BUFFER_BYTES, file), path))
    }
}

impl<'p, 'a> Statements<BufReader<Counted<'p, 'a>>> {
    /// Opens the regular file `path`; `progress` counts what is read of it.
    pub(super) fn open_counted(path: &Path, progress: &'p Progress<'a>) -> Result<Self> {
        let file = Counted { file: open_regular(path)?, progress };
        Ok(Self::new(BufReader::with_capacity(BUFFER_BYTES, file), path))
    }
}

impl<R: BufRead> Statements<R> {
    /// Reads from `reader`; `path` is for messages.
    pub(super) fn new(reader: R, path: &Path) -> Self {
        Self {
            reader,
            path: path.to_path_buf(),
            line: 0,
            after_carriage_return: false,
            bytes: Vec::new(),
            text: String::new(),
        }
    }

    /// The file, as the user named it.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The next statement, `None` at the end.
    ///
    /// # Errors
    /// When the file cannot be read, holds a zero byte or has a line beyond all measure.
    pub(super) fn next(&mut self) -> Result<Option<Statement<'_>>> {
        let line = loop {
            self.bytes.clear();
            let line = self.line + 1;
            if !self.append_line()? {
                return Ok(None);
            }
            if line == 1 && self.bytes.starts_with(b"\xef\xbb\xbf") {
                self.bytes.drain(..3);
            }
            // A comment is never continued: exporters put paths that end in a backslash there.
            match self.bytes.trim_ascii_start().first() {
                None | Some(b'#') => {}
                Some(_) => break line,
            }
        };
        while self.bytes.trim_ascii_end().ends_with(b"\\") {
            let end = self.bytes.trim_ascii_end().len() - 1;
            self.bytes.truncate(end);
            self.bytes.push(b' ');
            if !self.append_line()? {
                break;
            }
        }
        let text = match std::str::from_utf8(&self.bytes) {
            Ok(text) => text,
            // Latin-1: its 256 codes are the first 256 of Unicode.
            Err(_) => {
                self.text.clear();
                self.text.extend(self.bytes.iter().map(|&b| char::from(b)));
                &self.text
            }
        };
        Ok(Some(Statement::new(line, text)))
    }

    /// Appends the next line without its end to `bytes`; false at the end of the file.
    fn append_line(&mut self) -> Result<bool> {
        let mut started = false;
        loop {
            let available = match self.reader.fill_buf() {
                Ok(available) => available,
                Err(e) if e.kind() == ErrorKind::Interrupted => continue,
                Err(e) => return Err(Error::io(&self.path, "read", e)),
            };
            if std::mem::take(&mut self.after_carriage_return) && available.first() == Some(&b'\n')
            {
                self.reader.consume(1);
                continue;
            }
            if available.is_empty() {
                return Ok(started);
            }
            if !std::mem::replace(&mut started, true) {
                self.line += 1;
            }
            let end = available.iter().position(|b| matches!(b, b'\n' | b'\r' | 0));
            let length = end.unwrap_or(available.len());
            self.bytes.extend_from_slice(&available[..length]);
            let terminator = end.map(|end| available[end]);
            self.reader.consume(length + usize::from(end.is_some()));
            if terminator == Some(0) {
                return Err(self.unreadable(
                    "this is not a text file (it has a zero byte here); \
                     if it is UTF-16, save it as UTF-8",
                ));
            }
            if self.bytes.len() > LONGEST_STATEMENT {
                return Err(self.unreadable("this line is longer than 16 MiB; is it a text file?"));
            }
            if let Some(terminator) = terminator {
                self.after_carriage_return = terminator == b'\r';
                return Ok(true);
            }
        }
    }

    fn unreadable(&self, message: &str) -> Error {
        let start = &self.bytes[..self.bytes.len().min(200)];
        Error::parse(&self.path, self.line, printable(&String::from_utf8_lossy(start)), message)
    }
}

/// `text` with control characters replaced, so that showing it cannot upset a terminal.
pub(super) fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().any(char::is_control) {
        let shown = |c: char| match c {
            '\t' => ' ',
            c if c.is_control() => char::REPLACEMENT_CHARACTER,
            c => c,
        };
        Cow::Owned(text.chars().map(shown).collect())
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statements(bytes: &[u8]) -> Vec<(usize, String)> {
        // A tiny buffer, so that every line is read in pieces.
        let reader = BufReader::with_capacity(3, bytes);
        let mut reader = Statements::new(reader, Path::new("test.obj"));
        let mut all = Vec::new();
        while let Some(s) = reader.next().unwrap() {
            all.push((s.line, s.text.to_string()));
        }
        all
    }

    #[test]
    fn every_line_end_and_the_byte_order_mark() {
        let expected = [(1, "v 1 2 3"), (3, "f 1"), (4, "g")].map(|(l, t)| (l, t.to_string()));
        assert_eq!(statements(b"v 1 2 3\n\nf 1\ng"), expected);
        assert_eq!(statements(b"v 1 2 3\r\n\r\nf 1\r\ng\r\n"), expected);
        assert_eq!(statements(b"v 1 2 3\r\rf 1\rg\r"), expected);
        assert_eq!(statements(b"\xef\xbb\xbfv 1 2 3\n\n \tf 1 \ng"), expected);
    }

    #[test]
    fn continued_lines_keep_the_number_of_the_first() {
        let found = statements(b"f 1 2\\\n 3 \\  \r\n4\ng a\\");
        assert_eq!(found, [(1, "f 1 2  3  4".to_string()), (4, "g a".to_string())]);
    }

    #[test]
    fn comments_do_not_continue() {
        let found = statements(b"# C:\\models\\\nv 1 2 3\n  # x\\\nf");
        assert_eq!(found, [(2, "v 1 2 3".to_string()), (4, "f".to_string())]);
    }

    #[test]
    fn latin_1_letters_survive() {
        assert_eq!(statements(b"usemtl caf\xe9"), [(1, "usemtl café".to_string())]);
        assert_eq!(statements("usemtl café".as_bytes()), [(1, "usemtl café".to_string())]);
    }

    #[test]
    fn names_keep_their_number_signs() {
        let statement = |text| Statement::new(1, text);
        assert_eq!(statement("usemtl Material #25").name(), "Material #25");
        assert_eq!(statement("usemtl\tred # the red one").name(), "red");
        assert_eq!(statement("usemtl #").name(), "");
        assert_eq!(statement("f 1 2 3 #x").numbers(), "1 2 3");
        assert_eq!(statement("vn 0 0 1.#IND").numbers(), "0 0 1.#IND");
    }

    #[test]
    fn binary_files_are_refused() {
        let mut reader = Statements::new(&b"v 1\n\x01\0\x02"[..], Path::new("x.obj"));
        assert!(reader.next().is_ok());
        let message = reader.next().unwrap_err().to_string();
        assert!(message.starts_with("x.obj:2: this is not a text file"), "{message}");
    }

    #[test]
    fn endless_lines_are_refused() {
        let endless = BufReader::new(std::io::Read::take(std::io::repeat(b'a'), 1 << 30));
        assert!(Statements::new(endless, Path::new("x.obj")).next().is_err());
    }
}
