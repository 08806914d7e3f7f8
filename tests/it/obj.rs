//! OBJ files of every odd kind, against the slow parser of `support::reference_obj`.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may unwrap, and so may its helpers")]

use crate::support::reference_obj::{assert_same, parse};
use glint::error::{Error, Result};
use glint::load::{LoadedModel, load_obj};
use glint::math::DVec3;
use std::path::{Path, PathBuf};

/// Writes `files` to a folder of their own and loads the first.
fn load(files: &[(&str, &[u8])]) -> Result<LoadedModel> {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }
    load_obj(&folder.path().join(files[0].0))
}

/// The lines of the first file that warnings are about.
fn warned_lines(loaded: &LoadedModel) -> Vec<usize> {
    loaded.warnings.iter().filter_map(|w| Some(w.location.as_ref()?.line)).collect()
}

/// Loads an OBJ text, compares it with the reference and checks which lines are warned about.
fn check(name: &str, text: impl AsRef<[u8]>, lines: &[usize]) -> LoadedModel {
    let text = text.as_ref();
    let loaded = load(&[("model.obj", text)]).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_same(&loaded, &parse(text), name);
    assert_eq!(warned_lines(&loaded), lines, "{name}: {:#?}", loaded.warnings);
    loaded
}

/// Four vertices, texture coordinates and normals: lines 1 to 12.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                      vn 0 0 1\nvn 0 1 1\nvn 1 0 1\nvn 0 0 -2\n";

fn square(rest: &str) -> String {
    format!("{SQUARE}{rest}")
}

#[test]
fn corners_of_every_form() {
    check("positions only", square("f 1 2 3\n"), &[]);
    check("texture coordinates", square("f 1/1 2/2 3/3 4/4\n"), &[]);
    check("normals", square("f 1//1 2//2 3//3\n"), &[]);
    check("all", square("f 1/4/1 2/3/2 3/2/3 4/1/4\n"), &[]);
    check("trailing slashes", square("f 1/ 2/ 3//\nf 1/1/ 2/2/ 3/3/\n"), &[]);
    check("negative", square("f -4/-4/-4 -3/-3/-3 -2/-2/-2\nv 5 5 5\nf -1 -2 -4\n"), &[]);
    check("plus signs", square("f +1 +2 +3\n"), &[]);
    check("obsolete keyword", square("fo 1 2 3\n"), &[]);
    check("no newline at the end", square("f 1 2 3"), &[]);
    check("one-dimensional uv", square("vt 0.25\nvt 0.5 0.5 7\nf 1/5 2/6 3/1\n"), &[]);
    check("long normals", square("vn 1e300 1e300 0\nvn 0 1e-300 0\nf 1//5 2//6 3//5\n"), &[]);
}

#[test]
fn corners_that_disagree_lose_the_attribute_and_no_other() {
    check("some corners with uv", square("f 1/1 2 3/3\nf 1 2/2 3/3\n"), &[13, 14]);
    check("some corners with normals", square("f 1/1/1 2/2 3/3\nf 1//1 2 3\n"), &[13, 14]);
    let loaded =
        check("mixed faces", square("f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//2 3//3\nf 1 3 4\n"), &[]);
    assert_eq!(loaded.model.meshes.len(), 3, "one mesh for each set of attributes");
    assert_eq!(loaded.model.meshes[0].positions.len(), 3 + 3, "vertices of both its runs");
    let alternating = "f 1 2 3\nf 1/1 2/2 3/3\n".repeat(500);
    let loaded = check("alternating faces", square(&alternating), &[]);
    assert_eq!(loaded.model.meshes.len(), 2);
    // tobj would give the first normal of the file to corners without one.
    check("normals before faces without", square("f 2 3 4\nf 1//1 2//2 3//3\nf 4 3 2\n"), &[]);
}

