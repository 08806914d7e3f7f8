//! What is met first, against whole numbers and every triangle: small whole numbers (where everything is a tie), all
//! magnitudes, near misses, instances.

use super::school;
use super::{placed, soup};
use glint::accel::AcceptAll;
use glint::accel::oracle::{Oracle, Place};
use glint::geometry::{Geometry, PrimitiveId, Ray, TriangleMesh};
use glint::math::Vec3;
use glint::sampling::CounterRng;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Draws of numbers that are out to break arithmetic.
struct Hostile(CounterRng);

impl Hostile {
    fn below(&mut self, n: u32) -> u32 {
        (self.0.unit() * n as f32) as u32
    }

    /// -2, -1, 0, 1 or 2.
    fn small(&mut self) -> f32 {
        self.below(5) as f32 - 2.0
    }

    /// A small whole number, or one so near that it is barely another.
    fn near_small(&mut self) -> f32 {
        let off = match self.below(16) {
            0 => 2.0 * f32::EPSILON,
            1 => -2.0 * f32::EPSILON,
            _ => 0.0,
        };
        self.small() + off
    }

    /// Any magnitude from 1e-38 to 1e38, or a subnormal number.
    fn any(&mut self) -> f32 {
        let exponent = self.below(255);
        f32::from_bits(self.below(2) << 31 | exponent << 23 | self.below(1 << 23))
    }

    fn point(&mut self, number: impl Fn(&mut Self) -> f32) -> Vec3 {
        Vec3::new(number(self), number(self), number(self))
    }
}

/// Compares all that a verdict says; returns how often each place was met, and ties.
fn compare(geometry: &Arc<Geometry>, rays: &[Ray]) -> BTreeMap<String, usize> {
    let oracle = Oracle::build(geometry.clone());
    let mut seen = BTreeMap::<String, usize>::new();
    for ray in rays.iter().filter(|ray| ray.direction != Vec3::ZERO) {
        let verdict = oracle.closest(ray, &AcceptAll);
        let truth = school::closest(geometry, ray);
        let sorted = |mut met: Vec<(PrimitiveId, Place)>| {
            met.sort_by_key(|met| met.0);
            met
        };
        assert_eq!(verdict.nearest, sorted(truth.nearest), "{ray:?}");
        assert!(verdict.grazed.iter().all(|id| truth.grazed.contains(id)), "{ray:?}");
        if let Some(t) = truth.t {
            let [low, high] = verdict.t;
            assert!(t.cmp_f64(low).is_ge(), "{ray:?}");
            assert!(high == f64::INFINITY || t.cmp_f64(high).is_le(), "{ray:?}");
        }
        for (_, place) in &verdict.nearest {
            *seen.entry(format!("{place:?}")).or_default() += 1;
        }
        *seen.entry("ties".into()).or_default() += usize::from(verdict.nearest.len() > 1);
        *seen.entry("misses".into()).or_default() += usize::from(verdict.nearest.is_empty());
        *seen.entry("grazed".into()).or_default() += verdict.grazed.len();
    }
    seen
}

fn all_seen(seen: &BTreeMap<String, usize>, kinds: &[&str]) -> bool {
    kinds.iter().all(|&kind| seen.get(kind).is_some_and(|&n| n >= 5))
}

/// Triangles and rays whose coordinates are drawn by `number`, the rays with ends of their own.
fn case(seed: u64, number: impl Fn(&mut Hostile) -> f32 + Copy) -> (Arc<Geometry>, Vec<Ray>) {
    let mut hostile = Hostile(CounterRng::new(seed));
    let positions = (0..3 * 60).map(|_| hostile.point(number).to_array()).collect();
    let mut ray = |_| Ray {
        t_min: if hostile.below(2) == 0 { 0.0 } else { number(&mut hostile).abs() },
        t_max: if hostile.below(2) == 0 { f32::INFINITY } else { number(&mut hostile).abs() },
        ..Ray::new(hostile.point(number), hostile.point(number))
    };
    (soup(positions), (0..500).map(&mut ray).collect())
}

const EVERYTHING: [&str; 6] = ["Inside", "Edge", "Vertex", "ties", "misses", "grazed"];

