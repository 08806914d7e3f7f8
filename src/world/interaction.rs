//! A hit expanded into what shading needs: point, normals, texture coordinates, footprint.
//!
//! Sources: ray cones for texture footprints, Akenine-Möller et al., "Improved Shader and Texture Level
//! of Detail Using Ray Cones", JCGT 10(1), 2021; bump mapping, Blinn 1978, with the height gradient
//! taken over the footprint.

use super::material::{lookup, wrap_of};
use super::{SurfaceMesh, World};
use crate::geometry::{Hit, NONE, PrimitiveId, Ray};
use crate::math::{Frame, Vec3};
use crate::scene::{MaterialId, NormalInput, TextureReference};

/// The surface where a ray met it, seen from the side the ray came from.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceInteraction {
    /// The point, relative to the world origin.
    pub point: Vec3,
    /// How far along `n_geometric` a ray must start so as not to meet this surface again.
    pub offset: f32,
    /// Unit normal of the triangle, towards the ray's origin.
    pub n_geometric: Vec3,
    /// Shading frame; its normal is on the ray's side too.
    pub frame: Frame,
    /// Whether the ray came from outside (the side the file's winding faces).
    pub entering: bool,
    /// Texture coordinates; 0 where the mesh has none.
    pub uv: [f32; 2],
    /// Width of the ray's footprint in texture coordinates.
    pub footprint: f32,
    /// Material of the triangle.
    pub material: MaterialId,
}

impl SurfaceInteraction {
    /// Where a ray that leaves towards `direction` starts: past the surface on that side for sure.
    #[inline]
    pub fn origin_towards(&self, direction: Vec3) -> Vec3 {
        let side = if direction.dot(self.n_geometric) < 0.0 { -self.offset } else { self.offset };
        self.point + self.n_geometric * side
    }
}

/// Where texture coordinates, footprints and normal maps are worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Details {
    /// Nowhere: no material looks anything up.
    Nowhere,
    /// On surfaces whose material looks something up.
    WhereNeeded,
    /// Everywhere.
    Everywhere,
}

impl World {
    /// Whether the surface that `id` is on is to be expanded with its details.
    #[inline]
    pub fn is_detailed(&self, id: PrimitiveId, details: Details) -> bool {
        match details {
            Details::Nowhere => false,
            Details::WhereNeeded => self.needs_uv[self.material_id(id).index()],
            Details::Everywhere => true,
        }
    }

    /// Expands `hit`, which must be one, of `ray`, whose cone is `width` wide there. Without `detailed`, there are
    /// no texture coordinates, and none of what depends on them.
    #[inline(always)]
    pub fn interact(&self, ray: &Ray, hit: &Hit, width: f32, detailed: bool) -> SurfaceInteraction {
        let mirrored =
            hit.id.instance != NONE && self.surfaces.instances[hit.id.instance as usize].1;
        let outward = if mirrored { -hit.normal } else { hit.normal };
        let entering = outward.dot(ray.direction) < 0.0;
        let n_geometric = if entering { outward } else { -outward };
        let surface = self.surface(hit.id);
        let material = surface.materials[hit.id.primitive as usize];
        let material = self.overridden(hit.id, material);

        let mut n_shading = n_geometric;
        if !surface.normals.is_empty() {
            n_shading = self.interpolated_normal(surface, hit, n_geometric);
        }
        let mut mapped = Mapped { uv: [0.0; 2], footprint: 0.0, n_shading };
        if detailed && !surface.uvs.is_empty() {
            let normals = [n_geometric, n_shading];
            mapped = self.mapped(surface, ray, hit, width, normals, material);
        }
        SurfaceInteraction {
            point: hit.point,
            offset: hit.offset,
            n_geometric,
            frame: Frame::from_normal(facing(mapped.n_shading, -ray.direction)),
            entering,
            uv: mapped.uv,
            footprint: mapped.footprint,
            material,
        }
    }

    /// The normal of a smooth mesh at a hit, on the side of `n_geometric`.
    #[inline]
    fn interpolated_normal(&self, surface: &SurfaceMesh, hit: &Hit, n_geometric: Vec3) -> Vec3 {
        let [a, b, c] = self.corners(hit.id).map(|i| Vec3::from_array(surface.normals[i as usize]));
        let normal = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let normal = match hit.id.instance {
            NONE => normal,
            i => self.geometry.instances[i as usize].world_from_object.transform_normal(normal),
        };
        let normal = normal.normalize_or_zero();
        if normal == Vec3::ZERO {
            return n_geometric;
        }
        if normal.dot(n_geometric) < 0.0 { -normal } else { normal }
    }

