//! The architecture as tests. ARCHITECTURE.md numbers the same rules and gives their reasons.
//!
//! A rule is a function from a source to what is wrong with it. This file applies the rules to the
//! repository; `each_rule_can_fail` applies them to snippets that break them.

mod each_rule_can_fail;
mod modules;
mod source;

use modules::{FOR_TESTS, TABLE, allowed, uses};
use source::Source;
use std::path::Path;

/// What breaks a rule, as `path:line: what`.
type Violations = Vec<String>;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).expect(path)
}

/// Applies a rule to every source of the repository.
fn check(rule: impl Fn(&Source) -> Violations) {
    let folders = ["src", "tests", "benches"];
    let mut sources: Vec<_> = folders.iter().flat_map(|f| Source::below(root(), f)).collect();
    sources.push(Source::new("build.rs", read("build.rs")));
    assert!(sources.len() > 20, "these are not all sources");
    let violations: Violations = sources.iter().flat_map(rule).collect();
    assert!(violations.is_empty(), "\n{}\n", violations.join("\n"));
}

// Rule 1: modules use only modules above them.

#[test]
fn rule_1_modules_use_only_what_the_table_allows() {
    check(module_edges);
}

fn module_edges(file: &Source) -> Violations {
    let module = file.module();
    if !file.in_src() || module == "lib" {
        return Vec::new();
    }
    let Some(allowed) = allowed(module) else {
        return vec![format!("{}:1: `{module}` is not in the table of modules", file.path)];
    };
    let allowed: Vec<_> = allowed.collect();
    let for_tests: Vec<_> = FOR_TESTS.split_whitespace().collect();
    uses(file)
        .iter()
        .filter(|u| !allowed.contains(&u.name.as_str()))
        .filter(|u| !(u.in_test && for_tests.contains(&u.name.as_str())))
        .map(|u| format!("{}:{}: `{module}` must not use `{}`", file.path, u.line, u.name))
        .collect()
}

#[test]
fn rule_1_every_row_of_the_table_names_only_rows_above() {
    for (row, (module, uses)) in TABLE.iter().enumerate() {
        for used in uses.split_whitespace() {
            assert!(TABLE[..row].iter().any(|r| r.0 == used), "{module}: {used} is not above it");
        }
    }
}

#[test]
fn rule_1_the_crate_lists_its_modules_in_the_order_of_the_table() {
    let crate_root = Source::new("src/lib.rs", read("src/lib.rs"));
    let listed = (0..crate_root.tokens.len()).filter(|&i| crate_root.before(i) == "mod");
    let listed: Vec<_> = listed.map(|i| crate_root.token(i)).collect();
    let in_order = TABLE.iter().map(|row| row.0).filter(|module| listed.contains(module));
    assert_eq!(listed, in_order.collect::<Vec<_>>());
}

#[test]
fn rule_1_the_table_in_architecture_md_is_the_same() {
    let text = read("ARCHITECTURE.md");
    for (module, uses) in TABLE {
        let exists =
            ["", "/mod"].iter().any(|m| root().join(format!("src/{module}{m}.rs")).exists());
        let row = format!("| `{module}` | {uses} |");
        let rows = text.lines().filter(|line| line.starts_with(&row)).count();
        assert_eq!(rows, usize::from(exists), "ARCHITECTURE.md, the row that begins with {row}");
    }
}

// Rule 2: every file begins by saying what it is.

#[test]
fn rule_2_every_file_begins_with_what_it_is() {
    check(first_line);
}

fn first_line(file: &Source) -> Violations {
    let says = file.text.strip_prefix("//! ").is_some_and(|rest| rest.len() > 10);
    violation(!says, file, 1, "begins without `//!` and what it is")
}

// Rule 3: one idea a file.

#[test]
fn rule_3_files_are_short() {
    check(length);
}

fn length(file: &Source) -> Violations {
    let has_tests = !file.in_src() || file.tokens.iter().any(|token| token.in_test);
    let limit = if has_tests { 600 } else { 400 };
    let lines = file.text.lines().count();
    violation(lines > limit, file, lines, &format!("more than {limit} lines"))
}

// Rule 4: `unsafe` has three homes, and each block its reason.

const UNSAFE_HOMES: [&str; 3] = ["src/accel/embree/", "src/accel/bvh/", "src/os/"];

#[test]
fn rule_4_unsafe_stays_at_home_and_says_why() {
    check(unsafe_code);
}

fn unsafe_code(file: &Source) -> Violations {
    let at_home = UNSAFE_HOMES.iter().any(|home| file.path.starts_with(home));
    let lines: Vec<_> = file.text.lines().collect();
    each(file, |i| {
        if file.token(i) != "unsafe" {
            None
        } else if !at_home {
            Some("`unsafe` outside of its three folders".to_owned())
        } else {
            let needs_reason = matches!(file.token(i + 1), "{" | "impl");
            let reason = has_safety_comment(&lines, file.tokens[i].line);
            (needs_reason && !reason).then(|| "`unsafe` without a SAFETY comment".to_owned())
        }
    })
}

/// Whether a SAFETY comment stands on `line` (from 1), or right above the statement that it belongs to.
fn has_safety_comment(lines: &[&str], line: usize) -> bool {
    let above = lines[..line].iter().rev().enumerate().take_while(|(i, text)| {
        let ends_another =
            text.trim_end().ends_with([';', '{', '}', ',']) || text.trim().is_empty();
        *i == 0 || text.trim_start().starts_with("//") || !ends_another
    });
    above.into_iter().any(|(_, text)| text.contains("SAFETY:"))
}

// Rule 5: transcendental functions are `math`'s own, and products are rounded.

