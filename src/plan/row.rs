//! The table of effects: on or off, why, and the stages that run for each.

use super::{Pipeline, Wishes};
use crate::error::Location;
use crate::ledger::{Class, Ledger, Stage};
use crate::scene::{self, Effect, Style};
use crate::world::{Census, Feature, Feature as F, LightSampler, Witness};

/// One effect or strategy.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name; those of [`Effect`] can be taken out by it.
    pub effect: &'static str,
    /// Whether it is simulated.
    pub on: bool,
    /// Why.
    pub reason: String,
    /// What calls for it, where it is defined in a file.
    pub source: Option<Location>,
    /// What runs for it, beyond what runs for every picture.
    pub stages: &'static [Stage],
    /// What it is billed for.
    charge: Charge,
}

/// What of a ledger an effect is billed for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Charge {
    /// The rays of a class.
    Class(Class),
    /// Whole stages.
    Stages(&'static [Stage]),
    /// Stages that do for some surfaces what others do for the rest, and more; where everything runs, they do it for
    /// all, so that what would be spared cannot be told.
    Instead(&'static [Stage]),
    /// Hit filters.
    CutOuts,
    /// Nothing that can be told from the rest.
    None,
}

impl Row {
    /// The worker seconds that a ledger has for it, where they can be told from the rest. Rows are views of one sum:
    /// a shadow ray is in its light's and in the one of shadows.
    pub fn seconds(&self, ledger: &Ledger) -> Option<f64> {
        let of = |stages: &[Stage]| stages.iter().map(|&s| ledger.stage(s).seconds).sum();
        match self.charge {
            Charge::Class(class) => Some(ledger.class_seconds(class)),
            Charge::Stages(stages) => Some(of(stages)),
            Charge::Instead(stages) => self.on.then(|| of(stages)),
            Charge::CutOuts => Some(ledger.cut_outs.seconds),
            Charge::None => None,
        }
    }
}

/// Why something is on or off, and who called for it.
type Reason = (bool, String, Option<Location>);

/// All rows.
pub(super) fn rows(
    pipeline: &Pipeline,
    lights: &LightSampler,
    census: &Census,
    camera: &scene::Camera,
    wishes: &Wishes,
) -> Vec<Row> {
    let judge = Judge { pipeline, lights, census, camera, wishes };
    let (lit, scatter) = (&[Stage::SampleLights, Stage::Shadow], &[Stage::Scatter]);
    let direct = |features| judge.direct(features);
    let event = |effect, feature| judge.event(effect, &[feature]);
    let row = |effect, reason: Reason, stages, charge| {
        let (on, reason, source) = reason;
        Row { effect, on, reason, source, stages, charge }
    };
    let instead = |effect, reason, stages| row(effect, reason, stages, Charge::Instead(stages));
    let staged = |effect, reason, stages| row(effect, reason, stages, Charge::Stages(stages));
    let classed = |effect, reason, stages, class| row(effect, reason, stages, Charge::Class(class));
    use Class as C;
    vec![
        staged("emission", judge.emission(), &[Stage::Emit]),
        staged("environment", judge.environment(), &[Stage::Environment]),
        classed("direct light of points", direct(&[F::PointLight]), lit, C::DirectPoint),
        classed("direct light of suns", direct(&[F::Sun, F::Direction]), lit, C::DirectSun),
        classed("direct light of surfaces", direct(&[F::Emission]), lit, C::DirectSurface),
        classed("direct light around", direct(&[F::Image, F::Constant]), lit, C::DirectEnvironment),
        staged("shadows", judge.shadows(), &[Stage::Shadow]),
        classed("diffuse", event(Effect::Diffuse, F::Diffuse), scatter, C::Diffuse),
        classed("glossy", event(Effect::Glossy, F::Glossy), scatter, C::Glossy),
        classed("mirror", event(Effect::Mirror, F::Mirror), scatter, C::Mirror),
        classed("refraction", judge.refraction(), scatter, C::Refraction),
        row("absorption", event(Effect::Absorption, F::Absorption), scatter, Charge::None),
        classed("caustics", judge.caustics(), scatter, C::Caustic),
        instead("textures", event(Effect::Textures, F::Texture), &[Stage::Textures]),
        instead("normal-maps", event(Effect::NormalMaps, F::NormalMap), &[Stage::Details]),
        row("cut-outs", event(Effect::CutOuts, F::CutOut), &[Stage::Intersect], Charge::CutOuts),
        staged("depth-of-field", judge.depth_of_field(), &[Stage::Lens]),
        row("instancing", judge.instancing(), &[Stage::Intersect], Charge::None),
        staged("light-sampling", judge.light_sampling(), lit),
        row(
            "choice of lights by power",
            judge.light_choice(),
            &[Stage::SampleLights],
            Charge::None,
        ),
        staged("scatter-sampling", judge.scatter_sampling(), &[Stage::Emit, Stage::Environment]),
        row("multiple importance sampling", judge.combination(), lit, Charge::None),
    ]
}

/// What reasons are made of.
struct Judge<'a> {
    pipeline: &'a Pipeline,
    lights: &'a LightSampler,
    census: &'a Census,
    camera: &'a scene::Camera,
    wishes: &'a Wishes,
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
        Feature::PointLight => "no point or spot light",
        Feature::Direction => "no directional light",
        Feature::Sun => "no sun and no other directional light",
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
    /// The reason that stands before all others: what the user took out, or that everything runs.
    fn said(&self, effect: Effect) -> Option<Reason> {
        let effects = &self.wishes.effects;
        if !effects.allowed.has(effect) {
            return Some(off(format!("left out: --effects {effects}")));
        }
        (effects.style == Style::All).then(|| on("--effects all"))
    }

    /// The first of `features` that the scene has; `Err` with the reason why there is none.
    fn found(&self, features: &[Feature]) -> Result<Reason, Reason> {
        let witness = features.iter().find_map(|&feature| self.census.witness(feature));
        witness.map(called_for).ok_or_else(|| off(nothing(features[0])))
    }

    fn with(&self, effect: Effect, reason: impl FnOnce() -> Reason) -> Reason {
        self.said(effect).unwrap_or_else(reason)
    }

    /// An effect that is on where something calls for it.
    fn event(&self, effect: Effect, features: &[Feature]) -> Reason {
        self.with(effect, || self.found(features).unwrap_or_else(|none| none))
    }

    fn emission(&self) -> Reason {
        self.event(Effect::Emission, &[Feature::Emission])
    }

    fn environment(&self) -> Reason {
        self.with(Effect::Environment, || {
            match self.found(&[Feature::Image, Feature::Constant, Feature::Sun]) {
                Ok(_) if self.wishes.hide_background => off("hidden: --background"),
                Ok(found) => found,
                Err(_) => off("nothing surrounds the scene"),
            }
        })
    }

    /// Direct light of one kind of lights.
    fn direct(&self, features: &[Feature]) -> Reason {
        self.with(Effect::Direct, || {
            let found = match self.found(features) {
                Ok(found) => found,
                Err(none) => return none,
            };
            if let Some(nothing) = self.ends_at_once() {
                return nothing;
            }
            if !self.census.has_any(&[F::Diffuse, F::Glossy, F::RoughRefraction]) {
                return off("no rough surface to fall on: light is mirrored or refracted");
            }
            let is_hard = |f: &Feature| matches!(f, Feature::PointLight | Feature::Direction);
            let has = |hard| features.iter().any(|f| is_hard(f) == hard && self.census.has(*f));
            let shadows = match (has(true), has(false)) {
                (true, true) => "hard and soft",
                (true, false) => "hard",
                (false, _) => "soft",
            };
            let how = match self.pipeline.light_sampling {
                true => format!("{shadows} shadows"),
                false => format!("{shadows} shadows, by scattered rays"),
            };
            (true, format!("{}: {how}", found.1), found.2)
        })
    }

    /// Why paths end at the first surface, if they do.
    fn ends_at_once(&self) -> Option<Reason> {
        (self.pipeline.max_depth < 2).then(|| match self.wishes.max_depth {
            0 | 1 => off("--max-depth 1"),
            _ => off("no surface scatters light"),
        })
    }

    fn shadows(&self) -> Reason {
        self.with(Effect::Shadows, || match self.pipeline.light_sampling {
            true => on("lights are sampled: rays to them may be blocked"),
            false => off("no ray is sent to a light: scattered ones meet what is in the way"),
        })
    }

    fn refraction(&self) -> Reason {
        let features = [Feature::Refraction, Feature::RoughRefraction];
        let reason = self.event(Effect::Refraction, &features);
        match reason {
            (true, why, source) if self.wishes.effects.style != Style::All => {
                (true, format!("{why}: with total internal reflection"), source)
            }
            other => other,
        }
    }

    fn caustics(&self) -> Reason {
        self.with(Effect::Caustics, || {
            let sharp = [Feature::Refraction, Feature::RoughRefraction, Feature::Mirror];
            let found = match self.found(&sharp) {
                Ok(found) => found,
                Err(_) => return off("nothing reflects or refracts sharply"),
            };
            if !self.census.has_any(&[Feature::Diffuse, Feature::Glossy]) {
                return off("no rough surface to throw light on");
            }
            if !self.pipeline.emission && !self.pipeline.environment {
                return off("lights are points: no ray meets one by way of a mirror");
            }
            if self.pipeline.max_depth < 3 {
                return off("--max-depth ends paths before");
            }
            found
        })
    }

    fn depth_of_field(&self) -> Reason {
        self.with(Effect::DepthOfField, || match self.camera.projection.has_lens() {
            true => {
                let camera = format!("camera \"{}\" has a lens", self.camera.name);
                (true, camera, self.camera.location.clone())
            }
            false => (false, "the camera has no lens".into(), self.camera.location.clone()),
        })
    }

    fn instancing(&self) -> Reason {
        match self.census.witness(Feature::Instancing) {
            Some(witness) => {
                let (n, first) = (witness.count, &witness.first);
                (true, format!("{n} placements, the first of {first}"), witness.location.clone())
            }
            None => off(nothing(Feature::Instancing)),
        }
    }

    fn light_sampling(&self) -> Reason {
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

    fn light_choice(&self) -> Reason {
        match (self.pipeline.light_choice, self.pipeline.everything) {
            (true, true) => on("--effects all"),
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

    fn scatter_sampling(&self) -> Reason {
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

    fn combination(&self) -> Reason {
        if self.pipeline.combination {
            return on(match self.pipeline.everything {
                true => "--effects all",
                false => "some lights are found in both ways",
            });
        }
        if let Some(nothing) = self.ends_at_once() {
            return nothing;
        }
        off(if !self.pipeline.light_sampling {
            "scattering alone finds all light"
        } else if !self.pipeline.scatter_sampling {
            "light sampling alone finds lights"
        } else {
            "no sampled light can be met by a ray: light sampling is exact"
        })
    }
}