    /// What texture coordinates add to a hit, with the geometric and the shading normal. Not inlined: what it
    /// returns in memory is small, and without it the rest of an interaction stays in registers.
    #[inline(never)]
    fn mapped(
        &self,
        surface: &SurfaceMesh,
        ray: &Ray,
        hit: &Hit,
        width: f32,
        [n_geometric, n_shading]: [Vec3; 2],
        material: MaterialId,
    ) -> Mapped {
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let ([a, b, c], _) = self.geometry.world_vertices(hit.id);
        let (ab, ac) = (b - a, c - a);
        let [uv_a, uv_b, uv_c] = self.corners(hit.id).map(|i| surface.uvs[i as usize]);
        let mix = |k: usize| weights[0] * uv_a[k] + weights[1] * uv_b[k] + weights[2] * uv_c[k];
        let (du1, dv1) = (uv_b[0] - uv_a[0], uv_b[1] - uv_a[1]);
        let (du2, dv2) = (uv_c[0] - uv_a[0], uv_c[1] - uv_a[1]);
        let uv_area = du1 * dv2 - dv1 * du2;
        let area = ab.cross(ac).length() as f32;
        // The cone's section on the surface, as if it were as wide as it is long.
        let cos_theta = (-ray.direction).dot(n_geometric).max(0.05);
        let footprint = width * (uv_area.abs() / area / cos_theta).sqrt();
        let mut mapped = Mapped { uv: [mix(0), mix(1)], footprint, n_shading };

        // dp/du and dp/dv span the tangent frame that normal maps are written in.
        if let (Some(normal), true) = (&self.material(material).normal, uv_area != 0.0) {
            let inverse = f64::from(1.0 / uv_area);
            let dp_du = (ab * f64::from(dv2) - ac * f64::from(dv1)) * inverse;
            let frame = Frame::from_normal_tangent(n_shading, dp_du.as_vec3());
            // Texture v runs along the bitangent, or against it where the mapping is mirrored.
            let dp_dv = (ac * f64::from(du1) - ab * f64::from(du2)) * inverse;
            let handedness = 1.0_f32.copysign(frame.bitangent.dot(dp_dv.as_vec3()));
            let normal = self.perturb(normal, &mapped, &frame, handedness);
            // A map that turns the normal below the triangle would show its back: stay on this side.
            if normal.dot(n_geometric) > 0.0 {
                mapped.n_shading = normal;
            }
        }
        mapped
    }

    /// The shading normal after a normal or bump map.
    fn perturb(&self, input: &NormalInput, at: &Mapped, frame: &Frame, handedness: f32) -> Vec3 {
        let local = match input {
            NormalInput::Map(texture) => {
                let rgb = lookup(&self.textures, texture, at.uv, at.footprint).0;
                Vec3::new(
                    2.0 * rgb.r - 1.0,
                    (2.0 * rgb.g - 1.0) * handedness,
                    (2.0 * rgb.b - 1.0).max(0.05),
                )
            }
            NormalInput::Bump { texture, strength } => {
                let (du, dv) = self.height_gradient(texture, at);
                Vec3::new(-strength * du, -strength * dv * handedness, 1.0)
            }
        };
        frame.world_from_local(local).normalize_or_zero()
    }

    /// Height differences per unit of texture coordinate, over half a texel or the footprint.
    fn height_gradient(&self, texture: &TextureReference, at: &Mapped) -> (f32, f32) {
        let map = &self.textures[texture.image.index()];
        let [width, height] = [map.image().width(), map.image().height()].map(|n| n as f32);
        let uv = [0, 1].map(|k| at.uv[k] * texture.scale[k] + texture.offset[k]);
        let footprint = at.footprint * texture.scale[0].abs().max(texture.scale[1].abs());
        let step = [(0.5 / width).max(0.5 * footprint), (0.5 / height).max(0.5 * footprint)];
        let sample = |du: f32, dv: f32| {
            map.lookup([uv[0] + du, uv[1] + dv], footprint, wrap_of(texture)).0.r
        };
        let du = (sample(step[0], 0.0) - sample(-step[0], 0.0)) / (2.0 * step[0]);
        let dv = (sample(0.0, step[1]) - sample(0.0, -step[1])) / (2.0 * step[1]);
        (du, dv)
    }
}

/// What texture coordinates add to a hit.
struct Mapped {
    uv: [f32; 2],
    /// Width of the ray's footprint in texture coordinates.
    footprint: f32,
    /// After a normal or bump map, if there is one.
    n_shading: Vec3,
}

/// Turns the normal as little as needed for it to face `wo`: an interpolated normal may point away near
/// silhouettes. Both are unit vectors.
#[inline(always)]
fn facing(normal: Vec3, wo: Vec3) -> Vec3 {
    const GRAZING: f32 = 1e-3;
    let cos_theta = normal.dot(wo);
    if cos_theta >= GRAZING {
        return normal;
    }
    (normal + wo * (GRAZING - cos_theta)).normalize()
}
