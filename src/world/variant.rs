//! The same scene with less to see: what a user leaves out of surfaces is taken out of the world, once, so that
//! nothing has to ask for it while paths are traced. Variants share geometry, images and attributes.

use super::lights::Lights;
use super::{World, material};
use crate::error::Result;
use crate::math::Rgb;
use crate::scene::{Channel, ColorInput, Effect, Effects, Material, ScalarInput, Style, Surface};
use crate::texture::MipMap;
use std::sync::Arc;

impl World {
    /// The world that is rendered with `effects`: without what they leave out of surfaces, and all white where only
    /// ambient occlusion is wanted. Where everything is to run, hit filters are asked about every surface.
    ///
    /// # Errors
    /// None that a user could cause.
    pub fn with_effects(&self, effects: &Effects) -> Result<Self> {
        let mut world = self.clone();
        let allowed = |effect| effects.allowed.has(effect);
        for material in &mut world.materials {
            if !allowed(Effect::Textures) {
                material.forget_textures(&self.textures);
            }
            if !allowed(Effect::NormalMaps) {
                material.normal = None;
            }
            if !allowed(Effect::CutOuts) {
                material.opacity = ScalarInput::constant(1.0);
            }
            if effects.style == Style::AmbientOcclusion {
                material.surface = Surface::Lambert { albedo: ColorInput::constant(Rgb::WHITE) };
                material.emission = None;
            }
        }
        world.has_cut_outs &= allowed(Effect::CutOuts);
        world.needs_uv = material::needs_uv(&world.materials);
        if effects.style == Style::AmbientOcclusion {
            world.lights = Lights::white_surroundings(&world)?;
        }
        if effects.style == Style::All {
            Arc::make_mut(&mut world.geometry).filter_everything();
        }
        Ok(world)
    }
}

impl Material {
    /// Puts the mean of each texture into its place; cut-outs and normal maps stay.
    fn forget_textures(&mut self, textures: &[MipMap]) {
        let (colors, scalars) = self.inputs();
        for input in colors {
            if let Some(texture) = input.texture.take() {
                input.value *= textures[texture.image.index()].average();
            }
        }
        for input in scalars {
            if let Some((texture, channel)) = input.texture.take() {
                let image = &textures[texture.image.index()];
                input.value *= match channel {
                    Channel::Red => image.average().r,
                    Channel::Alpha => image.average_alpha(),
                };
            }
        }
    }
}
