//! Whether an effect is on, why, and who calls for it: in words for people.
//!
//! The reasons follow the decisions of [`Pipeline`]; nothing is decided here.

use super::{Pipeline, Wishes};
use crate::error::Location;
use crate::scene::{self, Effect, Style};
use crate::world::{Census, Feature, LightSampler, Witness};

/// Whether something is on, why, and where who calls for it is defined.
pub(super) type Reason = (bool, String, Option<Location>);

/// What reasons are made of.
pub(super) struct Judge<'a> {
    pub(super) pipeline: &'a Pipeline,
    pub(super) lights: &'a LightSampler,
    pub(super) census: &'a Census,
    pub(super) camera: &'a scene::Camera,
    pub(super) wishes: &'a Wishes,
}

fn off(reason: impl Into<String>) -> Reason {
    (false, reason.into(), None)
}

fn on(reason: impl Into<String>) -> Reason {
    (true, reason.into(), None)
}

/// Who calls for something, and how many do.
fn called_for(witness: &Witness) -> Reason {
    let others = match witness.count - 1 {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    (true, format!("{}{others}", witness.first), witness.location.clone())
}

/// What it means that nothing in a scene has a feature.
const fn nothing(feature: Feature) -> &'static str {
    match feature {
        Feature::PointLight => "no point or spot light shines",
        Feature::Direction => "no directional light shines",
        Feature::Sun => "no sun and no other directional light shines",
        Feature::Emission => "no surface emits",
        Feature::Constant => "no constant environment",
        Feature::Image => "no sky and no image around the scene",
        Feature::Diffuse => "no diffuse surface",
        Feature::Glossy => "no glossy surface",
        Feature::Mirror => "no mirror and no smooth interface",
        Feature::Refraction | Feature::RoughRefraction => "nothing is transparent",
        Feature::Absorption => "no medium absorbs",
        Feature::Texture => "no surface has a texture",
        Feature::NormalMap => "no normal or bump map",
        Feature::CutOut => "every surface is whole",
        Feature::Instancing => "no model is placed twice",
    }
}

