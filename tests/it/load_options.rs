//! Loading as it is told: progress in bytes, and one material for everything.

use glint::load::{LoadOptions, Surroundings, load_scene_with};
use glint::math::Rgb;
use glint::scene::{Environment, ImageId, Material};
use std::cell::RefCell;
use std::fs;

/// A strip of `n` triangles.
fn strip(n: usize) -> String {
    let vertices = (0..n + 2).map(|i| format!("v {} {} 0\n", i / 2, i % 2));
    let faces = (1..=n).map(|i| format!("f {i} {} {}\n", i + 1, i + 2));
    vertices.chain(faces).collect()
}

/// Bytes read and bytes in all, over all models, each counted once however often it is placed.
#[test]
fn progress_goes_steadily_to_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let (large, small) = (strip(20_000), strip(1));
    fs::write(folder.path().join("large.obj"), &large).unwrap();
    fs::write(folder.path().join("small.obj"), &small).unwrap();
    let object = |name| format!("[[object]]\nfile = '{name}.obj'\n");
    let scene = object("large") + &object("small") + &object("large");
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    for (name, bytes) in [("large.obj", large.len()), ("scene.toml", large.len() + small.len())] {
        let told = RefCell::new(Vec::new());
        let report = |done, total| told.borrow_mut().push((done, total));
        let options = LoadOptions { progress: Some(&report), ..LoadOptions::default() };
        load_scene_with(&folder.path().join(name), options).unwrap();
        let told = told.into_inner();
        assert!(told.len() > 5, "{name}: {told:?}");
        assert!(told.is_sorted(), "{name}: {told:?}");
        assert!(told.iter().all(|(_, total)| *total == bytes as u64), "{name}: {told:?}");
        assert_eq!(told.last(), Some(&(bytes as u64, bytes as u64)), "{name}");
    }
}

/// An image that no one will see is not read; what is wrong with the table itself still is.
#[test]
fn given_surroundings_take_the_place_of_the_files() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("model.obj"), strip(1)).unwrap();
    fs::write(folder.path().join("broken.hdr"), "no image").unwrap();
    let grey = image::RgbImage::from_pixel(2, 1, image::Rgb([100; 3]));
    grey.save(folder.path().join("grey.png")).unwrap();
    let object = "[[object]]\nfile = 'model.obj'\n[environment.image]\nfile = 'broken.hdr'\n";
    fs::write(folder.path().join("scene.toml"), object).unwrap();
    let two = format!("{object}[environment.constant]\nradiance = 1\n");
    fs::write(folder.path().join("two.toml"), two).unwrap();
    let load = |name: &str, surroundings| {
        let options = LoadOptions { surroundings, ..LoadOptions::default() };
        load_scene_with(&folder.path().join(name), options)
    };
    let white = || Environment::Constant { radiance: Rgb::WHITE };
    let computed = || Some(Surroundings::computed(white()));
    let image = || Surroundings::image(&folder.path().join("grey.png"), Rgb::WHITE, 30.0).ok();

    assert!(load("scene.toml", None).unwrap_err().to_string().contains("broken.hdr"));
    assert!(load("two.toml", computed()).unwrap_err().to_string().contains("at once"));
    for name in ["model.obj", "scene.toml"] {
        let scene = load(name, computed()).unwrap();
        assert_eq!(scene.environment, Some(white()));
        assert!(scene.images.is_empty() && !scene.inputs.iter().any(|p| p.ends_with("broken.hdr")));
        let scene = load(name, image()).unwrap();
        let (image, scale, rotation) = (ImageId(0), Rgb::WHITE, 30.0);
        assert_eq!(scene.environment, Some(Environment::Image { image, scale, rotation }));
        assert_eq!(scene.images.len(), 1);
        assert!(scene.inputs.iter().any(|path| path.ends_with("grey.png")));
    }
}

#[test]
fn one_material_is_the_only_one() {
    let folder = tempfile::tempdir().unwrap();
    let model = format!("mtllib m.mtl\nusemtl a\n{}usemtl b\nf 1 3 2\n", strip(3));
    fs::write(folder.path().join("model.obj"), model).unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl a\nmap_Kd a.png\nnewmtl b\nKe 1 1 1\n").unwrap();
    let scene = "[[object]]\nfile = 'model.obj'\nmaterial = 'c'\n[[object]]\nfile = 'model.obj'\n\
        [override]\nb = 'c'\n[material.c.lambert]\nalbedo = { file = 'c.png' }\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    for name in ["model.obj", "scene.toml"] {
        let material = Some(Material { name: "only".into(), ..Material::default_grey() });
        let options = LoadOptions { material, ..LoadOptions::default() };
        let scene = load_scene_with(&folder.path().join(name), options).unwrap();
        let names: Vec<_> = scene.materials.iter().map(|material| &material.name).collect();
        assert_eq!(names, ["only"]);
        assert!(scene.images.is_empty() && scene.warnings.is_empty(), "{:?}", scene.warnings);
        let meshes = scene.models.iter().flat_map(|model| &model.meshes);
        assert!(meshes.flat_map(|mesh| &mesh.materials).all(|id| id.0 == 0));
        assert!(!scene.inputs.iter().any(|path| path.ends_with("m.mtl")), "{:?}", scene.inputs);
    }
}
