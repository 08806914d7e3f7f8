//! The compiled scene: dense arrays in `f32` around one origin, ready to be asked by paths.
//!
//! `World::compile` consumes what the files said. Everything a path asks for is here: the geometry for
//! the accelerator, the interaction at a hit, the BSDF there, and the lights. It traces no rays.

mod census;
mod cut_out;
mod interaction;
mod light_sampler;
mod lights;
mod material;
mod place;
mod variant;

pub use census::{Census, Feature, Witness};
pub use cut_out::CutOuts;
pub use interaction::{Details, SurfaceInteraction};
pub use light_sampler::{Finding, LightSampler, LightToSample};
pub use lights::Lights;

use crate::camera::{Camera, View};
use crate::error::{Error, Location, Result, Warning};
use crate::geometry::{Aabb, Geometry, NONE, PrimitiveId};
use crate::math::DVec3;
use crate::scene::{self, Environment, Material, MaterialId, Projection, Scene};
use crate::texture::MipMap;
use place::SurfaceMesh;
use std::sync::Arc;

/// A scene that is ready to be rendered. Clones share what is large.
#[derive(Clone)]
pub struct World {
    /// What an accelerator is built from; coordinates are relative to `origin`.
    pub geometry: Arc<Geometry>,
    /// World (scene-file) coordinates of the `f32` zero.
    pub origin: DVec3,
    /// Box around everything, relative to `origin`.
    pub bounds: Aabb,
    /// All lights.
    pub lights: Lights,
    /// What could not be used.
    pub warnings: Vec<Warning>,
    has_cut_outs: bool,
    materials: Vec<Material>,
    /// For each material: whether anything about it depends on texture coordinates.
    needs_uv: Vec<bool>,
    textures: Arc<Vec<MipMap>>,
    surfaces: Arc<Surfaces>,
}

/// What the shading of all triangles needs, parallel to the geometry.
struct Surfaces {
    /// Attributes of `geometry.meshes`.
    own: Vec<SurfaceMesh>,
    /// Attributes of the meshes of each of `geometry.objects`.
    objects: Vec<Vec<SurfaceMesh>>,
    /// For each of `geometry.objects`: the model's name, and where it is placed first.
    models: Vec<(String, Option<Location>)>,
    /// For each instance: its material override, and whether it mirrors.
    instances: Vec<(Option<MaterialId>, bool)>,
}

impl World {
    /// Compiles a scene. Where the scene has neither lights nor an environment nor emissive faces, a
    /// clear sky is added, and a warning says so.
    ///
    /// # Errors
    /// [`Error::Scene`] when there is nothing to render or a light is impossible.
    pub fn compile(mut scene: Scene) -> Result<Self> {
        let mut warnings = std::mem::take(&mut scene.warnings);
        let textures: Vec<MipMap> = scene.images.iter().map(|i| MipMap::new(i.clone())).collect();
        let mut materials = std::mem::take(&mut scene.materials);
        if materials.is_empty() {
            materials.push(Material::default_grey());
        }
        for material in &mut materials {
            material::drop_alpha_of_opaque_images(material, &textures);
        }

        // Geometry first: the lights need the bounds.
        let placed = place::place(&scene, &materials);
        if placed.geometry.placed_triangles() == 0 {
            return Err(Error::Scene("the scene has no triangles to render".into()));
        }
        let bounds = placed.geometry.bounds();
        let mut world = Self {
            has_cut_outs: placed.geometry.has_filtered_meshes(),
            geometry: Arc::new(placed.geometry),
            origin: placed.origin,
            bounds,
            lights: Lights::default(),
            warnings: Vec::new(),
            needs_uv: material::needs_uv(&materials),
            materials,
            textures: Arc::new(textures),
            surfaces: Arc::new(Surfaces {
                own: placed.surfaces,
                objects: placed.object_surfaces,
                models: placed.models,
                instances: placed.instances,
            }),
        };
        let lit = !scene.lights.is_empty()
            || scene.environment.is_some()
            || world.materials.iter().any(|m| m.emission.is_some());
        if !lit {
            scene.environment = Some(DEFAULT_SKY);
            warnings.push(Warning {
                location: None,
                message:
                    "the scene has no light of its own: lit by a clear sky (set one with --env)"
                        .into(),
            });
        }
        world.lights = Lights::compile(&world, &scene)?;
        if world.lights.weights().all(|weight| weight == 0.0) {
            warnings.push(Warning {
                location: None,
                message: "no light of the scene sends anything: the picture will be black".into(),
            });
        }
        world.warnings = warnings;
        Ok(world)
    }

