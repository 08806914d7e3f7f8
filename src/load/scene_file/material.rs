//! `[material.NAME]`: how a surface scatters (one table named after the kind), what it emits, where it
//! is cut out.

use super::source::{Source, exactly_one};
use super::texture::{BumpMap, ColorSource, NormalMap, ScalarSource, Textures};
use super::value::{Color, ConeAngle, Fraction, NonNegative, Positive, SignedFraction};
use crate::bsdf::{METALS, Metal};
use crate::error::Result;
use crate::math::Rgb;
use crate::scene::{ColorInput, Emission, Material, ScalarInput, Surface};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// `[material.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    lambert: Option<Lambert>,
    oren_nayar: Option<OrenNayar>,
    mirror: Option<Mirror>,
    dielectric: Option<Dielectric>,
    conductor: Option<Spanned<Conductor>>,
    plastic: Option<Plastic>,
    principled: Option<Principled>,
    emission: Option<ColorSource<NonNegative>>,
    opacity: Option<ScalarSource>,
    normal_map: Option<NormalMap>,
    bump_map: Option<BumpMap>,
}

/// `[material.NAME.lambert]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Lambert {
    albedo: ColorSource<Fraction>,
}

/// `[material.NAME.oren_nayar]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OrenNayar {
    albedo: ColorSource<Fraction>,
    /// Degrees.
    sigma: ConeAngle,
}

/// `[material.NAME.mirror]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mirror {
    #[serde(default = "white")]
    reflectance: ColorSource<Fraction>,
}

/// `[material.NAME.dielectric]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Dielectric {
    #[serde(default = "glass")]
    eta: Positive,
    #[serde(default = "smooth")]
    roughness: ScalarSource,
    #[serde(default = "clear")]
    absorption: Color<NonNegative>,
    #[serde(default = "all")]
    transmittance: Color<Fraction>,
    #[serde(default)]
    thin: bool,
}

/// `[material.NAME.conductor]`: `metal`, or `eta` and `k`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Conductor {
    metal: Option<Spanned<String>>,
    eta: Option<Color<Positive>>,
    k: Option<Color<NonNegative>>,
    #[serde(default = "smooth")]
    roughness: ScalarSource,
    #[serde(default = "isotropic")]
    anisotropy: SignedFraction,
}

/// `[material.NAME.plastic]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plastic {
    albedo: ColorSource<Fraction>,
    #[serde(default = "glass")]
    eta: Positive,
    #[serde(default = "smooth")]
    roughness: ScalarSource,
}

/// `[material.NAME.principled]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Principled {
    base_color: ColorSource<Fraction>,
    #[serde(default = "smooth")]
    metallic: ScalarSource,
    #[serde(default = "half")]
    roughness: ScalarSource,
    #[serde(default = "four_percent")]
    specular: ColorSource<Fraction>,
    #[serde(default = "isotropic")]
    anisotropy: SignedFraction,
    #[serde(default = "none")]
    clearcoat: Fraction,
    #[serde(default = "none")]
    clearcoat_roughness: Fraction,
    #[serde(default = "none")]
    sheen: Fraction,
}

const fn clear() -> Color<NonNegative> {
    Color::new(Rgb::BLACK)
}

const fn all() -> Color<Fraction> {
    Color::new(Rgb::WHITE)
}

fn white() -> ColorSource<Fraction> {
    ColorSource::Plain(Rgb::WHITE)
}

fn four_percent() -> ColorSource<Fraction> {
    ColorSource::Plain(Rgb::splat(0.04))
}

const fn glass() -> Positive {
    Positive(1.5)
}

fn smooth() -> ScalarSource {
    ScalarSource::Plain(0.0)
}

fn half() -> ScalarSource {
    ScalarSource::Plain(0.5)
}

const fn none() -> Fraction {
    Fraction(0.0)
}

const fn isotropic() -> SignedFraction {
    SignedFraction(0.0)
}

