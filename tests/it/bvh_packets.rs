//! Rays that stay together travel as packets: they hit what each hits alone, to the bit.

#![cfg(feature = "bvh")]

use crate::accel::sphere;
use glint::accel::bvh::Bvh;
use glint::accel::{Accelerator, AcceptAll, BuildOptions, HitFilter};
use glint::geometry::{Geometry, Hit, Ray};
use glint::math::Vec3;
use glint::sampling::{CounterRng, warp};
use std::sync::Arc;

/// Refuses a third of the triangles.
struct Thirds;

impl HitFilter for Thirds {
    fn accept(&self, _: &Ray, candidate: &Hit) -> bool {
        !candidate.id.primitive.is_multiple_of(3)
    }
}

/// A surface with coincident copies, one with holes, and one of small triangles about them.
fn bvh(is_compact: bool) -> Bvh {
    let meshes = vec![
        sphere(Vec3::ZERO, 1.0, 40, false),
        sphere(Vec3::ZERO, 1.0, 40, false),
        sphere(Vec3::new(0.3, 0.1, 0.0), 1.2, 25, true),
        sphere(Vec3::ZERO, 3.0, 200, false),
    ];
    let geometry = Arc::new(Geometry { meshes, ..Geometry::default() });
    let options = BuildOptions { is_compact, ..BuildOptions::default() };
    Bvh::with_options(geometry, &options).expect("it builds")
}

/// What cameras see from inside and outside, row by row; then shadow rays towards a light from there, with others among
/// them that go their own way.
fn rays(bvh: &Bvh) -> Vec<Ray> {
    let mut rng = CounterRng::new(0);
    let mut rays = Vec::new();
    for view in 0..24 {
        let from = warp::sphere([rng.unit(), rng.unit()]) * [0.0, 0.5, 1.1, 2.0, 8.0][view % 5];
        // Some look along an axis exactly.
        let axes = [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_X];
        let (x, y, z) = match view % 3 {
            0 => (axes[view % 4].any_orthonormal_vector(), Vec3::Y, axes[view % 4]),
            _ => {
                let z = warp::sphere([rng.unit(), rng.unit()]);
                let (x, y) = z.any_orthonormal_pair();
                (x, y, z)
            }
        };
        for i in 0..48 * 32 {
            let (u, v) = ((i % 48) as f32 / 48.0 - 0.5, (i / 48) as f32 / 32.0 - 0.5);
            let direction = z + (x * u + y * v) * [0.02, 0.5, 2.0][view % 3];
            let t_max = if i % 7 == 0 { 1.0 + rng.unit() } else { f32::INFINITY };
            rays.push(Ray { t_max, ..Ray::new(from, direction) });
        }
    }
    let mut hits = vec![Hit::MISS; rays.len()];
    bvh.closest(&rays, &AcceptAll, &mut hits);
    for hit in hits.iter().filter(|hit| hit.is_hit()) {
        let light = Vec3::new(0.5, 2.5, 0.2) + Vec3::splat(rng.unit() * 0.1);
        rays.push(match (rng.unit() * 40.0) as u32 {
            0 => Ray::new(hit.point, warp::sphere([rng.unit(), rng.unit()])),
            _ => Ray::between(hit.point + hit.normal * hit.offset, light),
        });
    }
    rays
}

fn check<F: HitFilter>(bvh: &Bvh, rays: &[Ray], filter: &F) {
    let mut alone = vec![Hit::MISS; rays.len()];
    for (ray, hit) in rays.iter().zip(&mut alone) {
        bvh.closest(std::slice::from_ref(ray), filter, std::slice::from_mut(hit));
    }
    assert!(alone.iter().filter(|hit| hit.is_hit()).count() > rays.len() / 2);
    // Whole batches, and such as end in the middle of a packet.
    for size in [rays.len(), 4096 + 1000, 333, 31] {
        for (rays, alone) in rays.chunks(size).zip(alone.chunks(size)) {
            let mut hits = vec![Hit::MISS; rays.len()];
            bvh.closest(rays, filter, &mut hits);
            assert_eq!(hits, alone, "{size}");
            let mut blocked = vec![false; rays.len()];
            bvh.occluded(rays, filter, &mut blocked);
            assert!(blocked.iter().zip(alone).all(|(&b, hit)| b == hit.is_hit()), "{size}");
        }
    }
}

#[test]
fn what_travels_together_hits_what_it_hits_alone() {
    let kept = bvh(false);
    let rays = rays(&kept);
    check(&kept, &rays, &AcceptAll);
    check(&kept, &rays, &Thirds);
    check(&bvh(true), &rays, &AcceptAll);
}