impl Judge<'_> {
    /// What the user took out.
    fn left_out(&self, effect: Effect) -> Option<Reason> {
        let effects = &self.wishes.effects;
        (!effects.allowed.has(effect)).then(|| off(format!("left out: effects {effects}")))
    }

    /// What takes paths of more segments than the user wants.
    fn too_long(&self, segments: u32) -> Option<Reason> {
        let depth = self.wishes.max_depth;
        (depth < segments).then(|| off(format!("a depth of {depth} ends paths before")))
    }

    /// That everything runs.
    fn everything(&self) -> Option<Reason> {
        (self.wishes.effects.style == Style::All).then(|| on("effects all"))
    }

    /// The first of `features` that the scene has; `Err` with the reason why there is none.
    fn found(&self, features: &[Feature]) -> Result<Reason, Reason> {
        let mut witnesses = features.iter().filter_map(|&feature| self.census.witness(feature));
        let Some(first) = witnesses.next() else { return Err(off(nothing(features[0]))) };
        let mut reason = called_for(first);
        // Who calls for several of them is not counted twice.
        if first.count == 1 && witnesses.any(|other| other.count > 1 || other.first != first.first)
        {
            reason.1.push_str(" and others");
        }
        Ok(reason)
    }

    /// `reason`, unless the user took the effect out or had everything run.
    fn with(&self, effect: Effect, reason: impl FnOnce() -> Reason) -> Reason {
        self.left_out(effect).or_else(|| self.everything()).unwrap_or_else(reason)
    }

    /// An effect that is on where something calls for it, and that takes paths of so many segments.
    pub(super) fn event(&self, effect: Effect, features: &[Feature], segments: u32) -> Reason {
        let barred = self.left_out(effect).or_else(|| self.too_long(segments));
        let found = || self.found(features).unwrap_or_else(|none| none);
        barred.or_else(|| self.everything()).unwrap_or_else(found)
    }

    pub(super) fn emission(&self) -> Reason {
        self.event(Effect::Emission, &[Feature::Emission], 0)
    }

    pub(super) fn environment(&self) -> Reason {
        self.with(Effect::Environment, || {
            match self.found(&[Feature::Image, Feature::Constant, Feature::Sun]) {
                Ok(_) if self.wishes.hide_background => off("hidden: --background"),
                Ok(found) => found,
                Err(_) => off("nothing surrounds the scene"),
            }
        })
    }

    /// Direct light of one kind of lights.
    pub(super) fn direct(&self, features: &[Feature]) -> Reason {
        if let Some(barred) = self.left_out(Effect::Direct).or_else(|| self.too_long(2)) {
            return barred;
        }
        let is_hard = |f: &Feature| matches!(f, Feature::PointLight | Feature::Direction);
        let has = |hard| features.iter().any(|f| is_hard(f) == hard && self.census.has(*f));
        let Pipeline { light_sampling, scatter_sampling, .. } = *self.pipeline;
        let is_found = light_sampling || scatter_sampling && has(false);
        if (has(true) || has(false)) && !is_found && self.is_sampling_left_out() {
            let effects = self.wishes.effects;
            return off(format!("no ray meets it, and it is not sampled: effects {effects}"));
        }
        self.everything().unwrap_or_else(|| {
            let found = match self.found(features) {
                Ok(found) => found,
                Err(none) => return none,
            };
            if let Some(nothing) = self.ends_at_once() {
                return nothing;
            }
            if !self.census.has_any(&[Feature::Diffuse, Feature::Glossy, Feature::RoughRefraction])
            {
                return off("no rough surface to fall on: light is mirrored or refracted");
            }
            let how = match (light_sampling, has(true), has(false)) {
                _ if !self.pipeline.shadows => "no shadows",
                (false, ..) => "soft shadows, by scattered rays",
                (true, true, true) => "hard and soft shadows",
                (true, true, false) => "hard shadows",
                (true, false, _) => "soft shadows",
            };
            (true, format!("{}: {how}", found.1), found.2)
        })
    }

    /// Why paths end at the first surface, if they do.
    fn ends_at_once(&self) -> Option<Reason> {
        let scatter = [
            Feature::Diffuse,
            Feature::Glossy,
            Feature::RoughRefraction,
            Feature::Mirror,
            Feature::Refraction,
        ];
        (self.pipeline.max_depth < 2).then(|| match self.too_long(2) {
            Some(reason) => reason,
            None if !self.census.has_any(&scatter) => off("no surface scatters light"),
            None => off(format!("scattered light is left out: effects {}", self.wishes.effects)),
        })
    }

    fn is_sampling_left_out(&self) -> bool {
        !self.wishes.effects.allowed.has(Effect::LightSampling)
    }

    pub(super) fn shadows(&self) -> Reason {
        self.with(Effect::Shadows, || match (self.pipeline.light_sampling, self.ends_at_once()) {
            (true, _) => on("lights are sampled: rays to them may be blocked"),
            (false, Some(nothing)) => nothing,
            (false, None) => off("no ray is sent to a light: scattered ones are stopped anyway"),
        })
    }

    pub(super) fn refraction(&self) -> Reason {
        let features = [Feature::Refraction, Feature::RoughRefraction];
        let reason = self.event(Effect::Refraction, &features, 2);
        match reason {
            (true, why, source) if self.wishes.effects.style != Style::All => {
                (true, format!("{why}: with total internal reflection"), source)
            }
            other => other,
        }
    }

    pub(super) fn caustics(&self) -> Reason {
        if let Some(barred) = self.left_out(Effect::Caustics).or_else(|| self.too_long(3)) {
            return barred;
        }
        self.everything().unwrap_or_else(|| {
            let sharp = [Feature::Refraction, Feature::RoughRefraction, Feature::Mirror];
            let found = match self.found(&sharp) {
                Ok(found) => found,
                Err(_) => return off("nothing reflects or refracts sharply"),
            };
            if !self.census.has_any(&[Feature::Diffuse, Feature::Glossy]) {
                return off("no rough surface to throw light on");
            }
            found
        })
    }

    pub(super) fn depth_of_field(&self) -> Reason {
        self.with(Effect::DepthOfField, || match self.camera.projection.has_lens() {
            true => {
                let camera = format!("camera \"{}\" has a lens", self.camera.name);
                (true, camera, self.camera.location.clone())
            }
            false => (false, "the camera has no lens".into(), self.camera.location.clone()),
        })
    }

    pub(super) fn instancing(&self) -> Reason {
        match self.census.witness(Feature::Instancing) {
            Some(witness) => {
                let (n, first) = (witness.count, &witness.first);
                (true, format!("{n} placements, the first of {first}"), witness.location.clone())
            }
            None => off(nothing(Feature::Instancing)),
        }
    }

    pub(super) fn light_sampling(&self) -> Reason {
        self.with(Effect::LightSampling, || {
            if self.pipeline.light_sampling {
                let ways: Vec<&str> = [
                    (Feature::PointLight, "points"),
                    (Feature::Direction, "directions"),
                    (Feature::Sun, "suns by solid angle"),
                    (Feature::Emission, "surfaces by area"),
                    (Feature::Image, "surroundings by radiance"),
                ]
                .into_iter()
                .filter(|(feature, _)| self.census.has(*feature))
                .map(|(_, way)| way)
                .collect();
                return on(ways.join(", "));
            }
            if let Some(nothing) = self.ends_at_once() {
                return nothing;
            }
            if self.lights.is_empty() && self.census.has(Feature::Constant) {
                return off("a constant environment is found better by scattering alone");
            }
            if self.lights.is_empty() {
                return off("there is no light");
            }
            off("every surface is a mirror or clear: only reflections find lights")
        })
    }

    pub(super) fn light_choice(&self) -> Reason {
        match (self.pipeline.light_choice, self.pipeline.everything) {
            (true, true) => on("effects all"),
            (true, false) if self.lights.idle() > 0.0 => on(format!(
                "one of {}, or none at {:.0} % of the vertices: scattering finds what is around",
                self.lights.choices(),
                100.0 * self.lights.idle()
            )),
            (true, false) => on(format!("one of {}", self.lights.choices())),
            (false, _) if !self.pipeline.light_sampling => off("no light is sampled"),
            (false, _) => off("one light is sampled"),
        }
    }

    pub(super) fn scatter_sampling(&self) -> Reason {
        self.with(Effect::ScatterSampling, || {
            if !self.pipeline.scatter_sampling {
                return off("without shadows, only light sampling finds lights");
            }
            if let Some(nothing) = self.ends_at_once() {
                return nothing;
            }
            match self.pipeline.emission || self.pipeline.environment {
                true => on("rays can meet lights"),
                false => off("lights are points or directions: no ray meets one"),
            }
        })
    }

    pub(super) fn combination(&self) -> Reason {
        if self.pipeline.combination {
            return on(match self.pipeline.everything {
                true => "effects all",
                false => "some lights are found in both ways",
            });
        }
        if let Some(nothing) = self.ends_at_once() {
            return nothing;
        }
        off(if !self.pipeline.light_sampling && !self.pipeline.scatter_sampling {
            "no light is looked for"
        } else if !self.pipeline.light_sampling {
            "scattering alone finds lights"
        } else if !self.pipeline.scatter_sampling {
            "light sampling alone finds lights"
        } else {
            "no sampled light can be met by a ray: light sampling is exact"
        })
    }
}
