//! Rough diffuse reflection that keeps its energy.
//!
//! Source: M. Oren and S. Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, in the
//! improved qualitative form of Y. Fujii ("A tiny improvement of Oren-Nayar reflectance model", 2012), with
//! the multiple scattering of J. Portsmouth, P. Kutz and S. Hill ("EON: A Practical Energy-Preserving Rough
//! Diffuse BRDF", JCGT 14(1), 2025): the loss comes back as a separable lobe, all in closed form.

use super::{BsdfSample, BsdfValue, LobeKind, Scatter, reflectance};
use crate::math::{Rgb, Vec3, fun};
use crate::sampling::warp;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

/// Rough diffuse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    albedo: Rgb,
    /// Weight of the constant term and, relative to it, of the angular one (Fujii's A pi and B / A).
    constant: f32,
    angular: f32,
    /// Reflectance of the multiply scattered lobe, over the mean loss.
    multiple: Rgb,
}

impl OrenNayar {
    /// `albedo` in [0, 1]; `sigma` >= 0 is the standard deviation of the facets' slope angle in radians, which
    /// enters by the ratio of the two terms of Oren and Nayar's qualitative model.
    #[inline]
    pub fn new(albedo: Rgb, sigma: f32) -> Self {
        let albedo = reflectance(albedo);
        let sigma2 = sigma * sigma;
        let angular = (0.45 * sigma2 / (sigma2 + 0.09)) / (1.0 - 0.5 * sigma2 / (sigma2 + 0.33));
        let constant = 1.0 / (1.0 + (FRAC_PI_2 - 2.0 / 3.0) * angular);
        // Hemispherical mean of the single-scattering albedo, and what it leaves.
        let mean = constant * (1.0 + angular * (2.0 / 3.0 - 28.0 / 15.0 * FRAC_1_PI));
        let loss = 1.0 - mean;
        let multiple = if loss > 0.0 {
            albedo.map(|rho| rho * rho * mean / (1.0 - rho * loss) / loss)
        } else {
            Rgb::BLACK
        };
        Self { albedo, constant, angular, multiple }
    }

    /// Single-scattering albedo of a white surface.
    #[inline]
    fn single(&self, cos: f32) -> f32 {
        let cos = cos.min(1.0);
        let sin2 = (1.0 - cos) * (1.0 + cos);
        let sin = sin2.sqrt();
        // (1 - sin^3) / cos without its cancellation at grazing angles.
        let ratio = cos * (1.0 + sin + sin2) / (1.0 + sin);
        let g = sin * (fun::acos(cos) - sin * cos) + 2.0 / 3.0 * (sin * ratio - sin);
        self.constant * (1.0 + self.angular * FRAC_1_PI * g)
    }
}

impl Scatter for OrenNayar {
    const HAS_LOBES: bool = false;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return BsdfValue::ZERO;
        }
        // The azimuthal term s / t, with sin_o sin_i cos(phi) = wo.wi - cos_o cos_i.
        let s = wo.x * wi.x + wo.y * wi.y;
        let ratio = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
        let single = self.constant * (1.0 + self.angular * ratio);
        let loss = (1.0 - self.single(wo.z)).max(0.0) * (1.0 - self.single(wi.z)).max(0.0);
        let pdf_solid_angle = warp::cosine_hemisphere_pdf(wi.z);
        BsdfValue {
            f_cos: (self.albedo * single + self.multiple * loss) * pdf_solid_angle,
            pdf_solid_angle,
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, _lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        let wi = warp::cosine_hemisphere(direction);
        BsdfSample::spread(wi, self.evaluate(wo, wi), LobeKind::Diffuse)
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        let single = self.single(wo.z);
        let mean_loss =
            1.0 - self.constant * (1.0 + self.angular * (2.0 / 3.0 - 28.0 / 15.0 * FRAC_1_PI));
        self.albedo * single + self.multiple * ((1.0 - single).max(0.0) * mean_loss)
    }

    #[inline]
    fn is_delta(&self) -> bool {
        false
    }
}
