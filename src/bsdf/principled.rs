//! The artist's model: diffuse, specular, metal, clear coat and sheen, each with a weight.
//!
//! Parameters follow B. Burley, "Physically-Based Shading at Disney" (SIGGRAPH course, 2012); the way the
//! layers share energy is our own and keeps every combination reciprocal and, when white, at albedo 1:
//! - The coat, on top, has the albedo c e(w). It leaves the specular lobe below it the factor
//!   1 - c max(e(wo), e(wi)), the most that is symmetric and never creates energy.
//! - What coat and specular lobe do not scatter from direction w is K(w) = 1 - c e(w) - S(w). It belongs to
//!   separable lobes K(wo) K(wi) / (pi mean K), as in [`super::energy`]: for the dielectric part that is the
//!   diffuse lobe (Kelemen and Szirmay-Kalos 2001), for the metal its multiple scattering.
//! - Sheen takes the share s(w) = sheen (1 - cos)^5 of K from the diffuse lobe, and is separable too.

use super::conductor::{loss_scale, multiple_reflectance};
use super::energy::{self, COAT_F0, Single};
use super::microfacet::{self, Ggx};
use super::{BsdfSample, BsdfValue, LobeKind, Scatter, fresnel};
use crate::math::{Rgb, Vec3};

/// Parameters of [`Principled`]; all in [0, 1] unless said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledParameters {
    /// Diffuse albedo of the dielectric part, specular colour at normal incidence of the metallic part.
    pub base_color: Rgb,
    /// Blend from dielectric to metal.
    pub metallic: f32,
    /// Perceptual roughness of the main specular lobe.
    pub roughness: f32,
    /// Specular reflectance at normal incidence of the dielectric part (0.04 for eta 1.5). Below 0.02 the
    /// reflectance at grazing angles fades too, so that 0 is purely diffuse.
    pub specular: Rgb,
    /// -1..1: stretches the highlight along the local x (positive) or y axis.
    pub anisotropy: f32,
    /// Strength of a clear coat of eta 1.5.
    pub clearcoat: f32,
    /// Perceptual roughness of the coat.
    pub clearcoat_roughness: f32,
    /// Strength of the sheen.
    pub sheen: f32,
}

impl Default for PrincipledParameters {
    /// Mid-grey, dielectric, half rough.
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.5),
            metallic: 0.0,
            roughness: 0.5,
            specular: Rgb::splat(0.04),
            anisotropy: 0.0,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen: 0.0,
        }
    }
}

/// Schlick's Fresnel factor f0 + (f90 - f0) (1 - cos)^5.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Schlick<T> {
    f0: T,
    f90: f32,
}

/// A separable lobe: color * scale * g(wo) * g(wi), of albedo color * g(wo).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Separable {
    color: Rgb,
    scale: f32,
}

/// The artist's model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// The specular lobe; `None` smooth.
    ggx: Option<Ggx>,
    /// Its Fresnel factor, blended between dielectric and metal.
    specular: Schlick<Rgb>,
    /// The Fresnel factor of the dielectric part alone, its largest channel.
    dielectric: Schlick<f32>,
    /// Lobe of the coat; `None` smooth.
    coat_ggx: Option<Ggx>,
    clearcoat: f32,
    sheen: f32,
    diffuse: Separable,
    metal: Separable,
    /// Scale of the white sheen lobe, with the weight of the dielectric part in it.
    sheen_scale: f32,
    /// How much the sampling of the separable lobes favours grazing angles ([`energy::sample_spread`]).
    grazing: f32,
}

/// What the layers do with light of one direction.
struct View {
    /// Albedo e of a coat of strength 1.
    coat: f32,
    /// Single scattering of the specular lobe.
    single: Single,
    /// Mean of max(e(wi) - e(wo), 0) over the specular lobe.
    coat_excess: f32,
    /// Share s of the sheen.
    sheen: f32,
    /// K of the dielectric part and of the metal.
    dielectric_loss: f32,
    metal_loss: f32,
}

