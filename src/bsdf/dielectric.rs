//! Smooth glass and liquids: Fresnel reflection and refraction; and thin sheets of them.
//!
//! Source: [`super::fresnel`]; for the sheet, the geometric series of the inner reflections (pbrt 4th ed.,
//! section 9.5). Absorption inside is the integrator's.

use super::{BsdfSample, BsdfValue, LobeKind, Scatter, fresnel};
use crate::math::{Rgb, Vec3};

/// Smooth interface, or thin sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Index of the far side over that of the side of `wo`.
    eta: f32,
    transmittance: Rgb,
    thin: bool,
}

impl Dielectric {
    /// `eta_inside_over_outside` > 0; `entering`: `wo` is outside; `transmittance` in [0, 1] multiplies what
    /// passes. `thin`: a sheet without an inside, which light leaves in the direction in which it came;
    /// it is the same from both sides, so `entering` does not matter.
    #[inline]
    pub fn new(
        eta_inside_over_outside: f32,
        entering: bool,
        transmittance: Rgb,
        thin: bool,
    ) -> Self {
        let eta = relative_eta(eta_inside_over_outside, entering, thin);
        Self { eta, transmittance: super::reflectance(transmittance), thin }
    }

    /// Reflectance from `wo`, and the cosine of the refracted direction.
    #[inline]
    fn reflectance(&self, wo: Vec3) -> (f32, f32) {
        let (single, cos_t) = fresnel::dielectric(wo.z, self.eta);
        (if self.thin { sheet_reflectance(single) } else { single }, cos_t)
    }
}

/// Index of the far side over that of the side of `wo`.
#[inline]
pub(super) fn relative_eta(eta_inside_over_outside: f32, entering: bool, thin: bool) -> f32 {
    if entering || thin { eta_inside_over_outside } else { 1.0 / eta_inside_over_outside }
}

/// Reflectance of a sheet both of whose faces have reflectance F: F + (1-F)^2 F (1 + F^2 + F^4 + ...).
#[inline]
pub(super) fn sheet_reflectance(face: f32) -> f32 {
    2.0 * face / (1.0 + face)
}

/// Probability of reflecting: its share of the energy, the transmitted part being tinted.
#[inline]
pub(super) fn reflection_probability(reflectance: f32, transmittance: Rgb) -> f32 {
    if reflectance > 0.0 {
        reflectance / (reflectance + (1.0 - reflectance) * transmittance.max_channel())
    } else {
        0.0
    }
}

impl Scatter for Dielectric {
    const HAS_LOBES: bool = true;

    #[inline]
    fn evaluate(&self, _wo: Vec3, _wi: Vec3) -> BsdfValue {
        BsdfValue::ZERO
    }

    #[inline]
    fn sample(&self, wo: Vec3, lobe: f32, _direction: [f32; 2]) -> Option<BsdfSample> {
        let (reflectance, cos_t) = self.reflectance(wo);
        let probability = reflection_probability(reflectance, self.transmittance);
        if lobe < probability {
            return BsdfSample::mirrored(wo, Rgb::splat(reflectance / probability));
        }
        let (wi, eta_scale) = if self.thin {
            (-wo, 1.0)
        } else {
            (Vec3::new(-wo.x / self.eta, -wo.y / self.eta, -cos_t), self.eta * self.eta)
        };
        let energy = self.transmittance * ((1.0 - reflectance) / (1.0 - probability));
        (wo.z > 0.0 && wi.z < 0.0).then(|| BsdfSample {
            wi,
            weight: energy / eta_scale,
            pdf_solid_angle: 0.0,
            is_delta: true,
            kind: LobeKind::Refraction,
            eta_scale,
        })
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        let (reflectance, _) = self.reflectance(wo);
        Rgb::splat(reflectance) + self.transmittance * (1.0 - reflectance)
    }

    #[inline]
    fn is_delta(&self) -> bool {
        true
    }
}
