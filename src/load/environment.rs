//! What surrounds a scene, read before the scene is: an image that cannot be read is found at once.

use crate::error::{Location, Result};
use crate::image::{ColorSpace, Image, read};
use crate::math::Rgb;
use crate::scene::{Environment, ImageId, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An environment that belongs to no scene yet.
#[derive(Debug)]
pub struct Surroundings {
    /// Its image is `image`, whatever id it says.
    environment: Environment,
    image: Option<(PathBuf, Image)>,
    location: Option<Location>,
}

impl Surroundings {
    /// Surroundings without an image.
    pub fn computed(environment: Environment) -> Self {
        Self { environment, image: None, location: None }
    }

    /// The image at `path` (radiance: linear for HDR and EXR, sRGB for the rest), times `scale`, turned by
    /// `rotation` degrees.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`] or `Image` when it cannot be read.
    pub fn image(path: &Path, scale: Rgb, rotation: f64) -> Result<Self> {
        let image = Some((path.to_path_buf(), read(path, ColorSpace::Srgb)?));
        let environment = Environment::Image { image: ImageId(0), scale, rotation };
        Ok(Self { environment, image, location: None })
    }

    /// The same, as defined at `location`.
    #[must_use]
    pub fn defined_at(self, location: Location) -> Self {
        Self { location: Some(location), ..self }
    }

    /// Puts them around `scene`, whose other images are all there.
    pub(super) fn surround(mut self, scene: &mut Scene) {
        if let (Environment::Image { image: id, .. }, Some((path, image))) =
            (&mut self.environment, self.image)
        {
            *id = ImageId(scene.images.len() as u32);
            scene.images.push(Arc::new(image));
            scene.inputs.push(path);
        }
        scene.environment = Some(self.environment);
        scene.environment_location = self.location;
    }
}
