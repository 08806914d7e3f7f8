//! Answers whose fault is known, before the judge.

use super::noisy::Noisy;
use super::{placed, soup, world};
use crate::accel::sphere;
use glint::accel::oracle::{Class, Judgement, Oracle};
use glint::accel::{AcceptAll, HitFilter};
use glint::geometry::{Geometry, Hit, NONE, PrimitiveId, Ray, TriangleMesh};
use glint::math::Vec3;
use glint::sampling::{CounterRng, warp};
use std::sync::Arc;

/// A unit of round-off: one ulp, as edge distances count.
const U: f32 = f32::EPSILON * 0.5;

fn triangle(primitive: u32) -> PrimitiveId {
    PrimitiveId { instance: NONE, geometry: 0, primitive }
}

fn judge(oracle: &Oracle, ray: &Ray, answer: PrimitiveId) -> Judgement {
    oracle.judge(ray, &AcceptAll, answer)
}

/// Two spheres, one in the other, and rays from inside both that pass no edge in the band.
fn spheres() -> (Arc<Geometry>, Oracle, Vec<Ray>) {
    let geometry =
        world(vec![sphere(Vec3::ZERO, 1.0, 12, false), sphere(Vec3::ZERO, 2.0, 12, false)]);
    let mut rng = CounterRng::new(0);
    let mut direction = || warp::sphere([rng.unit(), rng.unit()]);
    let rays = (0..500).map(|_| Ray::new(direction() * 0.3, direction())).collect();
    (geometry.clone(), Oracle::build(geometry), rays)
}

#[test]
fn every_plain_error_is_what_it_is_called() {
    let (_, oracle, rays) = spheres();
    let mut false_hits = 0;
    for (ray, i) in rays.iter().zip(0..) {
        let verdict = oracle.closest(ray, &AcceptAll);
        let [(right, _)] = verdict.nearest[..] else { panic!("a ray through an edge") };
        let right_one = judge(&oracle, ray, right);
        assert!(right_one.class == Class::Right && right_one.is_lawful());
        // What lies behind, found by taking the first one away.
        let behind = oracle.closest(&Ray { t_min: verdict.t[1] as f32 * 1.1, ..*ray }, &AcceptAll);
        let behind = behind.nearest[0].0;
        let elsewhere = PrimitiveId { primitive: (right.primitive + 7 + i % 100) % 288, ..right };
        // The line may meet that one before the ray begins.
        let wrong = judge(&oracle, ray, elsewhere);
        assert!(matches!(wrong.class, Class::FalseHit | Class::End) && !wrong.is_lawful());
        false_hits += usize::from(wrong.class == Class::FalseHit);
        for (answer, class) in [
            (PrimitiveId::MISS, Class::Missed),
            (behind, Class::WrongOrder),
            (PrimitiveId { primitive: 288, ..right }, Class::Refused),
            (PrimitiveId { geometry: 2, ..right }, Class::Refused),
            (PrimitiveId { instance: 0, ..right }, Class::Refused),
        ] {
            let judgement = judge(&oracle, ray, answer);
            assert_eq!(judgement.class, class, "{ray:?} {answer:?}");
            assert!(!judgement.is_lawful(), "{ray:?} {answer:?} {judgement:?}");
        }
        let missed = judge(&oracle, ray, PrimitiveId::MISS).overlooked.expect("it was");
        assert!(!missed.silhouette && [right, behind].contains(&missed.id));
        // Intervals that end before the first, or begin behind it.
        let t = verdict.t[0] as f32;
        let short = Ray { t_max: t * 0.9, ..*ray };
        assert!(judge(&oracle, &short, PrimitiveId::MISS).is_lawful());
        let late = Ray { t_min: t * 1.1, ..*ray };
        for ray in [short, late] {
            let judgement = judge(&oracle, &ray, right);
            assert!(judgement.class == Class::End && !judgement.is_lawful(), "{judgement:?}");
            assert!(judgement.ulps > 1e5);
        }
        assert_eq!(judge(&oracle, &late, behind).class, Class::Right);
    }
    assert!(false_hits > 450);
}

/// Refuses the inner of two spheres.
struct OuterOnly;

impl HitFilter for OuterOnly {
    fn accept(&self, _: &Ray, candidate: &Hit) -> bool {
        candidate.id.geometry == 1
    }
}

