//! `glint bench`: its rays, what becomes of a backend that lies, and the command.

#[cfg(feature = "bvh")]
use glint::accel::bvh::Bvh as Backend;
#[cfg(not(feature = "bvh"))]
use glint::accel::embree::EmbreeAccelerator as Backend;
use glint::accel::{Accelerator, AcceptAll, BuildOptions, BuildStats, HitFilter};
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Hit, PrimitiveId, Ray};
use glint::load::load_scene;
use glint::math::DVec3;
use glint::os::Isa;
use glint::scene::{Camera, Projection};
use glint::study::bench::{
    Contestant, Findings, InHouse, Law, RayKind, RaySet, RaySource, Role, Sample, Settings, contest,
};
use glint::world::World;
use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Duration;

fn world(kind: Kind, triangles: u64) -> World {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    let mut file = std::fs::File::create(&path).unwrap();
    write_obj(&Model { kind, triangles, seed: 0 }, "model.mtl", &mut file, &mut |_| Ok(()))
        .unwrap();
    World::compile(load_scene(&path).unwrap()).unwrap()
}

/// Two views from above, one twice as close.
fn cameras(world: &World) -> [Camera; 2] {
    let (to, radius) = (world.bounds.center().as_dvec3(), world.bounds.bounding_radius());
    [2.0, 1.0].map(|far| Camera {
        name: "test".into(),
        location: None,
        from: world.origin + to + DVec3::new(0.3, 0.8, 0.5) * f64::from(far * radius),
        to: world.origin + to,
        up: DVec3::Y,
        projection: Projection::Perspective { vertical_fov: 35.0 },
    })
}

fn ray_sets(world: &World, backend: &Backend, count: usize) -> Vec<RaySet> {
    let closest = |rays: &[Ray]| {
        let mut hits = vec![Hit::MISS; rays.len()];
        backend.closest(rays, &AcceptAll, &mut hits);
        hits
    };
    let source = RaySource { world, cameras: &cameras(world), closest: &closest };
    source.generate(&RayKind::ALL.map(|(_, kind)| kind), count).expect("cameras")
}

#[test]
fn rays_follow_from_the_scene_and_are_what_their_kind_says() {
    let world = world(Kind::Foliage, 20_000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    // Neither a multiple of tiles nor of packets.
    let sets = ray_sets(&world, &backend, 3001);
    assert!(sets == ray_sets(&world, &backend, 3001), "the same rays twice");
    // How far the rays of neighbours go apart: the mean cosine.
    let coherence = |set: &RaySet| {
        let pairs = set.rays.windows(2);
        let cosine =
            |pair: &[Ray]| pair[0].direction.normalize().dot(pair[1].direction.normalize());
        pairs.map(cosine).sum::<f32>() / (set.rays.len() - 1) as f32
    };
    let radius = world.bounds.bounding_radius();
    for set in &sets {
        let name = set.kind.name();
        assert_eq!(set.rays.len(), 3001, "{name}");
        for (ray, id) in set.rays.iter().zip(0..) {
            assert!(ray.origin.is_finite() && ray.t_min == 0.0 && ray.id == id, "{name}: {ray:?}");
            let length = ray.direction.length();
            let is_unit = (length - 1.0).abs() < 1e-5;
            match set.kind {
                RayKind::Shadow => assert!(length.is_finite() && ray.t_max < 1.0, "{ray:?}"),
                RayKind::AmbientOcclusion => assert!(is_unit && ray.t_max == 0.2 * radius),
                _ => assert!(is_unit && ray.t_max == f32::INFINITY, "{name}: {ray:?}"),
            }
            if set.kind != RayKind::Primary {
                let outside =
                    (ray.origin - world.bounds.center()).abs() - 0.5 * world.bounds.extent();
                assert!(outside.max_element() < 1e-3 * radius, "{name}: {ray:?}");
            }
        }
        let coherence = coherence(set);
        match set.kind {
            RayKind::Primary => assert!(coherence > 0.99, "{coherence}"),
            RayKind::DeepBounce | RayKind::Random => assert!(coherence.abs() < 0.1, "{coherence}"),
            _ => {}
        }
    }
    // No two kinds share their numbers.
    assert!(sets[1].rays.iter().zip(&sets[4].rays).all(|(a, b)| a.direction != b.direction));
}

#[test]
fn a_scene_without_room_for_some_kind_has_none_of_it() {
    // The cameras look away: nothing to bounce off.
    let world = world(Kind::Sphereflake, 5000);
    let away = cameras(&world).map(|c| Camera { to: c.from + c.from - c.to, ..c });
    let miss = |rays: &[Ray]| vec![Hit::MISS; rays.len()];
    let source = RaySource { world: &world, cameras: &away, closest: &miss };
    let sets = source.generate(&RayKind::ALL.map(|(_, kind)| kind), 100).expect("cameras");
    let counts: Vec<_> = sets.iter().map(|set| set.rays.len()).collect();
    assert_eq!(counts, [100, 0, 0, 0, 0, 100]);
}

/// A backend that loses every hit on some primitives, or puts another in their place.
struct Liar<'a> {
    backend: &'a Backend,
    lie: fn(PrimitiveId) -> Option<PrimitiveId>,
    /// How often it is honest before.
    honest_calls: AtomicUsize,
}