#[test]
fn small_whole_numbers_where_everything_is_a_tie() {
    let (geometry, rays) = case(0, Hostile::small);
    let seen = compare(&geometry, &rays);
    assert!(all_seen(&seen, &EVERYTHING), "{seen:?}");
}

#[test]
fn neighbours_of_small_whole_numbers() {
    let (geometry, rays) = case(1, Hostile::near_small);
    let seen = compare(&geometry, &rays);
    assert!(all_seen(&seen, &EVERYTHING), "{seen:?}");
}

/// A triangle that lies across an axis, so that its box has no thickness, and rays exactly through its corners along
/// whole numbers whose reciprocals are rounded: a box test that trusts them leaves some out.
#[test]
fn corners_of_flat_boxes() {
    let mut hostile = Hostile(CounterRng::new(7));
    let mut whole = |n: u32| hostile.below(2 * n + 1) as f32 - n as f32;
    let mut corners_met = 0;
    for i in 0..200 {
        let mut corners = [0; 3].map(|_| [0; 3].map(|_| whole(7)));
        let across = corners[0][i % 3];
        corners.iter_mut().for_each(|corner| corner[i % 3] = across);
        let rays = (0..6).map(|k| {
            let direction = Vec3::new(whole(200), whole(200), whole(200));
            Ray::new(Vec3::from_array(corners[k % 3]) - direction * (k + 1) as f32, direction)
        });
        let rays: Vec<_> = rays.collect();
        corners_met += compare(&soup(corners.to_vec()), &rays).get("Vertex").copied().unwrap_or(0);
    }
    assert!(corners_met > 800, "{corners_met}");
}

#[test]
fn every_magnitude_of_f32() {
    let (geometry, rays) = case(2, Hostile::any);
    let seen = compare(&geometry, &rays);
    assert!(all_seen(&seen, &["Inside", "misses"]), "{seen:?}");
    // Magnitudes of a factor each, so that they meet: thin triangles across the axes of the rays.
    let mut hostile = Hostile(CounterRng::new(3));
    let scales: Vec<f32> = (0..60).map(|i| 2.0_f32.powi(4 * i - 120)).collect();
    let corners = scales.iter().flat_map(|&s| [[s, -s, -s], [s, s, -s], [s, 0.0, s]]);
    let mut rays = Vec::new();
    for _ in 0..500 {
        let (s, d) = (scales[hostile.below(60) as usize], scales[hostile.below(60) as usize]);
        let towards = Vec3::new(1.0, hostile.near_small() * 0.125, hostile.near_small() * 0.125);
        rays.push(Ray::new(Vec3::new(s, 0.0, 0.0), towards * d));
    }
    let seen = compare(&soup(corners.collect()), &rays);
    assert!(all_seen(&seen, &["Inside"]), "{seen:?}");
}

#[test]
fn instances_are_where_world_vertices_says() {
    let (own, rays) = case(4, Hostile::small);
    for (scale, shift) in [(1.0, 0.0), (0.7, 0.3), (1e-3, 1e3), (1e25, -1e20), (1e-25, 1e-30)] {
        let mut geometry = placed(own.meshes[0].clone(), scale, shift);
        geometry.meshes = vec![TriangleMesh::new(
            vec![[2.0, 1.0, 0.5], [-2.0, 1.0, 0.0], [0.0, -2.0, 0.1]],
            vec![[0, 1, 2]],
            false,
        )];
        let geometry = Arc::new(geometry);
        // Towards what is there, at its own scale.
        let mut hostile = Hostile(CounterRng::new(5));
        let ids = school::ids(&geometry);
        let mut aimed = rays[..100].to_vec();
        for ray in &mut aimed {
            let [a, b, _] = geometry.world_vertices(ids[hostile.below(60) as usize]).0;
            ray.origin =
                (b * 3.0 - a * 2.0).as_vec3() + hostile.point(Hostile::small) * scale as f32;
            ray.direction = ((a + b) * 0.5).as_vec3() - ray.origin;
            (ray.t_min, ray.t_max) = (0.0, f32::INFINITY);
        }
        let seen = compare(&geometry, &[&aimed[..], &rays[..100]].concat());
        assert!(seen.get("Inside").is_some_and(|&n| n > 20), "{scale} {shift}: {seen:?}");
    }
}

