//! Maps from the unit square to discs, hemispheres, cones, spheres and triangles, each with its pdf.
//!
//! Source: pbrt 4th ed., appendix A.5; the concentric map is Shirley and Chiu, "A Low Distortion Map
//! Between Disk and Square", JGT 2(3), 1997. Directions are local: z is the axis. Every map is
//! area-preserving up to the stated density, so stratification of the square carries over.

use crate::math::{Vec2, Vec3, fun};
use std::f32::consts::{FRAC_1_PI, PI};

/// Uniform point on the unit disc (concentric map).
#[inline(always)]
pub fn disc([u, v]: [f32; 2]) -> Vec2 {
    let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    // In each quarter the angle from the nearer axis is an eighth turn times the ratio of the
    // coordinates. Selects instead of branches: which quarter it is, is random.
    let steep = y.abs() > x.abs();
    let (radius, other) = if steep { (y, x) } else { (x, y) };
    let ratio = other / if radius == 0.0 { 1.0 } else { radius };
    let (sin, cos) = fun::sin_cos_eighth(ratio);
    let (sin, cos) = if steep { (cos, sin) } else { (sin, cos) };
    Vec2::new(radius * cos, radius * sin)
}

/// Cosine-weighted direction around +z; its density is [`cosine_hemisphere_pdf`].
#[inline(always)]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let p = disc(u);
    Vec3::new(p.x, p.y, (1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] per solid angle.
#[inline(always)]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Uniform direction on the sphere; density 1 / (4 pi).
#[inline(always)]
pub fn sphere([u, v]: [f32; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = fun::sin_cos_turn(v);
    Vec3::new(r * cos, r * sin, z)
}

/// Uniform direction in the cone around +z whose half-angle has `one_minus_cos = 1 - cos`; density
/// [`cone_pdf`]. The argument keeps its digits for cones as narrow as the sun's.
#[inline(always)]
pub fn cone([u, v]: [f32; 2], one_minus_cos: f32) -> Vec3 {
    let h = u * one_minus_cos;
    // sin^2 = (1 - cos)(1 + cos) = h (2 - h)
    let r = (h * (2.0 - h)).max(0.0).sqrt();
    let (sin, cos) = fun::sin_cos_turn(v);
    Vec3::new(r * cos, r * sin, 1.0 - h)
}

/// Density of [`cone`] per solid angle.
#[inline(always)]
pub fn cone_pdf(one_minus_cos: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// Barycentric weights (of the second and third vertex) of a uniform point of a triangle.
///
/// Source: E. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
#[inline(always)]
pub fn triangle([u, v]: [f32; 2]) -> [f32; 2] {
    if v > u {
        let b1 = 0.5 * u;
        [b1, v - b1]
    } else {
        let b2 = 0.5 * v;
        [u - b2, b2]
    }
}
