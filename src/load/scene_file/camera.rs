//! `[camera.NAME]`: where a camera stands and how it projects (one table named after the kind).

use super::source::{Source, exactly_one};
use super::value::{FieldOfView, Length, Point, Radius};
use crate::error::Result;
use crate::math::DVec3;
use crate::scene::{Camera, Projection};
use serde::Deserialize;
use toml::Spanned;

/// `[camera.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    from: Point,
    to: Point,
    /// Said nothing: the scene's.
    up: Option<Point>,
    perspective: Option<Perspective>,
    thin_lens: Option<ThinLens>,
    orthographic: Option<Orthographic>,
    panoramic: Option<Panoramic>,
}

/// `[camera.NAME.perspective]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Perspective {
    vertical_fov: FieldOfView,
}

/// `[camera.NAME.thin_lens]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ThinLens {
    vertical_fov: FieldOfView,
    lens_radius: Radius,
    /// Said nothing: the distance from `from` to `to`.
    focus_distance: Option<Length>,
}

/// `[camera.NAME.orthographic]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Orthographic {
    height: Length,
}

/// `[camera.NAME.panoramic]`: the table is empty.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Panoramic {}

impl CameraTable {
    /// The camera for `scene`, called `name`; `scene_up` is upward where it says nothing else.
    ///
    /// # Errors
    /// When it looks nowhere (`from` is `to`), when `up` is along the view, when there is not exactly one
    /// projection.
    pub(super) fn camera(
        &self,
        name: &Spanned<String>,
        scene_up: DVec3,
        source: Source,
    ) -> Result<Camera> {
        let complain = |message: &str| {
            source.error(name.span(), format!("camera `{}` {message}", name.get_ref()))
        };
        let [from, to] = [self.from, self.to].map(Point::vector);
        let up = self.up.map_or(scene_up, Point::vector);
        let view = to - from;
        if view == DVec3::ZERO {
            return Err(complain("looks at its own position: move `from` or `to`"));
        }
        // The sine of the angle between view and up: below a millionth, the roll is not defined.
        let sine = view.normalize_or_zero().cross(up.normalize_or_zero()).length();
        if sine < 1e-6 {
            return Err(complain("has an `up` along its view: choose another `up`"));
        }
        let projection = exactly_one([
            ("perspective", self.perspective.as_ref().map(Perspective::projection)),
            ("thin_lens", self.thin_lens.as_ref().map(|lens| lens.projection(view.length()))),
            ("orthographic", self.orthographic.as_ref().map(Orthographic::projection)),
            ("panoramic", self.panoramic.as_ref().map(|_| Projection::Panoramic)),
        ])
        .map_err(|message| complain(&message))?;
        let location = Some(source.location(&name.span()));
        Ok(Camera { name: name.get_ref().clone(), location, from, to, up, projection })
    }
}

impl Perspective {
    fn projection(&self) -> Projection {
        Projection::Perspective { vertical_fov: self.vertical_fov.0 }
    }
}

impl ThinLens {
    fn projection(&self, view_length: f64) -> Projection {
        Projection::ThinLens {
            vertical_fov: self.vertical_fov.0,
            lens_radius: self.lens_radius.0,
            focus_distance: self.focus_distance.map_or(view_length, |distance| distance.0),
        }
    }
}

impl Orthographic {
    fn projection(&self) -> Projection {
        Projection::Orthographic { height: self.height.0 }
    }
}
