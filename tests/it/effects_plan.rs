//! The plan's table: what is on and off, why, and in which line of which file.

use glint::load::load_scene;
use glint::math::Vec3;
use glint::plan::{Plan, Row, Wishes};
use glint::scene::{Effect, Effects};
use glint::world::World;
use std::path::Path;

const TRIANGLE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl used\nf 1 2 3\n";
const LIBRARY: &str = "newmtl used\nKd 0.5 0.5 0.5\n\nnewmtl unused\nillum 7\nNi 1.5\nKe 1 1 1\n";

/// The world and the plan of a scene file of this text, beside a model with a material that is used and one that is not.
fn plan(scene: &str, effects: &str, max_depth: u32) -> (World, Plan) {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("a.obj", TRIANGLE);
    write("a.mtl", LIBRARY);
    write("scene.toml", scene);
    let mut scene = load_scene(&folder.path().join("scene.toml")).expect("a scene");
    let camera = scene.cameras.remove(0);
    let effects: Effects = effects.parse().expect("effects");
    let whole = World::compile(scene).expect("it compiles");
    let world = whole.with_effects(&effects).expect("it has less");
    let wishes = Wishes { effects, max_depth, hide_background: false };
    let plan = Plan::new(&world, &camera, &wishes);
    (world, plan)
}

fn rows(scene: &str, effects: &str) -> Vec<Row> {
    rows_of(scene, effects, u32::MAX)
}

fn rows_of(scene: &str, effects: &str, max_depth: u32) -> Vec<Row> {
    plan(scene, effects, max_depth).1.rows
}

fn row<'r>(rows: &'r [Row], effect: &str) -> &'r Row {
    rows.iter().find(|row| row.effect == effect).expect("a row of this name")
}

/// File name and line of what calls for a row.
fn source(row: &Row) -> Option<(String, usize)> {
    row.source.as_ref().map(|source| {
        let name = Path::new(&source.path).file_name().expect("a file");
        (name.to_string_lossy().into_owned(), source.line)
    })
}

const CAMERA: &str =
    "[camera.front]\nfrom = [0, 0, 3]\nto = [0, 0, 0]\nperspective = { vertical_fov = 35 }\n";

#[test]
fn reasons_name_the_line() {
    // Lines 1 to 4 are the camera.
    let scene = format!(
        "{CAMERA}[[object]]\nfile = 'a.obj'\n[[object]]\nfile = 'a.obj'\nmaterial = 'pane'\n\
         [material.pane.dielectric]\neta = 1.5\nabsorption = 0.5\n\
         [[light.spot]]\nposition = [0, 2, 0]\ndirection = [0, -1, 0]\nintensity = 1\n\
         outer_angle = 40\ninner_angle = 20\n\
         [[light.directional]]\ndirection = [0, -1, 0]\nirradiance = 1\n\
         [environment.sky]\nelevation = 30\nazimuth = 0\n"
    );
    let rows = rows(&scene, "auto");
    for (effect, place) in [
        ("diffuse", Some(("a.mtl", 1))),
        ("refraction", Some(("scene.toml", 10))),
        ("absorption", Some(("scene.toml", 10))),
        ("direct light of points", Some(("scene.toml", 13))),
        ("direct light around", Some(("scene.toml", 22))),
        ("direct light of suns", Some(("scene.toml", 22))),
        ("instancing", Some(("scene.toml", 6))),
        ("caustics", Some(("scene.toml", 10))),
    ] {
        let row = row(&rows, effect);
        assert!(row.on, "{effect}: {}", row.reason);
        let place = place.map(|(name, line): (&str, usize)| (name.to_owned(), line));
        assert_eq!(source(row), place, "{effect}: {}", row.reason);
    }
    assert!(row(&rows, "direct light of points").reason.contains("hard shadows"));
    assert!(row(&rows, "direct light of suns").reason.contains("hard and soft shadows"));
    for effect in ["emission", "glossy", "textures", "normal-maps", "cut-outs"] {
        assert!(!row(&rows, effect).on, "{effect}");
    }
    let lens = row(&rows, "depth-of-field");
    assert!(!lens.on && source(lens) == Some(("scene.toml".into(), 1)), "{lens:?}");
}

#[test]
fn what_nothing_shows_calls_for_nothing() {
    let scene = format!(
        "{CAMERA}[[object]]\nfile = 'a.obj'\n[[light.point]]\nposition = [0, 1, 1]\nintensity = 1\n\
         [[light.point]]\nposition = [0, 1, 1]\nintensity = 0\n\
         [material.unplaced.mirror]\nreflectance = 1\n"
    );
    let auto = rows(&scene, "auto");
    let mut on: Vec<&str> = auto.iter().filter(|row| row.on).map(|row| row.effect).collect();
    on.sort_unstable();
    let expected = ["diffuse", "direct light of points", "light-sampling", "shadows"];
    assert_eq!(on, expected);
    // One light has power: there is nothing to choose, nothing to combine, nothing to meet.
    assert_eq!(row(&auto, "choice of lights by power").reason, "one light is sampled");
    assert!(row(&auto, "multiple importance sampling").reason.contains("exact"));
}

