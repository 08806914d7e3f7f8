//! Cameras: from a place on the film to a ray.
//!
//! Compiled from `f64` to `f32`, relative to the world origin. Right-handed: looking along -z with y up,
//! +x is to the right in the picture. Knows no scene and no sampler.
//!
//! Film positions are in pixels, y downward: (0, 0) is the top left corner of the image, pixel centres
//! are at halves, and a filter may ask beyond the edges.

mod framing;
mod lanes;
mod orthographic;
mod panoramic;
mod perspective;
mod view;

pub use framing::{frame, frame_points};
pub use lanes::CameraRays;
pub use view::View;

use crate::error::Result;
use crate::geometry::Ray;
use orthographic::Orthographic;
use panoramic::Panoramic;
use perspective::Perspective;
use view::Basis;

/// A ray from the camera, with the cone that its pixel sees (for the footprints of textures): at distance
/// t the cone is `initial_width + spread * t` wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Its direction has length 1.
    pub ray: Ray,
    /// Angle that one pixel covers, radians: the square root of its solid angle.
    pub spread: f32,
    /// Width of one pixel at the origin of the ray, scene units.
    pub initial_width: f32,
}

/// A camera for images of one size.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    basis: Basis,
    projection: Projection,
}

/// Every projection.
#[derive(Clone, Copy, Debug)]
enum Projection {
    /// Pinhole, or thin lens.
    Perspective(Perspective),
    /// Parallel rays.
    Orthographic(Orthographic),
    /// All directions.
    Panoramic(Panoramic),
}

impl Camera {
    /// A pinhole camera. `vertical_fov` in degrees, within (0, 180). Errors say which number is wrong.
    pub fn perspective(view: &View, size: [u32; 2], vertical_fov: f64) -> Result<Self> {
        let projection = Projection::Perspective(Perspective::new(size, vertical_fov)?);
        Ok(Self { basis: view.basis()?, projection })
    }

    /// A camera with a lens of radius `lens_radius` >= 0 in focus at `focus_distance` > 0 along its axis,
    /// both in scene units.
    pub fn thin_lens(
        view: &View,
        size: [u32; 2],
        vertical_fov: f64,
        lens_radius: f64,
        focus_distance: f64,
    ) -> Result<Self> {
        let pinhole = Perspective::new(size, vertical_fov)?;
        let projection = Projection::Perspective(pinhole.with_lens(lens_radius, focus_distance)?);
        Ok(Self { basis: view.basis()?, projection })
    }

    /// A parallel projection; the picture is `picture_height` > 0 scene units high. Rays start in the
    /// plane of the camera's position: what is behind it is not seen.
    pub fn orthographic(view: &View, size: [u32; 2], picture_height: f64) -> Result<Self> {
        let projection = Projection::Orthographic(Orthographic::new(size, picture_height)?);
        Ok(Self { basis: view.basis()?, projection })
    }

    /// A full latitude-longitude panorama with `view.to` in its centre and `view.up` towards its top row;
    /// it is laid out as an image environment is.
    pub fn panoramic(view: &View, size: [u32; 2]) -> Result<Self> {
        let projection = Projection::Panoramic(Panoramic::new(size)?);
        Ok(Self { basis: view.basis()?, projection })
    }

    /// Whether [`Camera::ray`] depends on `lens`.
    pub fn needs_lens(&self) -> bool {
        matches!(&self.projection, Projection::Perspective(p) if p.has_lens())
    }

    /// The ray through `film` (pixels), `lens` a uniform point of the square.
    #[inline]
    pub fn ray(&self, film: [f32; 2], lens: [f32; 2]) -> CameraRay {
        match &self.projection {
            Projection::Perspective(p) => p.ray(&self.basis, film, lens),
            Projection::Orthographic(p) => p.ray(&self.basis, film),
            Projection::Panoramic(p) => p.ray(&self.basis, film),
        }
    }
}
