//! The table of effects: the stages that run for each, and what it is billed for.

use super::judge::{Judge, Reason};
use super::{Pipeline, Wishes};
use crate::error::Location;
use crate::ledger::{Class, Ledger, Stage};
use crate::scene::{self, Effect};
use crate::world::{Census, Feature as F, LightSampler};

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
    let event = |effect, feature| judge.event(effect, &[feature], 2);
    let again = |effect, feature| judge.event(effect, &[feature], 3);
    let look = |effect, feature| judge.event(effect, &[feature], 0);
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
        classed("diffuse", again(Effect::Diffuse, F::Diffuse), scatter, C::Diffuse),
        classed("glossy", again(Effect::Glossy, F::Glossy), scatter, C::Glossy),
        classed("mirror", event(Effect::Mirror, F::Mirror), scatter, C::Mirror),
        classed("refraction", judge.refraction(), scatter, C::Refraction),
        row("absorption", event(Effect::Absorption, F::Absorption), scatter, Charge::None),
        classed("caustics", judge.caustics(), scatter, C::Caustic),
        instead("textures", look(Effect::Textures, F::Texture), &[Stage::Textures]),
        instead("normal-maps", look(Effect::NormalMaps, F::NormalMap), &[Stage::Details]),
        row("cut-outs", look(Effect::CutOuts, F::CutOut), &[Stage::Intersect], Charge::CutOuts),
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
