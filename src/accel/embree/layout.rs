//! Embree's layouts of rays, one by one and side by side, and the calls that take them. For benchmarks.

use super::query::to_embree;
use super::scene::EmbreeScene;
use super::sys;
use super::variant::EmbreeCall;
use crate::geometry::{PrimitiveId, Ray};

/// A layout of Embree's: `WIDTH` rays side by side.
pub(super) trait Packet: Copy + Default + Send {
    const WIDTH: usize;

    /// Puts a ray into a lane, unanswered.
    fn set(&mut self, lane: usize, ray: &Ray);

    /// What Embree wrote into a lane.
    fn answer(&self, lane: usize, scene: &EmbreeScene) -> (bool, PrimitiveId);

    /// Traces the first `rays` rays.
    fn trace(scene: &EmbreeScene, packets: &mut [Self], rays: usize, call: EmbreeCall);
}

/// Answers of any-hit calls: Embree marks a ray that is blocked by an infinite end.
fn blocked(end: f32) -> (bool, PrimitiveId) {
    (end == f32::NEG_INFINITY, PrimitiveId::MISS)
}

/// Answers of closest-hit calls.
fn closest(
    scene: &EmbreeScene,
    instance: u32,
    geometry: u32,
    primitive: u32,
) -> (bool, PrimitiveId) {
    if geometry == u32::MAX {
        (false, PrimitiveId::MISS)
    } else {
        (true, scene.primitive_id(instance, geometry, primitive))
    }
}

/// Checks what every call below relies on, and gives the number of rays in C's type.
fn checked<P: Packet>(packets: &[P], rays: usize) -> u32 {
    assert!(rays <= packets.len() * P::WIDTH, "more rays than there is room for");
    u32::try_from(rays).unwrap_or(u32::MAX)
}

impl Packet for sys::RTCRay {
    const WIDTH: usize = 1;

    fn set(&mut self, _: usize, ray: &Ray) {
        *self = to_embree(ray, 0);
    }

    fn answer(&self, _: usize, _: &EmbreeScene) -> (bool, PrimitiveId) {
        blocked(self.tfar)
    }

    fn trace(scene: &EmbreeScene, packets: &mut [Self], rays: usize, call: EmbreeCall) {
        let (n, first) = (checked(packets, rays), packets.as_mut_ptr());
        if let EmbreeCall::Stream(length, _) = call {
            // SAFETY: the scene is committed; there are n initialised, aligned rays.
            unsafe {
                sys::glint_occluded_stream(scene.handle(), first, n, length, call.is_coherent())
            };
        } else {
            // SAFETY: as above; without a filter there is nothing to pass to it.
            unsafe { sys::glint_occluded(scene.handle(), first, n, None, std::ptr::null()) };
        }
    }
}

impl Packet for sys::RTCRayHit {
    const WIDTH: usize = 1;

    fn set(&mut self, lane: usize, ray: &Ray) {
        self.ray.set(lane, ray);
        self.hit.geomID = u32::MAX;
        self.hit.instID = [u32::MAX];
    }

    fn answer(&self, _: usize, scene: &EmbreeScene) -> (bool, PrimitiveId) {
        closest(scene, self.hit.instID[0], self.hit.geomID, self.hit.primID)
    }

    fn trace(scene: &EmbreeScene, packets: &mut [Self], rays: usize, call: EmbreeCall) {
        let (n, first) = (checked(packets, rays), packets.as_mut_ptr());
        if let EmbreeCall::Stream(length, _) = call {
            // SAFETY: the scene is committed; there are n initialised, aligned ray-hits.
            unsafe {
                sys::glint_closest_stream(scene.handle(), first, n, length, call.is_coherent())
            };
        } else {
            // SAFETY: as above; without a filter there is nothing to pass to it.
            unsafe { sys::glint_closest(scene.handle(), first, n, None, std::ptr::null()) };
        }
    }
}

/// The layouts of packets of one width: of rays, and of rays with hits.
macro_rules! packets {
    ($width:literal, $ray:ty, $ray_hit:ty, $occluded:path, $closest:path) => {
        impl Packet for $ray {
            const WIDTH: usize = $width;

            fn set(&mut self, lane: usize, ray: &Ray) {
                let from = to_embree(ray, 0);
                self.org_x[lane] = from.org_x;
                self.org_y[lane] = from.org_y;
                self.org_z[lane] = from.org_z;
                self.tnear[lane] = from.tnear;
                self.dir_x[lane] = from.dir_x;
                self.dir_y[lane] = from.dir_y;
                self.dir_z[lane] = from.dir_z;
                self.time[lane] = from.time;
                self.tfar[lane] = from.tfar;
                self.mask[lane] = from.mask;
                self.id[lane] = from.id;
                self.flags[lane] = from.flags;
            }

            fn answer(&self, lane: usize, _: &EmbreeScene) -> (bool, PrimitiveId) {
                blocked(self.tfar[lane])
            }

            fn trace(scene: &EmbreeScene, packets: &mut [Self], rays: usize, call: EmbreeCall) {
                let (n, first) = (checked(packets, rays), packets.as_mut_ptr());
                // SAFETY: the scene is committed; the aligned, initialised packets hold n rays.
                unsafe { $occluded(scene.handle(), first, n, call.is_coherent()) };
            }
        }

        impl Packet for $ray_hit {
            const WIDTH: usize = $width;

            fn set(&mut self, lane: usize, ray: &Ray) {
                self.ray.set(lane, ray);
                self.hit.geomID[lane] = u32::MAX;
                self.hit.instID[0][lane] = u32::MAX;
            }

            fn answer(&self, lane: usize, scene: &EmbreeScene) -> (bool, PrimitiveId) {
                let hit = &self.hit;
                closest(scene, hit.instID[0][lane], hit.geomID[lane], hit.primID[lane])
            }

            fn trace(scene: &EmbreeScene, packets: &mut [Self], rays: usize, call: EmbreeCall) {
                let (n, first) = (checked(packets, rays), packets.as_mut_ptr());
                // SAFETY: the scene is committed; the aligned, initialised packets hold n rays.
                unsafe { $closest(scene.handle(), first, n, call.is_coherent()) };
            }
        }
    };
}

packets!(8, sys::RTCRay8, sys::RTCRayHit8, sys::glint_occluded_8, sys::glint_closest_8);
packets!(16, sys::RTCRay16, sys::RTCRayHit16, sys::glint_occluded_16, sys::glint_closest_16);
