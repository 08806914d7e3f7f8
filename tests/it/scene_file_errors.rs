//! What wrong scene files get: an error with the right line, the line itself, and advice.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may unwrap, and so may its helpers")]

use crate::scene_file::{Folder, every_key};
use glint::error::Error;
use glint::load::load_scene;
use glint::sampling::CounterRng;
use rand::RngExt;
use std::fs;

/// The scene file `text` must fail at `line`, with each of `fragments` in the message.
fn rejects(text: &str, line: usize, fragments: &[&str]) {
    let folder = Folder::new();
    let error = folder.load(text).err().unwrap_or_else(|| panic!("accepted:\n{text}"));
    let message = error.to_string();
    let place = format!("scene.toml:{line}: ");
    assert!(message.contains(&place), "not at line {line}: {message}\n{text}");
    let excerpt = format!("\n  {line} | {}", text.lines().nth(line - 1).unwrap().trim_end());
    assert!(message.ends_with(&excerpt), "no excerpt: {message}");
    for fragment in fragments {
        assert!(message.contains(fragment), "no `{fragment}`: {message}");
    }
}

/// An object with `keys`, the first of which is on line 3.
fn object(keys: &str) -> String {
    format!("[[object]]\nfile = 'tri.obj'\n{keys}")
}

/// A camera with `keys`, the first of which is on line 2.
fn camera_with(keys: &str) -> String {
    format!("[camera.main]\n{keys}")
}

/// A material whose `lambert` table is on line 2.
fn material(keys: &str) -> String {
    format!("[material.m]\n{keys}")
}

#[test]
fn syntax() {
    rejects("[film]\nsize = [1, 2", 2, &["expected"]);
    rejects("object = 3\n[[object]]\n", 2, &[]);
    rejects("\n\nfilm = {", 3, &[]);
}

#[test]
fn unknown_keys() {
    rejects(
        "[film]\nsice = [1, 1]",
        2,
        &["unknown key `sice`", "did you mean `size`?", "`tonemap`"],
    );
    rejects("[rendering]", 1, &["unknown key `rendering`", "did you mean `render`?"]);
    rejects(&camera_with("fov = 40"), 2, &["unknown key `fov`", "Allowed here: `from`, `to`"]);
    rejects(
        &camera_with("perspective = { fov = 40 }"),
        2,
        &["did you mean `vertical_fov`?", "Allowed here: `vertical_fov`"],
    );
    rejects(&camera_with("panoramic = { fov = 1 }"), 2, &["unknown key `fov`", "none"]);
    rejects(&object("position = [1, 2, 3]"), 3, &["unknown key `position`", "`translate`"]);
    rejects(&object("transforms = [\n{},\n{ scal = 2 }]"), 5, &["did you mean `scale`?"]);
    rejects(&object("rotate = { axes = [1, 0, 0], angle = 1 }"), 3, &["did you mean `axis`?"]);
    rejects(&material("glass = {}"), 2, &["unknown key `glass`", "`dielectric`"]);
    rejects(&material("lambert = { albido = 1 }"), 2, &["did you mean `albedo`?"]);
    rejects(
        &material("lambert.albedo = { file = 'a.png',\nwrap = 'clamp' }"),
        3,
        &["unknown key `wrap`", "`clamp`"],
    );
    rejects(&material("lambert.albedo = 1\nnormal_map.fil = 'a.png'"), 3, &["`file`"]);
    rejects("[[light.spots]]", 1, &["did you mean `spot`?"]);
    rejects("[environment.sun]", 1, &["`constant`, `image`, `sky`"]);
}

#[test]
fn missing_keys() {
    rejects(&camera_with("to = [0, 0, 0]"), 1, &["missing key `from`"]);
    rejects(&material("oren_nayar = { albedo = 1 }"), 2, &["missing key `sigma`"]);
    rejects("\n[[light.point]]\nposition = [1, 1, 1]", 2, &["missing key `intensity`"]);
    rejects(&object("rotate = { axis = [1, 0, 0] }"), 3, &["missing key `angle`"]);
}

