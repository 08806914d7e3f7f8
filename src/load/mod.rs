//! Files to scene data: OBJ models and their MTL libraries.
//!
//! Whatever the files hold, the result is a scene that can be rendered, warnings that name the line of
//! every dropped part, or an error; never a panic. Images are asked for here ([`ImageRequest`]) and
//! decoded elsewhere. Must not know how light is transported, only what the files mean.

mod environment;
mod fingerprint;
mod image_request;
mod line_filter;
mod mtl;
mod mtl_material;
mod mtl_texture;
mod obj;
mod obj_element;
mod obj_filter;
mod obj_mesh;
mod obj_polygon;
mod obj_read;
mod obj_scan;
mod paths;
mod progress;
mod scene_file;
mod warning_list;

pub use crate::image::ColorSpace;
pub use environment::Surroundings;
pub use fingerprint::fingerprint;
pub use image_request::{ImageRequest, ImageTable};
pub use mtl::load_mtl;
pub use obj::{LoadedModel, load_obj};
pub use scene_file::{LoadOptions, check_scene, load_scene, load_scene_with};