impl Principled {
    /// A surface with these parameters.
    pub fn new(p: &PrincipledParameters) -> Self {
        let metallic = p.metallic.clamp(0.0, 1.0);
        let dielectric_part = 1.0 - metallic;
        let specular_max = p.specular.max_channel();
        let dielectric = Schlick { f0: specular_max, f90: (specular_max / 0.02).min(1.0) };
        let specular = Schlick {
            f0: p.specular.lerp(p.base_color, metallic),
            f90: dielectric.f90 * dielectric_part + metallic,
        };
        let mut surface = Self {
            ggx: Ggx::new(p.roughness, p.anisotropy),
            specular,
            dielectric,
            coat_ggx: Ggx::new(p.clearcoat_roughness, 0.0),
            clearcoat: p.clearcoat,
            sheen: p.sheen,
            diffuse: Separable { color: p.base_color * dielectric_part, scale: 0.0 },
            metal: Separable { color: Rgb::BLACK, scale: 0.0 },
            sheen_scale: 0.0,
            grazing: 0.0,
        };
        // Hemispherical means of the K's, and the scales that they fix.
        let [white, schlick] = energy::single_mean(surface.ggx.as_ref());
        let mut dielectric_mean =
            1.0 - dielectric.f0 * (white - schlick) - dielectric.f90 * schlick;
        let mut metal_mean = 1.0 - white;
        let mut sheen_mean = 0.0;
        if p.clearcoat > 0.0 || p.sheen > 0.0 {
            [dielectric_mean, metal_mean, sheen_mean] = surface.means();
        }
        surface.diffuse.scale = loss_scale(dielectric_mean - sheen_mean);
        surface.sheen_scale = loss_scale(sheen_mean) * dielectric_part;
        // Mean of Schlick's factor with f90 = 1 over the hemisphere: f0 + (1 - f0) / 21.
        let tint = |f0: f32| multiple_reflectance(f0 + (1.0 - f0) / 21.0, white);
        surface.metal =
            Separable { color: p.base_color.map(tint) * metallic, scale: loss_scale(metal_mean) };
        // Both metal and sheen have their energy there; any value is unbiased.
        let metal_grazing = surface.ggx.as_ref().map_or(0.0, energy::loss_grazing);
        surface.grazing = metallic * metal_grazing + 0.5 * dielectric_part * p.sheen.min(1.0);
        surface
    }

    /// Hemispherical means of K of the dielectric part, K of the metal, and s K of the sheen.
    fn means(&self) -> [f32; 3] {
        // cos^2 of 1/16, 5/16, 3/16 and 7/16 of half a turn: the azimuth varies with the cosine, for the sake of
        // anisotropic lobes.
        const COS2_PHI: [f32; 4] = [0.961_94, 0.308_66, 0.691_34, 0.038_06];
        let mut node = 0;
        energy::hemisphere_mean(16, |cos| {
            node += 1;
            let view = self.view(energy::direction(cos, COS2_PHI[node % COS2_PHI.len()]));
            [view.dielectric_loss, view.metal_loss, view.sheen * view.dielectric_loss]
        })
    }

    /// Everything that depends on one direction only, w.z > 0.
    #[inline]
    fn view(&self, w: Vec3) -> View {
        let single = Single::new(self.ggx.as_ref(), w);
        let (mut coat, mut coat_excess) = (0.0, 0.0);
        if self.clearcoat > 0.0 {
            coat = Single::new(self.coat_ggx.as_ref(), w).schlick(COAT_F0, 1.0);
            coat_excess = energy::coat_excess(self.ggx.as_ref(), self.coat_ggx.as_ref(), w);
        }
        // A specular lobe of albedo E under the coat scatters S = E (1 - c e - c excess).
        let through = 1.0 - self.clearcoat * coat;
        let loss =
            |albedo: f32| (through - albedo * (through - self.clearcoat * coat_excess)).max(0.0);
        View {
            coat,
            single,
            coat_excess,
            sheen: self.sheen * fresnel::schlick_weight(w.z),
            dielectric_loss: loss(single.schlick(self.dielectric.f0, self.dielectric.f90)),
            metal_loss: loss(single.white),
        }
    }

    /// Albedos of the coat, of the specular lobe, and of all separable lobes together.
    #[inline]
    fn albedos(&self, view: &View) -> (f32, Rgb, Rgb) {
        let coat = self.clearcoat * view.coat;
        let through = (1.0 - coat - self.clearcoat * view.coat_excess).max(0.0);
        let specular =
            self.specular.f0.map(|f0| view.single.schlick(f0, self.specular.f90) * through);
        let sheen = if self.sheen_scale > 0.0 { view.sheen } else { 0.0 };
        let mut separable = self.diffuse.color * (view.dielectric_loss * (1.0 - sheen))
            + self.metal.color * view.metal_loss;
        if sheen > 0.0 {
            separable += Rgb::splat(view.dielectric_loss * sheen);
        }
        (coat, specular, separable)
    }

