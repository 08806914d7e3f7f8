//! Uniform sampling of an emissive triangle by area.
//!
//! Emission is two-sided: the cosine at the light counts by its absolute value. Source of the change
//! of measure: pbrt 4th ed., section 4.2.4. Knows neither the triangle's radiance nor who owns it.

use crate::math::Vec3;
use crate::sampling::warp;
use std::f32::consts::PI;

/// Area of the triangle.
#[inline]
pub fn area([a, b, c]: &[Vec3; 3]) -> f32 {
    0.5 * (*b - *a).cross(*c - *a).length()
}

/// A uniform point of the triangle, and the barycentric weights of its second and third vertex. Its
/// density per area is `1 / area`.
#[inline]
pub fn sample_area([a, b, c]: &[Vec3; 3], u: [f32; 2]) -> (Vec3, [f32; 2]) {
    let [b1, b2] = warp::triangle(u);
    (*a + (*b - *a) * b1 + (*c - *a) * b2, [b1, b2])
}

/// A density per area at a point of a surface, as a density per solid angle seen from `distance` away
/// along a direction that makes `cos_theta` with the surface's geometric normal (either side):
/// `pdf_area * distance^2 / |cos_theta|`. Infinite when seen edge-on; such a sample carries nothing.
#[inline]
pub fn pdf_solid_angle(pdf_area: f32, distance: f32, cos_theta: f32) -> f32 {
    pdf_area * distance * distance / cos_theta.abs()
}

/// Power that both sides of a surface of this area emit at constant radiance: `2 pi area radiance`.
#[inline]
pub fn power_estimate(area: f32, radiance_luminance: f32) -> f32 {
    2.0 * PI * area * radiance_luminance
}
