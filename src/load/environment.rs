//! An environment image that the command line names, added to a scene that is already loaded.

use crate::error::Result;
use crate::image::{ColorSpace, read};
use crate::scene::{ImageId, Scene};
use std::path::Path;
use std::sync::Arc;

/// Reads the image at `path` (radiance: linear for HDR and EXR, sRGB for the rest) into `scene`.
///
/// # Errors
/// [`crate::error::Error::Io`] or `Image` when it cannot be read.
pub fn add_environment_image(scene: &mut Scene, path: &Path) -> Result<ImageId> {
    let image = read(path, ColorSpace::Srgb)?;
    scene.images.push(Arc::new(image));
    scene.inputs.push(path.to_path_buf());
    Ok(ImageId(scene.images.len() as u32 - 1))
}
