//! What the scene does not call for is not simulated, and nothing is lost: `auto` against `all` on every scene of the
//! repository, on both backends; and proof that each decision to spare something could have been caught.

#![cfg(feature = "embree")]

use crate::support::effort;
use crate::support::scene_files::{Backend, FileScene, Small, paths};
use crate::support::z_test::assert_difference;
use glint::accel::embree::EmbreeAccelerator;
use glint::film::{Film, Pixels};
use glint::ledger::Stage;
use glint::math::Vec3;
use glint::plan::{Pipeline, Plan};
use glint::render::Rendered;
use glint::sampling::Strategy;
use glint::scene::Projection;
use glint::world::Details;

const SMALL: Small = Small { size: [32, 18], spp: 4, seed: 0, strategy: Strategy::Sobol };

/// Whether `auto` samples other lights than `all` in this scene: it leaves a constant environment to scattering.
fn changes_estimator(scene: &FileScene) -> bool {
    let [auto, all] = ["auto", "all"].map(|effects| scene.plan(effects).1);
    let world = &scene.whole;
    let of = |plan: &Plan| plan.lights.at_infinity(world, Vec3::Y).map(|seen| seen.2).collect();
    let sees = |plan: &Plan| -> Vec<f32> { of(plan) };
    auto.pipeline.max_depth > 1 && sees(&auto) != sees(&all)
}

#[test]
fn auto_equals_all_bit_by_bit_in_every_scene_on_both_backends() {
    let mut bitwise = 0;
    for path in paths() {
        let scene = FileScene::load(&path);
        for &backend in Backend::ALL {
            let film = |effects: &str| {
                let (world, plan) = scene.plan(effects);
                scene.render(&world, &plan, backend, SMALL).film
            };
            let all = film("all");
            // Where the estimator is another one, everything else that is spared must still change nothing.
            let (world, plan) = scene.plan_with_all_lights();
            let spared = scene.render(&world, &plan, backend, SMALL).film;
            assert!(spared == all, "{} {backend:?}: something spared was needed", scene.name);
            if !changes_estimator(&scene) {
                assert!(film("auto") == all, "{} {backend:?}: auto is not all", scene.name);
                bitwise += 1;
            }
        }
    }
    assert!(bitwise >= 8, "{bitwise} comparisons");
}

/// Mean luminance of a film.
fn mean_luminance(film: &Film) -> f64 {
    let pixels = film.develop().radiance;
    pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / pixels.len() as f64
}

#[test]
fn auto_has_the_mean_of_all_where_it_samples_other_lights() {
    // A tenth of the light in the quick tier; a hundredth in the full one, and in the quick one for the scenes below.
    let (seeds, power) = match effort(0, 1) {
        0 => (48, 0.12),
        _ => (2000, 0.01),
    };
    let mut compared = 0;
    for path in paths() {
        let scene = FileScene::load(&path);
        if !changes_estimator(&scene) {
            continue;
        }
        compared += 1;
        // The same scattered rays: only what is done with the lights differs, so pairs tell more than two means.
        let means = ["auto", "all"].map(|effects| {
            let (world, plan) = scene.plan(effects);
            let embree = EmbreeAccelerator::build(world.geometry.clone(), 2).expect("it builds");
            let of = |seed| scene.render_on(&world, &plan, &embree, Small { seed, ..SMALL });
            (0..seeds).map(|seed| mean_luminance(&of(seed).film)).collect::<Vec<f64>>()
        });
        let pairs: Vec<[f64; 2]> = means[0].iter().zip(&means[1]).map(|(a, b)| [*a, *b]).collect();
        assert_difference(&scene.name, &pairs, power);
    }
    assert!(compared >= 5, "{compared} scenes");
}

#[test]
fn all_runs_every_stage_that_auto_spares() {
    for path in paths() {
        let scene = FileScene::load(&path);
        let rendered = |effects: &str| {
            let (world, plan) = scene.plan(effects);
            (scene.render(&world, &plan, Backend::Embree, SMALL), plan)
        };
        let (all, _) = rendered("all");
        let (auto, plan) = rendered("auto");
        for &stage in Stage::ALL {
            let calls = |rendered: &Rendered| rendered.ledger.stage(stage).calls;
            assert!(calls(&all) > 0, "{}: {} never ran", scene.name, stage.name());
            let runs = plan.pipeline.runs(stage);
            assert_eq!(calls(&auto) > 0, runs, "{}: {}", scene.name, stage.name());
        }
        if plan.pipeline.hit_filter {
            assert!(auto.ledger.cut_outs.calls > 0, "{}", scene.name);
        } else {
            assert_eq!(auto.ledger.cut_outs.calls, 0, "{}", scene.name);
        }
        assert!(all.ledger.cut_outs.calls > 0, "{}", scene.name);
    }
}