/// Methods of `f32` and `f64` whose last bit is the C library's or the CPU's to choose.
const TRANSCENDENTAL: &str = "sin cos tan asin acos atan atan2 sin_cos sinh cosh tanh asinh acosh atanh \
    exp exp2 exp_m1 ln ln_1p log log2 log10 powf cbrt hypot";

/// glam's functions that call them, besides those of the same name and `from_rotation_*`.
const TRANSCENDENTAL_IN_GLAM: &str = "from_angle from_axis_angle from_euler from_scaled_axis \
    from_scale_angle_translation from_angle_translation to_angle to_axis_angle to_euler to_scaled_axis \
    angle_between angle_to slerp rotate_axis rotate_towards rotate_x rotate_y rotate_z";

#[test]
fn rule_5_transcendental_functions_are_our_own() {
    check(transcendentals);
}

fn transcendentals(file: &Source) -> Violations {
    let listed = |list: &str, word: &str| list.split_whitespace().any(|w| w == word);
    each(file, |i| {
        let (before, name) = (file.before(i), file.token(i));
        let of_float = before == "::" && i > 1 && matches!(file.token(i - 2), "f32" | "f64");
        let called = before == "." && matches!(file.token(i + 1), "(" | "::");
        let of_std = (called || of_float) && listed(TRANSCENDENTAL, name);
        let of_glam = (called || before == "::")
            && (listed(TRANSCENDENTAL_IN_GLAM, name) || name.starts_with("from_rotation_"))
            || file.at(i, &["glam", "::", "camera"])
            || file.at(i, &["glam", "::", "dcamera"]);
        let of_libm = name == "libm" && file.module() != "math";
        let outside_tests = file.in_src() && !file.tokens[i].in_test;
        let fused = file.in_src() && name == "mul_add";
        ((of_std || of_glam || of_libm) && outside_tests || fused)
            .then(|| format!("`{name}` depends on the machine; `math::fun` does not"))
    })
}

// Rule 6: only the command line prints.

#[test]
fn rule_6_only_the_command_line_prints() {
    check(printing);
}

fn printing(file: &Source) -> Violations {
    let may_print = !file.in_src() || matches!(file.module(), "cli" | "main");
    each(file, |i| {
        let name = file.token(i);
        let prints = match name {
            "print" | "println" | "eprint" | "eprintln" | "dbg" => file.token(i + 1) == "!",
            "stdout" | "stderr" => file.token(i + 1) == "(",
            _ => false,
        };
        (prints && !may_print).then(|| format!("`{name}` outside of `cli`"))
    })
}

// Rule 7: files are read and written in few places.

const FILE_USERS: [&str; 6] = ["load", "image", "film", "study", "batch", "cli"];

#[test]
fn rule_7_few_modules_touch_files() {
    check(file_access);
}

fn file_access(file: &Source) -> Violations {
    let may = !file.in_src() || FILE_USERS.contains(&file.module());
    each(file, |i| {
        let name = file.token(i);
        let touches = match name {
            "fs" => file.before(i) == "::" || file.token(i + 1) == "::",
            "File" => file.token(i + 1) == "::",
            "OpenOptions" | "AtomicWriteFile" => true,
            _ => false,
        };
        (touches && !may && !file.tokens[i].in_test)
            .then(|| format!("`{name}`: `{}` must not touch files", file.module()))
    })
}

// Rule 8: nothing is left for later.

/// Spelled so that this file keeps the rule.
const LEFT_FOR_LATER: [&str; 5] = [
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
    concat!("to", "do!"),
    concat!("unimpl", "emented!"),
    concat!("(to ", "be "),
];

#[test]
fn rule_8_nothing_is_left_for_later() {
    check(left_for_later);
    for path in [
        "x",
        ".ci/run",
        "tests/debian13.sh",
        "Cargo.toml",
        "ffi/embree_shim.c",
        "ffi/embree_shim.h",
    ] {
        assert_eq!(left_for_later(&Source::new(path, read(path))), Violations::new());
    }
}

fn left_for_later(file: &Source) -> Violations {
    let lines = file.text.lines().enumerate();
    let found = lines.flat_map(|(i, line)| LEFT_FOR_LATER.map(|word| (i + 1, line, word)));
    found
        .filter(|(_, line, word)| line.contains(word))
        .map(|(line, _, word)| format!("{}:{line}: `{word}`", file.path))
        .collect()
}

// Rule 9: every scene is introduced.

#[test]
fn rule_9_every_scene_is_introduced() {
    let scenes = root().join("scenes");
    let folders = std::fs::read_dir(&scenes).into_iter().flatten().map(|entry| entry.unwrap());
    let names = folders.filter(|entry| entry.path().is_dir()).map(|entry| entry.file_name());
    let names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
    if !names.is_empty() {
        assert_eq!(not_introduced(&names, &read("scenes/README.md")), Violations::new());
    }
}

fn not_introduced(scenes: &[String], text: &str) -> Violations {
    let named = |name| [format!("`{name}`"), format!("{name}/")].iter().any(|n| text.contains(n));
    scenes.iter().filter(|name| !named(*name)).cloned().collect()
}

// What the rules are made of.

fn violation(broken: bool, file: &Source, line: usize, what: &str) -> Violations {
    if broken { vec![format!("{}:{line}: {what}", file.path)] } else { Vec::new() }
}

/// The complaints of `rule` about each token of the file.
fn each(file: &Source, rule: impl Fn(usize) -> Option<String>) -> Violations {
    let complaint = |i: usize| Some(format!("{}:{}: {}", file.path, file.tokens[i].line, rule(i)?));
    (0..file.tokens.len()).filter_map(complaint).collect()
}
