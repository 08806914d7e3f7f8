//! `[[object]]` and `[model.NAME]`: what stands where. Nested models are flattened to one transform each.
//!
//! A model is a file, or a list of objects that may place other models. Nothing here reads a file: it
//! says which files are needed and where they go.

use super::Document;
use super::source::Source;
use super::transform::{Matrix, Rotation, Scale, TransformTable, is_regular};
use super::value::Point;
use crate::error::Result;
use crate::math::DAffine3;
use serde::Deserialize;
use std::collections::HashMap;
use toml::Spanned;

/// Models inside models inside models: no scene needs more.
const MAX_DEPTH: usize = 64;

/// Placements that a scene may flatten to, empty models included.
const MAX_PLACEMENTS: u64 = 1 << 24;

/// `[[object]]`: one model, placed once or many times.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    file: Option<Spanned<String>>,
    model: Option<Spanned<String>>,
    pub(super) material: Option<Spanned<String>>,
    matrix: Option<Matrix>,
    scale: Option<Scale>,
    rotate: Option<Rotation>,
    translate: Option<Point>,
    transforms: Option<Vec<TransformTable>>,
}

/// `[model.NAME]`: a file, or objects.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelTable {
    file: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) object: Vec<Spanned<ObjectTable>>,
}

/// One file in one place.
pub(super) struct PlacedFile<'d> {
    /// The OBJ file as written.
    pub(super) file: &'d Spanned<String>,
    pub(super) world_from_object: DAffine3,
    /// Name of the innermost material that the objects around the file say.
    pub(super) material: Option<&'d str>,
}

/// What an object or a model shows.
enum Content<'d> {
    File(&'d Spanned<String>),
    Model(&'d Spanned<String>, &'d ModelTable),
}

/// Every file of the scene with its place, in the order of the file; and the models that are never placed.
///
/// # Errors
/// For an object or model without content or with two, an unknown model or material, models that place
/// each other in a circle or deeper than [`MAX_DEPTH`], more than [`MAX_PLACEMENTS`], and a composed
/// transform without an inverse.
pub(super) fn flatten<'d>(
    document: &'d Document,
    source: Source<'d>,
) -> Result<(Vec<PlacedFile<'d>>, Vec<&'d Spanned<String>>)> {
    let mut check = Check { document, source, path: Vec::new(), counts: HashMap::new() };
    let mut total = 0_u64;
    for object in &document.object {
        total = total.saturating_add(check.count(object)?);
        if total > MAX_PLACEMENTS {
            let message =
                format!("with this object there are over {MAX_PLACEMENTS} placements: place fewer");
            return Err(source.error(object.span(), message));
        }
    }
    let is_placed = |name: &str| check.counts.contains_key(name);
    let unplaced = document.model.iter().map(|model| &model.0);
    let unplaced: Vec<_> = unplaced.filter(|name| !is_placed(name.get_ref())).collect();
    for (name, model) in document.model.iter() {
        check.count_model(name, model)?;
    }
    let mut flatten = Flatten { check: &check, placed: Vec::new() };
    for object in &document.object {
        flatten.object(object, &DAffine3::IDENTITY, None)?;
    }
    Ok((flatten.placed, unplaced))
}

/// First pass: every reference holds, there is no circle, and the number of placements is known.
struct Check<'d> {
    document: &'d Document,
    source: Source<'d>,
    /// The models that are open, outermost first.
    path: Vec<&'d str>,
    /// Placements within each model that was checked.
    counts: HashMap<&'d str, u64>,
}

