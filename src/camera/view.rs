//! Where a camera stands and how it is turned.

use crate::error::{Error, Result};
use crate::math::{DVec3, Vec3};

/// Position and orientation, in `f64` relative to the world origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the camera.
    pub from: DVec3,
    /// A point in the middle of the picture.
    pub to: DVec3,
    /// Upward in the picture; any length, need not be perpendicular to the view.
    pub up: DVec3,
}

/// Orthonormal axes of the picture, and the camera's position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Basis {
    pub(super) origin: Vec3,
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    pub(super) forward: Vec3,
}

impl View {
    /// The axes, computed in `f64` and rounded once. Errors when a number is not finite, the camera looks
    /// at itself, or `up` is along the view.
    pub(super) fn basis(&self) -> Result<Basis> {
        let Self { from, to, up } = *self;
        if !(from.as_vec3().is_finite() && to.is_finite() && up.is_finite()) {
            return Err(Error::Scene(format!(
                "the camera's from {from}, to {to} and up {up} must be finite numbers"
            )));
        }
        let Some(forward) = (to - from).try_normalize() else {
            return Err(Error::Scene(format!(
                "the camera's from and to are the same point, {from}; move one of them"
            )));
        };
        // The sine of the angle between view and up: below a millionth, the roll is not defined.
        let across = forward.cross(up.normalize_or_zero());
        if across.length() < 1e-6 {
            return Err(Error::Scene(format!(
                "the camera's up {up} is zero or along its view {forward}; choose another up, \
                 for instance 0,1,0, or 0,0,1 to look straight up or down"
            )));
        }
        let right = across.normalize();
        Ok(Basis {
            origin: from.as_vec3(),
            right: right.as_vec3(),
            up: right.cross(forward).as_vec3(),
            forward: forward.as_vec3(),
        })
    }
}

/// An error unless both sides of the image are at least one pixel.
pub(super) fn checked_size([width, height]: [u32; 2]) -> Result<[f64; 2]> {
    if width == 0 || height == 0 {
        return Err(Error::Scene(format!(
            "an image of {width} x {height} pixels has nothing in it; give a size of at least 1x1"
        )));
    }
    Ok([f64::from(width), f64::from(height)])
}
