//! The scene file: every key matters, transforms compose as documented, nested models flatten, and all
//! scenes of the repository load cleanly. What wrong files get is in `scene_file_errors.rs`.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may unwrap, and so may its helpers")]

use glint::error::Result;
use glint::load::load_scene;
use glint::math::{DAffine3, DVec3, Rgb};
use glint::scene::{Camera, Light, Placement, Projection, Scene, Surface};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A folder with small models and images, and the scene file `text` in it.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("tri.obj", "mtllib tri.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl old wood\nf 1 2 3\n");
        write("tri.mtl", "newmtl old wood\nKd 0.5 0.4 0.3\n");
        write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
        for (name, grey) in [("a.png", 100), ("b.png", 101)] {
            let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([grey, 50, 25, 128]));
            image.save(folder.path().join(name)).unwrap();
        }
        Self(folder)
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn load(&self, text: &str) -> Result<Scene> {
        let path = self.path().join("scene.toml");
        fs::write(&path, text).unwrap();
        load_scene(&path)
    }
}

fn load(text: &str) -> Scene {
    let scene = Folder::new().load(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(scene.warnings, []);
    scene
}

fn placements(text: &str) -> Vec<Placement> {
    load(text).placements
}

/// The only transform of a scene with one object of these keys.
fn transform(keys: &str) -> DAffine3 {
    placements(&format!("[[object]]\nfile = 'tri.obj'\n{keys}"))[0].world_from_object
}

#[test]
fn an_empty_scene_loads() {
    let scene = load("");
    assert!(scene.placements.is_empty() && scene.cameras.is_empty());
    assert_eq!(scene.settings, glint::scene::SceneSettings::default());
}

#[test]
fn a_model_alone_is_placed_once() {
    let folder = Folder::new();
    let scene = load_scene(&folder.path().join("tri.obj")).unwrap();
    assert_eq!(scene.placements.len(), 1);
    assert_eq!(scene.placements[0].world_from_object, DAffine3::IDENTITY);
    assert_eq!(scene.materials[0].name, "old wood");
    assert!(scene.cameras.is_empty() && scene.lights.is_empty() && scene.environment.is_none());
}

#[test]
fn values_arrive_as_written() {
    let scene = load(
        "film = { size = [640, 360], filter = 'gaussian:2', exposure = -1.5, tonemap = 'agx' }
         render = { spp = 64, max_depth = 9, sampler = 'random', seed = 7 }
         [camera.b]
         from = [1, 2, 3]
         to = [1, 2, -1]
         thin_lens = { vertical_fov = 40, lens_radius = 0.1 }
         [camera.a]
         from = [1e6, 2, 3]
         to = [0, 0, 0]
         up = [0, 0, 1]
         panoramic = {}
         [[light.directional]]
         direction = [0, -5, 0]
         irradiance = [3, 2, 1]",
    );
    let settings = &scene.settings;
    assert_eq!(settings.size, Some([640, 360]));
    assert_eq!((settings.samples_per_pixel, settings.max_depth), (Some(64), Some(9)));
    assert_eq!((settings.sampler.as_deref(), settings.seed), (Some("random"), Some(7)));
    assert_eq!((settings.filter.as_deref(), settings.exposure), (Some("gaussian:2"), Some(-1.5)));
    // Cameras keep the order of the file, and the focus is on `to`.
    let expected = Camera {
        name: "b".to_owned(),
        location: scene.cameras[0].location.clone(),
        from: DVec3::new(1.0, 2.0, 3.0),
        to: DVec3::new(1.0, 2.0, -1.0),
        up: DVec3::Y,
        projection: Projection::ThinLens {
            vertical_fov: 40.0,
            lens_radius: 0.1,
            focus_distance: 4.0,
        },
    };
    assert_eq!(scene.cameras[0], expected);
    assert_eq!((scene.cameras[1].name.as_str(), scene.cameras[1].up), ("a", DVec3::Z));
    assert_eq!(scene.cameras[1].projection, Projection::Panoramic);
    assert_eq!(
        scene.lights,
        [Light::Directional {
            direction: DVec3::NEG_Y,
            irradiance: Rgb::new(3.0, 2.0, 1.0),
            angular_diameter: 0.0
        }]
    );
}

/// `data/every_key.toml`: the scene with one of its environments, and what replaces its lines.
pub(crate) fn every_key() -> Vec<String> {
    let mut parts = include_str!("data/every_key.toml").split("#> part\n");
    let common = parts.next().unwrap();
    parts.map(|environment| format!("{common}{environment}")).collect()
}

/// (heading in the README, key, what the line becomes) of a line with a `#>` comment.
fn annotation(line: &str) -> Option<(&str, &str, Option<&str>)> {
    let (line, comment) = line.split_once("#>")?;
    let (heading, replacement) = match comment.split_once(" =") {
        Some((heading, replacement)) => (heading, Some(replacement)),
        None => (comment, None),
    };
    // The key of a line is before `=`; of a header, its last part but the user's names.
    let line = line.trim();
    let heading = heading.trim();
    let key = match line.strip_prefix('[') {
        Some(header) if heading == "the file" => {
            header.trim_start_matches('[').split(['.', ']']).next()
        }
        Some(header) => header.trim_end_matches(']').rsplit('.').next(),
        None if line.starts_with('"') => Some("override"),
        None => line.split(" =").next(),
    };
    Some((heading, key?, replacement))
}

#[test]
fn every_key_changes_the_scene() {
    let folder = Folder::new();
    let describe = |text: &str| {
        let mut scene = folder.load(text).unwrap_or_else(|error| panic!("{error}"));
        // What was read, and where it stands, is no part of the picture.
        scene.inputs.clear();
        scene.warnings.clear();
        scene.materials.iter_mut().for_each(|material| material.location = None);
        format!("{scene:?}")
    };
    for text in every_key() {
        assert_eq!(folder.load(&text).unwrap().warnings, []);
        let before = describe(&text);
        for line in text.lines() {
            if let Some((heading, key, Some(replacement))) = annotation(line) {
                let after = describe(&text.replacen(line, replacement, 1));
                assert!(before != after, "`{key}` of {heading} has no effect");
            }
        }
    }
}

#[test]
fn the_test_above_knows_every_key() {
    let parts = every_key();
    let tested: BTreeSet<_> = parts
        .iter()
        .flat_map(|text| text.lines())
        .filter_map(annotation)
        .map(|a| (a.0, a.1))
        .collect();
    let mut listed = BTreeSet::new();
    let mut heading = "";
    for line in include_str!("../../scenes/README.md").lines() {
        if let Some(text) = line.strip_prefix("#### ") {
            heading = text.trim_matches('`');
        } else if let Some(row) = line.strip_prefix("| `").filter(|_| !heading.is_empty()) {
            listed.insert((heading, row.split('`').next().unwrap()));
        }
    }
    assert_eq!(listed.difference(&tested).collect::<Vec<_>>(), Vec::<&(&str, &str)>::new());
    assert_eq!(tested.difference(&listed).collect::<Vec<_>>(), Vec::<&(&str, &str)>::new());
}

#[test]
fn transforms_compose_in_the_documented_order() {
    let apply = |keys: &str| transform(keys).transform_point3(DVec3::new(1.0, 2.0, 3.0));
    // Each key alone.
    assert_eq!(apply("translate = [10, 20, 30]"), DVec3::new(11.0, 22.0, 33.0));
    assert_eq!(apply("scale = 2"), DVec3::new(2.0, 4.0, 6.0));
    assert_eq!(apply("scale = [2, -3, 4]"), DVec3::new(2.0, -6.0, 12.0));
    assert_eq!(apply("rotate = [90, 0, 0]"), DVec3::new(1.0, -3.0, 2.0));
    assert_eq!(apply("rotate = [0, 90, 0]"), DVec3::new(3.0, 2.0, -1.0));
    assert_eq!(apply("rotate = [0, 0, 90]"), DVec3::new(-2.0, 1.0, 3.0));
    assert_eq!(apply("rotate = { axis = [0, 0, 5], angle = -270 }"), DVec3::new(-2.0, 1.0, 3.0));
    let rows = "matrix = [[0, 1, 0, 7], [0, 0, 2, 8], [3, 0, 0, 9]";
    assert_eq!(apply(&format!("{rows}]")), DVec3::new(9.0, 14.0, 12.0));
    assert_eq!(apply(&format!("{rows}, [0, 0, 0, 1]]")), DVec3::new(9.0, 14.0, 12.0));
    // About x, then y, then z: (1, 2, 3) -> (1, -3, 2) -> (2, -3, -1) -> (3, 2, -1).
    assert_eq!(apply("rotate = [90, 90, 90]"), DVec3::new(3.0, 2.0, -1.0));
    // Matrix (9, 14, 12), scale (18, 28, 24), rotate (-28, 18, 24), translate.
    let all = format!("translate = [1, 1, 1]\nrotate = [0, 0, 90]\nscale = 2\n{rows}]");
    assert_eq!(apply(&all), DVec3::new(-27.0, 19.0, 25.0));
    // An entry of `transforms` comes before the object's own keys.
    let many = "translate = [100, 0, 0]\ntransforms = [{ scale = 2 }, { translate = [0, 1, 0] }]";
    let placed = placements(&format!("[[object]]\nfile = 'tri.obj'\nrotate = [0, 0, 90]\n{many}"));
    let images = placed.iter().map(|p| p.world_from_object.transform_point3(DVec3::X));
    assert!(images.eq([DVec3::new(100.0, 2.0, 0.0), DVec3::new(99.0, 1.0, 0.0)]));
}

#[test]
fn transforms_keep_what_f32_would_lose() {
    let placed = transform("translate = [4000000.001, 0, 5e12]");
    assert_eq!(placed.translation, DVec3::new(4000000.001, 0.0, 5e12));
}

#[test]
fn nested_models_flatten() {
    let scene = load(
        "[model.tree]
         file = 'tri.obj'
         [model.row]
         object = [{ model = 'tree', transforms = [{ translate = [1, 0, 0] }, { translate = [2, 0, 0] }] }]
         [model.field]
         object = [
             { model = 'row', transforms = [{}, { translate = [0, 10, 0], scale = 2 }] },
             { file = 'quad.obj', material = 'inner' },
         ]
         [[object]]
         model = 'field'
         rotate = [0, 0, 90]
         material = 'outer'
         [[object]]
         file = 'tri.obj'
         [material.inner]
         mirror = {}
         [material.outer]
         mirror = {}",
    );
    // One model a file, however often and under whatever name it is placed.
    assert_eq!(scene.models.len(), 2);
    let summary = |p: &Placement| {
        let material = p.material_override.map(|id| scene.materials[id.index()].name.as_str());
        (p.model.index(), p.world_from_object.transform_point3(DVec3::ZERO).to_array(), material)
    };
    let placed: Vec<_> = scene.placements.iter().map(summary).collect();
    let expected = [
        (0, [0.0, 1.0, 0.0], Some("outer")),
        (0, [0.0, 2.0, 0.0], Some("outer")),
        (0, [-10.0, 2.0, 0.0], Some("outer")),
        (0, [-10.0, 4.0, 0.0], Some("outer")),
        (1, [0.0, 0.0, 0.0], Some("inner")),
        (0, [0.0, 0.0, 0.0], None),
    ];
    assert_eq!(placed, expected);
}

#[test]
fn overrides_replace_mtl_materials_everywhere() {
    let scene = load(
        "object = [{ file = 'tri.obj' }, { file = 'quad.obj' }]
         override = { 'old wood' = 'glass' }
         [material.glass]
         dielectric = { eta = 1.33 }
         [material.unused]
         lambert = { albedo = { file = 'nowhere.png' } }",
    );
    let id = scene.models[0].meshes[0].materials[0];
    let glass = &scene.materials[id.index()];
    assert_eq!(glass.name, "glass");
    assert!(matches!(glass.surface, Surface::Dielectric { eta: 1.33, .. }));
    assert_eq!(glass.location.as_ref().unwrap().line, 3);
    // Materials that nothing shows are left out, and so are their images.
    assert!(scene.materials.iter().all(|m| m.name != "old wood" && m.name != "unused"));
    assert!(scene.images.is_empty());
}

#[test]
fn images_are_shared_and_missing_ones_replaced() {
    let folder = Folder::new();
    fs::write(folder.path().join("broken.png"), "not an image").unwrap();
    let scene = folder
        .load(
            "[[object]]
             file = 'tri.obj'
             transforms = [{}, {}]
             material = 'm'
             [material.m]
             emission = { file = 'a.png' }
             opacity = { file = 'nowhere.png' }
             normal_map = { file = './a.png' }
             [material.m.principled]
             base_color = { file = './a.png' }
             roughness = { file = 'a.png' }
             metallic = { file = 'broken.png' }",
        )
        .unwrap();
    // a.png as colour and as data, each once.
    assert_eq!(scene.images.len(), 4);
    let warnings: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    let about = |line: usize, name: &str| {
        let place = format!("scene.toml:{line}: ");
        warnings.iter().any(|warning| warning.contains(&place) && warning.contains(name))
    };
    assert!(about(7, "nowhere.png") && about(12, "broken.png"), "{warnings:?}");
}

#[test]
fn models_that_are_never_placed_are_mentioned() {
    let scene = Folder::new().load("[model.spare]\nfile = 'tri.obj'").unwrap();
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.warnings[0].to_string().ends_with("scene.toml:1: model `spare` is never placed"));
}

#[test]
fn all_scenes_load_without_warnings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut loaded = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let Ok(files) = fs::read_dir(entry.unwrap().path()) else { continue };
        for file in files {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "toml" || extension == "obj") {
                let scene = load_scene(&path).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(scene.warnings, [], "{}", path.display());
                assert!(!scene.placements.is_empty(), "{}", path.display());
                loaded += usize::from(path.extension().unwrap() == "toml");
            }
        }
    }
    assert!(loaded >= 8, "only {loaded} scenes");
}
