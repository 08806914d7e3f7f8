//! Which effects of light a user wants: single effects, sets of them, and the words that name both.
//!
//! What a scene calls for is found later; this is only what was said.

use crate::error::{named_set, unknown_name};
use std::fmt;
use std::str::FromStr;

named_set! {
    /// An effect that a render can simulate or leave out. Where one is left out, the paths that need it are.
    Effect {
        /// Emissive surfaces, as the camera sees them.
        Emission = "emission",
        /// What surrounds the scene, as the camera sees it.
        Environment = "environment",
        /// Light that comes to what is seen straight from a light.
        Direct = "direct",
        /// Surfaces in the way of direct light.
        Shadows = "shadows",
        /// Light that diffuse surfaces throw on others.
        Diffuse = "diffuse",
        /// Rough reflections of other surfaces.
        Glossy = "glossy",
        /// Sharp reflections.
        Mirror = "mirror",
        /// Transmission, bent or straight, sharp or rough; with it, total internal reflection has two sides.
        Refraction = "refraction",
        /// What coloured glass and liquids keep of the light that runs through them.
        Absorption = "absorption",
        /// Light that mirrors and glass throw on rough surfaces.
        Caustics = "caustics",
        /// Images on surfaces; without them, their mean colours.
        Textures = "textures",
        /// Normal and bump maps.
        NormalMaps = "normal-maps",
        /// Parts of surfaces that are not there; without, surfaces are whole.
        CutOuts = "cut-outs",
        /// A lens in focus at one distance; without, a pinhole in its middle.
        DepthOfField = "depth-of-field",
        /// Rays sent to lights on purpose.
        LightSampling = "light-sampling",
        /// Lights met by rays that surfaces scatter.
        ScatterSampling = "scatter-sampling",
    }
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EffectSet(u32);

impl EffectSet {
    /// None.
    pub const NONE: Self = Self(0);
    /// Every one.
    pub const ALL: Self = Self((1 << Effect::ALL.len()) - 1);

    /// The set of the listed ones.
    pub const fn of(effects: &[Effect]) -> Self {
        let (mut set, mut i) = (Self::NONE, 0);
        while i < effects.len() {
            set = set.with(effects[i]);
            i += 1;
        }
        set
    }

    /// Whether it is in the set.
    #[inline]
    pub const fn has(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u32 != 0
    }

    /// With one more.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u32)
    }

    /// With one less.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u32))
    }

    /// Those that are in the set.
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.iter().copied().filter(move |&effect| self.has(effect))
    }
}

/// Where a choice of effects starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// What the scene calls for.
    #[default]
    Auto,
    /// Everything runs, whether the scene calls for it or not: what `Auto` is held against.
    All,
    /// Everything is white, and so is what surrounds it: how open each place is.
    AmbientOcclusion,
}

/// What a user wants simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Whether the scene has a say.
    pub style: Style,
    /// What may be simulated.
    pub allowed: EffectSet,
}

impl Default for Effects {
    fn default() -> Self {
        Self::AUTO
    }
}

/// How surfaces and the camera look, apart from the transport of light.
const LOOKS: EffectSet = EffectSet::of(&[
    Effect::Emission,
    Effect::Environment,
    Effect::Textures,
    Effect::NormalMaps,
    Effect::CutOuts,
    Effect::DepthOfField,
]);

impl Effects {
    /// What the scene calls for.
    pub const AUTO: Self = Self { style: Style::Auto, allowed: EffectSet::ALL };
    /// Everything.
    pub const EVERYTHING: Self = Self { style: Style::All, allowed: EffectSet::ALL };

    const DIRECT: EffectSet = LOOKS
        .with(Effect::Direct)
        .with(Effect::Shadows)
        .with(Effect::LightSampling)
        .with(Effect::ScatterSampling);

    /// What every list begins with.
    const FINDING_LIGHTS: [Effect; 3] =
        [Effect::Shadows, Effect::LightSampling, Effect::ScatterSampling];

    /// The sets with a name. `path` is `auto`: a path tracer simulates whatever a scene calls for.
    pub const NAMED: [(&'static str, Self); 6] = [
        ("auto", Self::AUTO),
        ("all", Self::EVERYTHING),
        ("path", Self::AUTO),
        ("direct", Self { style: Style::Auto, allowed: Self::DIRECT }),
        // T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980: rays to lights,
        // and the tree of mirrored and refracted rays.
        (
            "whitted",
            Self {
                style: Style::Auto,
                allowed: Self::DIRECT
                    .without(Effect::ScatterSampling)
                    .with(Effect::Mirror)
                    .with(Effect::Refraction)
                    .with(Effect::Absorption),
            },
        ),
        ("ambient-occlusion", Self { style: Style::AmbientOcclusion, allowed: Self::DIRECT }),
    ];

    fn allowed_beyond(&self, some: &[Effect]) -> Vec<Effect> {
        let is_more = |effect: &Effect| self.allowed.has(*effect) && !some.contains(effect);
        Effect::ALL.iter().copied().filter(is_more).collect()
    }

    /// The effects that were taken out of everything.
    pub fn left_out(&self) -> impl Iterator<Item = Effect> {
        let allowed = self.allowed;
        Effect::ALL.iter().copied().filter(move |&effect| !allowed.has(effect))
    }
}

impl FromStr for Effects {
    type Err = String;

