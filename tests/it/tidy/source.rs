//! Rust sources as tokens, for the rules of `tidy`: comments, strings and characters taken out, test code
//! and inline modules marked. Enough of the language for these rules; no parser.

use std::path::Path;

/// One file.
pub(super) struct Source {
    /// Relative to the repository, with forward slashes.
    pub(super) path: String,
    pub(super) text: String,
    pub(super) tokens: Vec<Token>,
}

/// An identifier, a number, `::`, or a single character of punctuation.
#[derive(Debug)]
pub(super) struct Token {
    pub(super) text: String,
    /// Counted from 1.
    pub(super) line: usize,
    /// Inside an item marked `#[test]` or `#[cfg(test)]`.
    pub(super) in_test: bool,
    /// How many `mod name { }` of this file are around it.
    pub(super) inline_modules: usize,
}

impl Source {
    pub(super) fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        let (path, text) = (path.into(), text.into());
        let mut tokens = lex(&text);
        mark(&mut tokens);
        // A file of unit tests, announced where its module is declared.
        if path.ends_with("/tests.rs") || path.ends_with("_tests.rs") {
            tokens.iter_mut().for_each(|token| token.in_test = true);
        }
        Self { path, text, tokens }
    }

    /// Every `.rs` file below `folder` of the repository `root`, in order of path.
    pub(super) fn below(root: &Path, folder: &str) -> Vec<Self> {
        let mut sources = Vec::new();
        let mut folders = vec![root.join(folder)];
        while let Some(folder) = folders.pop() {
            // A folder that does not exist holds nothing.
            for entry in std::fs::read_dir(folder).into_iter().flatten() {
                let path = entry.expect("a folder of sources is readable").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|e| e == "rs") {
                    let relative = path.strip_prefix(root).unwrap_or(&path).to_string_lossy();
                    let text = std::fs::read_to_string(&path).expect("sources are UTF-8");
                    sources.push(Self::new(relative.replace('\\', "/"), text));
                }
            }
        }
        sources.sort_by(|a, b| a.path.cmp(&b.path));
        sources
    }

    /// Whether it belongs to the crate itself, not to its tests, benches or build script.
    pub(super) fn in_src(&self) -> bool {
        self.path.starts_with("src/")
    }

    /// The top-level module that it is or belongs to, such as `accel` for `src/accel/bvh/build.rs`.
    pub(super) fn module(&self) -> &str {
        let inside = self.path.strip_prefix("src/").unwrap_or(&self.path);
        let first = inside.split('/').next().unwrap_or(inside);
        first.strip_suffix(".rs").unwrap_or(first)
    }

    /// How many modules deep the file is: 0 for `src/lib.rs`, 1 for `src/accel/mod.rs`.
    pub(super) fn depth(&self) -> usize {
        let inside = self.path.strip_prefix("src/").unwrap_or(&self.path);
        match inside {
            "lib.rs" | "main.rs" => 0,
            _ => inside.split('/').count() - usize::from(inside.ends_with("/mod.rs")),
        }
    }

    /// The text of the token at `index`, or nothing beyond the end.
    pub(super) fn token(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text.as_str())
    }

    /// The text of the token before `index`, or nothing at the beginning.
    pub(super) fn before(&self, index: usize) -> &str {
        index.checked_sub(1).map_or("", |index| self.token(index))
    }

    /// Whether the tokens from `index` on are `words`.
    pub(super) fn at(&self, index: usize, words: &[&str]) -> bool {
        words.iter().enumerate().all(|(i, word)| self.token(index + i) == *word)
    }
}

