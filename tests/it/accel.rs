//! Backends against brute force, ray by ray, on scenes with instances and filters.

use glint::accel::HitFilter;
use glint::accel::{Accelerator, AcceptAll, BruteForce};
use glint::geometry::{Geometry, Hit, Instance, NONE, Object, PrimitiveId, Ray, TriangleMesh};
use glint::math::{Affine, DAffine3, DMat3, DVec3, Vec3};
use glint::sampling::{CounterRng, warp};
use std::sync::Arc;

/// A closed sphere of `2 n^2` triangles with `radius` around `center`.
pub(crate) fn sphere(center: Vec3, radius: f32, n: u32, filtered: bool) -> TriangleMesh {
    let mut positions = Vec::new();
    for i in 0..=n {
        for j in 0..n {
            let z = (std::f64::consts::PI * f64::from(i) / f64::from(n)).cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            let phi = 2.0 * std::f64::consts::PI * f64::from(j) / f64::from(n);
            let p = DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3() * radius + center;
            positions.push(p.to_array());
        }
    }
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (k, a, b) = ((j + 1) % n, i * n, (i + 1) * n);
            triangles.push([a + j, b + j, b + k]);
            triangles.push([a + j, b + k, a + k]);
        }
    }
    TriangleMesh::new(positions, triangles, filtered)
}

fn scene() -> Arc<Geometry> {
    let turn = DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z);
    let place = |linear: DMat3, x: f64| {
        let map = DAffine3 { matrix3: linear, translation: DVec3::new(x, 0.3, -0.2) };
        Instance::new(0, Affine::from_f64(&map))
    };
    Arc::new(Geometry {
        meshes: vec![
            sphere(Vec3::ZERO, 1.0, 16, false),
            sphere(Vec3::new(0.5, 0.5, 0.5), 0.8, 12, true),
        ],
        objects: vec![Object { meshes: vec![sphere(Vec3::Z, 0.5, 8, false)] }],
        instances: vec![
            place(turn * 0.7, 2.0),
            place(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 0.5)), -2.0),
        ],
    })
}

/// Keeps the odd triangles, and depends on the ray too.
struct OddOnly;

impl HitFilter for OddOnly {
    fn accept(&self, ray: &Ray, candidate: &Hit) -> bool {
        (candidate.id.primitive + ray.id) % 2 == 1
    }
}

fn random_rays(n: u32) -> Vec<Ray> {
    let mut rng = CounterRng::new(0);
    (0..n)
        .map(|id| {
            let mut two = || [rng.unit(), rng.unit()];
            let origin = warp::sphere(two()) * 4.0 * two()[0];
            let target = warp::sphere(two()) * 1.5 * two()[0];
            let mut ray = Ray::new(origin, target - origin);
            if id % 5 == 0 {
                ray.t_max = two()[0];
            }
            Ray { id, ..ray }
        })
        .collect()
}

/// Compares a backend with brute force; returns (hits, rays that miss by a silhouette's rounding).
fn compare<A: Accelerator, F: HitFilter>(
    backend: &A,
    brute: &BruteForce,
    filter: &F,
) -> (u32, u32) {
    let rays = random_rays(20_000);
    let mut ours = vec![Hit::MISS; rays.len()];
    let mut truth = ours.clone();
    let mut blocked = vec![false; rays.len()];
    backend.closest(&rays, filter, &mut ours);
    brute.closest(&rays, filter, &mut truth);
    backend.occluded(&rays, filter, &mut blocked);
    let (mut hits, mut differ) = (0, 0);
    for i in 0..rays.len() {
        hits += u32::from(truth[i].is_hit());
        // Where the primitive agrees, every bit must.
        if ours[i].id == truth[i].id {
            assert_eq!(ours[i], truth[i]);
            assert_eq!(blocked[i], ours[i].is_hit(), "any hit differs from closest hit, ray {i}");
        } else {
            differ += 1;
        }
    }
    (hits, differ)
}

