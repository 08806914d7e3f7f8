//! Every list of effects, short paths and hidden surroundings: what a scene does not call for is spared there, too, and
//! the table and the bill say the same.

#![cfg(feature = "embree")]

use crate::support::effort;
use crate::support::scene_files::{FileScene, Small, paths, with_lights_of};
use glint::accel::embree::EmbreeAccelerator;
use glint::ledger::Class;
use glint::plan::{Plan, Wishes};
use glint::render::{Bill, Rendered};
use glint::sampling::Strategy;
use glint::scene::{Effect, Effects};

const SMALL: Small = Small { size: [16, 9], spp: 2, seed: 0, strategy: Strategy::Sobol };

/// Each effect taken out, and some that take out several.
fn lists() -> Vec<String> {
    let without = Effect::ALL.iter().map(|effect| format!("no-{}", effect.name()));
    let more = [
        "no-emission,no-scatter-sampling",
        "no-light-sampling,no-scatter-sampling",
        "no-light-sampling,no-shadows",
        "no-direct,no-diffuse,no-glossy,no-mirror,no-refraction,no-caustics",
        "no-environment,no-shadows,no-mirror",
        "no-diffuse,no-glossy",
    ];
    without.chain(more.map(String::from)).collect()
}

/// What is asked for, with `style` (`auto` or `all`) in place of the first word.
fn wishes(style: &str, list: &str, max_depth: u32, hide_background: bool) -> Wishes {
    let text = if list.is_empty() { style.into() } else { format!("{style},{list}") };
    Wishes { effects: text.parse::<Effects>().expect("effects"), max_depth, hide_background }
}

/// (list, longest path, hidden surroundings).
fn cases() -> Vec<(String, u32, bool)> {
    let mut cases: Vec<_> = lists().into_iter().map(|list| (list, u32::MAX, false)).collect();
    for depth in [1, 2, 3] {
        for list in ["", "no-shadows", "no-light-sampling"] {
            cases.push((list.into(), depth, depth == 2));
        }
    }
    cases.push((String::new(), u32::MAX, true));
    cases
}

/// The classes of which a plan says that they have no light.
fn classes_off(plan: &Plan) -> Vec<Class> {
    let of = |effect: &str| match effect {
        "direct light of points" => Some(Class::DirectPoint),
        "direct light of suns" => Some(Class::DirectSun),
        "direct light of surfaces" => Some(Class::DirectSurface),
        "direct light around" => Some(Class::DirectEnvironment),
        "diffuse" => Some(Class::Diffuse),
        "glossy" => Some(Class::Glossy),
        "mirror" => Some(Class::Mirror),
        "refraction" => Some(Class::Refraction),
        "caustics" => Some(Class::Caustic),
        _ => None,
    };
    plan.rows.iter().filter(|row| !row.on).filter_map(|row| of(row.effect)).collect()
}

/// Where what the table says and what the bill says differ.
fn contradictions(plan: &Plan, rendered: &Rendered) -> Vec<String> {
    let bill = Bill::new(rendered);
    let mut found = Vec::new();
    for class in classes_off(plan) {
        for row in bill.classes.iter().filter(|row| row.class == class.name()) {
            if row.energy_share != 0.0 || row.rays != 0 {
                found.push(format!("off, but {row:?}"));
            }
        }
    }
    let ledger = &rendered.ledger;
    let rays: u64 = bill.classes.iter().map(|row| row.rays).sum();
    if rays != ledger.rays() {
        found.push(format!("{rays} rays of {}", ledger.rays()));
    }
    let seconds: f64 = bill.classes.iter().map(|row| row.seconds).sum();
    let is_all_owned = ledger.light_samples() > 0 || !plan.pipeline.light_sampling;
    if is_all_owned && (seconds - ledger.seconds()).abs() > 1e-9 {
        found.push(format!("{seconds} s of {}", ledger.seconds()));
    }
    found
}

#[test]
fn auto_equals_all_with_the_same_list() {
    let mut off = 0;
    // The quick tier takes every fourth scene.
    let small = paths().into_iter().filter(|path| path.to_string_lossy().contains("effects"));
    for path in &small.step_by(effort(4, 1)).collect::<Vec<_>>() {
        let scene = FileScene::load(path);
        for (list, depth, hidden) in cases() {
            let case = format!("{} {list:?} --max-depth {depth}, hidden: {hidden}", scene.name);
            let (world, auto) = scene.plan_for(&wishes("auto", &list, depth, hidden));
            let (whole, all) = scene.plan_for(&wishes("all", &list, depth, hidden));
            let embree = EmbreeAccelerator::build(whole.geometry.clone(), 2).expect("it builds");
            let reference = scene.render_on(&whole, &all, &embree, SMALL);
            let embree = EmbreeAccelerator::build(world.geometry.clone(), 2).expect("it builds");
            let rendered = scene.render_on(&world, &auto, &embree, SMALL);
            assert_eq!(contradictions(&auto, &rendered), Vec::<String>::new(), "{case}");
            off += classes_off(&auto).len();
            let same_lights = with_lights_of(auto.clone(), all);
            let film = match same_lights.lights == auto.lights {
                true => rendered.film,
                false => scene.render_on(&world, &same_lights, &embree, SMALL).film,
            };
            assert!(film == reference.film, "{case}: something spared was needed");
        }
    }
    assert!(off > effort(500, 2000), "only {off} classes are off");
}