    /// `auto`, another named set or an effect, then effects to add and, after `no-`, to take out. An effect in the
    /// first place starts from nothing but the two ways of finding lights, and shadows; `no-` in the first place from
    /// `auto`.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut effects: Option<Self> = None;
        for word in text.split(',').map(str::trim) {
            let set = Self::NAMED.iter().find(|named| named.0 == word).map(|named| named.1);
            let taken = word.strip_prefix("no-");
            let name = taken.unwrap_or(word);
            let effect = Effect::ALL.iter().copied().find(|effect| effect.name() == name);
            effects = Some(match (effects, set, effect) {
                (None, Some(set), _) => set,
                (None, None, Some(effect)) if taken.is_some() => {
                    Self { allowed: EffectSet::ALL.without(effect), ..Self::AUTO }
                }
                (None, None, Some(effect)) => {
                    let allowed = EffectSet::of(&Self::FINDING_LIGHTS).with(effect);
                    Self { allowed, ..Self::AUTO }
                }
                (Some(before), _, Some(effect)) => {
                    let allowed = match taken {
                        Some(_) => before.allowed.without(effect),
                        None => before.allowed.with(effect),
                    };
                    Self { allowed, ..before }
                }
                (Some(_), Some(_), None) => {
                    return Err(format!("`{word}` names a whole set: put it first"));
                }
                (_, None, None) => {
                    let sets = Self::NAMED.iter().map(|named| named.0);
                    // `direct` is a set in the first place and an effect after it.
                    let single = Effect::ALL.iter().filter(|&&effect| effect != Effect::Direct);
                    let known = sets.filter(|_| taken.is_none());
                    let known = known.chain(single.map(|effect| effect.name()));
                    return Err(unknown_name("effects", name, known));
                }
            });
        }
        // Splitting gives one word at least.
        Ok(effects.unwrap_or_default())
    }
}

impl fmt::Display for Effects {
    /// In words that mean the same when they are read again.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = Self::NAMED.iter().find(|named| named.1 == *self) {
            return f.write_str(name);
        }
        // A list of few effects, where that says it all.
        let few = self.allowed_beyond(&Self::FINDING_LIGHTS);
        let is_few = few.len() < 5 && few.first().is_some_and(|first| *first != Effect::Direct);
        if self.style == Style::Auto && is_few {
            let names: Vec<&str> = few.iter().map(|effect| effect.name()).collect();
            f.write_str(&names.join(","))?;
            for effect in Self::FINDING_LIGHTS.iter().filter(|way| !self.allowed.has(**way)) {
                write!(f, ",no-{}", effect.name())?;
            }
            return Ok(());
        }
        f.write_str(match self.style {
            Style::Auto => "auto",
            Style::All => "all",
            Style::AmbientOcclusion => "ambient-occlusion",
        })?;
        let usual = match self.style {
            Style::AmbientOcclusion => Self::DIRECT,
            Style::Auto | Style::All => EffectSet::ALL,
        };
        for &effect in Effect::ALL {
            match (usual.has(effect), self.allowed.has(effect)) {
                (true, false) => write!(f, ",no-{}", effect.name())?,
                (false, true) => write!(f, ",{}", effect.name())?,
                _ => {}
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Effects {
        text.parse().unwrap()
    }

    #[test]
    fn words_add_and_take_out() {
        assert_eq!(parsed("path"), Effects::AUTO);
        assert_eq!(parsed("emission,mirror,no-shadows").to_string(), "emission,mirror,no-shadows");
        assert!(!"no-all".parse::<Effects>().unwrap_err().contains("did you mean"));
        assert_eq!(parsed("no-refraction"), parsed("auto,no-refraction"));
        assert_eq!(parsed("all,no-refraction").style, Style::All);
        assert!(!parsed("all,no-refraction").allowed.has(Effect::Refraction));
        assert_eq!(parsed("direct,shadows"), parsed("direct"));
        assert_eq!(parsed("direct, no-shadows , mirror").allowed, {
            Effects::DIRECT.without(Effect::Shadows).with(Effect::Mirror)
        });
        let mirror = parsed("mirror,emission").allowed;
        assert_eq!(mirror.iter().count(), 5);
        assert!(mirror.has(Effect::Shadows) && !mirror.has(Effect::Textures));
    }

    #[test]
    fn wrong_words_are_told() {
        assert!("all,whitted".parse::<Effects>().unwrap_err().contains("put it first"));
        let unknown = "pth".parse::<Effects>().unwrap_err();
        assert!(unknown.contains("did you mean `path`"), "{unknown}");
        assert!("all,no-refractions".parse::<Effects>().unwrap_err().contains("`refraction`"));
        assert!("".parse::<Effects>().is_err());
        assert!("all,".parse::<Effects>().is_err());
    }

    #[test]
    fn what_is_written_reads_the_same() {
        let single = Effect::ALL.iter().flat_map(|e| {
            ["auto,no-", "all,no-", "ambient-occlusion,no-", "direct,", "whitted,", ""]
                .map(|start| format!("{start}{}", e.name()))
        });
        let sets = Effects::NAMED.iter().map(|named| named.0.to_owned());
        for text in sets.chain(single) {
            let effects = parsed(&text);
            assert_eq!(parsed(&effects.to_string()), effects, "{text} is {effects}");
        }
    }
}
