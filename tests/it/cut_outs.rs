//! Cut-outs on instances: each is as covered as the material that it shows.

#![cfg(feature = "embree")]

use crate::support::scenes::Builder;
use glint::accel::{Accelerator, BruteForce};
use glint::geometry::{Hit, Ray};
use glint::math::{DAffine3, DVec3, Vec3};
use glint::scene::{MaterialId, ScalarInput};
use glint::world::CutOuts;

const OPAQUE: MaterialId = MaterialId(0);
const ABSENT: MaterialId = MaterialId(1);

/// Places a square of material `own` once for each of `overrides`; which of them a ray meets, and whether
/// filters are asked about any.
fn met(own: MaterialId, overrides: &[Option<MaterialId>]) -> (Vec<bool>, bool) {
    let mut b = Builder::default();
    b.lambert(0.5, 0.5, 0.5);
    b.lambert(0.5, 0.5, 0.5);
    b.scene.materials[ABSENT.index()].opacity = ScalarInput::constant(0.0);
    b.quad([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], own);
    let model = b.scene.placements.pop().expect("the square's").model;
    for (i, material_override) in overrides.iter().enumerate() {
        b.place(model, DAffine3::from_translation(DVec3::X * 4.0 * i as f64));
        b.scene.placements[i].material_override = *material_override;
    }
    let world = b.build();
    let accelerator = BruteForce::new(world.geometry.clone());
    let is_met = |i| {
        let ray = Ray::new(Vec3::new(4.0 * i as f32, 0.1, 3.0), -Vec3::Z);
        let mut hit = [Hit::MISS];
        accelerator.closest(&[ray], &CutOuts::new(&world), &mut hit);
        hit[0].is_hit()
    };
    ((0..overrides.len()).map(is_met).collect(), world.has_cut_outs())
}

#[test]
fn an_instance_is_as_covered_as_the_material_it_shows() {
    let (opaque, absent) = (Some(OPAQUE), Some(ABSENT));
    assert_eq!(met(OPAQUE, &[None, absent]), (vec![true, false], true));
    assert_eq!(met(OPAQUE, &[absent, opaque]), (vec![false, true], true));
    assert_eq!(met(ABSENT, &[None, opaque]), (vec![false, true], true));
    assert_eq!(met(OPAQUE, &[absent]), (vec![false], true));
}

#[test]
fn nothing_is_filtered_where_nothing_cut_out_is_shown() {
    let opaque = Some(OPAQUE);
    assert_eq!(met(OPAQUE, &[None, opaque]), (vec![true, true], false));
    assert_eq!(met(ABSENT, &[opaque, opaque]), (vec![true, true], false));
    assert_eq!(met(ABSENT, &[opaque]), (vec![true], false));
}
