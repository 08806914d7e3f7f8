//! Two backends, one picture: equal byte for byte in every pixel none of whose rays hit a different primitive.
//!
//! A witness renders every pixel by itself with the hits of one backend, and asks the other one about every ray. A pixel
//! that differs without a ray that does would refute the claim.

#![cfg(all(feature = "embree", feature = "bvh"))]

use crate::support::scenes::{Builder, cornell, cornell_shot, zoo, zoo_shot};
use crate::support::shot::Shot;
use glint::accel::bvh::Bvh;
use glint::accel::embree::EmbreeAccelerator;
use glint::accel::{Accelerator, BuildStats, HitFilter};
use glint::film::Region;
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Hit, Ray};
use glint::load::load_scene;
use glint::math::{DVec3, Rgb};
use glint::world::World;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Answers with the hits of one backend, and remembers whether the other one has ever met a different primitive.
struct Witness<'a, A, B> {
    told: &'a A,
    asked: &'a B,
    has_seen: AtomicBool,
}

impl<A: Accelerator, B: Accelerator> Accelerator for Witness<'_, A, B> {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        self.told.closest(rays, filter, hits);
        let mut others = vec![Hit::MISS; rays.len()];
        self.asked.closest(rays, filter, &mut others);
        let differ = hits.iter().zip(&others).any(|(hit, other)| hit.id != other.id);
        self.has_seen.fetch_or(differ, Relaxed);
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        self.told.occluded(rays, filter, blocked);
        let mut others = vec![false; rays.len()];
        self.asked.occluded(rays, filter, &mut others);
        self.has_seen.fetch_or(*blocked != *others, Relaxed);
    }

    fn build_stats(&self) -> BuildStats {
        self.told.build_stats()
    }
}

/// What two backends make of a shot.
struct Comparison {
    pixels: usize,
    /// Whose bytes differ.
    differing: Vec<[u32; 2]>,
    /// With a ray that hits a different primitive.
    witnessed: Vec<[u32; 2]>,
}

impl Comparison {
    fn of<A: Accelerator, B: Accelerator>(world: &World, shot: &Shot, told: &A, asked: &B) -> Self {
        let picture = shot.render_on(world, told).film.develop();
        let other = shot.render_on(world, asked).film.develop();
        let is_witnessed = |&[x, y]: &[u32; 2]| {
            let region = Region { start: [x, y], end: [x + 1, y + 1] };
            let alone = Shot { region: Some(region), batch: 16, threads: 1, ..shot.clone() };
            let witness = Witness { told, asked, has_seen: false.into() };
            let pixel = alone.render_on(world, &witness).film.develop();
            // Its rays are those of the picture.
            assert_eq!(pixel.radiance[0], picture.radiance[picture.region.index([x, y])]);
            witness.has_seen.into_inner()
        };
        Self {
            pixels: picture.region.pixels(),
            differing: picture.differing(&other),
            witnessed: picture.region.iter().filter(is_witnessed).collect(),
        }
    }

    /// Pixels that differ though all their rays hit the same primitives.
    fn unexplained(&self) -> usize {
        self.differing.iter().filter(|pixel| !self.witnessed.contains(pixel)).count()
    }
}

/// A red square and a green one an ulp behind it: which of them is nearer, Embree's distances in `f32` cannot tell.
fn an_ulp_apart() -> (World, Shot) {
    let mut b = Builder::default();
    let (red, green) = (b.lambert(0.8, 0.1, 0.1), b.lambert(0.1, 0.8, 0.1));
    for (z, material) in [(0.0, red), (f32::EPSILON, green)] {
        b.quad([-1.0, -1.0, z], [2.0, 0.0, 0.3], [0.0, 2.0, 0.4], material);
    }
    b.environment(Rgb::WHITE);
    (b.build(), Shot::new([0.9, 2.4, 9.0], [0.0, 0.0, 0.35], 30.0, [24, 24], 4))
}

fn generated(kind: Kind) -> (World, Shot) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    let mut file = std::fs::File::create(&path).unwrap();
    let model = Model { kind, triangles: 30_000, seed: 0 };
    write_obj(&model, "model.mtl", &mut file, &mut |_| Ok(())).unwrap();
    let world = World::compile(load_scene(&path).unwrap()).unwrap();
    let to = world.origin + world.bounds.center().as_dvec3();
    let far = 2.0 * f64::from(world.bounds.bounding_radius());
    let from = to + DVec3::new(0.3, 0.8, 0.5) * far;
    let shot = Shot::new(from.to_array(), to.to_array(), 35.0, [48, 36], 16);
    (world, shot)
}

/// Embree and the in-house BVH.
fn backends(world: &World) -> (EmbreeAccelerator, Bvh) {
    let embree = EmbreeAccelerator::build(world.geometry.clone(), 2).expect("it builds");
    (embree, Bvh::build(world.geometry.clone(), 2).expect("it builds"))
}

/// In ordinary scenes rays along edges are rare, too.
#[test]
fn pixels_whose_rays_hit_the_same_primitives_are_equal_byte_for_byte() {
    for (name, (world, shot)) in [
        ("cornell", (cornell().build(), cornell_shot([48, 48], 16))),
        ("zoo", (zoo().build(), zoo_shot([48, 36], 16))),
        ("hairball", generated(Kind::Hairball)),
        ("terrain", generated(Kind::Terrain)),
    ] {
        let (embree, bvh) = backends(&world);
        let found = Comparison::of(&world, &shot, &embree, &bvh);
        assert_eq!(found.unexplained(), 0, "{name}: {:?}", found.differing);
        let (differing, all) = (found.differing.len(), found.pixels);
        assert!(1000 * differing <= 2 * all, "{name}: {differing} of {all} pixels differ");
    }
}

/// Where backends do differ, with each of them in the lead.
#[test]
fn every_pixel_that_differs_has_a_ray_that_hits_a_different_primitive() {
    let (world, shot) = an_ulp_apart();
    let (embree, bvh) = backends(&world);
    let found = Comparison::of(&world, &shot, &embree, &bvh);
    let again = Comparison::of(&world, &shot, &bvh, &embree);
    assert!(found.differing.len() > found.pixels / 20, "{} pixels differ", found.differing.len());
    assert_eq!(found.differing, again.differing);
    for found in [found, again] {
        assert_eq!(found.unexplained(), 0);
        // The witness does not cry at everything.
        assert!(found.witnessed.len() < found.pixels / 2, "{} pixels", found.witnessed.len());
    }
}

/// Names the right primitives, and moves the points.
struct Moved<'a>(&'a Bvh);

impl Accelerator for Moved<'_> {
    fn closest<F: HitFilter>(&self, rays: &[Ray], filter: &F, hits: &mut [Hit]) {
        self.0.closest(rays, filter, hits);
        hits.iter_mut().filter(|hit| hit.is_hit()).for_each(|hit| hit.point.x += 1e-3);
    }

    fn occluded<F: HitFilter>(&self, rays: &[Ray], filter: &F, blocked: &mut [bool]) {
        self.0.occluded(rays, filter, blocked);
    }

    fn build_stats(&self) -> BuildStats {
        self.0.build_stats()
    }
}

/// The comparison can fail: a backend that decides more than which primitive is hit.
#[test]
fn a_backend_that_says_more_than_the_primitive_is_found_out() {
    let (world, shot) = (cornell().build(), cornell_shot([12, 12], 2));
    let (_, bvh) = backends(&world);
    let found = Comparison::of(&world, &shot, &bvh, &Moved(&bvh));
    assert!(found.unexplained() > found.pixels / 4, "{} pixels", found.unexplained());
}
