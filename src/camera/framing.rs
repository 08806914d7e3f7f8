//! The automatic camera: a three-quarter view that the scene just fills.

use super::View;
use crate::error::{Error, Result};
use crate::math::DVec3;
use crate::math::fun::double;

/// Camera's azimuth from the front (+z for y up) towards +x, degrees.
const AZIMUTH: f64 = 30.0;
/// Camera's elevation above the horizon, degrees.
const ELEVATION: f64 = 20.0;
/// Part of the picture, from its middle to its edge, that stays empty.
const MARGIN: f64 = 0.05;

/// The perspective view, from the front right and slightly above, that holds the box `[min, max]` and is
/// as close as it can be with a margin of 5 %.
///
/// `up` is the scene's upward axis: +y, with the front towards +z, or +z, with the front towards -y. `aspect` is
/// width over height, `vertical_fov` in degrees. A box that is a point is given an edge of 1. Errors when
/// the box is empty or a number is not finite or out of range.
pub fn frame(bounds: [DVec3; 2], up: DVec3, aspect: f64, vertical_fov: f64) -> Result<View> {
    let [min, max] = bounds;
    let corners = (0..8).map(|i| {
        let pick = |bit: i32| if i & bit == 0 { 0.0 } else { 1.0 };
        min + (max - min) * DVec3::new(pick(1), pick(2), pick(4))
    });
    frame_points(bounds, corners, up, aspect, vertical_fov)
}

/// As [`frame`], around `points` instead of the corners of their box `[min, max]`: closer, and centred on
/// what is really there.
pub fn frame_points(
    [min, max]: [DVec3; 2],
    points: impl Iterator<Item = DVec3>,
    up: DVec3,
    aspect: f64,
    vertical_fov: f64,
) -> Result<View> {
    if !(min.is_finite() && max.is_finite() && min.cmple(max).all()) {
        return Err(Error::Scene(format!(
            "the scene reaches from {min} to {max}: there is nothing to point a camera at; \
             check the model or give a camera"
        )));
    }
    let in_range = aspect > 0.0 && aspect.is_finite() && vertical_fov > 0.0 && vertical_fov < 180.0;
    let side = DVec3::X.cross(up).try_normalize();
    let (true, Some(front)) = (in_range, side) else {
        return Err(Error::Scene(format!(
            "no camera can be framed with up {up}, aspect {aspect} and a vertical field of view of \
             {vertical_fov} degrees; give up as 0,1,0 or 0,0,1 and a field of view between 0 and 180"
        )));
    };

    // Axes of the picture.
    let up = up.normalize();
    let side = up.cross(front);
    let (sin_azimuth, cos_azimuth) = sin_cos(AZIMUTH);
    let (sin_elevation, cos_elevation) = sin_cos(ELEVATION);
    let horizontal = side * sin_azimuth + front * cos_azimuth;
    let forward = -(horizontal * cos_elevation + up * sin_elevation);
    let right = forward.cross(up).normalize();
    let upward = right.cross(forward);

    // The points relative to the middle of the box, in those axes.
    let center = 0.5 * min + 0.5 * max;
    let in_picture = |p: DVec3| DVec3::new(right.dot(p), upward.dot(p), forward.dot(p));
    // A single point gets something around it to fill the picture.
    let single = min == max;
    let around = [-0.5, 0.5].map(|h| in_picture(DVec3::splat(h)));
    let points = points.map(|p| in_picture(p - center));
    let points = points.chain(around.into_iter().filter(|_| single));

    // A camera at (x, y, z) sees a point p within the margin when |p.x - x| <= k (p.z - z), and likewise
    // in y. So x is at least max(p.x - k p.z) + k z and at most min(p.x + k p.z) - k z: such an x exists up
    // to a largest z, the closest the camera may come, and in the middle of the two it is centred.
    let tangent = (1.0 - MARGIN) * double::tan(0.5 * vertical_fov.to_radians());
    let (mut low, mut high) = ([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]);
    let slopes = [tangent * aspect, tangent];
    for p in points {
        for (axis, k) in slopes.into_iter().enumerate() {
            low[axis] = low[axis].max(p[axis] - k * p.z);
            high[axis] = high[axis].min(p[axis] + k * p.z);
        }
    }
    let closest = |axis: usize| (high[axis] - low[axis]) / (2.0 * slopes[axis]);
    let z = closest(0).min(closest(1));
    let (x, y) = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]));
    let from = center + right * x + upward * y + forward * z;
    Ok(View { from, to: from - forward * z, up })
}

fn sin_cos(degrees: f64) -> (f64, f64) {
    let angle = degrees.to_radians();
    (double::sin(angle), double::cos(angle))
}
