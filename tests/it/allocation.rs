//! The bounce loop allocates nothing: a second block of the same size finds all memory in place.

#![cfg(feature = "embree")]

use crate::support::scenes::{cornell, cornell_shot, zoo, zoo_shot};
use glint::accel::AcceptAll;
use glint::trace::Wavefront;
use glint::world::CutOuts;

#[test]
fn the_bounce_loop_allocates_nothing() {
    for (world, shot) in
        [(cornell().build(), cornell_shot([32, 32], 4)), (zoo().build(), zoo_shot([32, 32], 4))]
    {
        let block = shot.block();
        shot.with_tracer(&world, |tracer| {
            let mut wavefront = Wavefront::new(Wavefront::DEFAULT_BATCH);
            let mut sum = 0.0;
            let mut run = || match world.has_cut_outs() {
                true => {
                    wavefront.run(tracer, &CutOuts::new(&world), &block, |s, _| sum += s.radiance.r)
                }
                false => wavefront.run(tracer, &AcceptAll, &block, |s, _| sum += s.radiance.r),
            };
            run();
            let second = allocation_counter::measure(run);
            assert_eq!(second.count_total, 0, "{second:?}");
        });
    }
}

/// The counter counts.
#[test]
fn an_allocation_is_seen() {
    let seen = allocation_counter::measure(|| drop(std::hint::black_box(vec![0_u8; 100])));
    assert_eq!(seen.count_total, 1);
}
