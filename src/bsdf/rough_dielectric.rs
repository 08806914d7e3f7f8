//! Frosted glass: a rough dielectric interface, or a thin sheet with a rough face.
//!
//! Source: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, for
//! single scattering; the rest returns as in [`super::energy`]. Light that scattered often has forgotten
//! its side: it leaves to each side in proportion to M = n^2 mean(K), which makes the lobe one separable
//! function K(wo) K(wi) / (pi (M_near + M_far)) of the whole sphere, reciprocal across the interface.

use super::dielectric::{reflection_probability, relative_eta, sheet_reflectance};
use super::energy::{self, Single};
use super::microfacet::{self, Ggx};
use super::{BsdfSample, BsdfValue, LobeKind, Scatter, fresnel};
use crate::math::{Rgb, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Rough interface, or thin sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    ggx: Ggx,
    /// Index of the far side over that of the side of `wo`.
    eta: f32,
    transmittance: Rgb,
    thin: bool,
    /// M of the side of `wo` and of the far side, in units of the near index squared.
    multiple_near: f32,
    multiple_far: f32,
}

/// Whether the two sides differ by more than half vectors of transmissions drown in rounding with.
#[inline]
fn is_refractive(eta: f32) -> bool {
    (eta - 1.0).abs() >= 1e-3
}

impl RoughDielectric {
    /// As [`super::Dielectric::new`], with perceptual `roughness` in [0, 1]. A thin sheet scatters what it
    /// transmits as widely as what it reflects. `None`: the interface is smooth, or its two sides differ so
    /// little that it is as good as absent; a [`super::Dielectric`] describes it.
    #[inline]
    pub fn new(
        eta_inside_over_outside: f32,
        entering: bool,
        transmittance: Rgb,
        thin: bool,
        roughness: f32,
    ) -> Option<Self> {
        let ggx = Ggx::new(roughness, 0.0)?;
        let eta = relative_eta(eta_inside_over_outside, entering, thin);
        if !is_refractive(eta) {
            return None;
        }
        let (multiple_near, multiple_far) = if thin {
            let [white, _] = energy::single_mean(Some(&ggx));
            (1.0 - white, 1.0 - white)
        } else {
            let far = energy::dielectric_loss_mean(&ggx, 1.0 / eta);
            (energy::dielectric_loss_mean(&ggx, eta), eta * eta * far)
        };
        let transmittance = super::reflectance(transmittance);
        Some(Self { ggx, eta, transmittance, thin, multiple_near, multiple_far })
    }

    /// Whether rough glass of this refractive index is rough seen from either side.
    pub fn is_refractive(eta_inside_over_outside: f32, thin: bool) -> bool {
        [true, false]
            .iter()
            .all(|&side| is_refractive(relative_eta(eta_inside_over_outside, side, thin)))
    }

    /// K of a direction on either side.
    #[inline]
    fn loss(&self, w: Vec3) -> f32 {
        if self.thin {
            1.0 - Single::new(Some(&self.ggx), Vec3::new(w.x, w.y, w.z.abs())).white
        } else if w.z > 0.0 {
            energy::dielectric_loss(&self.ggx, w.z, self.eta)
        } else {
            energy::dielectric_loss(&self.ggx, -w.z, 1.0 / self.eta)
        }
    }

    /// Reflectance of a microfacet seen under this cosine, the probability to choose it, and the cosine behind.
    #[inline]
    fn reflectance(&self, cos: f32) -> (f32, f32, f32) {
        let (face, cos_t) = fresnel::dielectric(cos, self.eta);
        let reflectance = if self.thin { sheet_reflectance(face) } else { face };
        (reflectance, reflection_probability(reflectance, self.transmittance), cos_t)
    }

    /// eta^2 for radiance that crosses; a sheet leads back to the same medium.
    #[inline]
    fn eta_scale(&self) -> f32 {
        if self.thin { 1.0 } else { self.eta * self.eta }
    }

    /// The far direction of a sheet as a reflection.
    #[inline]
    fn unfold(wi: Vec3) -> Vec3 {
        Vec3::new(wi.x, wi.y, -wi.z)
    }