/// The same triangles with their corners in another order, and everything larger by powers of two.
#[test]
fn neither_the_order_of_corners_nor_powers_of_two_matter() {
    let (geometry, rays) = case(6, Hostile::near_small);
    let mesh = &geometry.meshes[0];
    let oracle = Oracle::build(geometry.clone());
    let truth: Vec<_> = rays.iter().map(|ray| oracle.closest(ray, &AcceptAll)).collect();
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let triangles = mesh.triangles.iter().map(|t| order.map(|k| t[k])).collect();
        let turned = TriangleMesh::new(mesh.positions.to_vec(), triangles, false);
        let turned = Oracle::build(super::world(vec![turned]));
        for (ray, truth) in rays.iter().zip(&truth) {
            let verdict = turned.closest(ray, &AcceptAll);
            assert_eq!((&verdict.nearest, &verdict.grazed), (&truth.nearest, &truth.grazed));
        }
    }
    for (larger, faster) in
        [(1.0, 2.0_f32.powi(90)), (2.0_f32.powi(100), 0.25), (2.0_f32.powi(-90), 1.0)]
    {
        let positions = mesh.positions.iter().map(|p| p.map(|x| x * larger)).collect();
        let scaled = TriangleMesh::new(positions, mesh.triangles.to_vec(), false);
        let scaled = Oracle::build(super::world(vec![scaled]));
        for (ray, truth) in rays.iter().zip(&truth) {
            let Ray { t_min, t_max, .. } = *ray;
            let ray = Ray::new(ray.origin * larger, ray.direction * faster);
            let factor = larger / faster;
            let verdict = scaled
                .closest(&Ray { t_min: t_min * factor, t_max: t_max * factor, ..ray }, &AcceptAll);
            assert_eq!((&verdict.nearest, &verdict.grazed), (&truth.nearest, &truth.grazed));
            assert_eq!(verdict.t, truth.t.map(|t| t * f64::from(factor)));
        }
    }
}

/// All corners of a fan and of a grid are met where they are, by as many triangles as share them.
#[test]
fn shared_edges_and_corners_are_met_by_all_that_share_them() {
    let n = 6;
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let mut positions = Vec::new();
    for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
        positions.push([i as f32, j as f32, ((i * 5 + j * 3) % 4) as f32]);
    }
    let mut triangles = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    let oracle = Oracle::build(super::world(vec![TriangleMesh::new(positions, triangles, false)]));
    for (x, y, count, place) in [
        (3.0, 3.0, 6, Place::Vertex),
        (0.0, 3.0, 3, Place::Vertex),
        (0.0, 0.0, 2, Place::Vertex),
        (6.0, 0.0, 1, Place::Vertex),
        (3.5, 3.5, 2, Place::Edge),
        (3.5, 3.0, 2, Place::Edge),
        (3.5, 0.0, 1, Place::Edge),
        (3.5, 3.25, 1, Place::Inside),
    ] {
        for z in [10.0, -10.0] {
            let ray = Ray::new(Vec3::new(x, y, z), Vec3::new(0.0, 0.0, -z));
            let met = oracle.closest(&ray, &AcceptAll).nearest;
            assert_eq!(met.len(), count, "{x} {y}");
            assert!(met.iter().all(|(_, p)| *p == place), "{x} {y}: {met:?}");
        }
    }
}

/// Many coincident triangles, and needles of every size: no recursion to overflow, no pairs to try.
#[test]
fn piles_are_no_trouble() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let pile = Oracle::build(soup(corners.iter().copied().cycle().take(3 * 20_000).collect()));
    let ray = Ray::new(Vec3::new(0.25, 0.25, 2.0), -Vec3::Z);
    let verdict = pile.closest(&ray, &AcceptAll);
    assert_eq!(verdict.nearest.len(), 20_000);
    assert!(pile.judge(&ray, &AcceptAll, verdict.nearest[7].0).overlooked.is_some());
    assert!(verdict.t[0] <= 2.0 && verdict.t[1] >= 2.0);
    let nothing = Oracle::build(Arc::new(Geometry::default()));
    assert!(nothing.closest(&ray, &AcceptAll).nearest.is_empty());
    let odd = Oracle::build(soup(vec![[f32::NAN; 3], [0.0; 3], [1.0; 3]]));
    assert!(odd.closest(&ray, &AcceptAll).nearest.is_empty());
}