impl<'d> Check<'d> {
    /// What `object` shows.
    fn content(&self, object: &'d Spanned<ObjectTable>) -> Result<Content<'d>> {
        let models = &self.document.model;
        let message = match (&object.get_ref().file, &object.get_ref().model) {
            (Some(file), None) => return Ok(Content::File(file)),
            (None, Some(name)) => {
                let model = models.get(name.get_ref()).ok_or_else(|| {
                    self.source.unknown_name(name.span(), "model", name.get_ref(), models.names())
                })?;
                return Ok(Content::Model(name, model));
            }
            (Some(_), Some(_)) => "this object has `file` and `model` at once: keep one of them",
            (None, None) => "this object shows nothing: give it a `file` or a `model`",
        };
        Err(self.source.error(object.span(), message))
    }

    /// Placements that `object` flattens to, itself included.
    fn count(&mut self, object: &'d Spanned<ObjectTable>) -> Result<u64> {
        let table = object.get_ref();
        if let Some(material) = &table.material {
            self.document.check_material(material, self.source)?;
        }
        let within = match self.content(object)? {
            Content::File(_) => 1,
            Content::Model(name, model) => self.count_model(name, model)?,
        };
        let times = table.transforms.as_ref().map_or(1, |list| list.len() as u64);
        Ok(times.saturating_mul(within).saturating_add(1))
    }

    /// Placements that `model` flattens to, itself included; `place` is where it is named.
    fn count_model(&mut self, place: &'d Spanned<String>, model: &'d ModelTable) -> Result<u64> {
        let name = place.get_ref().as_str();
        if let Some(&count) = self.counts.get(name) {
            return Ok(count);
        }
        if let Some(first) = self.path.iter().position(|open| *open == name) {
            let circle = [&self.path[first..], &[name]].concat().join(" -> ");
            let message = format!("models place each other in a circle: {circle}");
            return Err(self.source.error(place.span(), message));
        }
        if self.path.len() >= MAX_DEPTH {
            let message = format!("models are nested more than {MAX_DEPTH} deep: flatten some");
            return Err(self.source.error(place.span(), message));
        }
        if model.file.is_some() != model.object.is_empty() {
            let message = format!("model `{name}` needs a `file` or objects, and not both");
            return Err(self.source.error(place.span(), message));
        }
        self.path.push(name);
        let mut count = 1_u64;
        for object in &model.object {
            count = count.saturating_add(self.count(object)?);
        }
        self.path.pop();
        self.counts.insert(name, count);
        Ok(count)
    }
}

/// Second pass: transforms are composed and written down.
struct Flatten<'c, 'd> {
    check: &'c Check<'d>,
    placed: Vec<PlacedFile<'d>>,
}

impl<'d> Flatten<'_, 'd> {
    fn object(
        &mut self,
        object: &'d Spanned<ObjectTable>,
        world_from_parent: &DAffine3,
        outer_material: Option<&'d str>,
    ) -> Result<()> {
        let table = object.get_ref();
        let content = self.check.content(object)?;
        let own_material = table.material.as_ref().map(|name| name.get_ref().as_str());
        let material = own_material.or(outer_material);
        let world_from_own = *world_from_parent * table.own_transform().affine();
        let once = [TransformTable::default()];
        for transform in table.transforms.as_deref().unwrap_or(&once) {
            let world_from_object = world_from_own * transform.affine();
            if !is_regular(&world_from_object) {
                let message = "this object's transform, with those around it, is singular: it flattens \
                               the object, or scales it beyond 1e-15 to 1e15";
                return Err(self.check.source.error(object.span(), message));
            }
            match content {
                Content::File(file) => {
                    self.placed.push(PlacedFile { file, world_from_object, material });
                }
                Content::Model(_, model) => self.model(model, &world_from_object, material)?,
            }
        }
        Ok(())
    }

    fn model(
        &mut self,
        model: &'d ModelTable,
        world_from_model: &DAffine3,
        material: Option<&'d str>,
    ) -> Result<()> {
        if let Some(file) = &model.file {
            self.placed.push(PlacedFile { file, world_from_object: *world_from_model, material });
        }
        model.object.iter().try_for_each(|object| self.object(object, world_from_model, material))
    }
}

impl ObjectTable {
    /// The transform that the object's own keys say.
    fn own_transform(&self) -> TransformTable {
        let Self { matrix, scale, rotate, translate, .. } = *self;
        TransformTable { matrix, scale, rotate, translate }
    }
}
