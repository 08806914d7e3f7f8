//! Each rule of `tidy` against sources that break it, and against their innocent neighbours.

use super::*;

/// How many violations `rule` finds in a file of this content.
fn found(rule: fn(&Source) -> Violations, path: &str, text: &str) -> usize {
    rule(&Source::new(path, text)).len()
}

#[test]
fn forbidden_edges() {
    let found = |path, text| found(module_edges, path, text);
    // Every spelling of a use that points upwards.
    for (path, text) in [
        ("src/accel/mod.rs", "use crate::scene::Scene;"),
        ("src/accel/mod.rs", "use super::scene::Scene;"),
        ("src/accel/bvh/build.rs", "use super::super::super::scene::Scene;"),
        ("src/accel/mod.rs", "fn f(_: crate::scene::Scene) {}"),
        ("src/accel/mod.rs", "fn f() { self::super::scene::g() }"),
        ("src/accel/mod.rs", "macro_rules! m { () => { $crate::scene::f() } }"),
        ("src/accel/mod.rs", "pub(in crate::scene) fn f() {}"),
        ("src/accel/mod.rs", "use crate::{error::Result, geometry::{Ray, Hit}, scene};"),
        (
            "src/accel/mod.rs",
            "use crate::{\n    math::Vec3, // of scene\n    scene::{self, Scene},\n};",
        ),
        ("src/accel/mod.rs", "use {crate::math, crate::scene};"),
        ("src/accel/mod.rs", "mod inner { use super::super::scene::Scene; }"),
        ("src/accel/mod.rs", "#[cfg(test)] mod tests { use crate::scene::Scene; }"),
        ("src/accel/mod.rs", "use crate::*;"),
        ("src/accel/mod.rs", "use crate as everything;"),
        ("src/error/mod.rs", "use crate::math::Vec3;"),
        ("src/bsdf/lambert.rs", "use crate::world::World;"),
        ("src/light/mod.rs", "use crate::load;"),
        ("src/main.rs", "use glint::render;"),
        ("src/unlisted/mod.rs", ""),
    ] {
        assert_eq!(found(path, text), 1, "{path}: {text}");
    }
    for (path, text) in [
        ("src/accel/mod.rs", "use crate::geometry::{Ray, scene};"),
        ("src/accel/mod.rs", "// use crate::scene::Scene;\n/* crate::scene /* */ crate::load */"),
        (
            "src/accel/mod.rs",
            "const S: &str = \"crate::scene\"; const R: &str = r#\"\" crate::scene\"#;",
        ),
        (
            "src/accel/mod.rs",
            "pub(crate) fn f<'a>(c: char) { c == '\"' || c == '\\'' } use crate::math::A;",
        ),
        ("src/accel/mod.rs", "use crate::accel::bvh; mod inner { use super::scene; }"),
        ("src/accel/bvh/build.rs", "use super::scene::Scene; use super::super::bvh;"),
        ("src/accel/mod.rs", "#[cfg(test)] mod tests { use crate::sampling::CounterRng; }"),
        ("src/main.rs", "use glint::cli;"),
        ("tests/it/main.rs", "use crate::scene::Scene;"),
    ] {
        assert_eq!(found(path, text), 0, "{path}: {text}");
    }
    let not_a_test = "#[cfg(test)] fn f(_: [u8; 2]) {} use crate::sampling::CounterRng;";
    assert_eq!(found("src/accel/mod.rs", not_a_test), 1);
}

#[test]
fn silent_files() {
    assert_eq!(found(first_line, "src/a.rs", "use std::fmt;\n"), 1);
    assert_eq!(found(first_line, "src/a.rs", "//!\n"), 1);
    assert_eq!(found(first_line, "src/a.rs", "//! What it is for.\n"), 0);
}

#[test]
fn long_files() {
    let tests = "#[cfg(test)]\nmod tests {}\n";
    assert_eq!(found(length, "src/a.rs", &"\n".repeat(401)), 1);
    assert_eq!(found(length, "src/a.rs", &format!("{}{tests}", "\n".repeat(400))), 0);
    assert_eq!(found(length, "src/a.rs", &format!("{}{tests}", "\n".repeat(600))), 1);
    assert_eq!(found(length, "tests/a.rs", &"\n".repeat(600)), 0);
    assert_eq!(found(length, "tests/a.rs", &"\n".repeat(601)), 1);
}

