//! Plastic, lacquered wood, glazed ceramics: a diffuse base under a dielectric coat, smooth or rough.
//!
//! With R the albedo of the coat from outside, light enters as 1 - R(wi), meets the base and the inner
//! reflection F_i of the coat again and again, and leaves as 1 - R(wo). The series sums to
//! rho (1 - F_i) / (1 - rho F_i) (1 - R(wo)) (1 - R(wi)) / (pi (1 - mean R)), where reciprocity fixes
//! (1 - mean R) = eta^2 (1 - F_i). It is reciprocal, and a white base returns everything.
//! Source: the diffuse light of L. Wolff, "Diffuse-reflectance model for smooth dielectric surfaces", JOSA A
//! 11(11), 1994; normalised for any R as in C. Kelemen and L. Szirmay-Kalos, "A Microfacet Based Coupled
//! Specular-Matte BRDF Model", Eurographics 2001.

use super::conductor::loss_scale;
use super::microfacet::{self, Ggx};
use super::{BsdfSample, BsdfValue, LobeKind, Scatter, energy, fresnel, reflectance};
use crate::math::{Rgb, Vec3};
use crate::sampling::warp;

/// Coated diffuse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// rho (1 - F_i) / (1 - rho F_i).
    base: Rgb,
    /// 1 / (pi (1 - mean R)).
    base_scale: f32,
    eta: f32,
    /// `None`: a smooth coat, which reflects as a delta lobe.
    ggx: Option<Ggx>,
}

impl Plastic {
    /// `albedo` in [0, 1] is the base's own; `eta` >= 1 is the index of the coat (smaller values count as 1);
    /// `roughness` in [0, 1] is the coat's, perceptual.
    #[inline]
    pub fn new(albedo: Rgb, eta: f32, roughness: f32) -> Self {
        let ggx = Ggx::new(roughness, 0.0);
        let eta = eta.max(1.0);
        let transmitted = 1.0 - energy::coat_mean(ggx.as_ref(), eta);
        let escape = (transmitted / (eta * eta)).clamp(0.0, 1.0);
        Self {
            base: reflectance(albedo).map(|rho| rho * escape / (1.0 - rho * (1.0 - escape))),
            base_scale: loss_scale(transmitted),
            eta,
            ggx,
        }
    }

    /// R, the albedo of the coat.
    #[inline]
    fn coat(&self, w: Vec3) -> f32 {
        energy::reflection_albedo(self.ggx.as_ref(), w, self.eta)
    }

    /// Probability of the coat's lobe, given R(wo): its share of the energy.
    #[inline]
    fn coat_probability(&self, coat: f32) -> f32 {
        let base = (1.0 - coat) * self.base.max_channel();
        if coat + base > 0.0 { coat / (coat + base) } else { 0.0 }
    }

    /// Value and density, given R(wo).
    #[inline]
    fn value(&self, coat: f32, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wi.z <= 0.0 {
            return BsdfValue::ZERO;
        }
        let probability = self.coat_probability(coat);
        let mut value = BsdfValue {
            f_cos: self.base * (self.base_scale * (1.0 - coat) * (1.0 - self.coat(wi)) * wi.z),
            pdf_solid_angle: (1.0 - probability) * warp::cosine_hemisphere_pdf(wi.z),
        };
        if let (Some(ggx), Some(h)) = (&self.ggx, microfacet::reflection_half(wo, wi)) {
            let (reflectance, _) = fresnel::dielectric(wo.dot(h), self.eta);
            value += ggx.reflection(wo, wi, h).scaled(Rgb::splat(reflectance), probability);
        }
        value
    }
}

impl Scatter for Plastic {
    const HAS_LOBES: bool = true;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wo.z > 0.0 { self.value(self.coat(wo), wo, wi) } else { BsdfValue::ZERO }
    }

    #[inline]
    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let coat = self.coat(wo);
        let probability = self.coat_probability(coat);
        let (wi, kind) = if lobe >= probability {
            (warp::cosine_hemisphere(direction), LobeKind::Diffuse)
        } else if let Some(ggx) = &self.ggx {
            (fresnel::reflect(wo, ggx.sample_visible(wo, direction)), LobeKind::Glossy)
        } else {
            return BsdfSample::mirrored(wo, Rgb::splat(coat / probability));
        };
        BsdfSample::spread(wi, self.value(coat, wo, wi), kind)
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        let coat = self.coat(wo);
        Rgb::splat(coat) + self.base * (1.0 - coat)
    }

    #[inline]
    fn is_delta(&self) -> bool {
        self.ggx.is_none() && self.base.is_black()
    }
}
