//! What an MTL record means: the mapping of its numbers to a [`Material`].
//!
//! MTL describes Phong's empirical model, and exporters fill it in with what they have; a path tracer needs
//! energy to be conserved. So the mapping is a reading, and this is it, the first row that fits:
//!
//! | record | surface |
//! |---|---|
//! | `illum` 4, 6, 7, 9 | dielectric of index `Ni` (1.5) and transmittance `Tf`; rough by `Pr`, or `Ns` below 100 |
//! | any of `Pr Pm Pc Ps aniso map_Pr map_Pm` | principled, with these |
//! | `illum` 0, 1; `Ks` black or absent; `Ns` at most 1 | Lambert: no highlight is meant |
//! | `illum` 3, 5 with `Kd` black or absent | mirror; metal of colour `Ks` when `Ns` is below 100 |
//! | `illum` 3, 5 otherwise | principled that reflects `Ks` at normal incidence, with `Kd + Ks` at most 1 |
//! | the rest | principled, with `Ks` as the artists' "specular level" |
//!
//! - Specular level: exporters write `Ks 0.5` for the common dielectric with 4 % reflectance (Blender does),
//!   and hand-made files use it for the strength of a highlight on plastic. Both come out right with
//!   reflectance 0.08 Ks (B. Burley, "Physically Based Shading at Disney", 2012, parameter "specular").
//! - Exponent: Phong's highlight is as wide as a microfacet one of alpha = sqrt(2 / (Ns + 2)) (B. Walter et
//!   al., "Microfacet Models for Refraction through Rough Surfaces", 2007, alpha_p = 2 / alpha_b^2 - 2);
//!   roughness is sqrt(alpha).
//! - `illum` 3 and above trace reflections, which the manual defines as sharp whatever `Ns` shapes the
//!   highlight of lamps; only exponents below 100, which no one gives to a clear thing, make them rough.

use super::image_request::ImageTable;
use super::mtl::MtlRecord;
use super::mtl_texture::TextureStatement;
use super::paths::{Found, find_file};
use super::warning_list::WarningList;
use crate::error::Location;
use crate::image::ColorSpace;
use crate::math::{Rgb, fun};
use crate::scene::{
    Channel, ColorInput, Emission, Material, NormalInput, ScalarInput, Surface, TextureReference,
};
use std::path::{Path, PathBuf};

/// Reflectance at normal incidence of a dielectric of index 1.5.
const COMMON_REFLECTANCE: f32 = 0.04;

/// Reflectance for `Ks 1` as a specular level.
const SPECULAR_LEVEL: f32 = 0.08;

/// Index of refraction of glass that does not say.
const COMMON_ETA: f32 = 1.5;

/// `Kd` up to this is black to a mirror: renderers of old wanted it to be above zero.
const NEARLY_BLACK: f32 = 0.05;

/// From this exponent on a traced reflection is sharp.
const SHARP_EXPONENT: f32 = 100.0;

/// Roughness of a highlight whose exponent is not said.
const COMMON_ROUGHNESS: f32 = 0.5;

/// Makes materials of the records of one library.
pub(super) struct Context<'a> {
    /// The library.
    pub(super) library: &'a Path,
    /// Where images are requested.
    pub(super) images: &'a mut ImageTable,
    /// Where repairs are told.
    pub(super) warnings: &'a mut WarningList,
}