fn lex(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let (mut rest, mut line) = (text, 1);
    while let Some(first) = rest.chars().next() {
        let skipped = match first {
            _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            _ if rest.starts_with("/*") => block_comment(rest),
            '\'' => character_or_lifetime(rest),
            _ if first.is_whitespace() => first.len_utf8(),
            _ => string(rest),
        };
        let length = if skipped > 0 {
            skipped
        } else {
            let length = token(rest, first);
            let text = rest[..length].to_owned();
            tokens.push(Token { text, line, in_test: false, inline_modules: 0 });
            length
        };
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    tokens
}

/// Length of the token that `rest` begins with.
fn token(rest: &str, first: char) -> usize {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    if rest.starts_with("::") {
        2
    } else if first.is_ascii_digit() {
        // A full stop belongs to a number only before a digit: not in `1..2` or `1.max(2)`.
        let digits = |s: &str| s.find(|c| !word(c)).unwrap_or(s.len());
        let whole = digits(rest);
        match rest[whole..].strip_prefix('.') {
            Some(fraction) if fraction.starts_with(|c: char| c.is_ascii_digit()) => {
                whole + 1 + digits(fraction)
            }
            _ => whole,
        }
    } else if word(first) {
        rest.find(|c| !word(c)).unwrap_or(rest.len())
    } else {
        first.len_utf8()
    }
}

/// Length of the block comment, which may hold others, that `rest` begins with.
fn block_comment(rest: &str) -> usize {
    let (mut at, mut open) = (2, 1);
    while open > 0 && at < rest.len() {
        let (length, change) = match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => (2, 1),
            [b'*', b'/', ..] => (2, -1),
            _ => (1, 0),
        };
        at += length;
        open += change;
    }
    at
}

/// Length of the string literal of any kind that `rest` begins with; 0 if it does not.
fn string(rest: &str) -> usize {
    let prefix =
        ["br", "cr", "b", "c", "r"].into_iter().find(|p| rest.starts_with(p)).unwrap_or("");
    let raw = prefix.ends_with('r');
    let quote =
        prefix.len() + rest[prefix.len()..].chars().take_while(|&c| raw && c == '#').count();
    if !rest[quote..].starts_with('"') {
        return 0;
    }
    let body = &rest[quote + 1..];
    let end = if raw {
        let end = format!("\"{}", &rest[prefix.len()..quote]);
        body.find(&end).map(|at| at + end.len())
    } else {
        let mut escaped = false;
        let quote = body.bytes().position(|b| {
            let ends = b == b'"' && !escaped;
            escaped = b == b'\\' && !escaped;
            ends
        });
        quote.map(|at| at + 1)
    };
    end.map_or(rest.len(), |end| quote + 1 + end)
}

/// Length of `'a'`, `'\''` or `'lifetime`.
fn character_or_lifetime(rest: &str) -> usize {
    let mut inside = rest[1..].chars();
    match (inside.next(), inside.next()) {
        (Some('\\'), Some(_)) => rest[3..].find('\'').map_or(rest.len(), |at| at + 4),
        (Some(c), Some('\'')) => c.len_utf8() + 2,
        _ => {
            1 + rest[1..].find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len() - 1)
        }
    }
}

/// Sets `in_test` and `inline_modules`.
fn mark(tokens: &mut [Token]) {
    let mut nesting = 0_usize;
    // The nesting outside of the test item, and outside of each inline module, that is open.
    let mut test: Option<usize> = None;
    let mut modules: Vec<usize> = Vec::new();
    // The nesting of the test item that an attribute has announced.
    let mut announced: Option<usize> = None;
    for i in 0..tokens.len() {
        if tokens[i].text == "#" {
            let attribute = attribute(&tokens[i..]);
            let has = |word| attribute.iter().any(|token| token.text == word);
            if has("test") && !has("not") && !has("cfg_attr") {
                announced = Some(nesting);
            }
        }
        let previous = |back: usize| i.checked_sub(back).map_or("", |i| tokens[i].text.as_str());
        let opens_module = previous(2) == "mod";
        tokens[i].inline_modules = modules.len();
        tokens[i].in_test = announced.is_some() || test.is_some();
        match tokens[i].text.as_str() {
            "{" => {
                if opens_module {
                    modules.push(nesting);
                }
                if let Some(outside) = announced.take() {
                    test.get_or_insert(outside);
                }
                nesting += 1;
            }
            "(" | "[" => nesting += 1,
            ")" | "]" | "}" => {
                nesting = nesting.saturating_sub(1);
                modules.pop_if(|outside| *outside == nesting && tokens[i].text == "}");
                test = test.filter(|outside| *outside != nesting || tokens[i].text != "}");
            }
            ";" => announced = announced.filter(|outside| *outside != nesting),
            _ => {}
        }
    }
}

/// The tokens from `#` to the first `]`.
fn attribute(tokens: &[Token]) -> &[Token] {
    let end = tokens.iter().position(|token| token.text == "]").unwrap_or(0);
    &tokens[..end]
}
