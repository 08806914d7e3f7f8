//! Boxes of triangles, by all threads.

use super::primitive::PrimitiveBox;
use crate::geometry::{Aabb, TriangleMesh};
use rayon::prelude::*;

/// Triangles that one thread handles at a time.
const CHUNK: usize = 8192;

/// Boxes of all triangles, which are numbered through. What is not finite has no box; the others keep their
/// numbers. There are fewer than 2^30 triangles.
pub(in super::super) fn boxes(meshes: &[TriangleMesh]) -> Vec<PrimitiveBox> {
    let total = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut boxes: Vec<PrimitiveBox> = bytemuck::zeroed_vec(total);
    let mut rest = &mut boxes[..];
    let mut next = 0;
    let mut jobs = Vec::with_capacity(total / CHUNK + meshes.len());
    for mesh in meshes {
        for start in (0..mesh.triangles.len()).step_by(CHUNK) {
            let end = mesh.triangles.len().min(start + CHUNK);
            let (places, behind) = rest.split_at_mut(end - start);
            rest = behind;
            jobs.push((mesh, start as u32, next, places));
            next += (end - start) as u32;
        }
    }
    let all_finite = jobs.into_par_iter().map(fill).reduce(|| true, |a, b| a & b);
    if !all_finite {
        boxes.retain(|b| !b.is_missing());
    }
    boxes
}

/// A mesh, its first triangle, the number of that among all, and the places for the boxes.
type Job<'a> = (&'a TriangleMesh, u32, u32, &'a mut [PrimitiveBox]);

/// Fills in the boxes of some triangles; says whether all have one.
fn fill((mesh, start, first, places): Job<'_>) -> bool {
    let mut all_finite = true;
    for (place, i) in places.iter_mut().zip(0..) {
        let corners = mesh.vertices(start + i);
        let is_finite = corners.iter().all(|p| p.is_finite());
        let [a, b, c] = corners;
        let bounds = Aabb { min: a.min(b).min(c), max: a.max(b).max(c) };
        *place =
            if is_finite { PrimitiveBox::new(&bounds, first + i) } else { PrimitiveBox::MISSING };
        all_finite &= is_finite;
    }
    all_finite
}