    /// Single scattering: value (with the radiance factor) and density.
    #[inline]
    fn single(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wi.z < 0.0 && !self.thin {
            return self.single_refraction(wo, wi);
        }
        let upper = if wi.z > 0.0 { wi } else { Self::unfold(wi) };
        let Some(h) = microfacet::reflection_half(wo, upper) else {
            return BsdfValue::ZERO;
        };
        let (reflectance, probability, _) = self.reflectance(wo.dot(h));
        let lobe = self.ggx.reflection(wo, upper, h);
        if wi.z > 0.0 {
            lobe.scaled(Rgb::splat(reflectance), probability)
        } else {
            lobe.scaled(self.transmittance * (1.0 - reflectance), 1.0 - probability)
        }
    }

    /// [`RoughDielectric::single`] across an interface.
    #[inline]
    fn single_refraction(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        let Some(h) = microfacet::refraction_half(wo, wi, self.eta) else {
            return BsdfValue::ZERO;
        };
        let reflectance = fresnel::dielectric_between(wo.dot(h), -wi.dot(h), self.eta);
        let probability = reflection_probability(reflectance, self.transmittance);
        self.ggx.transmission(wo, wi, h, self.eta).scaled(
            self.transmittance * ((1.0 - reflectance) / self.eta_scale()),
            1.0 - probability,
        )
    }

    /// All scattering, given what single scattering loses from `wo`: multiple scattering is chosen with that
    /// probability, and then a side by its M.
    #[inline]
    fn value(&self, loss: f32, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wi.z == 0.0 {
            return BsdfValue::ZERO;
        }
        let single = self.single(wo, wi);
        let multiple = self.multiple_near + self.multiple_far;
        let mut value =
            BsdfValue { pdf_solid_angle: (1.0 - loss) * single.pdf_solid_angle, ..single };
        if multiple > 0.0 {
            let cos_i = wi.z.abs();
            let (side, tint) = if wi.z > 0.0 {
                (self.multiple_near, Rgb::WHITE)
            } else {
                (self.multiple_far, self.transmittance)
            };
            let pdf = energy::spread_pdf(cos_i, energy::loss_grazing(&self.ggx));
            value += BsdfValue {
                f_cos: tint * (loss * self.loss(wi) * cos_i * FRAC_1_PI / multiple),
                pdf_solid_angle: loss * side / multiple * pdf,
            };
        }
        value
    }
}

impl Scatter for RoughDielectric {
    const HAS_LOBES: bool = true;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wo.z > 0.0 { self.value(self.loss(wo), wo, wi) } else { BsdfValue::ZERO }
    }

    #[inline]
    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let loss = self.loss(wo);
        let wi = if lobe < loss {
            let wi = energy::sample_spread(direction, energy::loss_grazing(&self.ggx));
            let near = self.multiple_near / (self.multiple_near + self.multiple_far);
            if lobe < loss * near { wi } else { Self::unfold(wi) }
        } else {
            let h = self.ggx.sample_visible(wo, direction);
            let (_, probability, cos_t) = self.reflectance(wo.dot(h));
            let reflected = fresnel::reflect(wo, h);
            if lobe - loss < (1.0 - loss) * probability {
                (reflected.z > 0.0).then_some(reflected)?
            } else if self.thin {
                (reflected.z > 0.0).then_some(Self::unfold(reflected))?
            } else {
                let refracted = fresnel::refract(wo, h, self.eta, cos_t);
                (refracted.z < 0.0).then_some(refracted)?
            }
        };
        let value = self.value(loss, wo, wi);
        if wi.z > 0.0 {
            BsdfSample::spread(wi, value, LobeKind::Glossy)
        } else {
            let sample = BsdfSample::spread(wi, value, LobeKind::Refraction)?;
            Some(BsdfSample { eta_scale: self.eta_scale(), ..sample })
        }
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        let single = if self.thin {
            let single = Single::new(Some(&self.ggx), wo);
            single.white * self.reflectance(single.cos_fresnel).0
        } else {
            energy::reflection_albedo(Some(&self.ggx), wo, self.eta)
        };
        let near =
            self.multiple_near / (self.multiple_near + self.multiple_far).max(f32::MIN_POSITIVE);
        let reflected = (single + self.loss(wo) * near).min(1.0);
        Rgb::splat(reflected) + self.transmittance * (1.0 - reflected)
    }

    #[inline]
    fn is_delta(&self) -> bool {
        false
    }
}
