//! The stretch that a contestant runs: rays loaded before, some traced to warm up, the rest against the clock.

use super::contestant::{Answer, Batch, Contestant};
use super::crew::{Lap, together};
use super::rays::Query;
use crate::geometry::Ray;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rays that a worker takes at once, and that the in-house BVH gets in a call, so that it can keep many in
/// flight. A multiple of all of Embree's packets and streams.
pub const BATCH: usize = 1024;

/// A contestant's room for rays, kept from turn to turn.
#[derive(Default)]
pub(super) struct Course<'a> {
    closest: Vec<Room<'a>>,
    any_hit: Vec<Room<'a>>,
}

/// Room for up to [`BATCH`] rays, one worker's at a time.
type Room<'a> = Mutex<Box<dyn Batch + 'a>>;

impl<'a> Course<'a> {
    /// Times `contestant` on `rays`, on so many threads, after those of `warm_up`: in a renderer
    /// the caches hold what the rays before have left there.
    pub(super) fn run(
        &mut self,
        contestant: &'a Contestant<'a>,
        query: Query,
        (warm_up, rays): (&[Ray], &[Ray]),
        threads: usize,
    ) -> Lap {
        contestant.isa.limit();
        let warm_ups = warm_up.len().div_ceil(BATCH);
        let all = warm_ups + rays.len().div_ceil(BATCH);
        let rooms = self.rooms(query);
        // Who cannot answer has no room, and is asked nothing.
        let new = (rooms.len()..all).map_while(|_| contestant.tracer.batch(query));
        rooms.extend(new.map(Mutex::new));
        let pieces = warm_up.chunks(BATCH).chain(rays.chunks(BATCH));
        for (room, rays) in rooms.iter_mut().zip(pieces) {
            batch_in(room).load(rays);
        }
        let (warm_up, timed) = rooms[..all.min(rooms.len())].split_at(warm_ups.min(rooms.len()));
        trace(warm_up, threads);
        trace(timed, threads)
    }

    /// The answers of the last run of `query`, to its `rays` rays behind the `warm_up` rays.
    pub(super) fn answers(&mut self, query: Query, warm_up: usize, rays: usize) -> Vec<Answer> {
        let mut answers = Vec::with_capacity(rays);
        let rooms = self.rooms(query).iter_mut().skip(warm_up.div_ceil(BATCH));
        for room in rooms.take(rays.div_ceil(BATCH)) {
            batch_in(room).read(&mut answers);
        }
        answers
    }

    fn rooms(&mut self, query: Query) -> &mut Vec<Room<'a>> {
        match query {
            Query::Closest => &mut self.closest,
            Query::AnyHit => &mut self.any_hit,
        }
    }
}

/// Traces what is in the rooms: each worker takes the next that nobody has taken.
fn trace(rooms: &[Room<'_>], threads: usize) -> Lap {
    let next = AtomicUsize::new(0);
    together(threads, || {
        while let Some(room) = rooms.get(next.fetch_add(1, Ordering::Relaxed)) {
            // Nobody else has it, so the lock costs nothing; a panic has ended everything.
            if let Ok(mut batch) = room.lock() {
                batch.trace();
            }
        }
    })
}

fn batch_in<'r, 'a>(room: &'r mut Room<'a>) -> &'r mut (dyn Batch + 'a) {
    match room.get_mut() {
        Ok(batch) => &mut **batch,
        Err(poisoned) => &mut **poisoned.into_inner(),
    }
}