#[test]
fn unsafe_away_from_home_or_without_reason() {
    let found = |path, text| found(unsafe_code, path, text);
    let with_reason = "fn f() {\n    // SAFETY: f is sound,\n    // always.\n    let x =\n        unsafe { g() };\n}";
    assert_eq!(found("src/os/a.rs", with_reason), 0);
    assert_eq!(found("src/world/a.rs", with_reason), 1);
    assert_eq!(found("tests/it/a.rs", with_reason), 1);
    assert_eq!(found("src/os/a.rs", "#![allow(unsafe_code)] // unsafe\nunsafe fn f() {}"), 0);
    assert_eq!(found("src/os/a.rs", "fn f() { unsafe { g() } }"), 1);
    assert_eq!(found("src/os/a.rs", "unsafe impl Send for A {}"), 1);
    let of_another = "// SAFETY: f is sound.\nunsafe { f() };\nunsafe { g() };";
    assert_eq!(found("src/os/a.rs", of_another), 1);
}

#[test]
fn transcendentals_of_the_machine() {
    let found = |text| found(transcendentals, "src/bsdf/a.rs", text);
    for text in [
        "x.sin()",
        "1.0.sin()",
        "x.0.exp()",
        "(2.0_f32).powf(x)",
        "xs.map(f32::ln)",
        "f64::atan2(y, x)",
        "a.mul_add(b, c)",
        "libm::sin(x)",
        "DMat3::from_rotation_x(a)",
        "DAffine3::from_axis_angle(v, a)",
        "v.angle_between(w)",
        "glam::camera::rh::proj::opengl::perspective(a, b, c, d)",
        "#[test] fn f() { a.mul_add(b, c) }",
    ] {
        assert_eq!(found(text), 1, "{text}");
    }
    for text in [
        "fun::sin(x)",
        "x.sqrt()",
        "x.powi(2)",
        "self.cos",
        "frame.cos_theta(w)",
        "let exp = 1;",
        "// x.sin()",
        "#[cfg(test)] mod tests { fn f(x: f64) -> f64 { x.sin() } }",
    ] {
        assert_eq!(found(text), 0, "{text}");
    }
}

#[test]
fn printing_from_within() {
    for text in ["println!(\"{x}\")", "eprint!(\"\")", "dbg!(x)", "std::io::stderr().lock()"] {
        assert_eq!(found(printing, "src/trace/a.rs", text), 1, "{text}");
        assert_eq!(found(printing, "src/cli/a.rs", text), 0, "{text}");
        assert_eq!(found(printing, "build.rs", text), 0, "{text}");
    }
    assert_eq!(found(printing, "src/trace/a.rs", "writeln!(f, \"println!\")"), 0);
}

#[test]
fn files_from_within() {
    for text in ["std::fs::read(p)", "use std::fs;", "File::open(p)", "OpenOptions::new()"] {
        assert_eq!(found(file_access, "src/world/a.rs", text), 1, "{text}");
        assert_eq!(found(file_access, "src/load/a.rs", text), 0, "{text}");
    }
    assert_eq!(found(file_access, "src/world/a.rs", "#[test] fn f() { File::open(p) }"), 0);
    assert_eq!(found(file_access, "src/os/a.rs", "fn map(file: &File) {}"), 0);
}

#[test]
fn leftovers() {
    for word in LEFT_FOR_LATER {
        assert_eq!(found(left_for_later, "src/a.rs", &format!("f();\n// {word}\n")), 1);
    }
    assert_eq!(found(left_for_later, "src/a.rs", "// total: done\n"), 0);
}

#[test]
fn scenes_without_introduction() {
    let scenes = ["furnace", "glass", "metals"].map(str::to_owned);
    assert_eq!(not_introduced(&scenes, "`furnace`: no metals. See glass/."), ["metals"]);
}
