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
use super::{BsdfSample, BsdfValue, LobeKind, Scatter, fresnel, reflectance, unit};
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
    /// reflectance at grazing angles fades too, so that 0 is purely diffuse. The diffuse lobe gets what the
    /// largest channel leaves, so a coloured `specular` darkens the other channels.
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
    /// The Fresnel factor of the dielectric part alone, the largest channel of it.
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
        let p = PrincipledParameters {
            base_color: reflectance(p.base_color),
            metallic: unit(p.metallic),
            specular: reflectance(p.specular),
            clearcoat: unit(p.clearcoat),
            sheen: unit(p.sheen),
            ..*p
        };
        let metallic = p.metallic;
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
        surface.grazing = metallic * metal_grazing + 0.5 * dielectric_part * p.sheen;
        surface
    }

    /// Hemispherical means of K of the dielectric part, K of the metal, and s K of the sheen: Gauss-Legendre
    /// with cos = x^2, which is exact for the sheen alone.
    fn means(&self) -> [f32; 3] {
        /// Roots of the Legendre polynomial of degree 8, and their weights.
        const NODES: [[f32; 2]; 4] = [
            [0.183_434_65, 0.362_683_8],
            [0.525_532_4, 0.313_706_64],
            [0.796_666_5, 0.222_381_03],
            [0.960_289_86, 0.101_228_535],
        ];
        /// cos^2 of 1/16, 5/16, 3/16 and 7/16 of half a turn: the azimuth varies with the cosine, for the sake
        /// of anisotropic lobes.
        const COS2_PHI: [f32; 4] = [0.961_94, 0.308_66, 0.691_34, 0.038_06];
        let mut sum = [0.0; 3];
        for (i, [root, weight]) in NODES.into_iter().enumerate() {
            for (x, cos2_phi) in
                [(0.5 - 0.5 * root, COS2_PHI[i]), (0.5 + 0.5 * root, COS2_PHI[3 - i])]
            {
                let view = self.view(energy::direction(x * x, cos2_phi));
                let values =
                    [view.dielectric_loss, view.metal_loss, view.sheen * view.dielectric_loss];
                // 2 cos dcos = 4 x^3 dx.
                let weight = 2.0 * x * x * x * weight;
                (0..3).for_each(|k| sum[k] += weight * values[k]);
            }
        }
        sum
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

    /// Value and density, given what depends on `wo` alone.
    fn value(&self, o: &View, wo: Vec3, wi: Vec3) -> BsdfValue {
        let Some(h) = microfacet::reflection_half(wo, wi).filter(|_| wi.z > 0.0) else {
            return BsdfValue::ZERO;
        };
        let i = self.view(wi);
        let (coat_probability, specular_probability) = self.probabilities(o);
        // The separable lobes.
        let dielectric = o.dielectric_loss * i.dielectric_loss;
        let diffuse = self.diffuse.scale * dielectric * (1.0 - o.sheen) * (1.0 - i.sheen);
        let metal = self.metal.scale * o.metal_loss * i.metal_loss;
        let sheen = self.sheen_scale * dielectric * o.sheen * i.sheen;
        let separable = self.diffuse.color * diffuse + self.metal.color * metal + Rgb::splat(sheen);
        let mut value = BsdfValue {
            f_cos: separable * wi.z,
            pdf_solid_angle: (1.0 - coat_probability - specular_probability).max(0.0)
                * energy::spread_pdf(wi.z, self.grazing),
        };
        // The specular lobe under the coat.
        let weight = fresnel::schlick_weight(wo.dot(h));
        if let Some(ggx) = &self.ggx {
            let through = 1.0 - self.clearcoat * o.coat.max(i.coat);
            let schlick = self.specular.f0.map(|f0| f0 + (self.specular.f90 - f0) * weight);
            value += ggx.reflection(wo, wi, h).scaled(schlick * through, specular_probability);
        }
        // The coat.
        if let Some(ggx) = self.coat_ggx.as_ref().filter(|_| self.clearcoat > 0.0) {
            let schlick = self.clearcoat * (COAT_F0 + (1.0 - COAT_F0) * weight);
            value += ggx.reflection(wo, wi, h).scaled(Rgb::splat(schlick), coat_probability);
        }
        value
    }
}

impl Scatter for Principled {
    const HAS_LOBES: bool = true;

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wo.z > 0.0 { self.value(&self.view(wo), wo, wi) } else { BsdfValue::ZERO }
    }

    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let view = self.view(wo);
        let (coat_probability, specular_probability) = self.probabilities(&view);
        let (wi, kind) = if lobe >= coat_probability + specular_probability {
            (energy::sample_spread(direction, self.grazing), LobeKind::Diffuse)
        } else {
            // Either interface, and its delta lobe's weight should it be smooth.
            let (ggx, delta) = if lobe < coat_probability {
                (&self.coat_ggx, Rgb::splat(self.clearcoat * view.coat / coat_probability))
            } else {
                let scale = (1.0 - self.clearcoat * view.coat) / specular_probability;
                let schlick = |f0| view.single.schlick(f0, self.specular.f90);
                (&self.ggx, self.specular.f0.map(schlick) * scale)
            };
            let Some(ggx) = ggx else {
                return BsdfSample::mirrored(wo, delta);
            };
            (fresnel::reflect(wo, ggx.sample_visible(wo, direction)), LobeKind::Glossy)
        };
        BsdfSample::spread(wi, self.value(&view, wo, wi), kind)
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
