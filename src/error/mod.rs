//! The one error type of the library, and the warnings that a load collects.
//!
//! Every error that a user can cause says where (file and line, when there is one), what was found
//! there, and what to do. Printing is the front end's job: nothing here writes to a terminal.

mod names;

pub use names::unknown_name;
pub(crate) use names::{advice, named_set, quoted};

use std::fmt;
use std::path::{Path, PathBuf};

/// Result of every fallible function of the library.
pub type Result<T> = std::result::Result<T, Error>;

/// A place in a file that a user wrote. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Location {
    /// The file, as the user named it.
    pub path: PathBuf,
    /// Line, from 1; 0 when the whole file is meant.
    pub line: usize,
}

impl Location {
    /// The place `line` of `path`; line 0 means the whole file.
    pub fn new(path: impl AsRef<Path>, line: usize) -> Self {
        Self { path: path.as_ref().to_path_buf(), line }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.path.display()),
            line => write!(f, "{}:{line}", self.path.display()),
        }
    }
}

/// Something in the input that was dropped, repaired or replaced; the render goes on without it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where it is, when it is in a file.
    pub location: Option<Location>,
    /// What was found and what was done about it.
    pub message: String,
}

impl Warning {
    /// A warning about `line` of `path`.
    pub fn at(path: impl AsRef<Path>, line: usize, message: impl Into<String>) -> Self {
        Self { location: Some(Location::new(path, line)), message: message.into() }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.location {
            Some(location) => write!(f, "{location}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

/// Why a job cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The operating system refused to read or write a file.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: "read", "write", "create".
        action: &'static str,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A text file does not say what it should.
    #[error("{location}: {message}{}", excerpt(location.line, text))]
    Parse {
        /// Where.
        location: Location,
        /// The offending line of text.
        text: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// The scene is well-formed but cannot be rendered.
    #[error("{0}")]
    Scene(String),
    /// An acceleration backend failed, in its own words.
    #[error("{backend}: {message}")]
    Backend {
        /// `embree` or `bvh`.
        backend: &'static str,
        /// Its own message.
        message: String,
    },
    /// An image file cannot be decoded or encoded.
    #[error("{}: {message}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// The command line asks for something that does not exist.
    #[error("{0}")]
    Usage(String),
}

impl Error {
    /// An I/O error on `path` while trying to `action`.
    pub fn io(path: impl AsRef<Path>, action: &'static str, source: std::io::Error) -> Self {
        Self::Io { path: path.as_ref().to_path_buf(), action, source }
    }

    /// A parse error on `line` of `path`, whose text is `text`.
    pub fn parse(
        path: impl AsRef<Path>,
        line: usize,
        text: impl Into<String>,
        message: impl Into<String>,
    ) -> Self {
        Self::Parse {
            location: Location::new(path, line),
            text: text.into(),
            message: message.into(),
        }
    }

    /// An error about the image file `path`.
    pub fn image(path: impl AsRef<Path>, message: impl Into<String>) -> Self {
        Self::Image { path: path.as_ref().to_path_buf(), message: message.into() }
    }
}

/// The offending line under its number, cut to a readable length; nothing where there is none.
fn excerpt(line: usize, text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    let mut shown: String = text.trim_end().chars().take(120).collect();
    if shown.len() < text.trim_end().len() {
        shown.push('…');
    }
    match line {
        0 => format!("\n  | {shown}"),
        line => format!("\n  {line} | {shown}"),
    }
}
