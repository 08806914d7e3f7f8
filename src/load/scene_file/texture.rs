//! Textures, and the colours and numbers that may be textured.
//!
//! A colour is `[r, g, b]`, one number for a grey, or `{ file = "x.png", .. }`; a number is a number or
//! `{ file = "x.png", .. }`. Knows nothing of materials.

use super::source::Source;
use super::value::{Color, Finite, Fraction, List, Ranged};
use crate::image::ColorSpace;
use crate::load::ImageTable;
use crate::math::Rgb;
use crate::scene::{Channel, ColorInput, NormalInput, ScalarInput, TextureReference};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// What textures are read into: the file that names them and the images asked for so far.
pub(super) struct Textures<'a> {
    pub(super) source: Source<'a>,
    pub(super) images: &'a mut ImageTable,
}

/// Defines the tables that name an image: the keys common to all, then each one's own.
macro_rules! texture_tables {
    ($($(#[$attribute:meta])* $name:ident $(<$range:ident>)? {
        $($(#[$key_attribute:meta])* $key:ident: $type:ty,)*
    })*) => {$(
        #[derive(Debug, Deserialize)]
        $(#[$attribute])*
        #[serde(deny_unknown_fields)]
        pub(super) struct $name $(<$range>)? {
            /// The image, relative to the scene file.
            file: Spanned<String>,
            /// `uv' = uv * scale + offset`.
            #[serde(default = "unit")]
            scale: List<Finite, 2>,
            /// See `scale`.
            #[serde(default = "zero")]
            offset: List<Finite, 2>,
            /// Beyond the edge of the image its edge repeats, instead of the image.
            #[serde(default)]
            clamp: bool,
            $($(#[$key_attribute])* $key: $type,)*
        }

        impl $(<$range>)? $name $(<$range>)? {
            /// Asks for the image and says how it lies on the surface.
            fn reference(&self, to: &mut Textures, space: ColorSpace) -> TextureReference {
                let path = to.source.resolve(self.file.get_ref());
                TextureReference {
                    image: to.images.request(path, space, to.source.location(&self.file.span())),
                    scale: self.scale.0.map(|v| v.0),
                    offset: self.offset.0.map(|v| v.0),
                    clamp: self.clamp,
                }
            }
        }
    )*};
}

texture_tables! {
    /// A texture of a colour whose channels are in the range of `C`.
    #[serde(bound = "C: Ranged")]
    ColorTexture<C> {
        /// Multiplies the image; 1 where it is not said.
        value: Option<Color<C>>,
    }

    /// A texture of a number.
    ScalarTexture {
        /// Multiplies the image.
        #[serde(default = "one")]
        value: Fraction,
        /// Which channel of the image is the number.
        #[serde(default)]
        channel: ChannelName,
    }

    /// A tangent-space normal map.
    NormalMap {}

    /// A height map.
    BumpMap {
        /// Multiplies the heights, which are in units of the texture's width.
        #[serde(default = "strength")]
        strength: Finite,
    }
}

const fn unit() -> List<Finite, 2> {
    List([Finite(1.0); 2])
}

const fn zero() -> List<Finite, 2> {
    List([Finite(0.0); 2])
}

const fn one() -> Fraction {
    Fraction(1.0)
}

const fn strength() -> Finite {
    Finite(1.0)
}

/// `channel = "red"` or `"alpha"`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ChannelName {
    #[default]
    Red,
    Alpha,
}

/// A colour that may be textured.
#[derive(Debug)]
pub(super) enum ColorSource<C> {
    /// The same everywhere.
    Plain(Rgb),
    /// An image.
    Texture(ColorTexture<C>),
}

impl<C: Ranged> ColorSource<C> {
    /// The colour for `scene`; its image, if it has one, is asked for as sRGB.
    pub(super) fn input(&self, to: &mut Textures) -> ColorInput {
        match self {
            Self::Plain(value) => ColorInput::constant(*value),
            Self::Texture(table) => ColorInput {
                value: table.value.as_ref().map_or(Rgb::WHITE, |color| color.rgb),
                texture: Some(table.reference(to, ColorSpace::Srgb)),
            },
        }
    }
}

impl<'de, C: Ranged> Deserialize<'de> for ColorSource<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SourceVisitor<C>(PhantomData<C>);
        impl<'de, C: Ranged> Visitor<'de> for SourceVisitor<C> {
            type Value = ColorSource<C>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}, a colour [r, g, b] of such, or {{ file = .. }}", C::EXPECTED)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                let color = Color::<C>::deserialize(value.into_deserializer())?;
                Ok(ColorSource::Plain(color.rgb))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                self.visit_f64(value as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Self::Value, A::Error> {
                let color = Color::<C>::deserialize(SeqAccessDeserializer::new(sequence))?;
                Ok(ColorSource::Plain(color.rgb))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                ColorTexture::deserialize(MapAccessDeserializer::new(map)).map(ColorSource::Texture)
            }
        }
        deserializer.deserialize_any(SourceVisitor(PhantomData))
    }
}

/// A number from 0 to 1 that may be textured.
#[derive(Debug)]
pub(super) enum ScalarSource {
    /// The same everywhere.
    Plain(f32),
    /// A channel of an image.
    Texture(ScalarTexture),
}

impl ScalarSource {
    /// The number for `scene`; its image, if it has one, is asked for as linear.
    pub(super) fn input(&self, to: &mut Textures) -> ScalarInput {
        match self {
            Self::Plain(value) => ScalarInput::constant(*value),
            Self::Texture(table) => {
                let channel = match table.channel {
                    ChannelName::Red => Channel::Red,
                    ChannelName::Alpha => Channel::Alpha,
                };
                let texture = table.reference(to, ColorSpace::Linear);
                ScalarInput { value: table.value.0, texture: Some((texture, channel)) }
            }
        }
    }
}

impl<'de> Deserialize<'de> for ScalarSource {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SourceVisitor;
        impl<'de> Visitor<'de> for SourceVisitor {
            type Value = ScalarSource;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} or {{ file = .. }}", Fraction::EXPECTED)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                let number = Fraction::deserialize(value.into_deserializer())?;
                Ok(ScalarSource::Plain(number.0))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                self.visit_f64(value as f64)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let table = ScalarTexture::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ScalarSource::Texture(table))
            }
        }
        deserializer.deserialize_any(SourceVisitor)
    }
}

impl NormalMap {
    /// The perturbation for `scene`.
    pub(super) fn input(&self, to: &mut Textures) -> NormalInput {
        NormalInput::Map(self.reference(to, ColorSpace::Linear))
    }
}

impl BumpMap {
    /// The perturbation for `scene`.
    pub(super) fn input(&self, to: &mut Textures) -> NormalInput {
        let texture = self.reference(to, ColorSpace::Linear);
        NormalInput::Bump { texture, strength: self.strength.0 }
    }
}