#[test]
fn a_constant_environment_is_left_to_scattering() {
    let scene =
        format!("{CAMERA}[[object]]\nfile = 'a.obj'\n[environment.constant]\nradiance = 1\n");
    let auto = rows(&scene, "auto");
    assert!(!row(&auto, "light-sampling").on && !row(&auto, "shadows").on);
    assert!(row(&auto, "light-sampling").reason.contains("scattering alone"));
    assert!(row(&auto, "direct light around").on);
    // Without scattering to find it, it is sampled.
    let alone = rows(&scene, "no-scatter-sampling");
    assert!(row(&alone, "light-sampling").on && row(&alone, "shadows").on);
}

/// A lamp of power 4 pi, alone or under a constant environment; the triangle's bounding sphere has radius 0.707, so that
/// an environment of radiance 1 has a power of 2 pi^2.
fn lamp(environment: &str) -> (World, Plan) {
    let scene = format!(
        "{CAMERA}[[object]]\nfile = 'a.obj'\n[[light.point]]\nposition = [0, 0, 2]\nintensity = 1\n\
         {environment}"
    );
    plan(&scene, "auto", u32::MAX)
}

#[test]
fn lamps_beside_a_constant_environment_are_sampled_at_some_vertices() {
    let under = |radiance: &str| lamp(&format!("[environment.constant]\nradiance = {radiance}\n"));
    let (_, alone) = lamp("");
    assert_eq!(alone.lights.idle(), 0.0);
    assert!(!alone.pipeline.light_choice);
    for (radiance, idle) in [("1", 0.0728), ("5", 0.2820), ("1e6", 0.75)] {
        let (world, plan) = under(radiance);
        assert!((plan.lights.idle() - idle).abs() < 0.001, "{radiance}: {}", plan.lights.idle());
        assert!(plan.pipeline.light_choice, "{radiance}");
        // As often as it says, and then with the density that it has.
        let selects = (0..10_000).map(|i| (i as f32 + 0.5) / 10_000.0);
        let sample = |select| plan.lights.sample(&world, Vec3::ZERO, select, [0.5; 2]);
        let sampled: Vec<_> = selects.filter_map(sample).collect();
        let rate = 1.0 - plan.lights.idle();
        assert!((sampled.len() as f32 / 10_000.0 - rate).abs() < 0.001, "{}", sampled.len());
        assert!(sampled.iter().all(|light| light.pdf_solid_angle == rate), "{:?}", sampled[0]);
    }
}

#[test]
fn short_paths_and_lights_that_nothing_finds_are_said() {
    let point = "[[light.point]]\nposition = [0, 0, 2]\nintensity = 1\n";
    let scene = format!(
        "{CAMERA}[[object]]\nfile = 'a.obj'\n[[object]]\nfile = 'a.obj'\nmaterial = 'chrome'\n\
         [material.chrome.mirror]\nreflectance = 1\n{point}"
    );
    let on = |max_depth: u32, effects: &str| {
        let rows = rows_of(&scene, effects, max_depth);
        let on = |effect: &str| row(&rows, effect).on;
        ["direct light of points", "mirror", "diffuse", "caustics"].map(on)
    };
    assert_eq!(on(u32::MAX, "auto"), [true; 4], "a mirror throws what a point lights on the rest");
    assert_eq!(on(3, "auto"), [true; 4]);
    assert_eq!(on(2, "auto"), [true, true, false, false]);
    assert_eq!(on(1, "all"), [false; 4]);
    assert!(!on(u32::MAX, "no-light-sampling")[0], "no ray meets a point");
    let nothing = rows_of(&scene, "emission", u32::MAX);
    let reason = &row(&nothing, "light-sampling").reason;
    assert!(reason.contains("scattered light is left out"), "{reason}");
}

#[test]
fn what_the_user_takes_out_is_said() {
    let scene =
        format!("{CAMERA}[[object]]\nfile = 'a.obj'\n[environment.constant]\nradiance = 1\n");
    for &effect in Effect::ALL {
        let rows = rows(&scene, &format!("all,no-{}", effect.name()));
        let named: Vec<&Row> = rows.iter().filter(|row| row.effect == effect.name()).collect();
        let all: Vec<&Row> = match effect {
            Effect::Direct => rows.iter().filter(|row| row.effect.starts_with("direct")).collect(),
            _ => named,
        };
        assert!(!all.is_empty(), "{effect:?} has no row");
        for row in all {
            assert!(!row.on && row.reason.contains("left out: effects"), "{row:?}");
        }
        let others = rows.iter().filter(|row| row.reason == "effects all").count();
        assert!(others >= 14, "{effect:?}: {others} rows still on");
    }
}
