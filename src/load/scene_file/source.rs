//! The text of a scene file, kept so that every error can quote the line that caused it.
//!
//! Turns byte spans of the TOML parser into lines, and the parser's messages into ones that say what
//! to write instead. Knows nothing of what the keys mean.

use crate::error::{Error, Location, Warning, advice, quoted, unknown_name};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene file's path and text.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    path: &'a Path,
    text: &'a str,
}

impl<'a> Source<'a> {
    /// The file `path`, whose contents are `text`.
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        Self { path, text }
    }

    /// The line, from 1, on which `span` begins.
    fn line(&self, span: &Range<usize>) -> usize {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }

    /// Where `span` begins.
    pub(super) fn location(&self, span: &Range<usize>) -> Location {
        Location::new(self.path, self.line(span))
    }

    /// An error about what stands at `span`.
    pub(super) fn error(&self, span: Range<usize>, message: impl Into<String>) -> Error {
        let line = self.line(&span);
        let text = self.text.lines().nth(line - 1).unwrap_or_default();
        Error::parse(self.path, line, text, message)
    }

    /// A warning about what stands at `span`.
    pub(super) fn warning(&self, span: Range<usize>, message: impl Into<String>) -> Warning {
        Warning { location: Some(self.location(&span)), message: message.into() }
    }

    /// An error about a name that is not among `known`; `what` is its kind ("material").
    pub(super) fn unknown_name<'n>(
        &self,
        span: Range<usize>,
        what: &str,
        name: &str,
        known: impl IntoIterator<Item = &'n str>,
    ) -> Error {
        self.error(span, unknown_name(what, name, known))
    }

    /// The path that `file` means: relative to the folder of the scene file.
    pub(super) fn resolve(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// The parser's error with file and line, and with its message completed by what would be right.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> Error {
        let span = error.span().unwrap_or(0..0);
        let message = error.message();
        let message = if let Some(message) = unknown_key(message) {
            message
        } else if let Some(key) = between(message, "missing field `", "`") {
            format!("missing key `{key}`: add it to this table")
        } else if message.starts_with("duplicate key") {
            let key = self.text.get(span.clone()).unwrap_or_default();
            format!("`{key}` is defined twice: rename or remove one of them")
        } else {
            message.to_owned()
        };
        self.error(span, message)
    }
}

/// The one of `kinds` that is given, or in words why it is not one.
pub(super) fn exactly_one<T, const N: usize>(kinds: [(&str, Option<T>); N]) -> Result<T, String> {
    let names = kinds.each_ref().map(|kind| kind.0);
    let given = kinds.into_iter().filter_map(|(name, kind)| Some((name, kind?)));
    let (given_names, mut given): (Vec<&str>, Vec<T>) = given.unzip();
    if given.len() > 1 {
        return Err(format!("has {} at once: keep one of them", quoted(&given_names)));
    }
    given.pop().ok_or_else(|| format!("needs one of {}", quoted(&names)))
}

/// serde's "unknown field `a`, expected one of `b`, `c`", with a suggestion.
fn unknown_key(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field `")?;
    let (name, expected) = rest.rsplit_once("`, expected ").or_else(|| rest.split_once("`, "))?;
    // The alternatives are what stands between pairs of backticks.
    let allowed: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    Some(format!("unknown key `{name}`{}", advice(name, &allowed, "Allowed here")))
}

/// What stands between `start` at the beginning of `text` and the next `end`.
fn between<'t>(text: &'t str, start: &str, end: &str) -> Option<&'t str> {
    text.strip_prefix(start)?.split_once(end).map(|found| found.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_unknown_key_is_understood() {
        let one = unknown_key("unknown field `fil`, expected `file`").unwrap();
        assert_eq!(one, "unknown key `fil`; did you mean `file`? Allowed here: `file`");
        let two = unknown_key("unknown field `q`, expected `ab` or `cd`").unwrap();
        assert_eq!(two, "unknown key `q`. Allowed here: `ab`, `cd`");
        let many = unknown_key("unknown field `a`b`, expected one of `x`, `y`, `z`").unwrap();
        assert_eq!(many, "unknown key `a`b`. Allowed here: `x`, `y`, `z`");
        let none = unknown_key("unknown field `q`, there are no fields").unwrap();
        assert_eq!(none, "unknown key `q`. Allowed here: none");
        assert_eq!(unknown_key("invalid type"), None);
    }
}
