//! Materials evaluated at a point: inputs times textures, then the BSDF's parameters.

use super::{SurfaceInteraction, World};
use crate::bsdf::{
    Bsdf, Conductor, Dielectric, Lambert, Mirror, OrenNayar, Plastic, Principled,
    PrincipledParameters, ReceiveAny, RoughDielectric,
};
use crate::math::Rgb;
use crate::scene::{
    Channel, ColorInput, Material, MaterialId, ScalarInput, Surface, TextureReference,
};
use crate::texture::{MipMap, Wrap};

impl World {
    /// Gives `receiver` the scattering model at an interaction, in its shading frame, for a ray from outside
    /// or inside.
    #[inline(always)]
    pub fn scattering<R: ReceiveAny>(&self, at: &SurfaceInteraction, receiver: &mut R) {
        let color = |input: &ColorInput| self.color(input, at.uv, at.footprint);
        let scalar = |input: &ScalarInput| self.scalar(input, at.uv, at.footprint);
        match &self.material(at.material).surface {
            Surface::Lambert { albedo } => receiver.receive(Lambert::new(color(albedo))),
            Surface::OrenNayar { albedo, sigma } => {
                receiver.receive(OrenNayar::new(color(albedo), *sigma));
            }
            Surface::Mirror { reflectance } => receiver.receive(Mirror::new(color(reflectance))),
            Surface::Dielectric { eta, roughness, transmittance, thin, .. } => {
                let (entering, roughness) = (at.entering, scalar(roughness));
                match RoughDielectric::new(*eta, entering, *transmittance, *thin, roughness) {
                    Some(rough) => receiver.receive(rough),
                    None => {
                        receiver.receive(Dielectric::new(*eta, entering, *transmittance, *thin))
                    }
                }
            }
            Surface::Conductor { eta, k, roughness, anisotropy } => {
                receiver.receive(Conductor::new(*eta, *k, scalar(roughness), *anisotropy));
            }
            Surface::Plastic { albedo, eta, roughness } => {
                receiver.receive(Plastic::new(color(albedo), *eta, scalar(roughness)));
            }
            Surface::Principled {
                base_color,
                metallic,
                roughness,
                specular,
                anisotropy,
                clearcoat,
                clearcoat_roughness,
                sheen,
            } => receiver.receive(Principled::new(&PrincipledParameters {
                base_color: color(base_color),
                metallic: scalar(metallic),
                roughness: scalar(roughness),
                specular: color(specular),
                anisotropy: *anisotropy,
                clearcoat: *clearcoat,
                clearcoat_roughness: *clearcoat_roughness,
                sheen: *sheen,
            })),
        }
    }

    /// [`World::scattering`] as one type for all models, where speed does not matter.
    pub fn bsdf(&self, at: &SurfaceInteraction) -> Bsdf {
        // Every surface has a model, which takes the place of this one.
        let mut bsdf = Bsdf::Lambert(Lambert::new(Rgb::BLACK));
        self.scattering(at, &mut bsdf);
        bsdf
    }

    /// Radiance emitted from the surface, the same on both sides; black where nothing is emitted.
    #[inline]
    pub fn emitted(&self, at: &SurfaceInteraction) -> Rgb {
        match &self.material(at.material).emission {
            None => Rgb::BLACK,
            Some(emission) => self.color(&emission.radiance, at.uv, at.footprint),
        }
    }

    /// Absorption coefficient inside a dielectric; `None` where nothing is absorbed.
    pub fn absorption(&self, material: MaterialId) -> Option<Rgb> {
        match self.material(material).surface {
            Surface::Dielectric { absorption, thin: false, .. } if !absorption.is_black() => {
                Some(absorption)
            }
            _ => None,
        }
    }

    /// Coverage of a material at a texture coordinate, in [0, 1].
    #[inline]
    pub(super) fn opacity(&self, material: MaterialId, uv: [f32; 2]) -> f32 {
        self.scalar(&self.material(material).opacity, uv, 0.0).clamp(0.0, 1.0)
    }

    /// Mean emitted radiance of a material over its texture.
    pub(super) fn mean_emission(&self, material: MaterialId) -> Rgb {
        self.material(material).emission.map_or(Rgb::BLACK, |emission| {
            let texture = emission.radiance.texture;
            let mean = texture.map_or(Rgb::WHITE, |t| self.textures[t.image.index()].average());
            emission.radiance.value * mean
        })
    }

    /// A colour input at a texture coordinate.
    #[inline]
    pub(super) fn color(&self, input: &ColorInput, uv: [f32; 2], footprint: f32) -> Rgb {
        match &input.texture {
            None => input.value,
            Some(texture) => input.value * lookup(&self.textures, texture, uv, footprint).0,
        }
    }

    #[inline]
    fn scalar(&self, input: &ScalarInput, uv: [f32; 2], footprint: f32) -> f32 {
        match &input.texture {
            None => input.value,
            Some((texture, channel)) => {
                let (rgb, alpha) = lookup(&self.textures, texture, uv, footprint);
                input.value
                    * match channel {
                        Channel::Red => rgb.r,
                        Channel::Alpha => alpha,
                    }
            }
        }
    }
}

/// Colour and alpha of a placed texture.
#[inline]
pub(super) fn lookup(
    textures: &[MipMap],
    texture: &TextureReference,
    uv: [f32; 2],
    footprint: f32,
) -> (Rgb, f32) {
    let uv = [0, 1].map(|k| uv[k] * texture.scale[k] + texture.offset[k]);
    let footprint = footprint * texture.scale[0].abs().max(texture.scale[1].abs());
    textures[texture.image.index()].lookup(uv, footprint, wrap_of(texture))
}

/// How a placed texture continues beyond its edges.
#[inline]
pub(super) fn wrap_of(texture: &TextureReference) -> Wrap {
    if texture.clamp { Wrap::Clamp } else { Wrap::Repeat }
}

/// For each material, whether its textures or maps are looked up when it is shaded. (Hit filters look up what is
/// cut out by themselves.)
pub(super) fn needs_uv(materials: &[Material]) -> Vec<bool> {
    let of = |material: &Material| {
        let mut shaded = Material { opacity: ScalarInput::constant(1.0), ..material.clone() };
        let mut textures = 0;
        shaded.for_each_texture(|_| textures += 1);
        textures > 0
    };
    materials.iter().map(of).collect()
}

/// An alpha cut-out by an image without alpha cuts nothing out: such a texture is dropped here, so
/// that its triangles need no filter.
pub(super) fn drop_alpha_of_opaque_images(material: &mut Material, textures: &[MipMap]) {
    if let Some((texture, Channel::Alpha)) = material.opacity.texture
        && !textures[texture.image.index()].image().has_alpha()
    {
        material.opacity.texture = None;
    }
}
