//! The in-house BVH on geometry that is out to break it: piles, needles, powers of ten, nothing at all.

#![cfg(feature = "bvh")]

use crate::accel::sphere;
use glint::accel::bvh::{Bvh, Steps};
use glint::accel::{Accelerator, AcceptAll, BruteForce, BuildOptions, Quality};
use glint::geometry::{Geometry, Hit, Instance, Object, Ray, TriangleMesh};
use glint::math::{Affine, DAffine3, DMat3, DVec3, Vec3};
use glint::os::Isa;
use glint::sampling::{CounterRng, warp};
use std::sync::Arc;

fn geometry(positions: Vec<[f32; 3]>) -> Arc<Geometry> {
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let mesh = TriangleMesh::new(positions, triangles.collect(), false);
    Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() })
}

fn closest<A: Accelerator>(accelerator: &A, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    accelerator.closest(rays, &AcceptAll, &mut hits);
    hits
}

/// Rays from around the middle of `scale`-sized things.
fn rays(scale: f32, n: u32) -> Vec<Ray> {
    let mut rng = CounterRng::new(0);
    let mut two = move || [rng.unit(), rng.unit()];
    let mut ray = || Ray::new(warp::sphere(two()) * (scale * two()[0]), warp::sphere(two()));
    (0..n).map(|_| ray()).collect()
}

#[test]
fn nothing_is_hit_where_there_is_nothing() {
    let bvh = Bvh::build(Arc::new(Geometry::default()), 1).expect("it builds");
    assert!(!closest(&bvh, &[Ray::new(Vec3::ZERO, Vec3::X)])[0].is_hit());
}

/// A quarter of a million copies of one triangle: no plane tells them apart. Ties go to the smallest id.
#[test]
fn a_pile_of_equal_triangles_is_no_trouble() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let pile = geometry(corners.iter().copied().cycle().take(3 * 250_000).collect());
    let bvh = Bvh::build(pile, 2).expect("it builds");
    let hit = closest(&bvh, &[Ray::new(Vec3::new(0.2, 0.3, 2.0), -Vec3::Z)])[0];
    assert_eq!(hit.id.primitive, 0);
}

/// Triangles whose sizes and places run through 60 powers of ten: each split takes off few of them.
#[test]
fn powers_of_ten_are_found_at_every_scale() {
    let mut positions = Vec::new();
    for i in 0..6000 {
        let s = 10.0_f32.powf((i as f32 - 3000.0) / 200.0);
        positions.extend([[s, -s, -s], [s, s, -s], [s, 0.0, s]]);
    }
    let geometry = geometry(positions);
    let bvh = Bvh::build(geometry.clone(), 2).expect("it builds");
    let brute = BruteForce::new(geometry);
    let mut rng = CounterRng::new(0);
    let rays: Vec<Ray> = (0..300)
        .map(|i| {
            let s = 10.0_f32.powf((i as f32 - 150.0) / 10.0);
            let tilt = Vec3::new(0.0, rng.unit() - 0.5, rng.unit() - 0.5) * 0.2;
            Ray::new(Vec3::X * s, Vec3::X + tilt)
        })
        .collect();
    let (ours, truth) = (closest(&bvh, &rays), closest(&brute, &rays));
    assert!(truth.iter().filter(|hit| hit.is_hit()).count() > 250);
    assert_eq!(ours, truth);
}

