//! Ideal diffuse reflection: f = albedo / pi (Lambert 1760).

use super::{BsdfSample, BsdfValue, LobeKind, Scatter, reflectance};
use crate::math::{Rgb, Vec3};
use crate::sampling::warp;

/// Ideal diffuse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    albedo: Rgb,
}

impl Lambert {
    /// `albedo` in [0, 1] (clamped, as all reflectances here).
    #[inline]
    pub fn new(albedo: Rgb) -> Self {
        Self { albedo: reflectance(albedo) }
    }
}

impl Scatter for Lambert {
    const HAS_LOBES: bool = false;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        // A select, not a branch: on which side a sampled light is, is random. Below, the density is 0.
        let cos_theta = if wo.z > 0.0 { wi.z } else { 0.0 };
        let pdf_solid_angle = warp::cosine_hemisphere_pdf(cos_theta);
        BsdfValue { f_cos: self.albedo * pdf_solid_angle, pdf_solid_angle }
    }

    #[inline]
    fn sample(&self, wo: Vec3, _lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        let wi = warp::cosine_hemisphere(direction);
        (wo.z > 0.0 && wi.z > 0.0).then(|| BsdfSample {
            wi,
            weight: self.albedo,
            pdf_solid_angle: warp::cosine_hemisphere_pdf(wi.z),
            is_delta: false,
            kind: LobeKind::Diffuse,
            eta_scale: 1.0,
        })
    }

    #[inline]
    fn albedo(&self, _wo: Vec3) -> Rgb {
        self.albedo
    }

    #[inline]
    fn is_delta(&self) -> bool {
        false
    }
}
