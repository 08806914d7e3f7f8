//! Two backends, one picture: where both name the same primitives, every bit of a pixel is the same.

#![cfg(all(feature = "embree", feature = "bvh"))]

use crate::support::scenes::{cornell, cornell_shot, zoo, zoo_shot};
use glint::accel::bvh::Bvh;

/// Rays within the rounding of an edge or a silhouette may meet its other side: pixels with such a ray are
/// counted. None was found on Embree 3.13.5 with AVX-512; other kernels of Embree may round a few otherwise.
#[test]
fn pictures_are_equal_byte_for_byte_but_for_rays_along_edges() {
    let scenes = [
        ("cornell", cornell().build(), cornell_shot([64, 64], 16)),
        ("zoo", zoo().build(), zoo_shot([64, 48], 16)),
    ];
    for (name, world, shot) in scenes {
        let embree = shot.pixels(&world);
        let bvh = Bvh::build(world.geometry.clone(), 2).expect("it builds");
        let bvh = shot.render_on(&world, &bvh).film.develop();
        let differing = (0..embree.radiance.len())
            .filter(|&i| embree.radiance[i] != bvh.radiance[i] || embree.alpha[i] != bvh.alpha[i]);
        let (differing, all) = (differing.count(), embree.radiance.len());
        assert!(1000 * differing <= 2 * all, "{name}: {differing} of {all} pixels differ");
    }
}
