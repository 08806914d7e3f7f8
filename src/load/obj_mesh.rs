//! Polygons to [`MeshData`]: triangles in `f32` around the file's origin, one mesh for each set of attributes.
//!
//! Must not know where polygons come from, nor what their materials are.

use super::obj_polygon::{Cut, Triangulator};
use super::obj_read::PolygonGroup;
use super::obj_scan::{Attributes, Face};
use super::warning_list::WarningList;
use crate::error::{Error, Location, Result};
use crate::math::DVec3;
use crate::scene::MeshData;
use std::path::Path;

/// Significant bits of the largest coordinate of an origin. With 12 the origin is within 1/4096 of the
/// first vertex, and its own coordinates are exact even in `f32`.
const ORIGIN_BITS: i32 = 12;

/// The first vertex, rounded to the power-of-two grid whose step is 2^-11 of the power of two below its
/// largest coordinate.
///
/// A vertex minus this is exact in `f64` unless it is much nearer to zero than the origin is (there the
/// round-off is 2^-29 of the one of `f32`), so a stored position is the file's number rounded once.
pub(super) fn snapped_origin(first_vertex: DVec3) -> DVec3 {
    let largest = first_vertex.abs().max_element();
    if largest < f64::from(f32::MIN_POSITIVE) {
        return DVec3::ZERO;
    }
    // The exponent from the bits: no logarithm, and exact.
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    let step = 2.0_f64.powi(exponent + 1 - ORIGIN_BITS);
    // Division by a power of two is exact; the quotient is below 2^12 and rounded to an integer.
    (first_vertex / step).round() * step
}

/// Makes the meshes of `groups`, in the order in which their sets of attributes first appear; `faces` are
/// the faces of all groups. What is no proper surface is told to `warnings`.
///
/// # Errors
/// When a mesh has more vertices than 32 bits count.
pub(super) fn build_meshes(
    path: &Path,
    groups: Vec<PolygonGroup>,
    faces: &[Face],
    origin: DVec3,
    warnings: &mut WarningList,
) -> Result<Vec<MeshData>> {
    let mut meshes: Vec<(Attributes, MeshData)> = Vec::new();
    let mut surface = Surface::default();
    let mut faces = faces;
    for group in groups {
        let (group_faces, later) = faces.split_at(group.faces);
        faces = later;
        let known = meshes.iter().position(|(attributes, _)| *attributes == group.attributes);
        let index = known.unwrap_or_else(|| {
            meshes.push((group.attributes, MeshData { origin, ..MeshData::default() }));
            meshes.len() - 1
        });
        let mesh = &mut meshes[index].1;
        let first_vertex = append_vertices(mesh, &group).ok_or_else(|| {
            Error::Scene(format!("{}: a mesh has more than 2^32 vertices", path.display()))
        })?;
        surface.append(mesh, &group, group_faces, first_vertex);
    }
    surface.report(path, warnings);
    let mut meshes: Vec<MeshData> = meshes.into_iter().map(|(_, mesh)| mesh).collect();
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    Ok(meshes)
}

/// Appends the vertices of `group` and returns the index of the first; `None` when 32 bits cannot count them.
fn append_vertices(mesh: &mut MeshData, group: &PolygonGroup) -> Option<u32> {
    let first = u32::try_from(mesh.positions.len()).ok()?;
    u32::try_from(mesh.positions.len() + group.positions.len() / 3).ok()?;
    let origin = mesh.origin;
    mesh.positions.extend(triples(&group.positions).map(|p| (p - origin).as_vec3().to_array()));
    // The largest coordinate first, so that no square overflows or vanishes.
    let unit = |n: DVec3| (n / n.abs().max_element()).normalize();
    mesh.normals.extend(triples(&group.normals).map(|n| unit(n).as_vec3().to_array()));
    mesh.uvs.extend(group.uvs.chunks_exact(2).map(|uv| [uv[0] as f32, uv[1] as f32]));
    Some(first)
}

fn triples(numbers: &[f64]) -> impl Iterator<Item = DVec3> {
    numbers.chunks_exact(3).map(DVec3::from_slice)
}

