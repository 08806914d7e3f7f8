//! Who may use whom: the crate's modules as a table, and the uses that a file makes of other modules.

use super::source::Source;

/// The modules in reading order, each with those that it may use: all of them rows above its own, so there
/// is no cycle. ARCHITECTURE.md holds the same table with a word on each.
pub(super) const TABLE: &[(&str, &str)] = &[
    // Tools.
    ("error", ""),
    ("math", ""),
    ("sampling", "error math"),
    ("image", "error math"),
    ("ledger", "error math"),
    ("os", "error"),
    // Models: pure types and functions that know no scene.
    ("geometry", "error math"),
    ("texture", "error math sampling image"),
    ("bsdf", "error math sampling"),
    ("light", "error math sampling image geometry texture"),
    ("camera", "error math sampling geometry"),
    ("filter", "error math sampling"),
    // Stages, in the order of the data.
    ("scene", "error math sampling image"),
    ("load", "error math sampling image os geometry bsdf filter scene"),
    ("accel", "error math ledger os geometry"),
    (
        "world",
        "error math sampling image ledger geometry texture bsdf light camera filter scene accel",
    ),
    ("plan", "error math sampling ledger light scene world"),
    (
        "trace",
        "error math sampling ledger os geometry texture bsdf light camera filter scene accel world plan",
    ),
    ("film", "error math sampling image ledger filter"),
    (
        "render",
        "error math sampling image ledger os geometry camera filter scene accel world plan trace film",
    ),
    // Uses.
    ("lab", "error math sampling image filter"),
    ("generate", "error math sampling os geometry scene"),
    (
        "study",
        "error math sampling image ledger os geometry scene load accel world plan trace film render lab",
    ),
    ("batch", "error math image ledger os scene load accel world plan film render"),
    // Front end.
    (
        "cli",
        "error math sampling image ledger os geometry camera filter scene load accel world plan trace film \
         render lab generate study batch",
    ),
    ("main", "cli"),
];

/// What the unit tests of every module may use besides.
pub(super) const FOR_TESTS: &str = "error math sampling";

/// The modules that `module` may use.
pub(super) fn allowed(module: &str) -> Option<impl Iterator<Item = &'static str>> {
    TABLE.iter().find(|row| row.0 == module).map(|row| row.1.split_whitespace())
}

/// A path in a file that leads out of its own module.
#[derive(Debug, PartialEq)]
pub(super) struct Use {
    /// The first name after the crate's root: a module, `*` for all of them, `crate` for a new name of it.
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) in_test: bool,
}

/// Every path of the file that starts at the crate's root, however it is spelled (`crate::`, `super::`, in
/// braces, inside an expression), and leads to another module.
pub(super) fn uses(file: &Source) -> Vec<Use> {
    let mut uses = Vec::new();
    for (i, token) in file.tokens.iter().enumerate() {
        let renames_root = file.at(i, &["crate", "as"]);
        if file.before(i) == "::" || file.token(i + 1) != "::" && !renames_root {
            continue;
        }
        let depth = file.depth() + token.inline_modules;
        // Climb towards the root; the rest of the path begins at `next`.
        let (climbed, next) = match token.text.as_str() {
            "crate" if renames_root => (depth, i),
            "crate" => (depth, i + 2),
            "glint" if file.module() == "main" => (depth, i + 2),
            "self" | "super" => {
                let mut next = i + if token.text == "self" { 2 } else { 0 };
                let mut climbed = 0;
                while file.at(next, &["super", "::"]) {
                    climbed += 1;
                    next += 2;
                }
                (climbed, next)
            }
            _ => continue,
        };
        if climbed < depth || depth == 0 && token.text == "self" {
            continue;
        }
        for name in names(file, next) {
            if name != file.module() {
                uses.push(Use { name, line: token.line, in_test: token.in_test });
            }
        }
    }
    uses
}

/// The first names of the path or of the paths in braces at `index`.
fn names(file: &Source, index: usize) -> Vec<String> {
    if file.token(index) != "{" {
        return vec![file.token(index).to_owned()];
    }
    let (mut names, mut nesting, mut index) = (Vec::new(), 0, index);
    loop {
        let token = file.token(index);
        match token {
            "{" => nesting += 1,
            "}" => nesting -= 1,
            _ if nesting == 1 && matches!(file.before(index), "{" | ",") => {
                names.push(token.to_owned());
            }
            _ => {}
        }
        if nesting == 0 || token.is_empty() {
            return names;
        }
        index += 1;
    }
}