impl Context<'_> {
    /// The material of a record.
    pub(super) fn material(&mut self, record: &MtlRecord) -> Material {
        let diffuse = self.color(record, "Kd", record.diffuse, &record.diffuse_map, 0.5);
        let surface = self.surface(record, diffuse);
        Material {
            name: record.name.clone(),
            location: Some(Location::new(self.library, record.line)),
            surface,
            emission: self.emission(record),
            opacity: self.opacity(record, diffuse),
            normal: self.normal(record),
        }
    }

    /// Scattering, by the table above.
    fn surface(&mut self, r: &MtlRecord, diffuse: ColorInput) -> Surface {
        let illumination = illumination(r);
        if is_glass(r) {
            return Surface::Dielectric {
                eta: r.eta.unwrap_or(COMMON_ETA),
                roughness: self.roughness(r, traced_roughness(r)),
                absorption: Rgb::BLACK,
                transmittance: r.transmittance.unwrap_or(Rgb::WHITE),
                thin: false,
            };
        }
        if has_pbr_keys(r) {
            return Surface::Principled {
                base_color: diffuse,
                metallic: self.scalar(r, "Pm", r.metallic, &r.metallic_map, 0.0),
                roughness: self.roughness(r, phong_roughness(r)),
                specular: self.dielectric_reflectance(r),
                anisotropy: anisotropy(r),
                clearcoat: r.clearcoat.unwrap_or(0.0),
                clearcoat_roughness: r.clearcoat_roughness.unwrap_or(0.0),
                sheen: r.sheen.unwrap_or(0.0),
            };
        }
        if illumination < 2 || !has_highlight(r) {
            return Surface::Lambert { albedo: diffuse };
        }
        let specular = self.color(r, "Ks", r.specular, &r.specular_map, 0.0);
        if !matches!(illumination, 3 | 5) {
            return principled(diffuse, 0.0, phong_roughness(r), scaled(specular, SPECULAR_LEVEL));
        }
        let is_unsaid = r.diffuse.is_none() && r.diffuse_map.is_none();
        let is_black = is_unsaid || diffuse.value.max_channel() <= NEARLY_BLACK;
        match (is_black, traced_roughness(r)) {
            (true, 0.0) => Surface::Mirror { reflectance: specular },
            (true, roughness) => {
                principled(specular, 1.0, roughness, ColorInput::constant(Rgb::BLACK))
            }
            (false, roughness) => {
                // Textures only darken, so the bound on the values holds for every texel.
                let share = 1.0 / (diffuse.value + specular.value).max_channel().max(1.0);
                principled(scaled(diffuse, share), 0.0, roughness, scaled(specular, share))
            }
        }
    }

    /// Reflectance at normal incidence beside PBR keys: by `Ks`, else by `Ni`, else the common one.
    fn dielectric_reflectance(&mut self, r: &MtlRecord) -> ColorInput {
        if r.specular.is_some() || r.specular_map.is_some() {
            let level = self.color(r, "Ks", r.specular, &r.specular_map, 0.0);
            return scaled(level, SPECULAR_LEVEL);
        }
        // Fresnel's equations at normal incidence.
        let of_eta = |eta: f32| ((eta - 1.0) / (eta + 1.0)).powi(2);
        ColorInput::constant(Rgb::splat(r.eta.map_or(COMMON_REFLECTANCE, of_eta)))
    }

    fn emission(&mut self, r: &MtlRecord) -> Option<Emission> {
        let radiance = self.color(r, "Ke", r.emission, &r.emission_map, 0.0);
        (!radiance.value.is_black()).then_some(Emission { radiance })
    }

    /// Coverage: `d` (or 1 - `Tr`) times the red channel of `map_d`; without `map_d` the alpha of `map_Kd`, which `world` drops
    /// when the image has none. Of glass `d` says how clear it is, not how much of it is there.
    fn opacity(&mut self, r: &MtlRecord, diffuse: ColorInput) -> ScalarInput {
        let dissolve = r.dissolve.or(r.transparency.map(|t| 1.0 - t));
        let said = if is_glass(r) { None } else { dissolve };
        let mut opacity = self.scalar(r, "d", said, &r.dissolve_map, 1.0);
        if r.dissolve_map.is_none() {
            opacity.texture = diffuse.texture.map(|texture| (texture, Channel::Alpha));
        }
        if opacity.value == 0.0 {
            self.warn("invisible materials", r.line, || {
                format!("material {:?} has opacity 0: its faces are invisible", r.name)
            });
        }
        opacity
    }

    fn normal(&mut self, r: &MtlRecord) -> Option<NormalInput> {
        if let Some(map) = &r.normal_map {
            return Some(NormalInput::Map(self.texture(map, ColorSpace::Linear)));
        }
        let map = r.bump_map.as_ref()?;
        let texture = self.texture(map, ColorSpace::Linear);
        if looks_like_normal_map(&map.file) {
            self.warn("normal maps named as bump maps", map.line, || {
                format!(
                    "{:?} is used as a normal map, by its name; write `norm` to be sure",
                    map.file
                )
            });
            return Some(NormalInput::Map(texture));
        }
        Some(NormalInput::Bump { texture, strength: map.bump_multiplier })
    }

    /// `Pr` times `map_Pr`, or `otherwise` when neither is given.
    fn roughness(&mut self, r: &MtlRecord, otherwise: f32) -> ScalarInput {
        self.scalar(r, "Pr", r.roughness, &r.roughness_map, otherwise)
    }

    fn scalar(
        &mut self,
        r: &MtlRecord,
        key: &'static str,
        value: Option<f32>,
        map: &Option<TextureStatement>,
        otherwise: f32,
    ) -> ScalarInput {
        let color = value.map(Rgb::splat);
        let Rgb { r: value, .. } = self.factor(r, key, color, map, otherwise);
        let texture = map.as_ref().map(|map| self.texture(map, ColorSpace::Linear));
        ScalarInput { value, texture: texture.map(|texture| (texture, Channel::Red)) }
    }

    fn color(
        &mut self,
        r: &MtlRecord,
        key: &'static str,
        value: Option<Rgb>,
        map: &Option<TextureStatement>,
        otherwise: f32,
    ) -> ColorInput {
        let value = self.factor(r, key, value, map, otherwise);
        let texture = map.as_ref().map(|map| self.texture(map, ColorSpace::Srgb));
        ColorInput { value, texture }
    }

    /// The factor of a texture. Exporters write zero for values that a texture replaces.
    fn factor(
        &mut self,
        r: &MtlRecord,
        key: &'static str,
        value: Option<Rgb>,
        map: &Option<TextureStatement>,
        otherwise: f32,
    ) -> Rgb {
        match (value, map) {
            (Some(value), Some(map)) if value.is_black() => {
                self.warn("textures times zero", map.line, || {
                    format!(
                        "{key} 0 of material {:?} would blacken its texture; taken as 1",
                        r.name
                    )
                });
                Rgb::WHITE
            }
            (Some(value), _) => value,
            (None, Some(_)) => Rgb::WHITE,
            (None, None) => Rgb::splat(otherwise),
        }
    }

    /// Requests the image of a statement.
    fn texture(&mut self, map: &TextureStatement, color_space: ColorSpace) -> TextureReference {
        let folder = self.library.parent().unwrap_or(Path::new(""));
        let path: PathBuf = match find_file(folder, &map.file) {
            Found::AsNamed(path) | Found::Missing(path) => path,
            Found::Elsewhere(path) => {
                self.warn("images found elsewhere", map.line, || {
                    format!("{:?} is not there; {} is used instead", map.file, path.display())
                });
                path
            }
        };
        let path = path.canonicalize().unwrap_or(path);
        let location = Location::new(self.library, map.line);
        TextureReference {
            image: self.images.request(path, color_space, location),
            scale: map.scale,
            offset: map.offset,
            clamp: map.clamp,
        }
    }

    fn warn(&mut self, kind: &'static str, line: usize, message: impl FnOnce() -> String) {
        self.warnings.add(kind, Location::new(self.library, line), message);
    }
}

