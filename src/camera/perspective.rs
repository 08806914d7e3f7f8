//! Perspective projection through a pinhole or a thin lens.
//!
//! Source: pbrt 4th ed., sections 5.2.2 and 5.2.3. The lens is a disc around the camera's position; all
//! rays of one film point meet in the plane `focus_distance` along the view axis.

use super::CameraRay;
use super::view::{Basis, checked_size};
use crate::error::{Error, Result};
use crate::geometry::Ray;
use crate::math::Vec3;
use crate::math::fun::double;
use crate::sampling::warp;

/// Perspective camera without its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Perspective {
    /// Middle of the film, pixels.
    center: [f32; 2],
    /// Edge of a pixel on the plane at distance 1.
    pixel: f32,
    /// Scene units; 0 for a pinhole.
    lens_radius: f32,
    focus_distance: f32,
}

impl Perspective {
    pub(super) fn new(size: [u32; 2], vertical_fov: f64) -> Result<Self> {
        let [width, height] = checked_size(size)?;
        if !(vertical_fov > 0.0 && vertical_fov < 180.0) {
            return Err(Error::Scene(format!(
                "the vertical field of view is {vertical_fov} degrees; give a number between 0 and 180, \
                 for instance 40"
            )));
        }
        let half_height = double::tan(0.5 * vertical_fov.to_radians());
        Ok(Self {
            center: [(0.5 * width) as f32, (0.5 * height) as f32],
            pixel: (2.0 * half_height / height) as f32,
            lens_radius: 0.0,
            focus_distance: 1.0,
        })
    }

    pub(super) fn with_lens(self, lens_radius: f64, focus_distance: f64) -> Result<Self> {
        if !(lens_radius >= 0.0 && (lens_radius as f32).is_finite()) {
            return Err(Error::Scene(format!(
                "the lens radius is {lens_radius}; give scene units of at least 0 (0: all in focus)"
            )));
        }
        if !(focus_distance > 0.0 && (focus_distance as f32).is_finite()) {
            return Err(Error::Scene(format!(
                "the focus distance is {focus_distance}; give the distance of what is to be sharp, \
                 more than 0 scene units"
            )));
        }
        let (lens_radius, focus_distance) = (lens_radius as f32, focus_distance as f32);
        Ok(Self { lens_radius, focus_distance, ..self })
    }

    pub(super) fn has_lens(&self) -> bool {
        self.lens_radius > 0.0
    }

    #[inline(always)]
    pub(super) fn ray(&self, basis: &Basis, film: [f32; 2], lens: [f32; 2]) -> CameraRay {
        match self.has_lens() {
            true => self.ray_through_lens(basis, film, lens),
            false => self.ray_of_pinhole(basis, film),
        }
    }

    #[inline(always)]
    pub(super) fn ray_of_pinhole(&self, basis: &Basis, film: [f32; 2]) -> CameraRay {
        let direction = self.through(basis, film).normalize();
        let spread = self.spread(basis, direction);
        CameraRay { ray: Ray::new(basis.origin, direction), spread, initial_width: 0.0 }
    }

    #[inline(always)]
    pub(super) fn ray_through_lens(
        &self,
        basis: &Basis,
        film: [f32; 2],
        lens: [f32; 2],
    ) -> CameraRay {
        let through = self.through(basis, film);
        let p = warp::disc(lens) * self.lens_radius;
        let offset = basis.right * p.x + basis.up * p.y;
        let direction = (through * self.focus_distance - offset).normalize();
        let spread = self.spread(basis, through.normalize());
        CameraRay { ray: Ray::new(basis.origin + offset, direction), spread, initial_width: 0.0 }
    }

    /// The film position on the plane at distance 1, from the centre of the lens.
    #[inline(always)]
    fn through(&self, basis: &Basis, film: [f32; 2]) -> Vec3 {
        let x = (film[0] - self.center[0]) * self.pixel;
        let y = (self.center[1] - film[1]) * self.pixel;
        basis.right * x + basis.up * y + basis.forward
    }

    /// A pixel's solid angle is its area times cos^3, as its distance is 1 / cos.
    #[inline(always)]
    fn spread(&self, basis: &Basis, direction: Vec3) -> f32 {
        let cos_theta = direction.dot(basis.forward).max(0.0);
        self.pixel * cos_theta * cos_theta.sqrt()
    }
}