/// Cuts polygons, and counts what is no proper surface.
#[derive(Debug, Default)]
struct Surface {
    cutter: Triangulator,
    corners: Vec<DVec3>,
    cut: Vec<[u32; 3]>,
    /// Triangles without area, and the line of the first.
    flat: usize,
    first_flat: u32,
    /// Polygons without a clear inside, and the line of the first.
    fans: usize,
    first_fan: u32,
}

impl Surface {
    /// Appends the triangles of `group`, whose vertices begin at `first_vertex`.
    fn append(
        &mut self,
        mesh: &mut MeshData,
        group: &PolygonGroup,
        faces: &[Face],
        first_vertex: u32,
    ) {
        let mut corners = group.corners.as_slice();
        for (i, face) in faces.iter().enumerate() {
            let arity = group.arities.get(i).map_or(3, |&n| n as usize);
            let (polygon, later) = corners.split_at(arity);
            corners = later;
            // Decide on the positions as they are stored: rounding may have moved or merged corners.
            let stored = |corner: u32| {
                let position = mesh.positions[(first_vertex + corner) as usize];
                DVec3::from_array(position.map(f64::from))
            };
            self.corners.clear();
            self.corners.extend(polygon.iter().map(|&corner| stored(corner)));
            self.cut.clear();
            if self.cutter.cut(&self.corners, &mut self.cut) == Cut::Fan {
                self.fans += 1;
                if self.fans == 1 {
                    self.first_fan = face.line;
                }
            }
            for triangle in &self.cut {
                let [a, b, c] = triangle.map(|k| self.corners[k as usize]);
                if (b - a).cross(c - a) == DVec3::ZERO {
                    self.flat += 1;
                    if self.flat == 1 {
                        self.first_flat = face.line;
                    }
                    continue;
                }
                mesh.triangles.push(triangle.map(|k| first_vertex + polygon[k as usize]));
                mesh.materials.push(face.material);
                mesh.lines.push(face.line);
            }
        }
    }

    fn report(&self, path: &Path, warnings: &mut WarningList) {
        let Self { flat, fans, .. } = self;
        if *flat > 0 {
            warnings.add("flat triangles", Location::new(path, self.first_flat as usize), || {
                format!("triangles without area left out: {flat}, the first of this line")
            });
        }
        if *fans > 0 {
            warnings.add("crossed polygons", Location::new(path, self.first_fan as usize), || {
                format!(
                    "polygons without a clear inside, cut as fans: {fans}, the first on this line"
                )
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_are_short_numbers_near_the_vertex() {
        for v in [
            DVec3::new(4_123_456.789, -512_345.678, 17.25),
            DVec3::new(-0.037_83, 0.127_94, 0.004_475),
            DVec3::new(1.0, 1.0, 1.0),
            DVec3::new(3e-20, 0.0, -1e-25),
            DVec3::new(5e17, 1.0, -4e17),
            DVec3::new(4095.9999, 0.0, 0.0),
        ] {
            let origin = snapped_origin(v);
            assert_eq!(origin.as_vec3().as_dvec3(), origin, "exact in f32");
            assert!((v - origin).abs().max_element() <= v.abs().max_element() / 4096.0);
            assert_eq!(snapped_origin(-v), -origin);
        }
        assert_eq!(snapped_origin(DVec3::ONE), DVec3::ONE);
        assert_eq!(snapped_origin(DVec3::ZERO), DVec3::ZERO);
        assert_eq!(snapped_origin(DVec3::splat(1e-310)), DVec3::ZERO);
    }

    #[test]
    fn georeferenced_vertices_keep_their_millimetres() {
        let first = DVec3::new(4_123_456.789, 512_345.678, 17.25);
        let origin = snapped_origin(first);
        for k in 0..1000 {
            let v = first + DVec3::splat(f64::from(k) * 0.0137);
            let stored = (v - origin).as_vec3().as_dvec3() + origin;
            assert!((stored - v).abs().max_element() < 1e-4, "{stored} for {v}");
        }
    }
}
