//! Embree as it comes, for benchmarks: any variant, any call, rays in Embree's own layouts.
//!
//! What is to be timed is [`BareRays::trace`] alone: it does nothing but call Embree. Rays are put into the
//! layout before, and answers are read after it. Filters are not asked; every surface is solid.

use super::device::Device;
use super::layout::Packet;
use super::scene::EmbreeScene;
use super::sys;
use super::variant::{EmbreeCall, EmbreeVariant};
use crate::accel::BuildStats;
use crate::error::Result;
use crate::geometry::{Geometry, PrimitiveId, Ray};
use crate::os::Isa;
use std::sync::Arc;
use std::time::Instant;

/// An Embree scene of any variant.
pub struct BareEmbree {
    // Dropped in this order: the scene before its device, both before the buffers.
    scene: EmbreeScene,
    _device: Device,
    geometry: Arc<Geometry>,
    stats: BuildStats,
}

impl BareEmbree {
    /// Builds with at most `threads` threads (0: all), for the instructions of `isa` and none wider.
    ///
    /// # Errors
    /// Embree's own.
    pub fn build(
        geometry: Arc<Geometry>,
        threads: usize,
        variant: EmbreeVariant,
        isa: Isa,
    ) -> Result<Self> {
        let start = Instant::now();
        let device = Device::new(threads, isa)?;
        let scene = EmbreeScene::build(&device, &geometry, variant, false)?;
        let seconds = start.elapsed().as_secs_f64();
        let stats = BuildStats { seconds, bytes: device.bytes(), shape: None };
        Ok(Self { scene, _device: device, geometry, stats })
    }

    /// What building it took.
    pub fn build_stats(&self) -> BuildStats {
        self.stats
    }

    /// Rays whose closest hits are looked for by `call`.
    pub fn closest(&self, call: EmbreeCall) -> BareRays<'_> {
        BareRays(match call {
            EmbreeCall::Single | EmbreeCall::Stream(..) => self.loaded::<sys::RTCRayHit>(call),
            EmbreeCall::Packet8(_) => self.loaded::<sys::RTCRayHit8>(call),
            EmbreeCall::Packet16(_) => self.loaded::<sys::RTCRayHit16>(call),
        })
    }

    /// Rays for which any hit is looked for by `call`; none where this Embree would not return from it.
    pub fn occluded(&self, call: EmbreeCall) -> Option<BareRays<'_>> {
        let returns = self.geometry.instances.is_empty() || call.returns_on_instances();
        returns.then(|| {
            BareRays(match call {
                EmbreeCall::Single | EmbreeCall::Stream(..) => self.loaded::<sys::RTCRay>(call),
                EmbreeCall::Packet8(_) => self.loaded::<sys::RTCRay8>(call),
                EmbreeCall::Packet16(_) => self.loaded::<sys::RTCRay16>(call),
            })
        })
    }

    fn loaded<'a, P: Packet + 'a>(&'a self, call: EmbreeCall) -> Box<dyn Buffer + 'a> {
        Box::new(Loaded::<P> { scene: &self.scene, call, packets: Vec::new(), rays: 0 })
    }
}

/// Rays in the layout of an Embree call, and what Embree wrote to them.
pub struct BareRays<'a>(Box<dyn Buffer + 'a>);

impl BareRays<'_> {
    /// Puts rays in place of whatever was there.
    pub fn load(&mut self, rays: &[Ray]) {
        self.0.load(rays);
    }

    /// Has Embree trace all rays, once after each [`Self::load`].
    pub fn trace(&mut self) {
        self.0.trace();
    }

    /// For each ray, whether anything was met, and which primitive (of an any-hit call, which does not say:
    /// [`PrimitiveId::MISS`]).
    pub fn read(&self) -> Vec<(bool, PrimitiveId)> {
        self.0.read()
    }
}

/// [`BareRays`] of any layout.
trait Buffer: Send {
    fn load(&mut self, rays: &[Ray]);
    fn trace(&mut self);
    fn read(&self) -> Vec<(bool, PrimitiveId)>;
}

/// Rays in packets of one layout.
struct Loaded<'a, P> {
    scene: &'a EmbreeScene,
    call: EmbreeCall,
    packets: Vec<P>,
    rays: usize,
}

impl<P: Packet> Buffer for Loaded<'_, P> {
    fn load(&mut self, rays: &[Ray]) {
        self.rays = rays.len();
        self.packets.resize(rays.len().div_ceil(P::WIDTH), P::default());
        for (packet, rays) in self.packets.iter_mut().zip(rays.chunks(P::WIDTH)) {
            for (lane, ray) in rays.iter().enumerate() {
                packet.set(lane, ray);
            }
        }
    }

    fn trace(&mut self) {
        // `load` has made room for exactly so many rays.
        P::trace(self.scene, &mut self.packets, self.rays, self.call);
    }

    fn read(&self) -> Vec<(bool, PrimitiveId)> {
        let answer = |i: usize| self.packets[i / P::WIDTH].answer(i % P::WIDTH, self.scene);
        (0..self.rays).map(answer).collect()
    }
}
