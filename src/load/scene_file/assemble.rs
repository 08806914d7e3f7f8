//! A parsed document becomes a [`Scene`]: its parts are checked, models are read, images decoded.

use super::builder::Builder;
use super::place::{self, PlacedFile};
use super::settings;
use super::source::Source;
use super::texture::Textures;
use super::{Document, LoadOptions, Up};
use crate::error::Result;
use crate::image::open_regular;
use crate::load::ImageTable;
use crate::load::obj::{Materials, load_model};
use crate::load::progress::Progress;
use crate::math::DVec3;
use crate::scene::{MaterialId, ModelId, Placement, Scene};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::Path;
use toml::Spanned;

/// The scene that `document` describes.
///
/// # Errors
/// Everything in the document that contradicts itself, and models and an environment image that cannot
/// be read.
pub(super) fn assemble(document: &Document, source: Source, options: LoadOptions) -> Result<Scene> {
    // What the document says by itself.
    let (placed, unplaced) = place::flatten(document, source)?;
    let mut overrides = Overrides::new(document, source)?;
    let mut builder = Builder::default();
    let scene = &mut builder.scene;
    scene.settings = settings::settings(&document.film, &document.render, source)?;
    if document.up == Some(Up::Z) {
        scene.up = DVec3::Z;
    }
    for (name, camera) in document.camera.iter() {
        scene.cameras.push(camera.camera(name, scene.up, source)?);
    }
    (scene.lights, scene.light_locations) = document.light.lights(source)?.into_iter().unzip();
    scene.warnings.extend(unplaced.into_iter().map(|name| {
        source.warning(name.span(), format!("model `{}` is never placed", name.get_ref()))
    }));
    let only = options.material.map(|material| builder.add_material(material));
    let mut used = HashSet::new();
    if only.is_none() {
        used.extend(placed.iter().filter_map(|file| file.material).chain(overrides.materials()));
    }
    let mut surroundings = options.surroundings;
    if let Some(table) = &document.environment {
        let own = table.get_ref().surroundings(table.span(), source, surroundings.is_some())?;
        surroundings = surroundings.or(own);
    }
    let library = add_library(document, source, &used, &mut builder)?;
    let material_of = |name| only.or_else(|| library.get(name).copied());

    // Models, each file once.
    let files = files_to_read(&placed, source)?;
    let progress = Progress::of(files.keys().map(|file| source.resolve(file)), options.progress);
    let mut models: HashMap<&str, ModelId> = HashMap::new();
    for PlacedFile { file, world_from_object, material } in placed {
        let name = file.get_ref().as_str();
        let material_override = material.and_then(material_of);
        let model = match models.get(name) {
            Some(&model) => model,
            None => {
                // Where none of its own materials can be seen, what is seen first takes their place.
                let instead = if files[name] { only } else { material_override };
                let materials = if instead.is_some() { Materials::Named } else { Materials::Read };
                let mut loaded = load_model(&source.resolve(name), materials, &progress)?;
                loaded.model.location = Some(source.location(&file.span()));
                let model = builder.add_model(loaded, |name| {
                    let replacement = overrides.replacement(name);
                    instead.or_else(|| material_of(replacement?))
                });
                *models.entry(name).or_insert(model)
            }
        };
        builder.scene.placements.push(Placement { model, world_from_object, material_override });
    }
    overrides.check_all_met(source)?;

    Ok(builder.finish(surroundings))
}

/// The files that are placed, and of each whether it is without a material from the scene file somewhere.
///
/// # Errors
/// For one that is not there or no regular file, before the first is read.
fn files_to_read<'d>(placed: &[PlacedFile<'d>], source: Source) -> Result<HashMap<&'d str, bool>> {
    let mut files = HashMap::new();
    for PlacedFile { file, material, .. } in placed {
        let name = file.get_ref().as_str();
        if !files.contains_key(name) {
            check_file(&source.resolve(name)).map_err(|e| source.error(file.span(), e))?;
        }
        *files.entry(name).or_insert(false) |= material.is_none();
    }
    Ok(files)
}

fn check_file(path: &Path) -> std::result::Result<(), String> {
    if !path.exists() {
        return Err(format!("there is no file {}", path.display()));
    }
    open_regular(path).map(drop).map_err(|error| error.to_string())
}

/// Adds the materials of the document that are `used`, and checks the others too. Ids by name.
fn add_library<'d>(
    document: &'d Document,
    source: Source,
    used: &HashSet<&str>,
    builder: &mut Builder,
) -> Result<HashMap<&'d str, MaterialId>> {
    let mut ids = HashMap::new();
    for (name, table) in document.material.iter() {
        if used.contains(name.get_ref().as_str()) {
            let mut textures = Textures { source, images: &mut builder.images };
            let material = table.material(name, &mut textures)?;
            ids.insert(name.get_ref().as_str(), builder.add_material(material));
        } else {
            // No file is read for a material that nothing shows.
            let mut ignored = ImageTable::new();
            table.material(name, &mut Textures { source, images: &mut ignored })?;
        }
    }
    Ok(ids)
}

/// `[override]`: MTL material to material of the document.
struct Overrides<'d> {
    entries: Vec<(&'d Spanned<String>, &'d str)>,
    /// Names of the MTL materials of all models.
    mtl_names: BTreeSet<String>,
}

impl<'d> Overrides<'d> {
    /// The overrides of `document`.
    ///
    /// # Errors
    /// For one to a material that the document does not define.
    fn new(document: &'d Document, source: Source) -> Result<Self> {
        let entry = |(mtl_name, material): &'d (Spanned<String>, Spanned<String>)| {
            document.check_material(material, source)?;
            Ok((mtl_name, material.get_ref().as_str()))
        };
        let entries = document.overrides.iter().map(entry).collect::<Result<_>>()?;
        Ok(Self { entries, mtl_names: BTreeSet::new() })
    }

    /// Names of the materials that replace others.
    fn materials(&self) -> impl Iterator<Item = &'d str> {
        self.entries.iter().map(|entry| entry.1)
    }

    /// The material that replaces `mtl_name`, a material of a model, if any does.
    fn replacement(&mut self, mtl_name: &str) -> Option<&'d str> {
        self.mtl_names.insert(mtl_name.to_owned());
        self.entries.iter().find(|entry| entry.0.get_ref() == mtl_name).map(|entry| entry.1)
    }

    /// Complains about an override of a material that no model has.
    fn check_all_met(&self, source: Source) -> Result<()> {
        let unmet = |entry: &&(&Spanned<String>, _)| !self.mtl_names.contains(entry.0.get_ref());
        match self.entries.iter().find(unmet) {
            None => Ok(()),
            Some((name, _)) => {
                let known = self.mtl_names.iter().map(String::as_str);
                Err(source.unknown_name(name.span(), "MTL material", name.get_ref(), known))
            }
        }
    }
}