impl Accelerator for Liar<'_> {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        self.backend.closest(rays, filter, hits);
        let one_less = |calls: usize| calls.checked_sub(1);
        if self.honest_calls.fetch_update(Relaxed, Relaxed, one_less).is_ok() {
            return;
        }
        for hit in hits.iter_mut().filter(|hit| hit.is_hit()) {
            *hit = (self.lie)(hit.id).map_or(Hit::MISS, |id| Hit { id, ..*hit });
        }
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        let mut hits = vec![Hit::MISS; rays.len()];
        self.closest(rays, filter, &mut hits);
        blocked.iter_mut().zip(&hits).for_each(|(blocked, hit)| *blocked = hit.is_hit());
    }

    fn build_stats(&self) -> BuildStats {
        self.backend.build_stats()
    }
}

fn contestant<'a, A: Accelerator>(accelerator: &'a A, name: &str, law: Law) -> Contestant<'a> {
    Contestant {
        backend: "bvh",
        variant: name.into(),
        isa: Isa::detect(),
        law,
        role: Role::Challenger,
        tracer: Box::new(InHouse { accelerator, slice: 100 }),
    }
}

fn settings(threads: &[usize]) -> Settings {
    Settings {
        rays: 0,
        kinds: Vec::new(),
        threads: threads.to_vec(),
        isa: Isa::detect(),
        repetitions: Some(2),
        time: Duration::from_secs(1),
        all_calls: false,
        build: BuildOptions::default(),
    }
}

