//! Albedo of rough dielectric interfaces: reflection with transmission, and reflection alone (coats).

use super::super::fresnel;
use super::super::grid::Grid;
use super::super::microfacet::{Ggx, SMOOTH_ALPHA};
use super::{
    LATTICE, Single, alpha_at, cosine_at, cosine_coordinate, direction, hemisphere_mean,
    roughness_coordinate,
};
use crate::math::Vec3;
use std::sync::LazyLock;

/// What an isotropic interface loses of the light from direction `w` (w.z > 0): 1 minus the energy that its
/// single scattering reflects and transmits. `eta` is the far side's index over that of the side of `w`.
#[inline]
pub(in super::super) fn dielectric_loss(ggx: &Ggx, cos_theta: f32, eta: f32) -> f32 {
    let alpha = ggx.alpha_x;
    let x = [eta_coordinate(eta), cosine_coordinate(cos_theta, alpha), roughness_coordinate(alpha)];
    let [loss, _] = DIRECTIONAL.get(x);
    loss
}

/// Cosine-weighted hemispherical mean of [`dielectric_loss`].
#[inline]
pub(in super::super) fn dielectric_loss_mean(ggx: &Ggx, eta: f32) -> f32 {
    let [mean] = LOSS_MEAN.get([roughness_coordinate(ggx.alpha_x), eta_coordinate(eta)]);
    mean
}

/// Albedo of the reflection from an isotropic interface, single scattering only, seen from `w` (w.z > 0).
/// Accurate for eta >= 1; below, near total reflection, good enough for the albedo of an image.
#[inline]
pub(in super::super) fn reflection_albedo(ggx: Option<&Ggx>, w: Vec3, eta: f32) -> f32 {
    let single = Single::new(ggx, w);
    let albedo = single.white * fresnel::dielectric(single.cos_fresnel, eta).0;
    match ggx {
        None => albedo,
        Some(ggx) => {
            let alpha = ggx.alpha_x;
            let c = cosine_coordinate(w.z, alpha);
            let [_, ratio] = DIRECTIONAL.get([eta_coordinate(eta), c, roughness_coordinate(alpha)]);
            (albedo * ratio).min(1.0)
        }
    }
}

/// Cosine-weighted hemispherical mean of [`reflection_albedo`].
#[inline]
pub(in super::super) fn coat_mean(ggx: Option<&Ggx>, eta: f32) -> f32 {
    let alpha = ggx.map_or(SMOOTH_ALPHA, |ggx| ggx.alpha_x);
    let [mean] = COAT_MEAN.get([roughness_coordinate(alpha), 2.0 * eta_coordinate(eta) - 1.0]);
    mean
}

/// The tables span indices from 1 / ETA_MAX to ETA_MAX; beyond, energy is kept only approximately.
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

/// Over (eta, cosine, roughness): the loss, and what the reflection's albedo is to
/// `Single::white * F(Single::cos_fresnel)`, a number near 1 when eta > 1.
static DIRECTIONAL: LazyLock<Grid<3, 2>> = LazyLock::new(|| {
    // An even number of nodes leaves out eta = 1, where the half vector of a transmission is undefined.
    const NODES: [usize; 3] = [26, 17, 13];
    let coordinate = |i: usize, n: usize| i as f32 / (n - 1) as f32;
    let mut values = Vec::with_capacity(NODES.iter().product());
    for r in 0..NODES[2] {
        let alpha = alpha_at(coordinate(r, NODES[2]));
        let ggx = Ggx { alpha_x: alpha, alpha_y: alpha };
        for c in 0..NODES[1] {
            let wo = direction(cosine_at(coordinate(c, NODES[1]), alpha), 1.0);
            let single = Single::new(Some(&ggx), wo);
            // All indices share the microfacets.
            let facets: Vec<Facet> = Facet::visible(&ggx, wo).collect();
            for e in 0..NODES[0] {
                let eta = eta_at(coordinate(e, NODES[0]));
                let (mut reflection, mut transmission) = (0.0, 0.0);
                for facet in &facets {
                    let (reflectance, cos_t) = fresnel::dielectric(facet.cos, eta);
                    reflection += facet.reflection * reflectance;
                    if reflectance < 1.0 {
                        let wi = fresnel::refract(wo, facet.h, eta, cos_t);
                        if wi.z < 0.0 {
                            let weight = facet.weight * (1.0 - reflectance);
                            transmission += weight * ggx.shadowing(wo, wi);
                        }
                    }
                }
                let estimate = single.white * fresnel::dielectric(single.cos_fresnel, eta).0;
                values.push([(1.0 - reflection - transmission).max(0.0), reflection / estimate]);
            }
        }
    }
    Grid::from_values(NODES, values)
});

/// A microfacet visible from `wo`, as a node of the quadrature.
struct Facet {
    h: Vec3,
    /// wo.h.
    cos: f32,
    weight: f32,
    /// The weight times the shadowing of what it reflects.
    reflection: f32,
}

impl Facet {
    fn visible(ggx: &Ggx, wo: Vec3) -> impl Iterator<Item = Self> {
        LATTICE.iter().map(move |node| {
            let h = ggx.visible_normal(wo, node.sin_cos, node.v);
            let wi = fresnel::reflect(wo, h);
            let shadowing = if wi.z > 0.0 { ggx.shadowing(wo, wi) } else { 0.0 };
            let reflection = node.weight * shadowing;
            Self { h, cos: wo.dot(h), weight: node.weight, reflection }
        })
    }
}

/// Over (roughness, eta).
static LOSS_MEAN: LazyLock<Grid<2, 1>> = LazyLock::new(|| {
    Grid::new([41, 51], |[r, e]| {
        let alpha = alpha_at(r);
        hemisphere_mean(32, |cos| {
            let [loss, _] = DIRECTIONAL.get([e, cosine_coordinate(cos, alpha), r]);
            [loss]
        })
    })
});

/// Over (roughness, eta >= 1).
static COAT_MEAN: LazyLock<Grid<2, 1>> = LazyLock::new(|| {
    Grid::new([11, 17], |[r, e]| {
        let alpha = alpha_at(r);
        let (ggx, eta) = (Ggx { alpha_x: alpha, alpha_y: alpha }, eta_at(0.5 + 0.5 * e));
        hemisphere_mean(64, |cos| [reflection_albedo(Some(&ggx), direction(cos, 1.0), eta)])
    })
});