#[test]
fn text_as_editors_and_exporters_write_it() {
    let text = square("usemtl red\nf 1 2 3\nf 1 3 4\n");
    let crlf = text.replace('\n', "\r\n");
    let warned = [13];
    check("LF", &text, &warned);
    check("CRLF", &crlf, &warned);
    check("CR", text.replace('\n', "\r"), &warned);
    check("mixed ends", text.replacen('\n', "\r\n", 5), &warned);
    check("byte order mark", format!("\u{feff}{text}"), &warned);
    check("tabs", text.replace(' ', "\t"), &warned);
    check("blanks", text.replace(' ', "  \t ").replace('\n', " \n  "), &warned);
    check("comments", text.replace('\n', " # 1 2 3\n# f 1 2 3 \\\n"), &[25]);
    check("empty lines", text.replace('\n', "\n\n \n"), &[37]);
    check("continued", square("f 1 2 \\\n3 \\\r\n4\nf 1\\\n2\\\n4\nf 9 \\\n1 2\n"), &[19]);
    check("continued at the end", square("f 1 2 3 \\"), &[]);
    check("Latin-1", [SQUARE.as_bytes(), b"# \xe9\xff\nusemtl caf\xe9\nf 1 2 3\n"].concat(), &[14]);
    check("names", square("o a b\ng ä # x\nusemtl Material #25\nf 1 2 3\ng\no\nf 1 3 4\n"), &[15]);
}

#[test]
fn what_is_no_polygon_is_passed_over() {
    check("points and lines", square("p 1 2\nl 1 2 3\nl 1/1 2/2\nf 1 2 3\n"), &[]);
    check("colours", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", &[]);
    check("some colours", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0.5 0.5\nf 1 2 3\n", &[]);
    check("weights", "v 0 0 0 1\nv 1 0 0 0\nv 0 1 0 0.5\nf 1 2 3\n", &[]);
    check("groups", square("g a b\ns 1\nmg 1 1\no x\nf 1 2 3\ns off\ng\nf 1 3 4\n"), &[]);
    check("hints", square("lod 3\nbevel on\nusemap x\nshadow_obj a.obj\nf 1 2 3\n"), &[]);
    check(
        "free-form",
        square("vp 0 1\ncstype bezier\ndeg 3 3\nsurf 0 1 0 1 1 2 3\nend\nf 1 2 3\n"),
        &[16],
    );
    check("unknown", square("F 1 2 3\nhello world\nf 1 2 3\n"), &[13, 14]);
}

#[test]
fn broken_faces_are_dropped_with_their_line() {
    let broken = [
        "f 1 2 5",
        "f 0 1 2",
        "f 1 2 -5",
        "f 1/5 2/1 3/1",
        "f 1/0 2/1 3/1",
        "f 1//9 2//1 3//1",
        "f",
        "f 1",
        "f 1 2",
        "f 1 2 x",
        "f 1.0 2 3",
        "f 1/1/1/1 2 3",
        "f /1 /2 /3",
        "f // // //",
        "f 1 2 99999999999999999999",
        "f 1 2 9223372036854775807",
        "f 1 2 -9223372036854775808",
        "f 1//9223372036854775807 2 3",
        "f 1 2 3#x",
        "f 1, 2, 3",
        "f nan 1 2",
    ];
    for line in broken {
        check(line, square(&format!("f 1 2 3\n{line}\nf 1 3 4\n")), &[14]);
    }
    check("used before it is defined", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[1]);
}

#[test]
fn unusable_elements_do_not_shift_the_others() {
    for vertex in ["nan 0 0", "0 inf 0", "0 0 1e400", "1e18 0 0", "0 0", "", "x y z", "1,5 2 3"] {
        let text = square(&format!("v {vertex}\nv 9 9 9\nf 1 2 5\nf 1 2 6\nf 2 3 -2\n"));
        check(vertex, text, &[13, 15, 17]);
    }
    for normal in ["0 0 0", "nan 0 1", "0 1", "1.#IND 0 0", "0 0 -nan(ind)", "inf 0 0"] {
        let text = square(&format!("vn {normal}\nvn 1 1 1\nf 1//5 2//1 3//1\nf 1//6 2//6 3//6\n"));
        check(normal, text, &[13, 15]);
    }
    for uv in ["", "nan 0", "0 inf", "1e39", "u"] {
        check(uv, square(&format!("vt {uv}\nvt 7 7\nf 1/5 2/1 3/1\nf 1/6 2/6 3/6\n")), &[13, 15]);
    }
    // Even the first vertex may be the broken one, on which the origin would stand.
    let loaded = check("first", "v nan 0 0\nv 4 5 6\nv 1 0 0\nv 0 1 0\nf 2 3 4\n", &[1]);
    assert_eq!(loaded.model.meshes[0].origin, DVec3::new(4.0, 5.0, 6.0));
}

#[test]
fn polygons_are_cut_along_their_outline() {
    let arrow = "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\nf 2 3 4 1\nf 4 3 2 1\n";
    let loaded = check("arrow", arrow, &[]);
    let mesh = &loaded.model.meshes[0];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| DVec3::from_array(mesh.positions[i as usize].map(f64::from)));
        // A fan from the wrong corner would have a triangle of area 2 that is turned over.
        let doubled = (b - a).cross(c - a).length();
        assert!((doubled - 1.0).abs() < 1e-12, "{doubled}");
    }
    assert_eq!(mesh.lines, [5, 5, 6, 6, 7, 7]);

    let mut comb = String::new();
    for i in 0..50 {
        comb += &format!("v {i} 0 {}\nv {i}.5 3 {}\n", i % 2, i % 3);
    }
    comb += "v 50 -1 0\nv 0 -1 0\nf";
    (1..=102).for_each(|i| comb += &format!(" {i}"));
    // Warped as it is, every corner is used and the area vectors add up.
    let folder_free = parse(comb.as_bytes());
    assert_eq!(folder_free[0].corners.len(), 102);
    check("comb", comb, &[]);
}

