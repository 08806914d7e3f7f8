//! Batches of rays through Embree: our rays into its layout, its ids back into our hits.

use super::scene::EmbreeScene;
use super::sys;
use crate::accel::{AcceptAll, HitFilter, resolve, resolve_all};
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use std::ffi::{c_int, c_uint, c_void};

/// Rays handed to the shim in one call: large enough to hide the call, small enough to stay in L1.
const CHUNK: usize = 64;

/// What a filter callback needs to ask our filter.
struct FilterQuery<'a, F> {
    filter: &'a F,
    rays: &'a [Ray],
    geometry: &'a Geometry,
    scene: &'a EmbreeScene,
}

/// Embree found a candidate on a filtered mesh. `extern "C"` aborts on unwind: no panic crosses into C.
unsafe extern "C" fn accept<F: HitFilter>(
    user: *const c_void,
    ray: c_uint,
    instance: c_uint,
    geometry: c_uint,
    primitive: c_uint,
) -> c_int {
    // SAFETY: `user` is the FilterQuery<F> that the calls below pass together with `accept::<F>`, and
    // it lives for the whole call.
    let query = unsafe { &*user.cast::<FilterQuery<'_, F>>() };
    let ray = &query.rays[ray as usize];
    let id = query.scene.primitive_id(instance, geometry, primitive);
    c_int::from(query.filter.accept(ray, &resolve(query.geometry, ray, id)))
}

/// `ray` in Embree's layout; its id is its place in the chunk, by which the filter finds it again.
#[inline]
pub(super) fn to_embree(ray: &Ray, place: usize) -> sys::RTCRay {
    sys::RTCRay {
        org_x: ray.origin.x,
        org_y: ray.origin.y,
        org_z: ray.origin.z,
        tnear: ray.t_min,
        dir_x: ray.direction.x,
        dir_y: ray.direction.y,
        dir_z: ray.direction.z,
        time: 0.0,
        tfar: ray.t_max,
        mask: u32::MAX,
        id: place as u32,
        flags: 0,
    }
}

/// See [`crate::accel::Accelerator::closest`].
pub(super) fn closest<F: HitFilter>(
    scene: &EmbreeScene,
    geometry: &Geometry,
    rays: &[Ray],
    filter: &F,
    hits: &mut [Hit],
) {
    let mut ids = [PrimitiveId::MISS; CHUNK];
    for (rays, hits) in rays.chunks(CHUNK).zip(hits.chunks_mut(CHUNK)) {
        closest_chunk(scene, geometry, rays, filter, &mut ids);
        resolve_all(geometry, rays, &ids[..rays.len()], hits);
    }
}

/// See [`super::EmbreeAccelerator::closest_ids`].
pub(super) fn closest_ids(
    scene: &EmbreeScene,
    geometry: &Geometry,
    rays: &[Ray],
    ids: &mut [PrimitiveId],
) {
    for (rays, ids) in rays.chunks(CHUNK).zip(ids.chunks_mut(CHUNK)) {
        closest_chunk(scene, geometry, rays, &AcceptAll, ids);
    }
}

/// The primitives that at most [`CHUNK`] rays hit.
fn closest_chunk<F: HitFilter>(
    scene: &EmbreeScene,
    geometry: &Geometry,
    rays: &[Ray],
    filter: &F,
    ids: &mut [PrimitiveId],
) {
    let mut buffer = [sys::RTCRayHit::default(); CHUNK];
    for (place, ray) in rays.iter().enumerate() {
        buffer[place].ray = to_embree(ray, place);
        buffer[place].hit.geomID = u32::MAX;
        buffer[place].hit.instID = [u32::MAX; 1];
    }
    let query = FilterQuery { filter, rays, geometry, scene };
    // SAFETY: the scene is committed; the buffer holds rays.len() initialised, aligned ray-hits; the
    // query outlives the call and is of the type that accept::<F> expects.
    unsafe {
        sys::glint_closest(
            scene.handle(),
            buffer.as_mut_ptr(),
            rays.len() as u32,
            Some(accept::<F>),
            std::ptr::from_ref(&query).cast(),
        );
    }
    for (answer, id) in buffer[..rays.len()].iter().zip(ids) {
        let found = &answer.hit;
        *id = if found.geomID == u32::MAX {
            PrimitiveId::MISS
        } else {
            scene.primitive_id(found.instID[0], found.geomID, found.primID)
        };
    }
}

/// See [`crate::accel::Accelerator::occluded`].
pub(super) fn occluded<F: HitFilter>(
    scene: &EmbreeScene,
    geometry: &Geometry,
    rays: &[Ray],
    filter: &F,
    blocked: &mut [bool],
) {
    let mut buffer = [sys::RTCRay::default(); CHUNK];
    for (rays, blocked) in rays.chunks(CHUNK).zip(blocked.chunks_mut(CHUNK)) {
        for (place, ray) in rays.iter().enumerate() {
            buffer[place] = to_embree(ray, place);
        }
        let query = FilterQuery { filter, rays, geometry, scene };
        // SAFETY: as in `closest`.
        unsafe {
            sys::glint_occluded(
                scene.handle(),
                buffer.as_mut_ptr(),
                rays.len() as u32,
                Some(accept::<F>),
                std::ptr::from_ref(&query).cast(),
            );
        }
        for (answer, blocked) in buffer.iter().zip(blocked) {
            *blocked = answer.tfar == f32::NEG_INFINITY;
        }
    }
}
