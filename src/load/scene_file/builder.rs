//! Merges what several files say into one [`Scene`], with one list of materials and one of images.

use crate::error::Warning;
use crate::image::{self, Image};
use crate::load::{ImageRequest, ImageTable, LoadedModel, Surroundings};
use crate::scene::{ImageId, Material, MaterialId, ModelId, Scene};
use rayon::prelude::*;
use std::sync::Arc;

/// A scene in the making, whose images are not decoded yet.
#[derive(Default)]
pub(super) struct Builder {
    /// All but its images.
    pub(super) scene: Scene,
    /// The images asked for so far.
    pub(super) images: ImageTable,
}

impl Builder {
    /// Adds `material`, whose images are this builder's.
    pub(super) fn add_material(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    /// Adds a model with its materials and images; `replacement` may say another material for the one
    /// of a name.
    pub(super) fn add_model(
        &mut self,
        loaded: LoadedModel,
        mut replacement: impl FnMut(&str) -> Option<MaterialId>,
    ) -> ModelId {
        // From the model's own ids to the scene's. Images of replaced materials are not asked for.
        let LoadedModel { mut model, materials, images, warnings, inputs } = loaded;
        let material_ids: Vec<MaterialId> = materials
            .into_iter()
            .map(|mut material| match replacement(&material.name) {
                Some(id) => id,
                None => {
                    material.for_each_texture(|texture| {
                        texture.image = self.request(&images[texture.image.index()]);
                    });
                    self.add_material(material)
                }
            })
            .collect();
        for mesh in &mut model.meshes {
            for id in &mut Arc::make_mut(mesh).materials {
                *id = material_ids[id.index()];
            }
        }
        self.scene.warnings.extend(warnings);
        self.scene.inputs.extend(inputs);
        self.scene.models.push(model);
        ModelId(self.scene.models.len() as u32 - 1)
    }

    fn request(&mut self, request: &ImageRequest) -> ImageId {
        let ImageRequest { path, color_space, location } = request.clone();
        self.images.request(path, color_space, location)
    }

    /// The scene with its images decoded, all at once, and with its surroundings. An image that is missing or
    /// broken is replaced by a stand-in, with a warning where it is named.
    pub(super) fn finish(self, surroundings: Option<Surroundings>) -> Scene {
        let Self { mut scene, images } = self;
        let requests = images.into_requests();
        let read = |request: &ImageRequest| image::read(&request.path, request.color_space);
        let decoded: Vec<_> = requests.par_iter().map(read).collect();
        for (request, result) in requests.into_iter().zip(decoded) {
            let mut warn = |message| {
                scene.warnings.push(Warning { location: Some(request.location.clone()), message });
            };
            let mut image = result.unwrap_or_else(|error| {
                warn(format!("{error}; a stand-in colour is shown instead"));
                Image::missing()
            });
            let repaired = image.replace_impossible();
            if repaired > 0 {
                let name = request.path.display();
                warn(format!(
                    "{name}: {repaired} texels that are negative, NaN (taken as 0) or infinite (as 65504)"
                ));
            }
            scene.images.push(Arc::new(image));
            scene.inputs.push(request.path);
        }
        if let Some(surroundings) = surroundings {
            surroundings.surround(&mut scene);
        }
        scene
    }
}