#[test]
fn filters_are_asked() {
    let (geometry, open, rays) = spheres();
    let meshes = geometry.meshes.iter().cloned().map(|m| TriangleMesh { filtered: true, ..m });
    let filtered = Oracle::build(world(meshes.collect()));
    for ray in &rays {
        let refused = open.closest(ray, &AcceptAll).nearest[0].0;
        // Where no mesh is marked as filtered, no filter is asked.
        assert_eq!(open.judge(ray, &OuterOnly, refused).class, Class::Right);
        assert_eq!(filtered.judge(ray, &OuterOnly, refused).class, Class::Refused);
        let seen = filtered.closest(ray, &OuterOnly).nearest;
        assert!(seen.iter().all(|(id, _)| id.geometry == 1) && !seen.is_empty());
        assert_eq!(filtered.judge(ray, &OuterOnly, seen[0].0).class, Class::Right);
    }
}

#[test]
fn equal_triangles_are_a_tie_and_the_smaller_id_goes_first() {
    let mesh = sphere(Vec3::ZERO, 1.0, 8, false);
    let oracle = Oracle::build(world(vec![mesh.clone(), mesh]));
    let ray = Ray::new(Vec3::new(0.1, 0.2, -5.0), Vec3::Z);
    let [(first, _), (second, _)] = oracle.closest(&ray, &AcceptAll).nearest[..] else {
        panic!("two are there")
    };
    assert!(judge(&oracle, &ray, first).is_lawful());
    let judgement = judge(&oracle, &ray, second);
    assert!(judgement.class == Class::Tie && !judgement.is_lawful());
    assert_eq!(judgement.overlooked.map(|o| o.id), Some(first));
}

/// Two planes whose distances along the ray round to the same `f32`, and two that do not.
#[test]
fn near_ties_are_measured() {
    let plane = |z: f32| [[-1e4, -1e4, z], [1e4, -1e4, z], [0.0, 1e4, z]];
    for (gap, class) in [(1.0 / 32.0, Class::NearTie), (1.0, Class::WrongOrder)] {
        for near_first in [true, false] {
            let planes = if near_first { [0.0, gap] } else { [gap, 0.0] };
            let oracle = Oracle::build(soup(planes.into_iter().flat_map(plane).collect()));
            // Ulps here are 1/16.
            let ray = Ray::new(Vec3::new(0.0, 0.0, -1_000_000.0), Vec3::Z);
            let near = triangle(u32::from(!near_first));
            let far = triangle(u32::from(near_first));
            assert_eq!(judge(&oracle, &ray, near).class, Class::Right);
            let judgement = judge(&oracle, &ray, far);
            assert_eq!((judgement.class, judgement.ulps), (class, f64::from(gap) * 16.0));
            // The farther one may be reported if it has the same distance and the smaller id.
            assert_eq!(judgement.is_lawful(), class == Class::NearTie && !near_first);
        }
    }
}

/// Two triangles that share an edge along y at x = 0, z = 0, and a ray that passes it at `x` along -z. Far to both sides
/// are more, so that the two are not in one box; and one of them has -0 for 0.
fn roof(x: f32, left: Option<Vec3>, right: Vec3) -> (Oracle, Ray) {
    (Oracle::build(soup(roof_corners(left, right))), towards_roof(x))
}

fn towards_roof(x: f32) -> Ray {
    Ray::new(Vec3::new(x, 0.0, 4.0), -Vec3::Z)
}