/// From inside a closed sphere no ray escapes: not through edges, not through vertices, not along an axis.
#[test]
fn closed_surfaces_do_not_leak() {
    for (center, radius) in
        [(Vec3::ZERO, 1.0), (Vec3::new(1e4, -3e4, 2e4), 1.0), (Vec3::ZERO, 1e-6), (Vec3::ZERO, 1e6)]
    {
        let mesh = sphere(center, radius, 16, false);
        let corners: Vec<Vec3> = mesh.positions.iter().map(|p| Vec3::from_array(*p)).collect();
        let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edges: Vec<_> = edges.map(|e| e.map(|i| corners[i as usize])).collect();
        let geometry = Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() });
        let bvh = Bvh::build(geometry, 2).expect("it builds");
        let mut rng = CounterRng::new(0);
        let mut rays = Vec::new();
        for origin in (0..40).map(|_| warp::sphere([rng.unit(), rng.unit()]) * (0.5 * radius)) {
            let origin = origin + center;
            rays.extend(corners.iter().map(|&corner| Ray::new(origin, corner - origin)));
            rays.extend(edges.iter().map(|&[a, b]| Ray::new(origin, (a + b) * 0.5 - origin)));
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            rays.extend(axes.iter().flat_map(|&d| [Ray::new(origin, d), Ray::new(origin, -d)]));
        }
        rays.retain(|ray| ray.direction != Vec3::ZERO);
        let escaped = closest(&bvh, &rays).iter().filter(|hit| !hit.is_hit()).count();
        assert_eq!(escaped, 0, "of {} rays, radius {radius} around {center}", rays.len());
    }
}

#[test]
fn the_number_of_threads_changes_no_hit_and_no_byte() {
    let mesh = sphere(Vec3::ZERO, 1.0, 100, false);
    let geometry = Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() });
    let [one, many] = [1, 4].map(|n| Bvh::build(geometry.clone(), n).expect("it builds"));
    assert_eq!(one.build_stats().bytes, many.build_stats().bytes);
    assert_eq!(one.validate().expect("a whole tree"), many.validate().expect("a whole tree"));
    let rays = rays(1.5, 10_000);
    assert_eq!(closest(&one, &rays), closest(&many, &rays));
}

/// Whatever instructions compute it, whatever flies beside it, a ray hits the same; and is blocked if it hits.
#[test]
fn the_instruction_set_changes_no_hit() {
    let object = Object { meshes: vec![sphere(Vec3::Z, 0.5, 30, false)] };
    let place = |x: f64| {
        let map = DAffine3 {
            matrix3: DMat3::from_cols(DVec3::Y * 2.0, DVec3::Z, DVec3::X * 0.7),
            translation: DVec3::new(x, 0.3, -0.2),
        };
        Instance::new(0, Affine::from_f64(&map))
    };
    let geometry = Arc::new(Geometry {
        meshes: vec![sphere(Vec3::ZERO, 1.0, 40, false), sphere(Vec3::ONE, 1.0, 40, false)],
        objects: vec![object],
        instances: (0..40).map(|i| place(f64::from(i) * 0.3 - 6.0)).collect(),
    });
    let bvh = Bvh::build(geometry.clone(), 2).expect("it builds");
    let rays = rays(3.0, 20_000);
    let single: Vec<_> = rays.iter().map(|&ray| closest(&bvh, &[ray])[0]).collect();
    assert!(single.iter().filter(|hit| hit.is_hit()).count() > 5000);
    // Nor does how the tree was built, or how leaves are kept.
    let qualities = Quality::ALL.map(|(_, quality)| (quality, false));
    for (quality, is_compact) in qualities.into_iter().chain([(Quality::Default, true)]) {
        let options = BuildOptions { threads: 2, quality, is_compact };
        let bvh = Bvh::with_options(geometry.clone(), &options).expect("it builds");
        bvh.validate().expect("a whole tree");
        for (name, isa) in Isa::ALL {
            isa.limit();
            assert_eq!(closest(&bvh, &rays), single, "{name}, {options:?}");
            let mut blocked = vec![false; rays.len()];
            bvh.occluded(&rays, &AcceptAll, &mut blocked);
            assert!(blocked.iter().zip(&single).all(|(&b, hit)| b == hit.is_hit()), "{name}");
        }
    }
}

