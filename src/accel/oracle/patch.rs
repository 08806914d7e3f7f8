//! The triangles around a ray, and where a surface is closed there, so that something must be hit.
//!
//! Rounding moves corners, and all triangles at a corner with it: a surface bends, but it does not tear. Take
//! the triangles that share edges within the band (`band`) of the ray. If each of those edges is shared by an even
//! number of them, no edge at which the surface ends comes near the ray. Then the number of its triangles
//! over the ray, modulo two, stays what it is however corners move in the band, and where it is odd at least
//! one of them is hit: an inner edge or corner of a mesh cannot leak. At a silhouette two triangles share an edge
//! and lie on the same side of it: even, and so both may be missed; at the rim of a mesh an edge has only
//! one triangle.

use super::band::{EdgeDistance, KernelRay};
use super::crossing::Crossing;
use super::placed::MeshTree;
use super::triple::Exact;
use super::walk::Line;
use super::{Oracle, is_regular};
use crate::accel::{HitFilter, resolve};
use crate::geometry::{Hit, NONE, PrimitiveId, Ray};
use crate::math::Vec3;
use std::cmp::Ordering;

/// A triangle that the line of a ray meets, or passes within the band.
pub(super) struct Near {
    pub(super) id: PrimitiveId,
    /// How it meets it.
    pub(super) crossing: Option<Crossing>,
    /// Distance from the edge that is nearest, as the band goes.
    pub(super) edge: EdgeDistance,
    /// Where a backend that reports it says that it is.
    pub(super) hit: Hit,
    /// Whether a backend that finds it has to consider it: it is within the interval and accepted.
    pub(super) counts: bool,
    /// Which of the patches it belongs to.
    pub(super) patch: usize,
}

/// Triangles connected by edges within the band.
#[derive(Clone, Copy, Default)]
pub(super) struct Patch {
    /// An odd number of triangles is over the ray; unknown if it is open.
    pub(super) is_odd: bool,
    /// One of the edges is shared by an odd number of triangles.
    pub(super) is_open: bool,
}

/// All that is around a ray.
pub(super) struct Surroundings {
    pub(super) near: Vec<Near>,
    pub(super) patches: Vec<Patch>,
}

/// An edge within the band: instance and the bits of its ends, the smaller one first. By value, not by
/// index: meshes have corners more than once, where texture coordinates differ.
type EdgeKey = (u32, [[u32; 3]; 2]);

impl Oracle {
    /// Everything along the line of `ray`, before its origin too.
    pub(super) fn surroundings<F: HitFilter>(&self, ray: &Ray, filter: &F) -> Surroundings {
        let mut near = Vec::new();
        let mut edges = Vec::new();
        if is_regular(ray) {
            let mut walk = |meshes: &MeshTree, kernel: &KernelRay, instance: u32| {
                let line = Line::new(kernel.origin, kernel.direction);
                let visit = |triangle| {
                    let (geometry, primitive) = meshes.locate(triangle);
                    let id = PrimitiveId { instance, geometry, primitive };
                    let index = near.len();
                    near.extend(self.near(ray, filter, kernel, id, index, &mut edges));
                    f64::INFINITY
                };
                let range = [f64::NEG_INFINITY, f64::INFINITY];
                line.walk(&meshes.tree, range, |bounds| kernel.padded(bounds), visit);
            };
            walk(&self.own, &KernelRay::in_world(ray), NONE);
            // One by one: the world boxes of instances have no room for their bands.
            for (placement, instance) in self.placements.iter().zip(0..) {
                let Some(placement) = placement else { continue };
                let meshes = &self.objects[placement.object as usize];
                walk(meshes, &KernelRay::in_object(ray, placement), instance);
            }
        }
        let patches = connect(ray, self, &mut near, edges);
        Surroundings { near, patches }
    }