fn roof_corners(left: Option<Vec3>, right: Vec3) -> Vec<[f32; 3]> {
    let [a, b] = [Vec3::new(0.0, -4.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
    let mut corners = vec![a, right, b];
    let negative = |p: Vec3| Vec3::new(-p.x, p.y, -p.z);
    corners.extend(left.into_iter().flat_map(|left| [negative(a), negative(b), left]));
    for i in 0..40 {
        let far = Vec3::new(if i % 2 == 0 { 100.0 } else { -100.0 }, i as f32, 0.0);
        corners.extend([far, far + Vec3::X, far + Vec3::Y]);
    }
    corners.iter().map(|p| p.to_array()).collect()
}

const LEFT: Vec3 = Vec3::new(-3.0, 0.0, 0.0);
const RIGHT: Vec3 = Vec3::new(3.0, 0.0, 0.0);

#[test]
fn distances_from_edges_are_in_ulps() {
    // The edge's ends are at most 4 away on any axis: an ulp is 4 u.
    for ulps in [0.0, 0.5, 1.0, 5.5, 6.5, 100.0] {
        let x = ulps * 4.0 * U;
        // At the rim of a surface rounding decides; farther in or out nothing may.
        let (oracle, ray) = roof(x, None, RIGHT);
        let missed = judge(&oracle, &ray, PrimitiveId::MISS);
        let edge = missed.overlooked.expect("it is met");
        assert!((edge.edge.ulps - f64::from(ulps)).abs() < 1e-5 && edge.silhouette == (ulps < 6.0));
        assert_eq!((missed.class, missed.is_lawful()), (Class::Missed, ulps < 6.0));
        let (oracle, ray) = roof(-x, None, RIGHT);
        if ulps > 0.0 {
            let false_hit = judge(&oracle, &ray, triangle(0));
            let outside = false_hit.outside.expect("it passes by");
            assert!((outside.ulps - f64::from(ulps)).abs() < 1e-5, "{outside:?}");
            assert_eq!((false_hit.class, false_hit.is_lawful()), (Class::FalseHit, ulps < 6.0));
        }
        // Where the surface goes on, the neighbour will do, but a miss will not.
        let (oracle, ray) = roof(x, Some(LEFT), RIGHT);
        let neighbour = judge(&oracle, &ray, triangle(1));
        let expected = match ulps {
            0.0 => Class::Tie,
            ..6.0 => Class::Neighbour,
            _ => Class::FalseHit,
        };
        assert_eq!((neighbour.class, neighbour.is_lawful()), (expected, ulps < 6.0));
        let leak = judge(&oracle, &ray, PrimitiveId::MISS);
        assert!(leak.class == Class::Missed && !leak.is_lawful());
        assert!(!leak.overlooked.expect("both are met").silhouette);
        // Where it turns back, a miss will do again.
        let back = Vec3::new(3.0, 1.0, -2.0);
        let (oracle, ray) = roof(x, Some(back), RIGHT);
        let silhouette = judge(&oracle, &ray, PrimitiveId::MISS);
        assert_eq!(silhouette.is_lawful(), ulps < 6.0, "{silhouette:?}");
    }
}

/// Under an instance there are two more roundings of the direction, and those of the origin.
#[test]
fn bands_under_an_instance_are_wider() {
    for (ulps, in_band) in [(9.5, true), (10.5, false)] {
        let ray = towards_roof(ulps * 4.0 * U);
        let mesh = soup(roof_corners(None, RIGHT)).meshes[0].clone();
        let oracle = Oracle::build(Arc::new(placed(mesh, 1.0, 0.0)));
        let verdict = oracle.closest(&ray, &AcceptAll);
        let [(id, _)] = verdict.nearest[1..] else { panic!("the second one is where the mesh is") };
        assert_eq!(id.instance, 1);
        let edge = judge(&oracle, &ray, PrimitiveId::MISS).overlooked.expect("it is met").edge;
        assert!((edge.band - 10.0).abs() < 0.1 && edge.is_in_band() == in_band, "{edge:?}");
    }
}

/// Refuses the left half of a roof.
struct RightOnly;

impl HitFilter for RightOnly {
    fn accept(&self, _: &Ray, candidate: &Hit) -> bool {
        candidate.id.primitive != 1
    }
}

#[test]
fn what_a_filter_refuses_closes_no_surface() {
    let ray = towards_roof(4.0 * U);
    let mesh = soup(roof_corners(Some(LEFT), RIGHT)).meshes[0].clone();
    let oracle = Oracle::build(world(vec![TriangleMesh { filtered: true, ..mesh }]));
    assert!(!oracle.judge(&ray, &AcceptAll, PrimitiveId::MISS).is_lawful());
    assert!(oracle.judge(&ray, &RightOnly, PrimitiveId::MISS).is_lawful());
}

#[test]
fn one_excuse_does_not_excuse_another() {
    let mut corners = roof_corners(None, RIGHT);
    corners.extend([[-9.0, -9.0, -1.0], [9.0, -9.0, -1.0], [0.0, 9.0, -1.0]]);
    let wall = triangle(corners.len() as u32 / 3 - 1);
    let oracle = Oracle::build(soup(corners));
    let ray = towards_roof(4.0 * U);
    assert!(judge(&oracle, &ray, wall).is_lawful());
    let missed = judge(&oracle, &ray, PrimitiveId::MISS);
    assert!(!missed.is_lawful() && missed.overlooked.map(|o| o.id) == Some(wall));
}

#[test]
fn what_has_no_area_or_is_seen_edge_on_is_left_open() {
    let flat = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let edge_on = [[0.0, -1.0, 2.0], [0.0, 1.0, 2.0], [0.0, 0.0, 4.0]];
    let wall = [[-1.0, -1.0, 8.0], [1.0, -1.0, 8.0], [0.0, 1.0, 8.0]];
    let oracle = Oracle::build(soup([flat, edge_on, wall].concat()));
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let verdict = oracle.closest(&ray, &AcceptAll);
    assert_eq!(verdict.grazed, [triangle(0), triangle(1)]);
    assert_eq!(verdict.nearest[0].0, triangle(2));
    for grazed in verdict.grazed {
        let judgement = judge(&oracle, &ray, grazed);
        assert!(judgement.class == Class::Grazed && judgement.is_lawful());
    }
    let from_behind = oracle.closest(&Ray::new(Vec3::new(0.0, 0.0, 16.0), -Vec3::Z), &AcceptAll);
    assert!(from_behind.grazed.is_empty() && from_behind.nearest.len() == 1);
    let beside = Ray::new(Vec3::new(0.125, 0.125, 0.0), Vec3::Z);
    assert!(oracle.closest(&beside, &AcceptAll).grazed.is_empty());
    for passed in [0, 1] {
        let judgement = judge(&oracle, &beside, triangle(passed));
        assert!(judgement.class == Class::FalseHit && !judgement.is_lawful());
    }
}

#[test]
fn the_wrong_instance_is_a_false_hit() {
    let geometry = placed(sphere(Vec3::ZERO, 1.0, 8, false), 0.5, 3.0);
    assert_eq!(geometry.instances.len(), 2);
    let oracle = Oracle::build(Arc::new(geometry));
    let mut rng = CounterRng::new(0);
    for _ in 0..200 {
        // From the middle of the second one.
        let ray = Ray::new(Vec3::new(3.0, 0.0, 0.0), warp::sphere([rng.unit(), rng.unit()]));
        let right = oracle.closest(&ray, &AcceptAll).nearest[0].0;
        assert_eq!(right.instance, 1);
        let wrong = judge(&oracle, &ray, PrimitiveId { instance: 0, ..right });
        assert!(matches!(wrong.class, Class::FalseHit | Class::WrongOrder) && !wrong.is_lawful());
    }
}

/// A kernel that rounds each triangle's corners for itself, within the band, leaks at shared edges; one that rounds
/// shared corners alike does not, and one that rounds by more is found out at silhouettes.
#[test]
fn kernels_that_round_wrongly_are_found_out() {
    let mesh = sphere(Vec3::ZERO, 1.0, 12, false);
    let geometry = world(vec![mesh.clone()]);
    let oracle = Oracle::build(geometry.clone());
    let (mut rng, mut rays) = (CounterRng::new(0), Vec::new());
    let towards = |target: Vec3, rng: &mut CounterRng| {
        let origin = warp::sphere([rng.unit(), rng.unit()]) * 3.0 * rng.unit();
        Ray::new(origin, target - origin)
    };
    for i in 0..12_000 {
        let [a, b, _] = mesh.vertices(i % mesh.triangles.len() as u32);
        let target = if i % 3 == 0 { a } else { a + (b - a) * rng.unit() };
        // Some as near as `f32` comes, some up to 50 ulps away.
        let off = if i % 2 == 0 { 0.0 } else { 50.0 * U * rng.unit() };
        let off = warp::sphere([rng.unit(), rng.unit()]) * off;
        rays.push(towards(target + off, &mut rng));
    }
    let unlawful = |ulps: f64, shared: bool| {
        let kernel = Noisy { geometry: &geometry, ulps, shared };
        let judged = rays.iter().map(|ray| judge(&oracle, ray, kernel.closest(ray)));
        let unlawful: Vec<_> = judged.filter(|judgement| !judgement.is_lawful()).collect();
        let leaks = unlawful.iter().filter(|j| j.overlooked.is_some_and(|o| !o.silhouette));
        (unlawful.len(), leaks.count())
    };
    assert_eq!(unlawful(0.0, true), (0, 0));
    assert_eq!(unlawful(5.9, true), (0, 0));
    let (all, leaks) = unlawful(3.0, false);
    assert!(leaks > 100 && all == leaks, "{all} {leaks}");
    let (all, leaks) = unlawful(30.0, true);
    assert!(all > 100 && leaks < all, "{all} {leaks}");
}