/// What every backend must do.
macro_rules! every_backend {
    ($name:ident, $feature:literal, $Backend:ty) => {
        #[cfg(feature = $feature)]
        mod $name {
            use super::*;

            #[test]
            fn agrees_with_brute_force() {
                let geometry = scene();
                let backend = <$Backend>::build(geometry.clone(), 2).expect("it builds");
                let brute = BruteForce::new(geometry);
                // At edges and silhouettes f32 kernels may round to a neighbour: at most 1 ray in 2000.
                let (hits, differ) = compare(&backend, &brute, &AcceptAll);
                assert!(hits > 8_000 && differ <= 10, "{hits} hits, {differ} differ");
                let (hits, differ) = compare(&backend, &brute, &OddOnly);
                assert!(hits > 8_000 && differ <= 10, "{hits} hits, {differ} differ");
            }

            #[test]
            fn a_batch_equals_its_rays_one_by_one() {
                let backend = <$Backend>::build(scene(), 1).expect("it builds");
                let rays = random_rays(1000);
                let mut batch = vec![Hit::MISS; rays.len()];
                backend.closest(&rays, &OddOnly, &mut batch);
                for (ray, expected) in rays.iter().zip(batch) {
                    let mut hit = [Hit::MISS];
                    backend.closest(std::slice::from_ref(ray), &OddOnly, &mut hit);
                    assert_eq!(hit[0], expected);
                }
            }

            #[test]
            fn a_singular_instance_is_never_hit() {
                let singular = Geometry {
                    objects: vec![Object { meshes: vec![sphere(Vec3::ZERO, 1.0, 4, false)] }],
                    instances: vec![Instance::new(0, Affine { columns: [[f32::NAN; 3]; 4] })],
                    ..Geometry::default()
                };
                let backend = <$Backend>::build(Arc::new(singular), 1).expect("it builds");
                let mut hit = [Hit::MISS];
                backend.closest(&[Ray::new(Vec3::ZERO, Vec3::Z)], &AcceptAll, &mut hit);
                assert!(!hit[0].is_hit());
            }

            /// Rays that leave a surface along its own offset never find it again: spheres of any size, anywhere.
            #[test]
            fn offset_rays_do_not_meet_the_triangle_they_leave() {
                for (scale, shift) in
                    [(1.0_f32, 0.0_f32), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e4), (1e-3, 1e3)]
                {
                    let center = Vec3::new(shift, -0.7 * shift, 0.3 * shift);
                    let geometry = Arc::new(Geometry {
                        meshes: vec![sphere(center, scale, 24, false)],
                        ..Geometry::default()
                    });
                    let backend = <$Backend>::build(geometry.clone(), 1).expect("it builds");
                    let mut rng = CounterRng::new(1);
                    let mut self_hits = 0;
                    for _ in 0..20_000 {
                        let mut two = || [rng.unit(), rng.unit()];
                        let inward = Ray::new(center, warp::sphere(two()));
                        let mut hit = [Hit::MISS];
                        backend.closest(&[inward], &AcceptAll, &mut hit);
                        let hit = hit[0];
                        assert!(hit.is_hit(), "a ray from the middle of a closed sphere escaped");
                        let ([a, b, c], _) = geometry.world_vertices(hit.id);
                        let point =
                            (a + (b - a) * f64::from(hit.u) + (c - a) * f64::from(hit.v)).as_vec3();
                        let mut normal = (b - a).cross(c - a).normalize().as_vec3();
                        if normal.dot(inward.direction) > 0.0 {
                            normal = -normal;
                        }
                        let mut direction = warp::sphere(two());
                        if direction.dot(normal) < 0.0 {
                            direction = -direction;
                        }
                        let mut next = [Hit::MISS];
                        let ray = Ray::new(point + normal * hit.offset, direction);
                        backend.closest(&[ray], &AcceptAll, &mut next);
                        self_hits += u32::from(next[0].id == hit.id);
                    }
                    assert_eq!(self_hits, 0, "scale {scale} shift {shift}");
                }
            }
        }
    };
}

every_backend!(embree, "embree", glint::accel::embree::EmbreeAccelerator);
every_backend!(bvh, "bvh", glint::accel::bvh::Bvh);

#[cfg(feature = "embree")]
mod embree_alone {
    use super::*;
    use glint::accel::embree::EmbreeAccelerator;

    #[test]
    fn buffers_are_shared_and_outlive_every_other_owner() {
        let geometry = scene();
        let positions = geometry.meshes[0].positions.clone();
        let backend = EmbreeAccelerator::build(geometry, 1).expect("embree builds");
        // Ours and the accelerator's: no copy was made, and none was dropped.
        assert_eq!(positions.owners(), 2);
        drop(positions);
        let mut hit = [Hit::MISS];
        backend.closest(&[Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::Z)], &AcceptAll, &mut hit);
        assert!(hit[0].is_hit());
    }

    #[test]
    fn reports_version_and_memory() {
        let backend = EmbreeAccelerator::build(scene(), 1).expect("embree builds");
        assert!(backend.version().starts_with(['3', '4']), "{}", backend.version());
        assert!(backend.build_stats().bytes > 10_000);
    }
}

#[test]
fn brute_force_prefers_the_smallest_id_on_ties() {
    let mesh = sphere(Vec3::ZERO, 1.0, 4, false);
    let geometry = Geometry { meshes: vec![mesh.clone(), mesh], ..Geometry::default() };
    let mut hit = [Hit::MISS];
    let ray = Ray::new(Vec3::new(0.1, 0.2, 5.0), -Vec3::Z);
    BruteForce::new(Arc::new(geometry)).closest(&[ray], &AcceptAll, &mut hit);
    assert_eq!((hit[0].id.instance, hit[0].id.geometry), (NONE, 0));
    assert_ne!(hit[0].id, PrimitiveId::MISS);
}
