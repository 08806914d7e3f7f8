//! Loads an OBJ model with its materials: reads the polygons, then the libraries, then joins them.
//!
//! A bad part of a file is left out and said in a warning that names its line; only a file without a
//! single usable face is an error.

use super::image_request::{ImageRequest, ImageTable};
use super::mtl::{MtlRecord, read_mtl};
use super::mtl_material::Context;
use super::obj_mesh::{build_meshes, snapped_origin};
use super::obj_read::{ObjFile, read_obj};
use super::obj_scan::{Named, Scan};
use super::paths::{Found, find_file};
use super::progress::Progress;
use super::warning_list::WarningList;
use crate::error::{Error, Location, Result, Warning};
use crate::math::DVec3;
use crate::scene::{Material, Model};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model file as it was read, with all that its meshes refer to.
#[derive(Debug)]
pub struct LoadedModel {
    /// The meshes, one for each set of attributes that faces of the file have.
    pub model: Model,
    /// The materials that faces use, in the order of their first use; the meshes' `MaterialId`s index this list.
    pub materials: Vec<Material>,
    /// The images that these materials need, not decoded; the materials' `ImageId`s index this list.
    pub images: Vec<ImageRequest>,
    /// Everything that was dropped, repaired or replaced.
    pub warnings: Vec<Warning>,
    /// The files that were read, the model first.
    pub inputs: Vec<PathBuf>,
}

/// Loads the OBJ file at `path` and the material libraries that it names.
///
/// # Errors
/// When the file cannot be read, is not text, or has no face that can be rendered.
pub fn load_obj(path: &Path) -> Result<LoadedModel> {
    load_model(path, Materials::Read, &Progress::default())
}

/// What is done about the materials of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Materials {
    /// Their libraries are read.
    Read,
    /// Others take their place, so only their names are wanted.
    Named,
}

/// [`load_obj`], as `progress` is told; materials that are only named are grey.
pub(super) fn load_model(
    path: &Path,
    materials: Materials,
    progress: &Progress,
) -> Result<LoadedModel> {
    let ObjFile { groups, mut scan } = read_obj(path, progress)?;
    let origin = snapped_origin(scan.first_vertex.map_or(DVec3::ZERO, DVec3::from_array));
    let mut warnings = std::mem::take(&mut scan.warnings);
    let meshes = build_meshes(path, groups, &scan.faces, origin, &mut warnings)?;
    if meshes.is_empty() {
        return Err(nothing_to_render(path, scan));
    }

    let mut inputs = vec![path.to_path_buf()];
    let mut images = ImageTable::new();
    let used = scan.materials.list.iter();
    let materials = if materials == Materials::Read {
        let libraries = Libraries::read(path, &scan.libraries.list, &mut inputs, &mut warnings);
        used.map(|used| libraries.material(path, used, &mut images, &mut warnings)).collect()
    } else {
        used.map(|used| grey(path, used)).collect()
    };
    Ok(LoadedModel {
        model: Model {
            name: path.display().to_string(),
            location: None,
            meshes: meshes.into_iter().map(Arc::new).collect(),
        },
        materials,
        images: images.into_requests(),
        warnings: warnings.finish(path),
        inputs,
    })
}

/// Why a file without a single triangle cannot be rendered.
fn nothing_to_render(path: &Path, scan: Scan) -> Error {
    let broken = scan.dropped;
    match scan.first_dropped {
        Some(Error::Parse { location, text, message, .. }) if scan.faces.is_empty() => {
            let message =
                format!("no usable face in this file: {broken} are broken; the first: {message}");
            Error::parse(location.path, location.line, text, message)
        }
        _ => {
            let reason = match (scan.faces.len(), broken) {
                (0, _) => "no faces in this file (lines that begin with f); is it an OBJ model?",
                (_, 0) => "no usable face in this file: all have zero area",
                _ => "no usable face in this file: all are broken or have zero area",
            };
            Error::Scene(format!("{}: {reason}", path.display()))
        }
    }
}

/// The material libraries of a model.
struct Libraries {
    /// Each file with its materials.
    files: Vec<(PathBuf, Vec<MtlRecord>)>,
    /// Name to file and record.
    index: HashMap<String, (usize, usize)>,
}

