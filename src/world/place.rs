//! Placements to geometry: one origin for the world, single placements baked, repeated ones instanced.
//!
//! All of it in `f64`, rounded to `f32` once. Triangles that any placement shows with a cut-out material go
//! to meshes of their own, so that hit filters are asked about those alone; the vertex buffers are shared.

use crate::error::Location;
use crate::geometry::{Buffer, Geometry, Instance, Object, TriangleMesh};
use crate::math::{Affine, DAffine3, DVec3, Vec3};
use crate::scene::{Material, MaterialId, MeshData, Model, Scene};

/// What the shading of a mesh's triangles needs, parallel to a [`TriangleMesh`].
pub(super) struct SurfaceMesh {
    /// Shading normals a vertex; empty when there are none.
    pub(super) normals: Buffer<[f32; 3]>,
    /// Texture coordinates a vertex; empty when there are none.
    pub(super) uvs: Buffer<[f32; 2]>,
    /// Material a triangle.
    pub(super) materials: Vec<MaterialId>,
    /// Source line a triangle; empty when there is no file.
    pub(super) lines: Vec<u32>,
}

/// The placed geometry and everything parallel to it.
pub(super) struct Placed {
    pub(super) origin: DVec3,
    pub(super) geometry: Geometry,
    pub(super) surfaces: Vec<SurfaceMesh>,
    pub(super) object_surfaces: Vec<Vec<SurfaceMesh>>,
    pub(super) instances: Vec<(Option<MaterialId>, bool)>,
    /// Name and first placement of the model of each object.
    pub(super) models: Vec<(String, Option<Location>)>,
}

/// How the placements of a model show it.
#[derive(Clone, Copy, Default)]
struct Shown {
    times: usize,
    /// With its own materials, somewhere.
    own: bool,
    /// With a cut-out material instead of its own, somewhere.
    cut_out: bool,
}

impl Shown {
    fn add(&mut self, material_override: Option<MaterialId>, materials: &[Material]) {
        self.times += 1;
        match material_override {
            None => self.own = true,
            Some(id) => self.cut_out |= materials[id.index()].is_cut_out(),
        }
    }

    /// Whether hit filters must be asked about triangles of the model's material `own`: an instance cannot
    /// have a mesh of its own, so one that is cut out decides for all.
    fn needs_filter(self, own: &Material) -> bool {
        self.cut_out || self.own && own.is_cut_out()
    }
}

/// Places every model of the scene.
pub(super) fn place(scene: &Scene, materials: &[Material]) -> Placed {
    let origin = world_origin(scene);
    let mut placed = Placed {
        origin,
        geometry: Geometry::default(),
        surfaces: Vec::new(),
        object_surfaces: Vec::new(),
        models: Vec::new(),
        instances: Vec::new(),
    };
    let mut shown = vec![Shown::default(); scene.models.len()];
    for placement in &scene.placements {
        shown[placement.model.index()].add(placement.material_override, materials);
    }
    // The object made of each model that is placed more than once, and its own origin.
    let mut objects: Vec<Option<(u32, DVec3)>> = vec![None; scene.models.len()];
    for placement in &scene.placements {
        let model = &scene.models[placement.model.index()];
        let shown = shown[placement.model.index()];
        let filtered = |own: MaterialId| shown.needs_filter(&materials[own.index()]);
        let to_world = DAffine3::from_translation(-origin) * placement.world_from_object;
        if shown.times == 1 {
            for mesh in &model.meshes {
                let parts = bake(mesh, &to_world, placement.material_override, filtered);
                for (mesh, surface) in parts {
                    placed.geometry.meshes.push(mesh);
                    placed.surfaces.push(surface);
                }
            }
            continue;
        }
        let (object, object_origin) = *objects[placement.model.index()]
            .get_or_insert_with(|| add_object(model, filtered, &mut placed));
        let world_from_object = to_world * DAffine3::from_translation(object_origin);
        placed.geometry.instances.push(Instance::new(object, Affine::from_f64(&world_from_object)));
        let mirrored = to_world.matrix3.determinant() < 0.0;
        placed.instances.push((placement.material_override, mirrored));
    }
    placed
}

