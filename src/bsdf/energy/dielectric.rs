//! Albedo of rough dielectric interfaces: reflection with transmission, and reflection alone (coats).

use super::super::fresnel;
use super::super::grid::Grid;
use super::super::microfacet::{Ggx, SMOOTH_ALPHA};
use super::{
    Single, alpha_at, cosine_at, cosine_coordinate, direction, hemisphere_mean,
    roughness_coordinate, visible_mean,
};
use crate::math::Vec3;
use std::sync::LazyLock;

/// What an isotropic interface loses of the light from direction `w` (w.z > 0): 1 minus the energy that its
/// single scattering reflects and transmits. `eta` is the far side's index over that of the side of `w`.
#[inline]
pub(in super::super) fn dielectric_loss(ggx: &Ggx, cos_theta: f32, eta: f32) -> f32 {
    let alpha = ggx.alpha_x;
    let x = [cosine_coordinate(cos_theta, alpha), roughness_coordinate(alpha), eta_coordinate(eta)];
    let [loss, _] = DIRECTIONAL.get(x);
    loss
}

/// Cosine-weighted hemispherical mean of [`dielectric_loss`].
#[inline]
pub(in super::super) fn dielectric_loss_mean(ggx: &Ggx, eta: f32) -> f32 {
    let [mean] = LOSS_MEAN.get([roughness_coordinate(ggx.alpha_x), eta_coordinate(eta)]);
    mean
}

/// Albedo of the reflection from a coat: single scattering of an isotropic interface to a medium of relative
/// index `eta` >= 1, seen from `w` (w.z > 0).
#[inline]
pub(in super::super) fn coat_albedo(ggx: Option<&Ggx>, w: Vec3, eta: f32) -> f32 {
    let single = Single::new(ggx, w);
    let albedo = single.white * fresnel::dielectric(single.cos_fresnel, eta).0;
    match ggx {
        None => albedo,
        Some(ggx) => {
            let alpha = ggx.alpha_x;
            let c = cosine_coordinate(w.z, alpha);
            let [_, ratio] = DIRECTIONAL.get([c, roughness_coordinate(alpha), eta_coordinate(eta)]);
            (albedo * ratio).min(1.0)
        }
    }
}

/// Cosine-weighted hemispherical mean of [`coat_albedo`].
#[inline]
pub(in super::super) fn coat_mean(ggx: Option<&Ggx>, eta: f32) -> f32 {
    let alpha = ggx.map_or(SMOOTH_ALPHA, |ggx| ggx.alpha_x);
    let [mean] = COAT_MEAN.get([roughness_coordinate(alpha), 2.0 * eta_coordinate(eta) - 1.0]);
    mean
}

/// The tables span indices from 1 / ETA_MAX to ETA_MAX.
const ETA_MAX: f32 = 4.0;

/// Table coordinate of an index ratio: finest around 1; an interface's two sides mirror at 1/2.
#[inline]
fn eta_coordinate(eta: f32) -> f32 {
    const ROOT_MAX: f32 = (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
    // The root of the reflectance at normal incidence.
    let root = (eta - 1.0) / (eta + 1.0);
    0.5 + 0.5 * (root.abs() / ROOT_MAX).sqrt().copysign(root)
}

/// Inverse of [`eta_coordinate`].
fn eta_at(coordinate: f32) -> f32 {
    let s = 2.0 * coordinate - 1.0;
    let root = s * s.abs() * (ETA_MAX - 1.0) / (ETA_MAX + 1.0);
    (1.0 + root) / (1.0 - root)
}

/// Over (cosine, roughness, eta): the loss, and what the reflection's albedo is to
/// `Single::white * F(Single::cos_fresnel)`, a number near 1 when eta > 1.
static DIRECTIONAL: LazyLock<Grid<3, 2>> = LazyLock::new(|| {
    // An even number of nodes leaves out eta = 1, where the half vector of a transmission is undefined.
    Grid::new([17, 13, 22], |[c, r, e]| {
        let (alpha, eta) = (alpha_at(r), eta_at(e));
        let ggx = Ggx { alpha_x: alpha, alpha_y: alpha };
        let wo = direction(cosine_at(c, alpha), 1.0);
        let [reflection, transmission] = visible_mean(&ggx, wo, |h| {
            let (reflectance, cos_t) = fresnel::dielectric(wo.dot(h), eta);
            let wi = fresnel::reflect(wo, h);
            let reflection = if wi.z > 0.0 { reflectance * ggx.shadowing(wo, wi) } else { 0.0 };
            if reflectance == 1.0 {
                return [reflection, 0.0];
            }
            let wi = fresnel::refract(wo, h, eta, cos_t);
            let transmittance = 1.0 - reflectance;
            let transmission = if wi.z < 0.0 { transmittance * ggx.shadowing(wo, wi) } else { 0.0 };
            [reflection, transmission]
        });
        let single = Single::new(Some(&ggx), wo);
        let estimate = single.white * fresnel::dielectric(single.cos_fresnel, eta).0;
        [(1.0 - reflection - transmission).max(0.0), reflection / estimate]
    })
});

/// Over (roughness, eta).
static LOSS_MEAN: LazyLock<Grid<2, 1>> = LazyLock::new(|| {
    Grid::new([41, 27], |[r, e]| {
        let alpha = alpha_at(r);
        hemisphere_mean(32, |cos| {
            let [loss, _] = DIRECTIONAL.get([cosine_coordinate(cos, alpha), r, e]);
            [loss]
        })
    })
});

/// Over (roughness, eta >= 1).
static COAT_MEAN: LazyLock<Grid<2, 1>> = LazyLock::new(|| {
    Grid::new([11, 17], |[r, e]| {
        let alpha = alpha_at(r);
        let (ggx, eta) = (Ggx { alpha_x: alpha, alpha_y: alpha }, eta_at(0.5 + 0.5 * e));
        hemisphere_mean(64, |cos| [coat_albedo(Some(&ggx), direction(cos, 1.0), eta)])
    })
});