#[test]
fn types() {
    rejects("[film]\nsize = '1280x720'", 2, &["string", "expected 2 numbers in brackets"]);
    rejects("[film]\nsize = [1280]", 2, &["length 1", "expected 2 numbers in brackets"]);
    rejects("[film]\nsize = [1280, 720, 3]", 2, &["length 3"]);
    rejects("[film]\nsize = [1280.5, 720]", 2, &["expected a whole number from 1 to 65536"]);
    rejects("[render]\nseed = 'x'", 2, &["string"]);
    rejects(&object("scale = 'big'"), 3, &["expected a number or [x, y, z]"]);
    rejects(&object("scale = [1, 2]"), 3, &["length 2"]);
    rejects(&object("rotate = 90"), 3, &["expected [x, y, z] in degrees, or { axis"]);
    rejects(&object("translate = [1, 2]"), 3, &["length 2", "expected 3 numbers"]);
    rejects(&object("matrix = [[1, 0, 0, 0]]"), 3, &["three rows of four numbers"]);
    rejects(&object("matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"), 3, &["length 3"]);
    let bad_row = "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]";
    rejects(&object(bad_row), 3, &["a fourth one can only be [0, 0, 0, 1]"]);
    rejects(&material("lambert.albedo = 'red'"), 2, &["a colour [r, g, b]", "{ file = .. }"]);
    rejects(&material("lambert.albedo = [1, 1]"), 2, &["length 2"]);
    rejects(&material("opacity = [1, 1, 1]"), 2, &["expected a number from 0 to 1 or { file"]);
    rejects(&material("opacity = { file = 'a.png', channel = 'blue' }"), 2, &["`red`"]);
    rejects("material = 3", 1, &["expected named entries"]);
    rejects("override = { wood = 3 }", 1, &["expected a string"]);
}

#[test]
fn ranges() {
    rejects("[film]\nsize = [0, 720]", 2, &["expected a whole number from 1"]);
    rejects("[film]\nsize = [-5, 720]", 2, &["expected a whole number from 1"]);
    rejects("[film]\nexposure = nan", 2, &["expected a finite number"]);
    rejects("[render]\nspp = 0", 2, &["expected a whole number from 1"]);
    rejects("[render]\nmax_depth = 0", 2, &["expected a whole number from 1"]);
    rejects("[render]\nseed = -1", 2, &["-1"]);
    for fov in ["0", "180", "-40", "nan", "inf"] {
        let text = camera_with(&format!("perspective = {{ vertical_fov = {fov} }}"));
        rejects(&text, 2, &["expected an angle above 0 and below 180 degrees"]);
    }
    let lens = "thin_lens = { vertical_fov = 40, lens_radius = -1 }";
    rejects(&camera_with(lens), 2, &["-1 is out of range: expected a length from 0"]);
    rejects(&camera_with("orthographic = { height = 0 }"), 2, &["expected a length above 0"]);
    rejects(&camera_with("from = [0, inf, 0]"), 2, &["expected a coordinate"]);
    rejects(&camera_with("from = [0, 1e300, 0]"), 2, &["expected a coordinate"]);
    rejects(&object("translate = [0, nan, 0]"), 3, &["expected a coordinate"]);
    rejects(&object("rotate = [0, 0, inf]"), 3, &["expected a finite angle"]);
    rejects(&object("rotate = { axis = [0, 0, 0], angle = 1 }"), 3, &["must not be [0, 0, 0]"]);
    for albedo in ["1.5", "[0, 0, -0.1]", "[0, nan, 0]", "{ file = 'a.png', value = 2 }"] {
        let text = material(&format!("lambert.albedo = {albedo}"));
        rejects(&text, 2, &["out of range: expected a number from 0 to 1"]);
    }
    rejects(&material("emission = [-1, 0, 0]"), 2, &["expected a number of at least 0"]);
    rejects(&material("emission = 1e39"), 2, &["out of range"]);
    rejects(&material("dielectric.eta = 0"), 2, &["expected a number above 0"]);
    rejects(&material("dielectric.eta = 1e-60"), 2, &["expected a number above 0"]);
    rejects(&material("conductor.anisotropy = 2"), 2, &["expected a number from -1 to 1"]);
    let spot = |angles: &str| {
        let place = "position = [0, 0, 0]\ndirection = [0, -1, 0]\nintensity = 1";
        format!("[[light.spot]]\n{place}\n{angles}")
    };
    rejects(&spot("outer_angle = 0\ninner_angle = 0"), 5, &["above 0 and up to 180 degrees"]);
    rejects(&spot("outer_angle = 20\ninner_angle = 30"), 6, &["`inner_angle` 30 is larger"]);
    rejects("environment.sky = { elevation = 95, azimuth = 0 }", 1, &["from -90 to 90"]);
}