impl MaterialTable {
    /// The material for `scene`, called `name`; asks `to` for its images.
    ///
    /// # Errors
    /// When there is not exactly one kind (a material that only emits may have none), when a normal map
    /// meets a bump map, and for an unknown metal.
    pub(super) fn material(&self, name: &Spanned<String>, to: &mut Textures) -> Result<Material> {
        let source = to.source;
        let complain = |message: String| {
            source.error(name.span(), format!("material `{}` {message}", name.get_ref()))
        };
        let surface = match self.surface(to).map_err(complain)? {
            Some(surface) => surface?,
            None => Surface::Lambert { albedo: ColorInput::constant(Rgb::BLACK) },
        };
        let normal = match (&self.normal_map, &self.bump_map) {
            (Some(_), Some(_)) => {
                let message = "has `normal_map` and `bump_map` at once: keep one of them";
                return Err(complain(message.to_owned()));
            }
            (Some(map), None) => Some(map.input(to)),
            (None, map) => map.as_ref().map(|map| map.input(to)),
        };
        Ok(Material {
            location: Some(source.location(&name.span())),
            emission: self.emission.as_ref().map(|color| Emission { radiance: color.input(to) }),
            opacity: self.opacity.as_ref().map_or(ScalarInput::constant(1.0), |v| v.input(to)),
            normal,
            ..Material::new(name.get_ref(), surface)
        })
    }

    /// The one kind of scattering; none for a material that only emits. An outer error lacks its place.
    fn surface(&self, to: &mut Textures) -> std::result::Result<Option<Result<Surface>>, String> {
        let kinds = [
            ("lambert", self.lambert.as_ref().map(|table| Ok(table.surface(to)))),
            ("oren_nayar", self.oren_nayar.as_ref().map(|table| Ok(table.surface(to)))),
            ("mirror", self.mirror.as_ref().map(|table| Ok(table.surface(to)))),
            ("dielectric", self.dielectric.as_ref().map(|table| Ok(table.surface(to)))),
            (
                "conductor",
                self.conductor.as_ref().map(|table| table.get_ref().surface(table.span(), to)),
            ),
            ("plastic", self.plastic.as_ref().map(|table| Ok(table.surface(to)))),
            ("principled", self.principled.as_ref().map(|table| Ok(table.surface(to)))),
        ];
        if self.emission.is_some() && kinds.iter().all(|kind| kind.1.is_none()) {
            return Ok(None);
        }
        exactly_one(kinds).map(Some)
    }
}

impl Lambert {
    fn surface(&self, to: &mut Textures) -> Surface {
        Surface::Lambert { albedo: self.albedo.input(to) }
    }
}

impl OrenNayar {
    fn surface(&self, to: &mut Textures) -> Surface {
        let sigma = self.sigma.0.to_radians() as f32;
        Surface::OrenNayar { albedo: self.albedo.input(to), sigma }
    }
}

impl Mirror {
    fn surface(&self, to: &mut Textures) -> Surface {
        Surface::Mirror { reflectance: self.reflectance.input(to) }
    }
}

impl Dielectric {
    fn surface(&self, to: &mut Textures) -> Surface {
        Surface::Dielectric {
            eta: self.eta.0,
            roughness: self.roughness.input(to),
            absorption: self.absorption.rgb,
            transmittance: self.transmittance.rgb,
            thin: self.thin,
        }
    }
}

impl Conductor {
    fn surface(&self, span: Range<usize>, to: &mut Textures) -> Result<Surface> {
        let (eta, k) = self.index_of_refraction(span, to.source)?;
        Ok(Surface::Conductor {
            eta,
            k,
            roughness: self.roughness.input(to),
            anisotropy: self.anisotropy.0,
        })
    }

    /// (eta, k) of the named metal, or as given.
    fn index_of_refraction(&self, span: Range<usize>, source: Source) -> Result<(Rgb, Rgb)> {
        match (&self.metal, &self.eta, &self.k) {
            (Some(name), None, None) => match Metal::by_name(name.get_ref()) {
                Some(metal) => Ok((metal.eta, metal.k)),
                None => {
                    let known = METALS.iter().map(|metal| metal.name);
                    Err(source.unknown_name(name.span(), "metal", name.get_ref(), known))
                }
            },
            (None, Some(eta), Some(k)) => Ok((eta.rgb, k.rgb)),
            _ => {
                let message = "a conductor needs either the name of a `metal` or `eta` and `k`";
                Err(source.error(span, message))
            }
        }
    }
}

impl Plastic {
    fn surface(&self, to: &mut Textures) -> Surface {
        Surface::Plastic {
            albedo: self.albedo.input(to),
            eta: self.eta.0,
            roughness: self.roughness.input(to),
        }
    }
}

impl Principled {
    fn surface(&self, to: &mut Textures) -> Surface {
        Surface::Principled {
            base_color: self.base_color.input(to),
            metallic: self.metallic.input(to),
            roughness: self.roughness.input(to),
            specular: self.specular.input(to),
            anisotropy: self.anisotropy.0,
            clearcoat: self.clearcoat.0,
            clearcoat_roughness: self.clearcoat_roughness.0,
            sheen: self.sheen.0,
        }
    }
}
