//! The scene file: TOML text to a [`Scene`].
//!
//! A scene file places OBJ models and says what OBJ and MTL cannot: cameras, physical materials, lights,
//! what surrounds the scene, and settings that the command line can override. Every key is listed in
//! `scenes/README.md` (a test compares that list with the tables here). A complete scene:
//!
//! ```toml
//! [film]
//! size = [1280, 720]
//!
//! [camera.front]                       # the first camera is the one to render
//! from = [0, 1, 5]
//! to = [0, 1, 0]
//! perspective = { vertical_fov = 35 }  # or thin_lens, orthographic, panoramic
//!
//! [[object]]                           # all paths are relative to this file
//! file = "statue.obj"
//! rotate = [0, 30, 0]                  # degrees about x, then y, then z
//! material = "gold"                    # instead of what its MTL says
//!
//! [material.gold.conductor]
//! metal = "gold"
//! roughness = 0.2
//!
//! [model.pair]                         # a model is a file, or objects: models nest
//! object = [{ file = "vase.obj" }, { file = "vase.obj", translate = [1, 0, 0] }]
//!
//! [[object]]                           # thousands of placements are fine
//! model = "pair"
//! transforms = [{ translate = [0, 0, -2] }, { translate = [0, 0, -4], scale = 2 }]
//!
//! [override]                           # "name in the MTL" = name of a material here
//! "old wood" = "gold"
//!
//! [[light.point]]
//! position = [0, 3, 0]
//! intensity = [10, 9, 8]
//!
//! [environment.sky]                    # or constant, image
//! elevation = 30
//! azimuth = 120
//! ```
//!
//! Rules: a thing that comes in kinds has a table named after its kind. Transforms apply `matrix`, then
//! `scale`, then `rotate`, then `translate`; the entries of `transforms` apply before the object's own
//! keys, and a nested object's before those of the objects around it; all in `f64`. The innermost
//! `material` wins. Colours are linear Rec. 709. Angles are in degrees.
//!
//! A wrong file is an error with line and advice; a texture that cannot be read is a warning. Must not
//! know how light is transported, only what the keys mean.

mod assemble;
mod builder;
mod camera;
#[cfg(test)]
mod keys;
mod light;
mod material;
mod named;
mod place;
mod settings;
mod source;
mod texture;
mod transform;
mod value;

use crate::error::{Error, Result};
use crate::image::open_regular;
use crate::load::Surroundings;
use crate::load::obj::{Materials, load_model};
use crate::load::progress::Progress;
use crate::math::DAffine3;
use crate::scene::{Material, Placement, Scene};
use builder::Builder;
use named::Named;
use serde::Deserialize;
use source::Source;
use std::io::Read;
use std::path::Path;
use toml::Spanned;

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Document {
    up: Option<Up>,
    film: settings::FilmTable,
    render: settings::RenderTable,
    camera: Named<camera::CameraTable>,
    object: Vec<Spanned<place::ObjectTable>>,
    model: Named<place::ModelTable>,
    material: Named<material::MaterialTable>,
    #[serde(rename = "override")]
    overrides: Named<Spanned<String>>,
    light: light::LightTables,
    environment: Option<Spanned<light::EnvironmentTable>>,
}

/// `up = "y"` or `"z"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Up {
    Y,
    Z,
}

impl Document {
    /// # Errors
    /// When there is no material called `name`.
    fn check_material(&self, name: &Spanned<String>, source: Source) -> Result<()> {
        match self.material.get(name.get_ref()) {
            Some(_) => Ok(()),
            None => {
                let known = self.material.names();
                Err(source.unknown_name(name.span(), "material", name.get_ref(), known))
            }
        }
    }
}

/// What loading is told besides the file.
#[derive(Default)]
pub struct LoadOptions<'a> {
    /// The material of every surface: no other material is looked at, nor the files that it names.
    pub material: Option<Material>,
    /// What surrounds the scene: the image that the file names for that is not read.
    pub surroundings: Option<Surroundings>,
    /// Told of bytes read and bytes in all while models are read.
    pub progress: Option<&'a dyn Fn(u64, u64)>,
}

/// A scene file larger than this is a mistake: a million transforms take a fifth of it.
const MAX_BYTES: u64 = 1 << 28;

/// [`load_scene_with`] no options.
///
/// # Errors
/// As there.
pub fn load_scene(path: &Path) -> Result<Scene> {
    load_scene_with(path, LoadOptions::default())
}

/// Reads the scene `path` with everything that it names: a `.toml` scene file, or an `.obj` model, which
/// is placed once, without camera and lights.
///
/// # Errors
/// When the scene file is wrong, or a model that it places cannot be read. Smaller faults, such as
/// textures that cannot be read, are [`Scene::warnings`].
pub fn load_scene_with(path: &Path, options: LoadOptions) -> Result<Scene> {
    match kind_of(path)? {
        Kind::SceneFile => load_scene_file(path, options),
        Kind::Model => load_model_alone(path, options),
    }
}

/// Whether there is a file that could be a scene: what can be said before reading it.
///
/// # Errors
/// When its name is not that of a scene, or it cannot be read.
pub fn check_scene(path: &Path) -> Result<()> {
    kind_of(path)?;
    open_regular(path).map(drop)
}

enum Kind {
    SceneFile,
    Model,
}

fn kind_of(path: &Path) -> Result<Kind> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "toml" => Ok(Kind::SceneFile),
        "obj" => Ok(Kind::Model),
        _ => Err(Error::Usage(format!(
            "{}: a scene is a .toml or an .obj file; rename or convert it",
            path.display()
        ))),
    }
}

fn load_scene_file(path: &Path, options: LoadOptions) -> Result<Scene> {
    let mut bytes = Vec::new();
    let mut file = open_regular(path)?.take(MAX_BYTES + 1);
    file.read_to_end(&mut bytes).map_err(|error| Error::io(path, "read", error))?;
    if bytes.len() as u64 > MAX_BYTES {
        let (name, limit) = (path.display(), MAX_BYTES >> 20);
        return Err(Error::Scene(format!("{name}: more than {limit} MiB; is it a scene file?")));
    }
    let text = match std::str::from_utf8(&bytes) {
        Ok(text) => text,
        Err(error) => {
            let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            let line = 1 + valid.matches('\n').count();
            let start = valid.lines().last().unwrap_or_default();
            return Err(Error::parse(path, line, start, "not UTF-8 here: save the file as UTF-8"));
        }
    };
    let source = Source::new(path, text);
    let document: Document = toml::from_str(text).map_err(|error| source.toml_error(&error))?;
    let mut scene = assemble::assemble(&document, source, options)?;
    scene.inputs.insert(0, path.to_path_buf());
    Ok(scene)
}

fn load_model_alone(path: &Path, options: LoadOptions) -> Result<Scene> {
    let mut builder = Builder::default();
    let progress = Progress::of([path], options.progress);
    let only = options.material.map(|material| builder.add_material(material));
    let materials = if only.is_some() { Materials::Named } else { Materials::Read };
    let model = builder.add_model(load_model(path, materials, &progress)?, |_| only);
    let world_from_object = DAffine3::IDENTITY;
    builder.scene.placements.push(Placement { model, world_from_object, material_override: None });
    Ok(builder.finish(options.surroundings))
}