fn race(world: &World, sets: &[RaySet], contestants: &[Contestant<'_>]) -> Findings {
    contest("test", &world.geometry, sets, contestants, &settings(&[1, 2]), &|_, _| ())
}

#[test]
fn who_lies_gets_no_time_and_is_found_out() {
    let world = world(Kind::Foliage, 20_000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    let sets = ray_sets(&world, &backend, 5000);
    let liar = |lie, honest_calls: usize| Liar {
        backend: &backend,
        lie,
        honest_calls: honest_calls.into(),
    };
    let loses = liar(|id| (id.primitive % 5 != 0).then_some(id), 0);
    let swap = |id: PrimitiveId| {
        let primitive = id.primitive ^ u32::from(id.primitive == 77);
        Some(PrimitiveId { primitive, ..id })
    };
    let swaps = liar(swap, 0);
    let contestants = [
        contestant(&backend, "honest", Law::Exact),
        contestant(&loses, "loses", Law::Exact),
        contestant(&loses, "loses a lot, officially", Law::Approximate),
        contestant(&swaps, "swaps", Law::Exact),
    ];
    let findings = race(&world, &sets, &contestants);
    // Every kind on one thread and on two.
    assert_eq!(findings.runs.len(), 6 * 2 * contestants.len());
    for run in &findings.runs {
        let agreement = &run.agreement;
        assert_eq!(agreement.compared, 5000);
        match run.variant.as_str() {
            "honest" => {
                let speed = run.rays_per_second.expect("it was right");
                assert!(0.0 < speed.min && speed.min <= speed.median && speed.median <= speed.max);
                assert_eq!((agreement.differing(), agreement.unexplained), (0, 0));
            }
            "swaps" => {
                let hits = agreement.different + agreement.near + agreement.ties;
                assert_eq!(agreement.differing(), hits);
                assert_eq!(run.rays_per_second.is_none(), agreement.unexplained > 0);
            }
            _ => {
                // A surface behind may have been met instead, if any.
                let lost = agreement.missed + agreement.different;
                assert!(lost > 20 && agreement.unexplained > 20, "{}: {agreement:?}", run.ray_kind);
                assert_eq!(run.rays_per_second, None, "{}", run.ray_kind);
            }
        }
    }
    let swapped = findings.runs.iter().filter(|run| run.variant == "swaps");
    assert!(swapped.filter(|run| run.rays_per_second.is_none()).count() > 0);
    // Nobody is compared with a liar, nor a liar with anybody. (There is no rival here at all.)
    assert!(findings.ratios.is_empty() && findings.heats.is_empty());
    // The oracle had much to judge, and nothing against what all agree on.
    let agreed: Vec<_> = findings.scene.rays.iter().map(|count| count.agreed).collect();
    assert!(agreed.iter().all(|agreed| agreed.judged > 500 && agreed.wrong == 0), "{agreed:?}");
    let samples: usize = agreed.iter().map(|agreed| agreed.judged).sum();
    assert!(findings.scene.oracle.judged > samples + 6000, "{:?}", findings.scene.oracle);
}

#[test]
fn who_is_wrong_together_is_found_out_by_the_oracle() {
    let world = world(Kind::City, 5000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    let sets = ray_sets(&world, &backend, 3000);
    let lie = |id: PrimitiveId| (!id.primitive.is_multiple_of(5)).then_some(id);
    let loses = Liar { backend: &backend, lie, honest_calls: 0.into() };
    let contestants = ["a", "b"].map(|name| contestant(&loses, name, Law::Exact));
    let steps = RefCell::new(Vec::new());
    let tell = |step, _| steps.borrow_mut().push(step);
    let findings = contest("test", &world.geometry, &sets, &contestants, &settings(&[1]), &tell);
    assert!(findings.runs.iter().all(|run| run.agreement.differing() == 0));
    assert!(findings.runs.iter().all(|run| run.rays_per_second.is_none()));
    for count in &findings.scene.rays {
        let Sample { judged, wrong } = count.agreed;
        assert_eq!(judged, 1000);
        // A fifth of what is hit, except where the surface behind does as well: never.
        let expected = 0.2 * 1000.0 * count.hits as f64 / (0.8 * count.rays as f64);
        let low = (0.3 * expected) as usize;
        assert!(wrong > low.max(10), "{}: {wrong} of about {expected}", count.ray_kind);
    }
    // One oracle for all of it, built in a step of its own before the race.
    let mut steps = steps.into_inner();
    steps.dedup();
    let first = |name| steps.iter().position(|step| *step == name).expect("a step");
    assert!(first("building the oracle") < first("racing"));
    assert_eq!(steps.iter().filter(|step| **step == "building the oracle").count(), 1);
    assert_eq!(findings.scene.oracle.judged, 6000);
}

/// The reference agrees with itself; whoever is right finds it out.
#[test]
fn a_reference_that_lies_is_found_out_by_the_others() {
    let world = world(Kind::City, 5000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    let sets = ray_sets(&world, &backend, 3000);
    let lie = |id: PrimitiveId| (!id.primitive.is_multiple_of(5)).then_some(id);
    let loses = Liar { backend: &backend, lie, honest_calls: 0.into() };
    let baseline =
        Contestant { role: Role::Baseline, ..contestant(&loses, "loses", Law::Approximate) };
    let contestants = [baseline, contestant(&backend, "honest", Law::Exact)];
    for run in race(&world, &sets, &contestants).runs {
        let agreement = run.agreement;
        if run.variant == "loses" {
            assert!(agreement.unexplained > 20, "{}: {agreement:?}", run.ray_kind);
            assert_eq!(run.rays_per_second, None);
        } else {
            assert!(agreement.reference_wrong > 20 && agreement.unexplained == 0, "{agreement:?}");
            assert!(run.rays_per_second.is_some());
        }
    }
}

#[test]
fn who_is_right_when_it_is_checked_and_lies_when_it_is_timed_is_found_out() {
    let world = world(Kind::Foliage, 5000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    let sets = ray_sets(&world, &backend, 1000);
    // The check takes 20 calls, 10 of them to warm up; here those of the last two repetitions go wrong.
    let later = Liar { backend: &backend, lie: |_| None, honest_calls: 60.into() };
    let contestants =
        [contestant(&backend, "honest", Law::Exact), contestant(&later, "later", Law::Approximate)];
    let findings = race(&world, &sets[..1], &contestants);
    for run in findings.runs {
        let agreement = run.agreement;
        assert_eq!((agreement.compared, agreement.differing()), (1000, 0), "{}", run.variant);
        let is_honest = run.variant == "honest";
        assert_eq!(agreement.unsteady_turns == 0, is_honest);
        assert_eq!(run.rays_per_second.is_some(), is_honest);
    }
}

#[test]
fn rivals_are_compared_in_the_same_repetitions() {
    let world = world(Kind::City, 5000);
    let backend = Backend::build(world.geometry.clone(), 1).expect("it builds");
    let sets = ray_sets(&world, &backend, 2000);
    let with_role = |name, role| Contestant { role, ..contestant(&backend, name, Law::Exact) };
    let contestants = [
        with_role("ours", Role::Challenger),
        with_role("as usual", Role::Baseline),
        with_role("a", Role::Heat),
        with_role("b", Role::Heat),
        with_role("c", Role::Heat),
    ];
    let findings = race(&world, &sets[..1], &contestants);
    // Two of three qualify, and race on both numbers of threads.
    assert_eq!(findings.heats.len(), 3);
    assert!(findings.heats.iter().all(|heat| heat.rays_per_second.is_some()));
    assert_eq!(findings.heats.iter().filter(|heat| heat.qualified).count(), 2);
    assert_eq!(findings.runs.len(), 4 * 2);
    let against: Vec<_> = findings.ratios.iter().map(|r| (r.threads, r.against)).collect();
    assert_eq!(against, [(1, "baseline"), (1, "best"), (2, "baseline"), (2, "best")]);
    for comparison in &findings.ratios {
        let ratio = comparison.ratio;
        assert!(0.0 < ratio.low && ratio.low <= ratio.median && ratio.median <= ratio.high);
        assert_eq!(comparison.variant, "ours");
    }
    assert_eq!(findings.scene.repetitions, 2);
}

/// Every variant and call of Embree's gives Embree's own answers, whatever the number of rays.
#[cfg(feature = "embree")]
#[test]
fn every_call_of_embrees_gives_the_answers_of_single_rays() {
    use glint::accel::embree::{BareEmbree, EmbreeAccelerator, EmbreeCall, EmbreeVariant};
    use glint::study::bench::Query;
    let world = world(Kind::Foliage, 20_000);
    let embree = EmbreeAccelerator::build(world.geometry.clone(), 1).expect("it builds");
    let sets =
        ray_sets(&world, &Backend::build(world.geometry.clone(), 1).expect("it builds"), 999);
    for (name, variant) in EmbreeVariant::ALL {
        let bare = BareEmbree::build(world.geometry.clone(), 1, variant, Isa::detect());
        let bare = bare.expect("it builds");
        assert!(bare.build_stats().bytes > 100_000, "{name}");
        let calls = EmbreeCall::for_several().into_iter().chain([EmbreeCall::Single]);
        for call in calls {
            for set in &sets {
                let mut hits = vec![Hit::MISS; set.rays.len()];
                embree.closest(&set.rays, &AcceptAll, &mut hits);
                let query = set.kind.query();
                let mut rays = match query {
                    Query::Closest => bare.closest(call),
                    Query::AnyHit => bare.occluded(call).expect("there are no instances"),
                };
                // Twice, the second time over the first.
                for count in [999, 500] {
                    rays.load(&set.rays[..count]);
                    rays.trace();
                    let answers = rays.read();
                    assert_eq!(answers.len(), count);
                    let same = answers.iter().zip(&hits).filter(|((hit, id), expected)| {
                        *hit == expected.is_hit() && (query == Query::AnyHit || *id == expected.id)
                    });
                    let (same, place) = (same.count(), (name, call.name(), set.kind.name()));
                    assert!(same >= count - 1, "{place:?}: {same} of {count}");
                }
            }
        }
    }
}

#[cfg(feature = "embree")]
mod program;
