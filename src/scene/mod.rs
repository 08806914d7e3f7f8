//! What the files say, as plain data: the first stage of the pipeline.
//!
//! Everything a user wrote is kept in `f64` and in the units and axes of the file. Nothing here reads
//! a file (that is `load`) or computes anything about light (that is `world` and after).

mod camera;
mod effects;
mod light;
mod material;
mod mesh;

pub use camera::{Camera, Projection};
pub use effects::{Effect, EffectSet, Effects, Style};
pub use light::{Environment, Light};
pub use material::{
    Channel, ColorInput, Emission, Material, NormalInput, ScalarInput, Surface, TextureReference,
};
pub use mesh::MeshData;

use crate::error::{Location, Warning};
use crate::image::Image;
use crate::math::{DAffine3, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

/// Typed index into one of the vectors of a [`Scene`].
macro_rules! index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// The index as a `usize`.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

index!(
    /// Index into [`Scene::materials`].
    MaterialId
);
index!(
    /// Index into [`Scene::images`].
    ImageId
);
index!(
    /// Index into [`Scene::models`].
    ModelId
);

/// A model file: meshes that are placed together.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name for messages, usually the path.
    pub name: String,
    /// Where it is placed first, in the scene file.
    pub location: Option<Location>,
    /// The meshes, each with its own material per triangle.
    pub meshes: Vec<Arc<MeshData>>,
}

/// One placement of a model.
#[derive(Clone, Debug)]
pub struct Placement {
    /// What is placed.
    pub model: ModelId,
    /// Where: object (file) coordinates to world (scene file) coordinates.
    pub world_from_object: DAffine3,
    /// Replaces the material of every triangle of this placement.
    pub material_override: Option<MaterialId>,
}

/// A whole scene as its files describe it.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Upward: orients the sky, image environments and the automatic camera. +y unless said.
    pub up: DVec3,
    /// Model files that were read, each once however often it is placed.
    pub models: Vec<Model>,
    /// Where they stand.
    pub placements: Vec<Placement>,
    /// Every material, from MTL libraries and the scene file. Meshes and placements index this list.
    pub materials: Vec<Material>,
    /// Decoded images, each (path, colour space) once.
    pub images: Vec<Arc<Image>>,
    /// Lights that are not surfaces.
    pub lights: Vec<Light>,
    /// Where each of them is defined; empty when they come from no file.
    pub light_locations: Vec<Location>,
    /// What surrounds the scene, if it was said.
    pub environment: Option<Environment>,
    /// Where that is defined, if in a file.
    pub environment_location: Option<Location>,
    /// Cameras in the order of the file; the first is the default. Empty: framed automatically.
    pub cameras: Vec<Camera>,
    /// Render settings that the scene file sets; the command line overrides them.
    pub settings: SceneSettings,
    /// Everything that was dropped, repaired or replaced.
    pub warnings: Vec<Warning>,
    /// Every file that was read, in order: the scene's fingerprint covers their contents.
    pub inputs: Vec<PathBuf>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            up: DVec3::Y,
            models: Vec::new(),
            placements: Vec::new(),
            materials: Vec::new(),
            images: Vec::new(),
            lights: Vec::new(),
            light_locations: Vec::new(),
            environment: None,
            environment_location: None,
            cameras: Vec::new(),
            settings: SceneSettings::default(),
            warnings: Vec::new(),
            inputs: Vec::new(),
        }
    }
}

/// Render settings of a scene file; what is `None` was not said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneSettings {
    /// Image width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// Samples per pixel.
    pub samples_per_pixel: Option<u64>,
    /// Path segments; 1 shows emitters only.
    pub max_depth: Option<u32>,
    /// Name of the set of effects.
    pub effects: Option<String>,
    /// Name of the sampler.
    pub sampler: Option<String>,
    /// Random seed.
    pub seed: Option<u64>,
    /// `NAME[:radius]` of the pixel filter.
    pub filter: Option<String>,
    /// Exposure in stops for the PNG.
    pub exposure: Option<f32>,
    /// Name of the tone map.
    pub tonemap: Option<String>,
}