#[test]
fn singular_transforms() {
    rejects(&object("scale = 0"), 3, &["a scale of 0 flattens the object"]);
    rejects(&object("scale = [1, 0, 1]"), 3, &["a scale of 0 flattens the object"]);
    rejects(&object("matrix = [[1, 2, 0, 0], [2, 4, 0, 0], [0, 0, 1, 0]]"), 3, &["singular"]);
    // Each is fine by itself.
    let text = "\n[[object]]\nmodel = 'm'\nscale = 1e-10\n[model.m]\nobject = [\n{ file = 'tri.obj', scale = 1e-10 }]";
    rejects(text, 7, &["this object's transform, with those around it, is singular"]);
}

#[test]
fn contradictions() {
    rejects(&camera_with("from = [1, 1, 1]\nto = [1, 1, 1]"), 1, &["looks at its own position"]);
    rejects(&camera_with("from = [0, 5, 0]\nto = [0, 0, 0]"), 1, &["`up` along its view"]);
    let view = "from = [0, 0, 5]\nto = [0, 0, 0]\n";
    rejects(&camera_with(view), 1, &["camera `main` needs one of `perspective`, `thin_lens`"]);
    let two = format!("{view}panoramic = {{}}\northographic = {{ height = 1 }}");
    rejects(&camera_with(&two), 1, &["has `orthographic`, `panoramic` at once"]);
    rejects(&material("opacity = 1"), 1, &["material `m` needs one of `lambert`"]);
    rejects(&material("mirror = {}\nlambert.albedo = 1"), 1, &["has `lambert`, `mirror` at once"]);
    let maps = "mirror = {}\nnormal_map.file = 'a.png'\nbump_map.file = 'a.png'";
    rejects(&material(maps), 1, &["has `normal_map` and `bump_map` at once"]);
    rejects(&material("conductor = {}"), 2, &["`metal`", "`eta` and `k`"]);
    rejects(&material("conductor = { eta = 1 }"), 2, &["`eta` and `k`"]);
    rejects(&material("conductor = { metal = 'gold', k = 1 }"), 2, &["`metal`", "`eta` and `k`"]);
    rejects("[environment]", 1, &["`environment` needs one of `constant`, `image`, `sky`"]);
    rejects("\n[[object]]\nscale = 1", 2, &["give it a `file` or a `model`"]);
    rejects(&object("model = 'x'"), 1, &["has `file` and `model` at once"]);
    rejects("[model.x]", 1, &["model `x` needs a `file` or objects"]);
    rejects("[model.x]\nfile = 'tri.obj'\nobject = [{}]", 1, &["and not both"]);
}

#[test]
fn names_that_are_not_there() {
    let material = "[material.gold]\nmirror = {}\n";
    let text = format!("{material}[[object]]\nfile = 'tri.obj'\nmaterial = 'gould'");
    rejects(&text, 5, &["unknown material `gould`", "did you mean `gold`?", "Known: `gold`"]);
    rejects(&object("material = 'gold'"), 3, &["unknown material `gold`. Known: none"]);
    let text = "[[object]]\nmodel = 'tre'\n[model.tree]\nfile = 'tri.obj'";
    rejects(text, 2, &["unknown model `tre`", "did you mean `tree`?"]);
    // Also inside of models that nothing places.
    rejects("[[model.a.object]]\nmodel = 'b'", 2, &["unknown model `b`"]);
    rejects("override = { 'old wood' = 'gold' }", 1, &["unknown material `gold`"]);
    let text = format!("{material}[override]\n'olt wood' = 'gold'\n[[object]]\nfile = 'tri.obj'");
    rejects(&text, 4, &["unknown MTL material `olt wood`", "did you mean `old wood`?"]);
    rejects("[render]\nsampler = 'sobel'", 2, &["unknown sampler `sobel`", "`sobol`"]);
    rejects("[film]\nfilter = 'bax'", 2, &["unknown filter `bax`; did you mean `box`?", "`tent`"]);
    rejects("[film]\nfilter = 'box:99'", 2, &["radius", "up to 16"]);
    rejects("[film]\ntonemap = 'filmic'", 2, &["unknown tone map `filmic`", "agx"]);
    rejects("\nup = 'x'", 2, &["`y` or `z`"]);
    let text = "[material.m]\nconductor = { metal = 'goold' }";
    rejects(text, 2, &["unknown metal `goold`", "did you mean `gold`?", "`silver`"]);
}

#[test]
fn names_that_are_there_twice() {
    let text = "[material.gold]\nmirror = {}\n\n[material.gold]\nmirror = {}";
    rejects(text, 4, &["`gold` is defined twice"]);
    rejects("[camera]\na.to = 1\na.to = 2", 3, &["`to` is defined twice"]);
}