    /// A camera of the scene, made relative to the world's origin.
    ///
    /// # Errors
    /// [`Error::Scene`] when its numbers make no camera.
    pub fn camera(&self, camera: &scene::Camera, size: [u32; 2]) -> Result<Camera> {
        let origin = self.origin;
        let view = View { from: camera.from - origin, to: camera.to - origin, up: camera.up };
        match camera.projection {
            Projection::Perspective { vertical_fov } => {
                Camera::perspective(&view, size, vertical_fov)
            }
            Projection::ThinLens { vertical_fov, lens_radius, focus_distance } => {
                Camera::thin_lens(&view, size, vertical_fov, lens_radius, focus_distance)
            }
            Projection::Orthographic { height } => Camera::orthographic(&view, size, height),
            Projection::Panoramic => Camera::panoramic(&view, size),
        }
    }

    /// Whether hit filters must be asked at all.
    #[inline]
    pub fn has_cut_outs(&self) -> bool {
        self.has_cut_outs
    }

    /// The material of a primitive.
    #[inline]
    pub fn material_id(&self, id: PrimitiveId) -> MaterialId {
        self.overridden(id, self.surface(id).materials[id.primitive as usize])
    }

    /// `own`, or what the instance that `id` is in puts in its place.
    #[inline]
    fn overridden(&self, id: PrimitiveId, own: MaterialId) -> MaterialId {
        match id.instance {
            NONE => own,
            instance => self.surfaces.instances[instance as usize].0.unwrap_or(own),
        }
    }

    /// Vertex indices of a primitive.
    #[inline]
    fn corners(&self, id: PrimitiveId) -> [u32; 3] {
        self.geometry.mesh(id).triangles[id.primitive as usize]
    }

    /// The material description behind an id.
    #[inline]
    pub fn material(&self, id: MaterialId) -> &Material {
        &self.materials[id.index()]
    }

    /// Texture coordinate at barycentrics (u, v) of a primitive; 0 where its mesh has none.
    #[inline]
    pub(crate) fn uv(&self, id: PrimitiveId, u: f32, v: f32) -> [f32; 2] {
        let surface = self.surface(id);
        if surface.uvs.is_empty() {
            return [0.0; 2];
        }
        let [a, b, c] = self.corners(id).map(|i| surface.uvs[i as usize]);
        [0, 1].map(|k| (1.0 - u - v) * a[k] + u * b[k] + v * c[k])
    }

    /// Line of the model file that a primitive comes from, when known.
    pub fn source_line(&self, id: PrimitiveId) -> Option<u32> {
        self.surface(id).lines.get(id.primitive as usize).copied()
    }

    /// Bytes of all textures with their mip levels.
    pub fn texture_bytes(&self) -> usize {
        self.textures.iter().map(MipMap::bytes).sum()
    }

    #[inline]
    fn surface(&self, id: PrimitiveId) -> &SurfaceMesh {
        if id.instance == NONE {
            &self.surfaces.own[id.geometry as usize]
        } else {
            let object = self.geometry.instances[id.instance as usize].object;
            &self.surfaces.objects[object as usize][id.geometry as usize]
        }
    }
}

/// What lights a scene that has no light of its own.
pub const DEFAULT_SKY: Environment = Environment::Sky {
    elevation: 40.0,
    azimuth: 60.0,
    turbidity: 3.0,
    ground_albedo: crate::math::Rgb::splat(0.3),
    scale: 1.0,
};
