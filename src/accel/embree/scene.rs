//! Embree's scene over shared buffers: meshes as triangle geometries, objects as instanced scenes.

use super::device::Device;
use super::sys;
use super::variant::EmbreeVariant;
use crate::error::{Error, Result};
use crate::geometry::{Geometry, NONE, Object, PrimitiveId, TriangleMesh};

/// An owned, committed Embree scene. The buffers it reads must outlive it (the accelerator sees to it).
pub(super) struct EmbreeScene {
    handle: sys::RTCScene,
    /// Root geometry ids below this are meshes, from here on instances.
    own_meshes: u32,
}

// SAFETY: a committed scene is immutable, and Embree's queries on it are thread safe.
unsafe impl Send for EmbreeScene {}
// SAFETY: as above.
unsafe impl Sync for EmbreeScene {}

impl EmbreeScene {
    /// Builds and commits the root scene and one scene an object. Without `filters`, what is cut out is not
    /// asked about.
    pub(super) fn build(
        device: &Device,
        geometry: &Geometry,
        variant: EmbreeVariant,
        filters: bool,
    ) -> Result<Self> {
        let objects = geometry
            .objects
            .iter()
            .map(|Object { meshes }| {
                let scene = Self::new(device, meshes, variant, filters)?;
                scene.commit(device)?;
                Ok(scene)
            })
            .collect::<Result<Vec<_>>>()?;
        let root = Self::new(device, &geometry.meshes, variant, filters)?;
        for (i, instance) in geometry.instances.iter().enumerate() {
            let object = &objects[instance.object as usize];
            root.attach_instance(device, object, &instance.world_from_object, i as u32)?;
        }
        root.commit(device)?;
        // The object scenes may be released now: instances hold references to them.
        Ok(root)
    }

    /// The raw handle, valid as long as `self`.
    pub(super) fn handle(&self) -> sys::RTCScene {
        self.handle
    }

    /// glint's id of what Embree calls (instance, geometry, primitive).
    #[inline]
    pub(super) fn primitive_id(&self, instance: u32, geometry: u32, primitive: u32) -> PrimitiveId {
        let instance = if instance == NONE { NONE } else { instance - self.own_meshes };
        PrimitiveId { instance, geometry, primitive }
    }

    /// An uncommitted scene with `meshes` attached under their own indices.
    fn new(
        device: &Device,
        meshes: &[TriangleMesh],
        variant: EmbreeVariant,
        filters: bool,
    ) -> Result<Self> {
        // SAFETY: the device is valid.
        let handle = unsafe { sys::rtcNewScene(device.handle()) };
        if handle.is_null() {
            device.check()?;
            return Err(Error::Backend { backend: "embree", message: "no scene".into() });
        }
        let scene = Self { handle, own_meshes: meshes.len() as u32 };
        // SAFETY: the scene is valid and not committed yet.
        unsafe { sys::rtcSetSceneFlags(handle, variant.flags()) };
        // SAFETY: as above.
        unsafe { sys::rtcSetSceneBuildQuality(handle, variant.quality()) };
        for (i, mesh) in meshes.iter().enumerate() {
            scene.attach_mesh(device, mesh, i as u32, filters && mesh.filtered)?;
        }
        Ok(scene)
    }

    fn attach_mesh(
        &self,
        device: &Device,
        mesh: &TriangleMesh,
        id: u32,
        filtered: bool,
    ) -> Result<()> {
        let triangle = sys::RTCGeometryType::RTC_GEOMETRY_TYPE_TRIANGLE;
        // SAFETY: the device is valid.
        let handle = unsafe { sys::rtcNewGeometry(device.handle(), triangle) };
        device.check()?;
        // SAFETY: `positions` has 16 readable bytes behind its last element (Buffer's invariant) and
        // outlives the scene; 12 bytes of stride match [f32; 3].
        unsafe {
            sys::rtcSetSharedGeometryBuffer(
                handle,
                sys::RTCBufferType::RTC_BUFFER_TYPE_VERTEX,
                0,
                sys::RTCFormat::RTC_FORMAT_FLOAT3,
                mesh.positions.as_ptr().cast(),
                0,
                12,
                mesh.positions.len(),
            );
        }
        // SAFETY: as above; every index is below the number of positions (TriangleMesh's invariant).
        unsafe {
            sys::rtcSetSharedGeometryBuffer(
                handle,
                sys::RTCBufferType::RTC_BUFFER_TYPE_INDEX,
                0,
                sys::RTCFormat::RTC_FORMAT_UINT3,
                mesh.triangles.as_ptr().cast(),
                0,
                12,
                mesh.triangles.len(),
            );
        }
        if filtered {
            // SAFETY: the geometry is valid; the filter lives in the shim.
            unsafe { sys::glint_filter_geometry(handle) };
        }
        self.attach(handle, id);
        device.check()
    }

    fn attach_instance(
        &self,
        device: &Device,
        object: &Self,
        world_from_object: &crate::math::Affine,
        index: u32,
    ) -> Result<()> {
        let kind = sys::RTCGeometryType::RTC_GEOMETRY_TYPE_INSTANCE;
        // SAFETY: the device is valid.
        let handle = unsafe { sys::rtcNewGeometry(device.handle(), kind) };
        device.check()?;
        // SAFETY: both handles are valid; the instance takes a reference to the object's scene.
        unsafe { sys::rtcSetGeometryInstancedScene(handle, object.handle) };
        // SAFETY: the matrix is 12 floats in columns, copied by the call.
        unsafe {
            sys::rtcSetGeometryTransform(
                handle,
                0,
                sys::RTCFormat::RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                std::ptr::from_ref(world_from_object).cast(),
            );
        }
        self.attach(handle, self.own_meshes + index);
        device.check()
    }

    /// Commits a geometry and hands it over to the scene.
    fn attach(&self, geometry: sys::RTCGeometry, id: u32) {
        // SAFETY: the geometry is valid and complete.
        unsafe { sys::rtcCommitGeometry(geometry) };
        // SAFETY: both handles are valid, and the id is used once in this scene.
        unsafe { sys::rtcAttachGeometryByID(self.handle, geometry, id) };
        // SAFETY: drops our reference; the scene holds its own.
        unsafe { sys::rtcReleaseGeometry(geometry) };
    }

    fn commit(&self, device: &Device) -> Result<()> {
        // SAFETY: the scene is valid, and nothing else uses it yet.
        unsafe { sys::rtcCommitScene(self.handle) };
        device.check()
    }
}

impl Drop for EmbreeScene {
    fn drop(&mut self) {
        // SAFETY: the handle is owned and released once.
        unsafe { sys::rtcReleaseScene(self.handle) };
    }
}