#[test]
fn circles() {
    let text = "[model.a]\nobject = [{ model = 'b' }]\n[model.b]\nobject = [{ model = 'c' }]\n\
                [model.c]\nobject = [{ model = 'b' }]\n[[object]]\nmodel = 'a'";
    rejects(text, 6, &["models place each other in a circle: b -> c -> b"]);
    rejects("[model.a]\nobject = [\n{ model = 'a' }]", 3, &["in a circle: a -> a"]);
}

#[test]
fn explosions() {
    // Ten models, each of which places the next one ten times: 10^10 triangles.
    let mut text = String::from("[[object]]\nmodel = 'm0'\n");
    for level in 0..10 {
        let next =
            if level == 9 { "file = 'tri.obj'" } else { &format!("model = 'm{}'", level + 1) };
        let transforms = "transforms = [{}, {}, {}, {}, {}, {}, {}, {}, {}, {}]";
        text += &format!("[[model.m{level}.object]]\n{next}\n{transforms}\n");
    }
    rejects(&text, 1, &["16777216 placements"]);
    // Empty ones cost time as well.
    let files = "file = 'tri.obj'\ntransforms = [{}, {}, {}, {}, {}, {}, {}, {}, {}, {}]";
    let empty = text.replace(files, "file = 'tri.obj'\ntransforms = []");
    assert!(empty.len() < text.len());
    rejects(&empty, 1, &["16777216 placements"]);
    let mut text = String::from("[[object]]\nmodel = 'm0'\n");
    for level in 0..100 {
        text += &format!("[[model.m{level}.object]]\nmodel = 'm{}'\n", level + 1);
    }
    text += "[model.m100]\nfile = 'tri.obj'";
    rejects(&text, 130, &["nested more than 64 deep"]);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = Folder::new();
    rejects("\n[[object]]\nfile = 'nowhere.obj'", 3, &["there is no file", "nowhere.obj"]);
    rejects("\nenvironment.image.file = 'nowhere.png'", 2, &["nowhere.png"]);
    rejects("[[object]]\nfile = '.'", 2, &["not a regular file but a folder"]);
    let missing = load_scene(&folder.path().join("missing.toml")).unwrap_err();
    assert!(matches!(missing, Error::Io { .. }), "{missing}");
    let missing = load_scene(&folder.path().join("missing.obj")).unwrap_err();
    assert!(missing.to_string().contains("missing.obj"), "{missing}");
    let odd = load_scene(&folder.path().join("scene.txt")).unwrap_err();
    assert!(odd.to_string().contains("a scene is a .toml or an .obj file"), "{odd}");
    let path = folder.path().join("latin1.toml");
    fs::write(&path, b"[film]\n# M\xfcller").unwrap();
    let error = load_scene(&path).unwrap_err().to_string();
    assert!(error.contains("latin1.toml:2: not UTF-8"), "{error}");
}

#[test]
fn marks_and_line_ends_of_other_systems() {
    let scene = Folder::new().load("\u{feff}[film]\r\nsize = [3, 2]\r\n").unwrap();
    assert_eq!(scene.settings.size, Some([3, 2]));
    rejects("[film]\r\nsize = [3, 0]\r\n", 2, &["a whole number"]);
}

/// Whatever is damaged: a scene, or an error with a line of the file.
#[test]
fn damaged_files_never_panic() {
    let folder = Folder::new();
    let original = every_key().remove(0);
    let mut loaded = 0;
    for seed in 0..1000 {
        let mut rng = CounterRng::new(seed);
        let mut text: Vec<char> = original.chars().collect();
        for _ in 0..rng.random_range(1..4) {
            let at = rng.random_range(0..text.len());
            match rng.random_range(0..4) {
                0 => drop(text.remove(at)),
                1 => text.insert(at, char::from(rng.random_range(32..127_u8))),
                2 => {
                    text[at] =
                        ['0', '-', '[', ']', '{', '"', '\n', '9', 'e', '.'][seed as usize % 10]
                }
                _ => {
                    // A piece of the file once more, somewhere else.
                    let piece: Vec<char> = text.iter().skip(at).take(40).copied().collect();
                    let to = rng.random_range(0..text.len());
                    text.splice(to..to, piece);
                }
            }
        }
        let text: String = text.into_iter().collect();
        match folder.load(&text) {
            Ok(_) => loaded += 1,
            Err(error) => assert!(error.to_string().contains("scene.toml:"), "{error}\n{text}"),
        }
    }
    // Both outcomes are well covered: most of the file is comments.
    assert!((100..900).contains(&loaded), "{loaded} of 1000 loaded");
}