/// What a build says of its tree is what is found in it; compact leaves take half of the memory.
#[test]
fn statistics_are_those_of_the_tree() {
    let mesh = sphere(Vec3::ZERO, 1.0, 200, false);
    let triangles = mesh.triangles.len();
    let geometry = Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() });
    let bytes = [false, true].map(|is_compact| {
        let options = BuildOptions { is_compact, ..BuildOptions::default() };
        let bvh = Bvh::with_options(geometry.clone(), &options).expect("it builds");
        let (stats, walked) = (bvh.build_stats(), bvh.validate().expect("a whole tree"));
        let (told, found) = (stats.shape.expect("it is told"), walked.shape);
        assert_eq!((told.nodes, told.leaves, told.depth), (found.nodes, found.leaves, found.depth));
        assert!(told.sah_cost <= found.sah_cost && found.sah_cost < 1.2 * told.sah_cost);
        assert_eq!(walked.triangles, triangles);
        walked.bytes_per_triangle
    });
    assert!(bytes[0] < 32.0 && bytes[1] < 0.6 * bytes[0], "{bytes:?}");
}

/// Rays that are none miss, and do not hang.
#[test]
fn what_is_no_ray_hits_nothing() {
    let geometry = Arc::new(Geometry {
        meshes: vec![sphere(Vec3::ZERO, 1.0, 10, false)],
        ..Geometry::default()
    });
    let bvh = Bvh::build(geometry, 1).expect("it builds");
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let mut rays = vec![Ray::new(Vec3::ZERO, Vec3::ZERO)];
    for bad in [nan, inf, -inf] {
        rays.push(Ray::new(Vec3::new(bad, 0.0, 0.0), Vec3::X));
        rays.push(Ray::new(Vec3::ZERO, Vec3::new(0.0, bad, 1.0)));
    }
    let from_to = |t_min, t_max| Ray { t_min, t_max, ..Ray::new(Vec3::ZERO, Vec3::X) };
    rays.extend([from_to(2.0, 0.0), from_to(0.0, nan), from_to(nan, inf), from_to(0.0, 0.0)]);
    assert!(closest(&bvh, &rays).iter().all(|hit| !hit.is_hit()));
    assert!(closest(&bvh, &[from_to(0.0, inf), from_to(-0.0, 1e30)]).iter().all(Hit::is_hit));
}

/// Steps are counted: a ray that misses everything opens the root, and what is hit was in a leaf.
#[test]
fn steps_are_those_that_rays_take() {
    let mesh = sphere(Vec3::ZERO, 1.0, 100, false);
    let geometry = Arc::new(Geometry { meshes: vec![mesh], ..Geometry::default() });
    let bvh = Bvh::build(geometry, 1).expect("it builds");
    let away: Vec<_> = (0..100).map(|i| Ray::new(Vec3::X * (2.0 + i as f32), Vec3::X)).collect();
    let missed = bvh.steps(&away, &AcceptAll, false);
    assert_eq!(missed, Steps { nodes: 100, ..Steps::default() });
    // From inside of it every ray hits.
    let rays = rays(0.1, 1000);
    let [closest, any] = [false, true].map(|any| bvh.steps(&rays, &AcceptAll, any));
    for steps in [closest, any] {
        // Down to a triangle, which takes at least depth minus one nodes; all but the root were a child that was met.
        assert!(steps.nodes > 2 * 1000 && steps.nodes + steps.leaves <= steps.children + 1000);
        assert!(steps.leaves >= steps.distances && steps.distances >= 1000);
    }
    assert!(closest.prunes >= 1000 && any.prunes == 0);
    // Of one ray after the other they are the same, and their sum.
    let mut sum = Steps::default();
    for ray in &rays {
        let one = bvh.steps(std::slice::from_ref(ray), &AcceptAll, false);
        sum.nodes += one.nodes;
        sum.leaves += one.leaves;
    }
    assert_eq!((sum.nodes, sum.leaves), (closest.nodes, closest.leaves));
}