/// The illumination model; 2 (diffuse with highlights) where nothing is said.
fn illumination(r: &MtlRecord) -> u32 {
    r.illumination.map_or(2, |number| number as u32)
}

fn is_glass(r: &MtlRecord) -> bool {
    matches!(illumination(r), 4 | 6 | 7 | 9)
}

/// Whether `Ks` and `Ns` mean a highlight; exporters that mean none write black, or an exponent of 1.
fn has_highlight(r: &MtlRecord) -> bool {
    let has_color = r.specular_map.is_some() || r.specular.is_some_and(|ks| !ks.is_black());
    has_color && r.exponent.is_none_or(|exponent| exponent > 1.0)
}

fn has_pbr_keys(r: &MtlRecord) -> bool {
    let numbers = [r.roughness, r.metallic, r.clearcoat, r.sheen, r.anisotropy];
    numbers.iter().any(Option::is_some) || r.roughness_map.is_some() || r.metallic_map.is_some()
}

fn principled(
    base_color: ColorInput,
    metallic: f32,
    roughness: f32,
    specular: ColorInput,
) -> Surface {
    Surface::Principled {
        base_color,
        metallic: ScalarInput::constant(metallic),
        roughness: ScalarInput::constant(roughness),
        specular,
        anisotropy: 0.0,
        clearcoat: 0.0,
        clearcoat_roughness: 0.0,
        sheen: 0.0,
    }
}

fn scaled(color: ColorInput, factor: f32) -> ColorInput {
    ColorInput { value: color.value * factor, ..color }
}

/// Roughness of the highlight that `Ns` describes. Exponents up to 1 are exporters' way to leave it out.
fn phong_roughness(r: &MtlRecord) -> f32 {
    match r.exponent {
        Some(exponent) if exponent > 1.0 => (2.0 / (exponent + 2.0)).sqrt().sqrt(),
        _ => COMMON_ROUGHNESS,
    }
}

/// Roughness of a traced reflection or refraction.
fn traced_roughness(r: &MtlRecord) -> f32 {
    match r.exponent {
        Some(exponent) if exponent > 1.0 && exponent < SHARP_EXPONENT => phong_roughness(r),
        _ => 0.0,
    }
}

/// `aniso`, turned by `anisor`. The model stretches along or across the tangent only: of a rotation by an
/// angle t the part along these axes, cos 2t, is kept.
fn anisotropy(r: &MtlRecord) -> f32 {
    let turns = r.anisotropy_rotation.unwrap_or(0.0);
    let (_, cos_twice) = fun::sin_cos_turns(2.0 * turns);
    r.anisotropy.unwrap_or(0.0) * cos_twice
}

/// Exporters that know no `norm` write normal maps as `map_Bump`.
fn looks_like_normal_map(file: &str) -> bool {
    let name = file.rsplit(['/', '\\']).next().unwrap_or_default().to_lowercase();
    let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    ["normal", "nrm", "_nor"].iter().any(|part| stem.contains(part)) || stem.ends_with("_n")
}
