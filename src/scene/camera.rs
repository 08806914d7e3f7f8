//! Cameras as files describe them.

use crate::error::Location;
use crate::math::DVec3;

/// Where the camera is, where it looks, and how it projects.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name for `--camera`.
    pub name: String,
    /// Where it is defined, if in a file.
    pub location: Option<Location>,
    /// Position.
    pub from: DVec3,
    /// A point in the middle of the picture.
    pub to: DVec3,
    /// Upward in the picture; need not be perpendicular to the view.
    pub up: DVec3,
    /// The projection.
    pub projection: Projection,
}

/// Kinds of projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Pinhole.
    Perspective {
        /// Vertical field of view, degrees in (0, 180).
        vertical_fov: f64,
    },
    /// Lens with depth of field.
    ThinLens {
        /// Vertical field of view, degrees in (0, 180).
        vertical_fov: f64,
        /// Radius of the lens, scene units.
        lens_radius: f64,
        /// Distance along the view axis of the plane in focus.
        focus_distance: f64,
    },
    /// Parallel projection.
    Orthographic {
        /// Height of the picture in scene units.
        height: f64,
    },
    /// Full latitude-longitude panorama; `to` is in its centre.
    Panoramic,
}

impl Projection {
    /// Whether it blurs what is out of focus.
    pub fn has_lens(&self) -> bool {
        matches!(self, Self::ThinLens { lens_radius, .. } if *lens_radius > 0.0)
    }
}