    /// The triangle if it is met or in the band, its edges in the band added to `edges` under `index`.
    fn near<F: HitFilter>(
        &self,
        ray: &Ray,
        filter: &F,
        kernel: &KernelRay,
        id: PrimitiveId,
        index: usize,
        edges: &mut Vec<(EdgeKey, usize)>,
    ) -> Option<Near> {
        let corners = self.geometry.mesh(id).vertices(id.primitive);
        let distances = kernel.edge_distances(corners);
        let crossing = self.cross(ray, id);
        let in_band = distances.iter().any(EdgeDistance::is_in_band);
        if crossing.is_none() && !in_band {
            return None;
        }
        let [a, b, c] = corners.map(bits);
        for (distance, [p, q]) in distances.iter().zip([[b, c], [c, a], [a, b]]) {
            if distance.is_in_band() {
                edges.push(((id.instance, [p.min(q), p.max(q)]), index));
            }
        }
        let hit = resolve(&self.geometry, ray, id);
        let is_within = hit.t > ray.t_min && hit.t < ray.t_max;
        let counts = is_within && self.accepts(ray, filter, id);
        Some(Near { id, crossing, edge: nearest_edge(distances), hit, counts, patch: index })
    }

    /// How far a ray passes from the edges of a triangle; of several, from that which excuses most.
    pub(super) fn edge_distance(&self, ray: &Ray, id: PrimitiveId) -> Option<EdgeDistance> {
        let corners = self.geometry.mesh(id).vertices(id.primitive);
        let kernel = match self.placements.get(id.instance as usize) {
            Some(placement) => KernelRay::in_object(ray, placement.as_ref()?),
            None => KernelRay::in_world(ray),
        };
        Some(nearest_edge(kernel.edge_distances(corners)))
    }
}

fn nearest_edge(distances: [EdgeDistance; 3]) -> EdgeDistance {
    let [a, b, c] = distances;
    let nearer = |p: EdgeDistance, q: EdgeDistance| if q.ratio() < p.ratio() { q } else { p };
    nearer(nearer(a, b), c)
}

/// The bits of a corner, the same for 0 and -0.
fn bits(corner: Vec3) -> [u32; 3] {
    (corner + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// Finds the patches: gives every triangle its own, and joins those that share an edge.
fn connect(
    ray: &Ray,
    oracle: &Oracle,
    near: &mut [Near],
    mut edges: Vec<(EdgeKey, usize)>,
) -> Vec<Patch> {
    // Each triangle points to an earlier one of its patch; the first one to itself.
    let mut parents: Vec<usize> = (0..near.len()).collect();
    edges.sort_unstable();
    let shared = || edges.chunk_by(|a, b| a.0 == b.0);
    for sharing in shared() {
        let first = sharing[0].1;
        for &(_, other) in &sharing[1..] {
            let (p, q) = (root(&mut parents, first), root(&mut parents, other));
            parents[p.max(q)] = p.min(q);
        }
    }
    let mut patches = vec![Patch::default(); near.len()];
    for sharing in shared() {
        patches[root(&mut parents, sharing[0].1)].is_open |= sharing.len() % 2 == 1;
    }
    for (i, near) in near.iter_mut().enumerate() {
        near.patch = root(&mut parents, i);
        let patch = &mut patches[near.patch];
        // Of an open patch no one asks.
        if !patch.is_open {
            let vertices = oracle.geometry.world_vertices(near.id).0;
            patch.is_odd ^= is_over(&Exact::new(ray, &vertices));
        }
    }
    patches
}

/// The first triangle of a patch; makes the way there shorter for next time.
fn root(parents: &mut [usize], mut i: usize) -> usize {
    while parents[i] != i {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    i
}

/// Whether the line passes through the triangle, where of two triangles that share an edge and lie on both sides of
/// it exactly one is said to be passed through on the edge itself, and so on for corners: seen along the line,
/// an odd number of edges crosses the positive x axis, the axis itself counted to what lies below.
fn is_over(triangle: &Exact) -> bool {
    let z = (0..3).find(|&k| triangle.direction[k].sign().is_ne()).unwrap_or(0);
    let [a, b, c] = triangle.project([(z + 1) % 3, (z + 2) % 3, z]);
    let crosses = |[px, py]: &[_; 2], [qx, qy]: &[_; 2]| {
        let (p_above, q_above) = (is_positive(py), is_positive(qy));
        // The axis is crossed at (px qy - qx py) / (qy - py); the denominator has the sign of what is above.
        let numerator = (&(px * qy) - &(qx * py)).sign();
        let positive = if q_above { Ordering::Greater } else { Ordering::Less };
        p_above != q_above && numerator == positive
    };
    crosses(&a, &b) ^ crosses(&b, &c) ^ crosses(&c, &a)
}

fn is_positive(x: &super::dyadic::Dyadic) -> bool {
    x.sign().is_gt()
}
