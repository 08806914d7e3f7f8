//! The images that materials ask for, each (file, colour space) once.
//!
//! Nothing is decoded here: a request says what to decode and which line to blame when that fails.

use crate::error::Location;
use crate::image::ColorSpace;
use crate::scene::ImageId;
use std::collections::HashMap;
use std::path::PathBuf;

/// An image that some material needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageRequest {
    /// The file, canonical where it exists.
    pub path: PathBuf,
    /// How to read it.
    pub color_space: ColorSpace,
    /// The line that asks for it first.
    pub location: Location,
}

/// Requests in the order of their [`ImageId`]s.
#[derive(Clone, Debug, Default)]
pub struct ImageTable {
    requests: Vec<ImageRequest>,
    ids: HashMap<(PathBuf, ColorSpace), ImageId>,
}

impl ImageTable {
    /// A table without requests.
    pub fn new() -> Self {
        Self::default()
    }

    /// The index of the image `path` read as `color_space`; `location` is remembered when it is new.
    pub fn request(
        &mut self,
        path: PathBuf,
        color_space: ColorSpace,
        location: Location,
    ) -> ImageId {
        let next = ImageId(u32::try_from(self.requests.len()).unwrap_or(u32::MAX));
        let requests = &mut self.requests;
        *self.ids.entry((path.clone(), color_space)).or_insert_with(|| {
            requests.push(ImageRequest { path, color_space, location });
            next
        })
    }

    /// The requests; `ImageId(i)` is entry i.
    pub fn into_requests(self) -> Vec<ImageRequest> {
        self.requests
    }
}
