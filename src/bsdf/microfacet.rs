//! The GGX distribution of microfacets: density, shadowing, sampling of the visible normals.
//!
//! Source: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007
//! (distribution, half vectors and their Jacobians); E. Heitz, "Understanding the Masking-Shadowing
//! Function", JCGT 3(2), 2014 (height-correlated shadowing, anisotropy); J. Dupuy and A. Benyoub,
//! "Sampling Visible GGX Normals with Spherical Caps", HPG 2023 (sampling). Knows no Fresnel factor.
//!
//! Products such as G1 / cos_o are cancelled by hand, so nothing is divided by a cosine and grazing
//! directions cost no accuracy.

use super::BsdfValue;
use crate::math::{Rgb, Vec3, fun};
use std::f32::consts::FRAC_1_PI;

/// Surfaces smoother than this alpha (perceptual roughness 0.032) are treated as perfectly smooth, here and
/// nowhere else: their lobe is narrower than a tenth of a degree, and `f32` half vectors stop resolving it.
pub(super) const SMOOTH_ALPHA: f32 = 1e-3;

/// A GGX distribution; alpha along the local x and y axes, in [`SMOOTH_ALPHA`, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ggx {
    pub(super) alpha_x: f32,
    pub(super) alpha_y: f32,
}

/// A microfacet lobe without its Fresnel factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lobe {
    /// f |cos theta_i|; for transmission the energy's, without the radiance factor 1 / eta^2.
    pub(super) f_cos: f32,
    /// Density of `wi` over solid angle, given that this lobe was chosen.
    pub(super) pdf_solid_angle: f32,
}

impl Lobe {
    /// With the factor that the interface puts on it, when the lobe is chosen with `probability`.
    #[inline]
    pub(super) fn scaled(&self, factor: Rgb, probability: f32) -> BsdfValue {
        BsdfValue {
            f_cos: factor * self.f_cos,
            pdf_solid_angle: probability * self.pdf_solid_angle,
        }
    }
}

impl Ggx {
    /// `roughness` is perceptual, in [0, 1]: alpha = roughness^2. Anisotropy in [-1, 1] keeps that alpha along
    /// the highlight (x when positive, y when negative) and divides it by up to 10 across: the aspect of
    /// Burley ("Physically-Based Shading at Disney", 2012), normalised so that alpha stays below 1. `None`:
    /// the surface is smooth ([`SMOOTH_ALPHA`]).
    #[inline]
    pub(super) fn new(roughness: f32, anisotropy: f32) -> Option<Self> {
        let along = roughness.min(1.0) * roughness.min(1.0);
        (roughness > 0.0 && along >= SMOOTH_ALPHA).then(|| {
            let across = (along * (1.0 - 0.9 * anisotropy.abs().min(1.0))).max(SMOOTH_ALPHA);
            if anisotropy >= 0.0 {
                Self { alpha_x: along, alpha_y: across }
            } else {
                Self { alpha_x: across, alpha_y: along }
            }
        })
    }

    /// |(alpha_x x, alpha_y y, z)|: |z| sqrt(1 + alpha^2 tan^2 theta), which holds all of Smith's masking:
    /// G1(w) = 2 |w.z| / (|w.z| + stretched(w)).
    #[inline]
    fn stretched(&self, w: Vec3) -> f32 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// Density of microfacet normals over solid angle and per area of the surface.
    #[inline]
    fn density(&self, h: Vec3) -> f32 {
        let (x, y) = (h.x / self.alpha_x, h.y / self.alpha_y);
        let e = x * x + y * y + h.z * h.z;
        FRAC_1_PI / (self.alpha_x * self.alpha_y * e * e)
    }

    /// A normal distributed as those visible from `wo`: density G1(wo) (wo.h) D(h) / wo.z.
    #[inline]
    pub(super) fn sample_visible(&self, wo: Vec3, [u, v]: [f32; 2]) -> Vec3 {
        self.visible_normal(wo, fun::sin_cos_turns(u), v)
    }

    /// [`Ggx::sample_visible`] with the sine and cosine of the azimuth u.
    #[inline]
    pub(super) fn visible_normal(&self, wo: Vec3, (sin, cos): (f32, f32), v: f32) -> Vec3 {
        // Stretch to alpha = 1, where the facets are a hemisphere and what is seen of it mirrors `wo` into a
        // uniform cap of the sphere: the half vector of the cap's points is the normal.
        let o = Vec3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z).normalize();
        let h_z = (1.0 - v) * (1.0 + o.z);
        let z = h_z - o.z;
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let h = Vec3::new(r * cos + o.x, r * sin + o.y, h_z);
        // Back: normals stretch by the inverse transpose. As v < 1, h.z > 0 and the vector cannot vanish.
        Vec3::new(self.alpha_x * h.x, self.alpha_y * h.y, h.z).normalize()
    }

    /// G2(wo, wi) / G1(wo), height-correlated, for directions on the same side or on opposite ones: what a
    /// sample of the visible normals weighs besides its Fresnel factor.
    #[inline]
    pub(super) fn shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (cos_o, cos_i) = (wo.z, wi.z.abs());
        let (s_o, s_i) = (self.stretched(wo), self.stretched(wi));
        cos_i * (cos_o + s_o) / (cos_i * s_o + cos_o * s_i)
    }

    /// Reflection, for wo.z > 0 and wi.z > 0 with half vector `h` (Walter, eq. 20; its pdf, eq. 14 and Heitz).
    #[inline]
    pub(super) fn reflection(&self, wo: Vec3, wi: Vec3, h: Vec3) -> Lobe {
        // pdf = G1 (wo.h) D / cos_o / (4 wo.h), and f cos_i = D G2 / (4 cos_o).
        let pdf = self.density(h) / (2.0 * (wo.z + self.stretched(wo)));
        Lobe { f_cos: pdf * self.shadowing(wo, wi), pdf_solid_angle: pdf }
    }

    /// Transmission, for wo.z > 0 and wi.z < 0 with half vector `h` (Walter, eq. 21 and 17); `eta` is the index
    /// of the side of `wi` over that of `wo`.
    #[inline]
    pub(super) fn transmission(&self, wo: Vec3, wi: Vec3, h: Vec3, eta: f32) -> Lobe {
        let (o_h, i_h) = (wo.dot(h), wi.dot(h));
        let root = o_h / eta + i_h;
        let jacobian = i_h.abs() / (root * root);
        let pdf_visible = self.density(h) * 2.0 * o_h / (wo.z + self.stretched(wo));
        let pdf = pdf_visible * jacobian;
        Lobe { f_cos: pdf * self.shadowing(wo, wi), pdf_solid_angle: pdf }
    }
}

/// Half vector of a reflection; `None` where it is undefined (opposite directions).
#[inline]
pub(super) fn reflection_half(wo: Vec3, wi: Vec3) -> Option<Vec3> {
    (wo + wi).try_normalize()
}

/// Half vector of a refraction, on the side of `wo`; `None` where no microfacet refracts one into the other.
#[inline]
pub(super) fn refraction_half(wo: Vec3, wi: Vec3, eta: f32) -> Option<Vec3> {
    let h = (wo + wi * eta).try_normalize()?;
    let h = if h.z < 0.0 { -h } else { h };
    (wo.dot(h) > 0.0 && wi.dot(h) < 0.0).then_some(h)
}
