//! The same bytes for any number of threads, any batch, any crop; and the wavefront equals the naive
//! integrator path by path.

#![cfg(feature = "embree")]

use crate::support::scenes::{Builder, cornell, cornell_shot, zoo, zoo_shot};
use crate::support::shot::Shot;
use glint::film::Region;
use glint::os::Isa;
use glint::sampling::Strategy;
use glint::world::World;

fn scenes() -> [(&'static str, World, Shot); 2] {
    [
        ("cornell", cornell().build(), cornell_shot([40, 40], 9)),
        ("zoo", zoo().build(), zoo_shot([48, 36], 9)),
    ]
}

#[test]
fn threads_change_no_byte() {
    for (name, world, shot) in scenes() {
        let one = Shot { threads: 1, ..shot.clone() }.render(&world).film;
        let many = Shot { threads: 5, ..shot }.render(&world).film;
        assert!(one == many, "{name}");
    }
}

#[test]
fn batch_size_changes_no_byte() {
    for (name, world, shot) in scenes() {
        let films = [1, 7, 4096].map(|batch| Shot { batch, ..shot.clone() }.render(&world).film);
        assert!(films[0] == films[1] && films[1] == films[2], "{name}");
    }
}

/// Other tests may run meanwhile: what they see does not depend on it either.
#[test]
fn the_instruction_set_changes_no_byte() {
    for (name, world, shot) in scenes() {
        let films = Isa::ALL.map(|(_, isa)| {
            isa.limit();
            shot.clone().render(&world).film
        });
        assert!(films[0] == films[1] && films[1] == films[2], "{name}");
    }
}

#[test]
fn a_crop_is_the_cut_of_the_whole() {
    for (name, world, shot) in scenes() {
        let whole = shot.pixels(&world);
        let region = Region { start: [5, 11], end: [39, 30] };
        let crop = Shot { region: Some(region), ..shot }.pixels(&world);
        for pixel in region.iter() {
            let (a, b) = (whole.region.index(pixel), region.index(pixel));
            assert_eq!(whole.radiance[a], crop.radiance[b], "{name} {pixel:?}");
            assert_eq!(whole.alpha[a], crop.alpha[b], "{name} {pixel:?}");
        }
    }
}

#[test]
fn a_seed_gives_the_same_image_and_another_seed_another() {
    let (world, shot) = (cornell().build(), cornell_shot([16, 16], 4));
    let film = |seed| Shot { seed, ..shot.clone() }.render(&world).film;
    assert!(film(0) == film(0));
    assert!(film(0) != film(1));
}

/// Largest relative difference between the two integrators over all paths of a shot.
fn worst_difference(world: &World, shot: &Shot) -> f32 {
    let wavefront = shot.wavefront_samples(world);
    let naive = shot.naive_samples(world);
    assert_eq!(wavefront.len(), naive.len());
    let mut lit = 0;
    let mut worst = 0.0_f32;
    for (sample, naive) in wavefront.iter().zip(naive) {
        let difference = (sample.radiance - naive).map(f32::abs).max_channel();
        if difference > 0.0 {
            worst = worst.max(difference / naive.map(f32::abs).max_channel());
        }
        lit += u32::from(!naive.is_black());
    }
    assert!(lit as usize > wavefront.len() / 4, "too dark to mean anything: {lit} lit paths");
    worst
}

#[test]
fn wavefront_equals_naive_path_by_path() {
    for (name, world, shot) in scenes() {
        for &kind in Strategy::ALL.iter().filter(|strategy| strategy.can_render()) {
            let worst = worst_difference(&world, &Shot { kind, ..shot.clone() });
            assert!(worst < 1e-5, "{name} {kind:?}: {worst}");
        }
    }
}

/// The comparison can fail: a different seed is a different image.
#[test]
fn the_comparison_sees_a_difference() {
    let (world, shot) = (cornell().build(), cornell_shot([16, 16], 4));
    let a = shot.wavefront_samples(&world);
    let b = Shot { seed: 1, ..shot }.naive_samples(&world);
    let same = a.iter().zip(&b).filter(|(a, b)| a.radiance == **b).count();
    assert!(same < a.len() / 2);
}

/// Sums of many samples at extreme scales of light stay proportional.
#[test]
fn scaling_the_light_scales_the_image() {
    use crate::support::scenes::mean;
    use glint::math::Rgb;
    let at_scale = |scale: f32| {
        let mut b = Builder::default();
        let white = b.lambert(0.8, 0.8, 0.8);
        b.sphere([0.0; 3], 1.0, 12, false, white);
        b.environment(Rgb::splat(scale));
        let shot = Shot::new([0.0, 0.0, 4.0], [0.0; 3], 40.0, [24, 24], 8);
        mean(&shot.pixels(&b.build()))[0] / f64::from(scale)
    };
    let one = at_scale(1.0);
    for scale in [1e-6, 1e6] {
        assert!((at_scale(scale) / one - 1.0).abs() < 1e-5);
    }
}
