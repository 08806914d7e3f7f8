//! Fresnel reflectance of smooth interfaces, for unpolarised light, and the vectors that go with it.
//!
//! Source: M. Born and E. Wolf, "Principles of Optics", 7th ed., sections 1.5.2 (dielectrics) and 14.2
//! (conductors); C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", EGSR 1994, for
//! the approximation. Knows no roughness.

use crate::math::{Rgb, Vec3};

/// `v` reflected at the plane with unit normal `n`.
#[inline]
pub(super) fn reflect(v: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * v.dot(n)) - v
}

/// `v` (on the side of the unit normal `n`) refracted into the other side, by Snell's law;
/// `eta` is the other side's index over this side's, `cos_t` comes from [`dielectric`]. Unit length.
#[inline]
pub(super) fn refract(v: Vec3, n: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    ((n * v.dot(n) - v) / eta - n * cos_t).normalize()
}

/// Reflectance of a dielectric and the cosine of the refracted direction, 0 at total internal reflection.
/// `cos_i` >= 0; `eta` > 0 is the index of the far side over that of the side of arrival.
#[inline]
pub(super) fn dielectric(cos_i: f32, eta: f32) -> (f32, f32) {
    let cos_i = cos_i.min(1.0);
    // Snell: sin_t = sin_i / eta.
    let cos2_t = 1.0 - (1.0 - cos_i) * (1.0 + cos_i) / (eta * eta);
    if cos2_t <= 0.0 {
        return (1.0, 0.0);
    }
    let cos_t = cos2_t.sqrt();
    (dielectric_between(cos_i, cos_t, eta), cos_t)
}

/// Reflectance of a dielectric where both cosines are known, which keeps its digits near total reflection.
#[inline]
pub(super) fn dielectric_between(cos_i: f32, cos_t: f32, eta: f32) -> f32 {
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Reflectance of a metal with the complex index `eta + i k` (one channel), seen from air.
#[inline]
fn conductor_channel(cos_i: f32, eta: f32, k: f32) -> f32 {
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    // (a + i b)^2 = (eta + i k)^2 - sin^2: the normal component of the refracted wave vector.
    let difference = eta * eta - k * k - sin2;
    let modulus = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (modulus + difference)).max(0.0).sqrt();
    let perpendicular = (modulus + cos2 - 2.0 * a * cos_i) / (modulus + cos2 + 2.0 * a * cos_i);
    let (even, odd) = (modulus * cos2 + sin2 * sin2, 2.0 * a * cos_i * sin2);
    // Without a normal component (modulus = 0) at grazing incidence the ratio is 0/0: all is reflected.
    let sum = even + odd;
    let parallel = if sum > 0.0 { perpendicular * (even - odd) / sum } else { perpendicular };
    (0.5 * (perpendicular + parallel)).clamp(0.0, 1.0)
}

/// Reflectance of a metal with index of refraction `eta` and extinction coefficient `k` in air.
#[inline]
pub(super) fn conductor(cos_i: f32, eta: Rgb, k: Rgb) -> Rgb {
    let cos_i = cos_i.clamp(0.0, 1.0);
    eta.zip(k, |eta, k| conductor_channel(cos_i, eta, k))
}

/// (1 - cos)^5.
#[inline]
pub(super) fn schlick_weight(cos_i: f32) -> f32 {
    let m = (1.0 - cos_i).clamp(0.0, 1.0);
    let m2 = m * m;
    m2 * m2 * m
}