    /// Probabilities to sample the coat and the specular lobe; the rest goes to the separable ones.
    #[inline]
    fn probabilities(&self, view: &View) -> (f32, f32) {
        let (coat, specular, separable) = self.albedos(view);
        let specular = specular.max_channel();
        let sum = coat + specular + separable.max_channel();
        if sum > 0.0 { (coat / sum, specular / sum) } else { (0.0, 0.0) }
    }
}

impl Scatter for Principled {
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return BsdfValue::ZERO;
        }
        let Some(h) = microfacet::reflection_half(wo, wi) else {
            return BsdfValue::ZERO;
        };
        let (o, i) = (self.view(wo), self.view(wi));
        let (coat_probability, specular_probability) = self.probabilities(&o);
        // The separable lobes.
        let dielectric = o.dielectric_loss * i.dielectric_loss;
        let diffuse = self.diffuse.scale * dielectric * (1.0 - o.sheen) * (1.0 - i.sheen);
        let metal = self.metal.scale * o.metal_loss * i.metal_loss;
        let sheen = self.sheen_scale * dielectric * o.sheen * i.sheen;
        let mut value = BsdfValue {
            f_cos: (self.diffuse.color * diffuse + self.metal.color * metal + Rgb::splat(sheen))
                * wi.z,
            pdf_solid_angle: (1.0 - coat_probability - specular_probability).max(0.0)
                * energy::spread_pdf(wi.z, self.grazing),
        };
        // The specular lobe under the coat.
        let weight = fresnel::schlick_weight(wo.dot(h));
        if let Some(ggx) = &self.ggx {
            let lobe = ggx.reflection(wo, wi, h);
            let through = 1.0 - self.clearcoat * o.coat.max(i.coat);
            let schlick = self.specular.f0.map(|f0| f0 + (self.specular.f90 - f0) * weight);
            value.f_cos += schlick * (through * lobe.f_cos);
            value.pdf_solid_angle += specular_probability * lobe.pdf_solid_angle;
        }
        // The coat.
        if let Some(ggx) = self.coat_ggx.as_ref().filter(|_| self.clearcoat > 0.0) {
            let lobe = ggx.reflection(wo, wi, h);
            let schlick = COAT_F0 + (1.0 - COAT_F0) * weight;
            value.f_cos += Rgb::splat(self.clearcoat * schlick * lobe.f_cos);
            value.pdf_solid_angle += coat_probability * lobe.pdf_solid_angle;
        }
        value
    }

    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let view = self.view(wo);
        let (coat_probability, specular_probability) = self.probabilities(&view);
        let (ggx, smooth_weight) = if lobe < coat_probability {
            (&self.coat_ggx, Rgb::splat(self.clearcoat * view.coat / coat_probability))
        } else if lobe < coat_probability + specular_probability {
            let through = 1.0 - self.clearcoat * view.coat;
            let weight = through / specular_probability;
            (
                &self.ggx,
                self.specular.f0.map(|f0| view.single.schlick(f0, self.specular.f90) * weight),
            )
        } else {
            let wi = energy::sample_spread(direction, self.grazing);
            return BsdfSample::spread(self, wo, wi, LobeKind::Diffuse);
        };
        match ggx {
            Some(ggx) => {
                let wi = fresnel::reflect(wo, ggx.sample_visible(wo, direction));
                BsdfSample::spread(self, wo, wi, LobeKind::Glossy)
            }
            None => BsdfSample::mirrored(wo, smooth_weight),
        }
    }

    fn albedo(&self, wo: Vec3) -> Rgb {
        let (coat, specular, separable) = self.albedos(&self.view(wo));
        Rgb::splat(coat) + specular + separable
    }

    #[inline]
    fn is_delta(&self) -> bool {
        let no_separable = self.diffuse.color.is_black()
            && self.sheen_scale == 0.0
            && (self.metal.color.is_black() || self.metal.scale == 0.0);
        no_separable && self.ggx.is_none() && (self.coat_ggx.is_none() || self.clearcoat == 0.0)
    }
}