/// A decision that was wrongly made, as a change to a plan.
type Mutation = (&'static str, fn(&mut Pipeline));

const MUTATIONS: [Mutation; 13] = [
    ("bounces", |p| (p.max_depth, p.bounded) = (1, true)),
    ("bounces after the first", |p| (p.max_depth, p.bounded) = (2, true)),
    ("lens", |p| p.lens = false),
    ("hit filter", |p| p.hit_filter = false),
    ("details", |p| p.details = Details::Nowhere),
    ("emission", |p| p.emission = false),
    ("environment", |p| p.environment = false),
    ("light sampling", |p| p.light_sampling = false),
    ("choice of lights", |p| p.light_choice = false),
    ("shadows", |p| p.shadows = false),
    ("combination", |p| p.combination = false),
    ("absorption", |p| p.absorption = false),
    ("roulette", |p| p.roulette = false),
];

/// The mutated run: each decision, forced the wrong way, changes the picture of a scene in which `auto` makes it the
/// right way, so that the comparison above would have failed.
#[test]
fn every_wrong_decision_would_have_been_seen() {
    let mut unseen: Vec<Mutation> = MUTATIONS.to_vec();
    for path in paths() {
        let scene = FileScene::load(&path);
        let (world, plan) = scene.plan_with_all_lights();
        let embree = EmbreeAccelerator::build(world.geometry.clone(), 2).expect("it builds");
        let small = Small { size: [16, 9], spp: 4, seed: 0, strategy: Strategy::Sobol };
        let right = scene.render_on(&world, &plan, &embree, small).film;
        unseen.retain(|(_, mutate)| {
            let mut wrong = plan.clone();
            mutate(&mut wrong.pipeline);
            scene.render_on(&world, &wrong, &embree, small).film == right
        });
    }
    let names: Vec<&str> = unseen.iter().map(|mutation| mutation.0).collect();
    assert!(names.is_empty(), "no scene notices without {names:?}");
}

#[test]
fn stages_add_up_to_the_time_of_the_workers() {
    for path in paths().iter().filter(|path| path.ends_with("cornell.toml")) {
        let scene = FileScene::load(path);
        let (world, plan) = scene.plan("auto");
        let small = Small { size: [128, 128], spp: 8, seed: 0, strategy: Strategy::Sobol };
        let ledger = scene.render(&world, &plan, Backend::Embree, small).ledger;
        let covered = ledger.seconds() / ledger.worker_seconds;
        assert!((0.95..=1.0).contains(&covered), "{covered} of the time is in stages");
    }
}

/// The scene file of this name.
fn scene(name: &str) -> FileScene {
    let path = paths().into_iter().find(|path| path.ends_with(name)).expect("a scene");
    FileScene::load(&path)
}

#[test]
fn looks_that_are_left_out_are_gone_whatever_else_runs() {
    let room = scene("room.toml");
    let rendered = |effects: &str| {
        let (world, plan) = room.plan(effects);
        room.render(&world, &plan, Backend::Embree, SMALL)
    };
    let whole = rendered("auto");
    for (left_out, stages, asks_filters) in [
        ("no-textures", &[Stage::Textures][..], true),
        ("no-normal-maps", &[], true),
        ("no-textures,no-normal-maps", &[Stage::Textures, Stage::Details], true),
        ("no-cut-outs", &[], false),
    ] {
        let auto = rendered(&format!("auto,{left_out}"));
        assert!(auto.film != whole.film, "{left_out} changes nothing");
        assert!(auto.film == rendered(&format!("all,{left_out}")).film, "{left_out}: auto, all");
        for &stage in stages {
            // What looks nothing up any more is not told apart any more.
            let items = auto.ledger.stage(stage).items;
            let before = whole.ledger.stage(stage).items;
            assert!(items < before, "{left_out}: {items} of {before} in {}", stage.name());
        }
        assert_eq!(auto.ledger.cut_outs.calls > 0, asks_filters, "{left_out}");
    }
    // Mean colours keep the light roughly as it was.
    let ratio = mean_luminance(&rendered("no-textures").film) / mean_luminance(&whole.film);
    assert!((0.7..1.4).contains(&ratio), "{ratio} of the light without textures");
}

#[test]
fn without_depth_of_field_the_lens_is_a_pinhole() {
    let mut chess = scene("chess.toml");
    let without = |scene: &FileScene, effects: &str| {
        let (world, plan) = scene.plan(effects);
        scene.render(&world, &plan, Backend::Embree, SMALL).film
    };
    let (lens, left_out) = (without(&chess, "auto"), without(&chess, "no-depth-of-field"));
    assert!(lens != left_out);
    let Projection::ThinLens { vertical_fov, .. } = chess.cameras[0].projection else {
        panic!("the camera of the chess board has a lens");
    };
    chess.cameras[0].projection = Projection::Perspective { vertical_fov };
    let (pinhole, left_out) = (without(&chess, "auto").develop(), left_out.develop());
    // The same rays but for their last bits, which a later bounce may notice: most pixels are as good as equal, and
    // with the lens hardly any is.
    let differing = |other: &Pixels| {
        let pairs = pinhole.radiance.iter().zip(&other.radiance);
        pairs
            .filter(|(a, b)| (**a - **b).map(f32::abs).max_channel() > 0.01 * a.max_channel())
            .count()
    };
    let (few, many) = (differing(&left_out), differing(&lens.develop()));
    assert!(few * 10 < pinhole.radiance.len(), "{few} pixels differ");
    assert!(many * 2 > pinhole.radiance.len(), "{many} pixels differ with the lens");
}