/// Where the `f32` zero lies: at the file's own zero for ordinary scenes, in the middle of the scene where
/// coordinates are large against its extent (georeferenced models), snapped to whole units.
fn world_origin(scene: &Scene) -> DVec3 {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for placement in &scene.placements {
        for mesh in &scene.models[placement.model.index()].meshes {
            for p in &mesh.positions {
                let p = Vec3::from_array(*p).as_dvec3() + mesh.origin;
                let p = placement.world_from_object.transform_point3(p);
                (min, max) = (min.min(p), max.max(p));
            }
        }
    }
    let center = (min + max) * 0.5;
    let far = center.abs().max_element() > 8.0 * (max - min).max_element();
    if far && center.is_finite() { center.round() } else { DVec3::ZERO }
}

/// A model as an object in its own coordinates, relative to the origin of its first mesh.
fn add_object(
    model: &Model,
    filtered: impl Fn(MaterialId) -> bool,
    placed: &mut Placed,
) -> (u32, DVec3) {
    let origin = model.meshes.first().map_or(DVec3::ZERO, |m| m.origin);
    let to_object = DAffine3::from_translation(-origin);
    let (meshes, surfaces) =
        model.meshes.iter().flat_map(|mesh| bake(mesh, &to_object, None, &filtered)).unzip();
    placed.geometry.objects.push(Object { meshes });
    placed.object_surfaces.push(surfaces);
    placed.models.push((model.name.clone(), model.location.clone()));
    (placed.geometry.objects.len() as u32 - 1, origin)
}

/// Transforms a mesh and splits it into the triangles of materials that are not and that are `filtered`
/// (each only if there are any).
fn bake(
    mesh: &MeshData,
    map: &DAffine3,
    material_override: Option<MaterialId>,
    filtered: impl Fn(MaterialId) -> bool,
) -> Vec<(TriangleMesh, SurfaceMesh)> {
    let positions = mesh
        .positions
        .iter()
        .map(|p| {
            let p = Vec3::from_array(*p).as_dvec3() + mesh.origin;
            map.transform_point3(p).as_vec3().to_array()
        })
        .collect();
    let positions = Buffer::new(positions);
    // Normals are covectors: transposed inverse, up to a scale that keeps the outside outside.
    let cofactors = Affine::from_f64(&DAffine3 { translation: DVec3::ZERO, ..*map });
    let mirrored = map.matrix3.determinant() < 0.0;
    let sign = if mirrored { -1.0 } else { 1.0 };
    let normals = mesh
        .normals
        .iter()
        .map(|n| {
            let n = cofactors.transform_normal(Vec3::from_array(*n)) * sign;
            n.normalize_or_zero().to_array()
        })
        .collect();
    let normals = Buffer::new(normals);
    let uvs = Buffer::new(mesh.uvs.clone());

    [false, true]
        .into_iter()
        .filter_map(|part| {
            let chosen: Vec<usize> = (0..mesh.triangles.len())
                .filter(|&i| filtered(mesh.materials[i]) == part)
                .collect();
            if chosen.is_empty() {
                return None;
            }
            // A mirror turns the winding inside out; swapping two corners turns it back.
            let triangle = |&i: &usize| {
                let [a, b, c] = mesh.triangles[i];
                if mirrored { [a, c, b] } else { [a, b, c] }
            };
            let surface = SurfaceMesh {
                normals: normals.clone(),
                uvs: uvs.clone(),
                materials: chosen
                    .iter()
                    .map(|&i| material_override.unwrap_or(mesh.materials[i]))
                    .collect(),
                lines: chosen.iter().filter_map(|&i| mesh.lines.get(i).copied()).collect(),
            };
            let triangles = Buffer::new(chosen.iter().map(triangle).collect());
            let positions = positions.clone();
            Some((TriangleMesh { positions, triangles, filtered: part }, surface))
        })
        .collect()
}
