//! Materials as files describe them: numbers times textures. `world` compiles them.

use super::ImageId;
use crate::error::Location;
use crate::math::Rgb;

/// How an image is placed on a surface: `uv' = uv * scale + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureReference {
    /// Which image.
    pub image: ImageId,
    /// MTL option `-s`.
    pub scale: [f32; 2],
    /// MTL option `-o`.
    pub offset: [f32; 2],
    /// MTL option `-clamp on`: texels beyond the edge repeat it; otherwise the image repeats.
    pub clamp: bool,
}

/// A colour: `value`, times the texture when there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorInput {
    /// Linear Rec. 709.
    pub value: Rgb,
    /// Multiplies the value.
    pub texture: Option<TextureReference>,
}

impl ColorInput {
    /// An untextured colour.
    pub const fn constant(value: Rgb) -> Self {
        Self { value, texture: None }
    }
}

/// Which channel of an image a number comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Red (a grey image has its grey in all three).
    Red,
    /// Alpha, 1 where the image has none.
    Alpha,
}

/// A number: `value`, times a channel of the texture when there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarInput {
    /// The number, or the factor of the texture.
    pub value: f32,
    /// Multiplies the value.
    pub texture: Option<(TextureReference, Channel)>,
}

impl ScalarInput {
    /// An untextured number.
    pub const fn constant(value: f32) -> Self {
        Self { value, texture: None }
    }
}

/// Perturbation of the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalInput {
    /// Tangent-space normal map (MTL `norm`): rgb = (n + 1) / 2, y up.
    Map(TextureReference),
    /// Height map (MTL `map_Bump`, `bump`): `strength` (option `-bm`) times the red channel, as a height
    /// in units of the texture's width.
    Bump {
        /// The heights.
        texture: TextureReference,
        /// Multiplies them.
        strength: f32,
    },
}

/// Emitted radiance, on both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance (MTL `Ke`, `map_Ke`).
    pub radiance: ColorInput,
}

/// How a surface scatters. Roughness is perceptual: GGX alpha = roughness^2. Ranges [0, 1] unless said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// Ideal diffuse.
    Lambert {
        /// Reflectance.
        albedo: ColorInput,
    },
    /// Rough diffuse (Oren-Nayar).
    OrenNayar {
        /// Reflectance.
        albedo: ColorInput,
        /// Standard deviation of the facet slope angle, radians.
        sigma: f32,
    },
    /// Perfect mirror.
    Mirror {
        /// Reflectance at every angle.
        reflectance: ColorInput,
    },
    /// Glass and liquids: smooth where roughness is 0.
    Dielectric {
        /// Index of refraction inside over outside, > 0.
        eta: f32,
        /// Perceptual roughness.
        roughness: ScalarInput,
        /// Absorption coefficient inside, per unit length (Beer-Lambert).
        absorption: Rgb,
        /// Multiplies what is transmitted (MTL `Tf`): a filter at the interface, physical only when thin.
        transmittance: Rgb,
        /// A sheet without an inside: light passes straight, with the inner reflections summed.
        thin: bool,
    },
    /// Metal.
    Conductor {
        /// Real part of the index of refraction, per channel.
        eta: Rgb,
        /// Imaginary part.
        k: Rgb,
        /// Perceptual roughness; 0 is a mirror.
        roughness: ScalarInput,
        /// -1..1: stretches highlights along (positive) or across the tangent.
        anisotropy: f32,
    },
    /// A diffuse base under a dielectric coat.
    Plastic {
        /// Reflectance of the base.
        albedo: ColorInput,
        /// Index of refraction of the coat.
        eta: f32,
        /// Perceptual roughness of the coat.
        roughness: ScalarInput,
    },
    /// The artist's model that MTL files map to.
    Principled {
        /// Diffuse albedo of the dielectric part, specular colour at normal incidence of the metallic part.
        base_color: ColorInput,
        /// Blend from dielectric to metal.
        metallic: ScalarInput,
        /// Perceptual roughness of the main specular lobe.
        roughness: ScalarInput,
        /// Specular reflectance at normal incidence of the dielectric part (0.04 for eta 1.5).
        specular: ColorInput,
        /// -1..1, as for conductors.
        anisotropy: f32,
        /// Strength of a clear coat of eta 1.5.
        clearcoat: f32,
        /// Perceptual roughness of the coat.
        clearcoat_roughness: f32,
        /// Strength of the sheen lobe.
        sheen: f32,
    },
}

/// A material: how it scatters, what it emits, where it is cut out.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the library or scene file.
    pub name: String,
    /// Where it is defined.
    pub location: Option<Location>,
    /// Scattering.
    pub surface: Surface,
    /// Emission, if any.
    pub emission: Option<Emission>,
    /// Coverage: 1 opaque, 0 absent (MTL `d`, `map_d`, alpha of `map_Kd`).
    pub opacity: ScalarInput,
    /// Perturbed shading normal, if any.
    pub normal: Option<NormalInput>,
}

impl Material {
    /// An opaque, non-emitting material.
    pub fn new(name: impl Into<String>, surface: Surface) -> Self {
        Self {
            name: name.into(),
            location: None,
            surface,
            emission: None,
            opacity: ScalarInput::constant(1.0),
            normal: None,
        }
    }

    /// Whether rays may pass through it: it must be asked about at every candidate hit.
    pub fn is_cut_out(&self) -> bool {
        self.opacity.value < 1.0 || self.opacity.texture.is_some()
    }

    /// The grey that faces without a material get.
    pub fn default_grey() -> Self {
        Self::new("default", Surface::Lambert { albedo: ColorInput::constant(Rgb::splat(0.5)) })
    }

    /// The inputs of its surface and of its emission: colours, and numbers.
    pub fn inputs(&mut self) -> (Vec<&mut ColorInput>, Vec<&mut ScalarInput>) {
        let (mut colors, scalars) = match &mut self.surface {
            Surface::Lambert { albedo } | Surface::OrenNayar { albedo, .. } => {
                (vec![albedo], vec![])
            }
            Surface::Mirror { reflectance } => (vec![reflectance], vec![]),
            Surface::Dielectric { roughness, .. } | Surface::Conductor { roughness, .. } => {
                (vec![], vec![roughness])
            }
            Surface::Plastic { albedo, roughness, .. } => (vec![albedo], vec![roughness]),
            Surface::Principled { base_color, metallic, roughness, specular, .. } => {
                (vec![base_color, specular], vec![metallic, roughness])
            }
        };
        colors.extend(self.emission.as_mut().map(|emission| &mut emission.radiance));
        (colors, scalars)
    }

    /// Calls `visit` on every texture of the material.
    pub fn for_each_texture(&mut self, mut visit: impl FnMut(&mut TextureReference)) {
        let (colors, scalars) = self.inputs();
        for color in colors {
            color.texture.iter_mut().for_each(&mut visit);
        }
        for scalar in scalars {
            scalar.texture.iter_mut().for_each(|(texture, _)| visit(texture));
        }
        self.opacity.texture.iter_mut().for_each(|(texture, _)| visit(texture));
        match &mut self.normal {
            Some(NormalInput::Map(texture) | NormalInput::Bump { texture, .. }) => visit(texture),
            None => {}
        }
    }
}
