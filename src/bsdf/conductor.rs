//! Metals, smooth or rough, with their exact Fresnel reflectance and multiple scattering.
//!
//! Source: [`super::fresnel`] and [`super::energy`]; the colour that multiple scattering takes on is Kulla
//! and Conty's (2017) with the correction of S. Hill (2018): light of the second and later bounces has been
//! reflected at least twice.

use super::energy::{self, Single};
use super::microfacet::{self, Ggx};
use super::{BsdfSample, BsdfValue, LobeKind, Scatter, fresnel};
use crate::math::{Rgb, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    eta: Rgb,
    k: Rgb,
    /// `None`: a mirror.
    ggx: Option<Ggx>,
    /// Reflectance of the multiply scattered lobe over pi times the mean loss.
    multiple: Rgb,
}

impl Conductor {
    /// `eta` and `k` >= 0 are the real and imaginary parts of the index of refraction per channel (see
    /// [`super::Metal`]); `roughness` in [0, 1] is perceptual; `anisotropy` in [-1, 1] stretches highlights
    /// along the local x axis (positive) or y axis.
    #[inline]
    pub fn new(eta: Rgb, k: Rgb, roughness: f32, anisotropy: f32) -> Self {
        let ggx = Ggx::new(roughness, anisotropy);
        let mut multiple = Rgb::BLACK;
        if ggx.is_some() {
            let [white, _] = energy::single_mean(ggx.as_ref());
            let mean = energy::hemisphere_mean(4, |cos| fresnel::conductor(cos, eta, k).to_array());
            multiple =
                Rgb::from(mean.map(|f| multiple_reflectance(f, white))) * loss_scale(1.0 - white);
        }
        Self { eta, k, ggx, multiple }
    }
}

/// Reflectance of light that left at the second bounce or later, of facets of mean reflectance `mean` whose
/// white single-scattering albedo has the mean `white`.
#[inline]
pub(super) fn multiple_reflectance(mean: f32, white: f32) -> f32 {
    mean * mean * white / (1.0 - mean * (1.0 - white))
}

/// 1 / (pi mean loss), the scale of a separable lobe; 0 where nothing is lost.
#[inline]
pub(super) fn loss_scale(mean_loss: f32) -> f32 {
    if mean_loss > 1e-6 { FRAC_1_PI / mean_loss } else { 0.0 }
}

impl Conductor {
    /// Value and density for a rough metal, given what single scattering loses from `wo`: multiple scattering
    /// is chosen with that probability.
    #[inline]
    fn rough(&self, ggx: &Ggx, loss_o: f32, wo: Vec3, wi: Vec3) -> BsdfValue {
        let Some(h) = microfacet::reflection_half(wo, wi).filter(|_| wi.z > 0.0) else {
            return BsdfValue::ZERO;
        };
        let reflectance = fresnel::conductor(wo.dot(h), self.eta, self.k);
        let mut value = ggx.reflection(wo, wi, h).scaled(reflectance, 1.0 - loss_o);
        let loss_i = 1.0 - Single::new(Some(ggx), wi).white;
        value += BsdfValue {
            f_cos: self.multiple * (loss_o * loss_i * wi.z),
            pdf_solid_angle: loss_o * energy::spread_pdf(wi.z, energy::loss_grazing(ggx)),
        };
        value
    }
}

impl Scatter for Conductor {
    const HAS_LOBES: bool = true;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        match &self.ggx {
            Some(ggx) if wo.z > 0.0 => {
                self.rough(ggx, 1.0 - Single::new(Some(ggx), wo).white, wo, wi)
            }
            _ => BsdfValue::ZERO,
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let Some(ggx) = &self.ggx else {
            return BsdfSample::mirrored(wo, fresnel::conductor(wo.z, self.eta, self.k));
        };
        let loss = 1.0 - Single::new(Some(ggx), wo).white;
        let wi = if lobe < loss {
            energy::sample_spread(direction, energy::loss_grazing(ggx))
        } else {
            fresnel::reflect(wo, ggx.sample_visible(wo, direction))
        };
        BsdfSample::spread(wi, self.rough(ggx, loss, wo, wi), LobeKind::Glossy)
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        let single = Single::new(self.ggx.as_ref(), wo);
        let [white, _] = energy::single_mean(self.ggx.as_ref());
        let multiple = self.multiple * (PI * (1.0 - white) * (1.0 - single.white));
        fresnel::conductor(single.cos_fresnel, self.eta, self.k) * single.white + multiple
    }

    #[inline]
    fn is_delta(&self) -> bool {
        self.ggx.is_none()
    }
}