#[test]
fn flat_triangles_are_left_out_and_counted_once() {
    let text = square("f 1 1 2\nf 1 2 3\nf 1 2 1\nv 2 0 0\nf 1 2 5\nf 1 2 5 3\nf 1 1 2 3\n");
    let loaded = check("flat", text, &[13]);
    let message = loaded.warnings[0].to_string();
    assert!(message.contains("left out: 4"), "{message}");
    // The corners differ in the file, but not any more in f32.
    check(
        "flat when rounded",
        "v 9 0 0\nv 1.00000000001 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nf 1 3 4\n",
        &[5],
    );
    check("crossed", square("f 1 2 4 3\n"), &[13]);
}

#[test]
fn materials_belong_to_triangles() {
    let mtl =
        "newmtl red\nKd 1 0 0\nnewmtl dark green\nKd 0 .2 0\nnewmtl unused\nmap_Kd none.png\n";
    let obj = square(
        "f 1 2 3\nmtllib a.mtl\nusemtl red\nf 1 2 3\nf 1/1 2/2 3/3\nusemtl dark green\nf 1 2 3 4\n\
         usemtl red # again\nf 1 3 4\nusemtl Red\nf 1 2 3\nusemtl\nf 1 2 4\n",
    );
    let loaded = load(&[("m.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())]).unwrap();
    assert_same(&loaded, &parse(obj.as_bytes()), "materials");
    let names: Vec<&str> = loaded.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["default", "red", "dark green", "Red"]);
    assert!(loaded.images.is_empty(), "images of unused materials are not wanted");
    assert_eq!(warned_lines(&loaded), [24, 22]);
    let red = &loaded.materials[1];
    assert_eq!(red.location.as_ref().unwrap().line, 1);
    assert_eq!(loaded.materials[3].location.as_ref().unwrap().line, 22);
    assert_eq!(loaded.inputs.len(), 2);
}

#[test]
fn libraries_are_found_and_read_once() {
    let obj = |mtllib: &str| square(&format!("{mtllib}\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"));
    let a: &[u8] = b"newmtl a\nKd 1 0 0\n";
    let b: &[u8] = b"\xef\xbb\xbfnewmtl b\r\nKd 0 1 0\r\n";
    let loaded_with = |mtllib: &str, files: &[(&str, &[u8])]| {
        let text = obj(mtllib);
        let mut all = vec![("m.obj", text.as_bytes())];
        all.extend_from_slice(files);
        load(&all).unwrap()
    };
    for (mtllib, names) in [
        ("mtllib a.mtl b.mtl", ["a.mtl", "b.mtl"]),
        ("mtllib\ta.mtl\nmtllib b.mtl # x", ["a.mtl", "b.mtl"]),
        ("mtllib b.mtl a.mtl b.mtl", ["a.mtl", "b.mtl"]),
        ("mtllib my lib.mtl\nmtllib \"b.mtl\"", ["my lib.mtl", "b.mtl"]),
        ("mtllib sub\\a.mtl\nmtllib ./b.mtl", ["sub/a.mtl", "b.mtl"]),
        ("mtllib a.mtl ./b.mtl", ["a.mtl", "b.mtl"]),
    ] {
        let loaded = loaded_with(mtllib, &[(names[0], a), (names[1], b)]);
        assert!(loaded.warnings.is_empty(), "{mtllib}: {:?}", loaded.warnings);
        assert_eq!(loaded.inputs.len(), 3, "{mtllib}");
        assert!(loaded.materials.iter().all(|m| {
            m.location.as_ref().unwrap().path.ends_with(if m.name == "a" {
                names[0]
            } else {
                names[1]
            })
        }));
    }
    // One library under many names, as exporters of many objects write it.
    let many: String = (0..181).map(|i| format!("mtllib {}a.mtl\n", "./".repeat(i % 7))).collect();
    let loaded = loaded_with(&many, &[("a.mtl", b"newmtl a\nnewmtl b\nNs x\n")]);
    assert_eq!(loaded.inputs.len(), 2);
    assert_eq!(loaded.warnings.len(), 1, "the library's own, once: {:?}", loaded.warnings);
    // Other spelling, missing, unreadable, defined twice.
    let loaded = loaded_with("mtllib A.MTL\nmtllib b.mtl", &[("a.mtl", a), ("b.mtl", b)]);
    assert_eq!(warned_lines(&loaded), [13]);
    let loaded = loaded_with("mtllib a.mtl none.mtl", &[("a.mtl", a)]);
    assert_eq!(warned_lines(&loaded), [13, 16], "the library, and the material");
    let loaded = loaded_with("mtllib a.mtl\nmtllib b.mtl", &[("a.mtl", a), ("b.mtl", b"\0\0")]);
    assert_eq!(warned_lines(&loaded), [14, 17]);
    let loaded =
        loaded_with("mtllib a.mtl b.mtl", &[("a.mtl", a), ("b.mtl", b"newmtl b\nnewmtl a\n")]);
    assert_eq!(warned_lines(&loaded), [2]);
    assert!(loaded.materials[0].location.as_ref().unwrap().path.ends_with("a.mtl"));
    let loaded = loaded_with("mtllib a.mtl", &[("a.mtl", b"newmtl b\nnewmtl a\nKd 1\nnewmtl a\n")]);
    assert_eq!(loaded.materials[0].location.as_ref().unwrap().line, 2);
}

#[test]
fn repeated_warnings_are_cut_short() {
    let text = square(&format!("f 1 2 3\n{}", "f 1 2 9\n".repeat(25)));
    let loaded = load(&[("m.obj", text.as_bytes())]).unwrap();
    assert_eq!(loaded.warnings.len(), 11);
    assert!(loaded.warnings[10].message.contains("15 more faces dropped"));
}

#[test]
fn large_groups_are_joined_again() {
    let side = 200;
    let mut text = String::new();
    for i in 0..=side {
        (0..=side).for_each(|j| text += &format!("v {i} {j} {}\n", (i * j) % 7));
    }
    for i in 0..side {
        for j in 0..side {
            let v = i * (side + 1) + j + 1;
            let w = v + side + 1;
            text += &format!("f {v} {w} {}\nf {v} {} {}\n", w + 1, w + 1, v + 1);
        }
        text += "o next\n";
    }
    let loaded = check("grid", text, &[]);
    assert_eq!(loaded.model.meshes[0].triangles.len(), 2 * side * side);
}

#[test]
fn positions_are_rounded_once() {
    let mut text = String::new();
    for i in 0..30 {
        let x = 4_123_456.0 + f64::from(i) * 0.123_456_7;
        text += &format!("v {x} {} {}\n", -x * 0.1 + f64::from(i % 5), i * i % 7);
    }
    (1..29).for_each(|i| text += &format!("f {i} {} {}\n", i + 1, i + 2));
    let loaded = check("georeferenced", &text, &[]);
    let mesh = &loaded.model.meshes[0];
    for face in parse(text.as_bytes()) {
        for corner in face.corners {
            let error = |stored: &[f32; 3]| {
                let stored = DVec3::from_array(stored.map(f64::from)) + mesh.origin;
                (stored - corner.position).abs().max_element()
            };
            let nearest = mesh.positions.iter().map(error).fold(f64::INFINITY, f64::min);
            assert!(nearest < 5e-5, "{nearest}: millimetres are lost");
        }
    }
}

#[test]
fn files_without_a_surface_are_errors() {
    let message = |content: &[u8]| load(&[("m.obj", content)]).unwrap_err().to_string();
    for content in
        [&b""[..], b"\n# nothing\n", b"v 0 0 0\nl 1 1\n", b"Dear reader,\nthis is no model.\n"]
    {
        assert!(message(content).contains("m.obj: no faces in this file"), "{}", message(content));
    }
    let broken = message(b"v 0 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 4\n");
    assert!(broken.contains("m.obj:3: no usable face in this file: 2 are broken"), "{broken}");
    assert!(broken.contains("vertex 3 does not exist: 2 are defined above"), "{broken}");
    assert!(broken.contains("3 | f 1 2 3"), "{broken}");
    assert!(message(b"v 0 0 0\nf 1 1 1\n").contains("zero area"));
    assert!(message(b"\x7fELF\x02\x01\x01\0\0").contains("m.obj:1: this is not a text file"));
    let utf16: Vec<u8> = SQUARE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(message(&utf16).contains("save it as UTF-8"));
    let control = message(b"v 0 0 0\nf 1 \x1b[31m 2\n");
    assert!(!control.contains('\x1b'), "control characters reach the terminal");

    let folder = tempfile::tempdir().unwrap();
    let of = |path: &Path| load_obj(path).unwrap_err();
    assert!(matches!(of(&folder.path().join("none.obj")), Error::Io { .. }));
    assert!(of(folder.path()).to_string().contains("not a regular file but a folder; name a file"));
}

#[test]
fn loading_twice_gives_the_same() {
    let obj = square("mtllib a.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1/1 2/2 3/3 4/4\nf 1 2 9\n");
    let files =
        [("m.obj", obj.as_bytes()), ("a.mtl", &b"newmtl a\nmap_Kd x.png\nnewmtl b\nKe 1\n"[..])];
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let load = || format!("{:?}", load_obj(&folder.path().join("m.obj")).unwrap());
    assert_eq!(load(), load());
}

#[test]
fn the_comparison_notices_each_difference() {
    let text = square("f 1 2 3\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 1 3 4\n");
    let loaded = load(&[("m.obj", text.as_bytes())]).unwrap();
    for (from, to) in [
        ("v 1 1 0", "v 1 1 1e-6"),
        ("vt 1 1", "vt 1 1.000001"),
        ("vn 0 0 1", "vn 0 1e-5 1"),
        ("f 1 2 3", "f 1 3 2"),
        ("f 1 2 3", "\nf 1 2 3"),
        ("f 1 2 3", "usemtl a\nf 1 2 3"),
        ("f 1 2 3\n", "\n"),
        ("f 1 3 4", "f 1 3 4\nf 1 3 4"),
        ("f 1 2 3\n", "f 1//1 2//1 3//1\n"),
        ("4/4/1", "1/1/1"),
    ] {
        let other = parse(text.replacen(from, to, 1).as_bytes());
        let compare = || assert_same(&loaded, &other, "expected to differ");
        assert!(std::panic::catch_unwind(compare).is_err(), "{from:?} for {to:?} is not noticed");
    }
}

/// The folder of real models: `GLINT_MODELS`, or beside the repository; `None` when there is none.
fn real_models() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/models");
    let folder = std::env::var_os("GLINT_MODELS").map_or(beside, PathBuf::from);
    folder.is_dir().then_some(folder)
}

#[test]
fn real_models_load_as_the_reference_reads_them() {
    let Some(folder) = real_models() else { return };
    for entry in std::fs::read_dir(folder).unwrap() {
        for file in std::fs::read_dir(entry.unwrap().path()).into_iter().flatten() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|e| e == "obj") {
                let loaded = load_obj(&path).unwrap();
                let faces = parse(&std::fs::read(&path).unwrap());
                assert_same(&loaded, &faces, &path.display().to_string());
            }
        }
    }
}