impl Libraries {
    /// Reads every file that `statements` (the texts behind `mtllib`) name, each once. Adds them to `inputs`.
    fn read(
        model: &Path,
        statements: &[Named],
        inputs: &mut Vec<PathBuf>,
        warnings: &mut WarningList,
    ) -> Self {
        let mut libraries = Self { files: Vec::new(), index: HashMap::new() };
        let mut seen = HashSet::new();
        for statement in statements {
            let location = Location::new(model, statement.line);
            for path in find_libraries(statement, &location, warnings) {
                if !seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
                    continue;
                }
                match read_mtl(&path, warnings) {
                    Ok(records) => {
                        inputs.push(path.clone());
                        libraries.add(path, records, warnings);
                    }
                    Err(error) => warnings.add("libraries unreadable", location.clone(), || {
                        format!("material library dropped, its materials are grey: {error}")
                    }),
                }
            }
        }
        libraries
    }

    /// Of materials with the same name the first counts, as the format's manual has it.
    fn add(&mut self, path: PathBuf, records: Vec<MtlRecord>, warnings: &mut WarningList) {
        let file = self.files.len();
        for (i, record) in records.iter().enumerate() {
            if let Some(&(f, r)) = self.index.get(&record.name) {
                let (first_path, first) = match self.files.get(f) {
                    Some((path, records)) => (path, &records[r]),
                    None => (&path, &records[r]),
                };
                warnings.add("repeated materials", Location::new(&path, record.line), || {
                    let first = Location::new(first_path, first.line);
                    format!(
                        "material {:?} is already defined at {first}; that one is used",
                        record.name
                    )
                });
            } else {
                self.index.insert(record.name.clone(), (file, i));
            }
        }
        self.files.push((path, records));
    }

    /// The material that faces of `model` use under a name: grey when there is none of that name.
    fn material(
        &self,
        model: &Path,
        used: &Named,
        images: &mut ImageTable,
        warnings: &mut WarningList,
    ) -> Material {
        if used.name.is_empty() {
            return grey(model, used);
        }
        // A comment may follow the name; but '#' may also be part of it.
        let bare = used.name.split(" #").next().unwrap_or_default().trim_end();
        let Some(&(file, record)) = self.index.get(&used.name).or_else(|| self.index.get(bare))
        else {
            let location = Location::new(model, used.line);
            warnings.add("materials missing", location.clone(), || {
                format!("material {:?} is in no library of this model; it is grey", used.name)
            });
            return grey(model, used);
        };
        let (path, records) = &self.files[file];
        Context { library: path, images, warnings }.material(&records[record])
    }
}

/// What stands for a material of `model` of which no more than the name is known, if that.
fn grey(model: &Path, used: &Named) -> Material {
    if used.name.is_empty() {
        return Material::default_grey();
    }
    let location = Some(Location::new(model, used.line));
    Material { name: used.name.clone(), location, ..Material::default_grey() }
}

/// The files that one `mtllib` at `location` names: one file whose name may have spaces, or several.
fn find_libraries(
    statement: &Named,
    location: &Location,
    warnings: &mut WarningList,
) -> Vec<PathBuf> {
    let folder = location.path.parent().unwrap_or(Path::new(""));
    let names = &statement.name;
    let is_missing = |found: &Found| matches!(found, Found::Missing(_));
    let is_as_named = |found: &Found| matches!(found, Found::AsNamed(_));
    let mut found = vec![find_file(folder, names)];
    if !is_as_named(&found[0]) {
        let parts: Vec<Found> =
            names.split_whitespace().map(|name| find_file(folder, name)).collect();
        if parts.iter().any(is_as_named) || is_missing(&found[0]) && !parts.iter().all(is_missing) {
            found = parts;
        }
    }
    let mut paths = Vec::new();
    for file in found {
        match file {
            Found::AsNamed(path) => paths.push(path),
            Found::Elsewhere(path) => {
                warnings.add("libraries found elsewhere", location.clone(), || {
                    format!("{names:?} is not there; {} is read instead", path.display())
                });
                paths.push(path);
            }
            Found::Missing(path) => {
                warnings.add("libraries missing", location.clone(), || {
                    let path = path.display().to_string();
                    format!("material library {path:?} does not exist; its materials are grey")
                });
            }
        }
    }
    paths
}
