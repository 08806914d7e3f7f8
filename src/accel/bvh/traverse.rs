//! Rays through the hierarchy, one after the other.
//!
//! A box is entered if the ray meets it after it has been made wider by more than all rounding errors of the box
//! test and of the triangle test behind it: a triangle that the edge test would accept is never missed.

use super::collapse::MAX_DEPTH;
use super::wide::{Child, WIDTH, WideNode};
use super::woop::Shear;
use super::{Bvh, MeshBvh};
use crate::accel::{HitFilter, resolve};
use crate::geometry::{Hit, NONE, PrimitiveId, Ray};
use crate::math::Vec3;
use crate::os::Kernel;

/// A batch of closest-hit queries, compiled for each instruction set.
pub(super) struct Closest<'a, F> {
    pub(super) bvh: &'a Bvh,
    pub(super) rays: &'a [Ray],
    pub(super) filter: &'a F,
    pub(super) hits: &'a mut [Hit],
}

impl<F: HitFilter> Kernel for Closest<'_, F> {
    #[inline(always)]
    fn run(self) {
        let mut stacks = Stacks::new();
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            let mut query = Query::new(self.bvh, ray, self.filter, false);
            query.run(&mut stacks);
            *hit = query.best;
        }
    }
}

/// A batch of any-hit queries.
pub(super) struct Occluded<'a, F> {
    pub(super) bvh: &'a Bvh,
    pub(super) rays: &'a [Ray],
    pub(super) filter: &'a F,
    pub(super) blocked: &'a mut [bool],
}

impl<F: HitFilter> Kernel for Occluded<'_, F> {
    #[inline(always)]
    fn run(self) {
        let mut stacks = Stacks::new();
        for (ray, blocked) in self.rays.iter().zip(self.blocked) {
            let mut query = Query::new(self.bvh, ray, self.filter, true);
            query.run(&mut stacks);
            *blocked = query.best.is_hit();
        }
    }
}

/// What is still to be visited: for the world or the instances, and for the object inside an instance.
struct Stacks {
    outer: Stack,
    inner: Stack,
}

impl Stacks {
    fn new() -> Self {
        let empty = [(0.0, Child::node(0)); STACK];
        Self { outer: empty, inner: empty }
    }
}

/// Children with the distance at which the ray enters them.
type Stack = [(f32, Child); STACK];

/// Each level leaves at most all but one of its children behind.
const STACK: usize = MAX_DEPTH * (WIDTH - 1) + WIDTH;

/// One ray's search.
struct Query<'a, F> {
    bvh: &'a Bvh,
    ray: &'a Ray,
    filter: &'a F,
    /// Whether the first hit is enough.
    any: bool,
    best: Hit,
}

impl<'a, F: HitFilter> Query<'a, F> {
    #[inline(always)]
    fn new(bvh: &'a Bvh, ray: &'a Ray, filter: &'a F, any: bool) -> Self {
        Self { bvh, ray, filter, any, best: Hit::MISS }
    }

    #[inline(always)]
    fn run(&mut self, stacks: &mut Stacks) {
        let bvh = self.bvh;
        let slabs = Slabs::new(self.ray, self.ray.origin, self.ray.direction);
        let shear = Shear::new(self.ray.origin, self.ray.direction);
        self.search(&bvh.own, &slabs, &shear, NONE, &mut stacks.inner);
        if bvh.instances.nodes.is_empty() || self.is_done() {
            return;
        }
        let mut search = Search::begin(&bvh.instances.nodes, &slabs, &mut stacks.outer);
        while let Some(leaf) = search.next_leaf(self.limit()) {
            let instance = bvh.instances.order[leaf as usize];
            self.enter(instance, &mut stacks.inner);
            if self.is_done() {
                return;
            }
        }
    }

    /// Searches the object of an instance. The ray keeps its parameter: its direction is not normalised.
    #[inline(always)]
    fn enter(&mut self, instance: u32, stack: &mut Stack) {
        let bvh = self.bvh;
        let object_from_world = &bvh.instances.object_from_world[instance as usize];
        let origin = object_from_world.transform_point3(self.ray.origin.as_dvec3()).as_vec3();
        let direction =
            object_from_world.transform_vector3(self.ray.direction.as_dvec3()).as_vec3();
        let slabs = Slabs::new(self.ray, origin, direction);
        let shear = Shear::new(origin, direction);
        let object = bvh.geometry.instances[instance as usize].object;
        self.search(&bvh.objects[object as usize], &slabs, &shear, instance, stack);
    }

    /// Searches the triangles of some meshes.
    #[inline(always)]
    fn search(
        &mut self,
        meshes: &MeshBvh,
        slabs: &Slabs,
        shear: &Shear,
        instance: u32,
        stack: &mut Stack,
    ) {
        if meshes.nodes.is_empty() {
            return;
        }
        let mut search = Search::begin(&meshes.nodes, slabs, stack);
        while let Some(leaf) = search.next_leaf(self.limit()) {
            let block = meshes.blocks.block(leaf);
            let mut inside = shear.inside(block);
            while inside != 0 {
                let lane = inside.trailing_zeros() as usize;
                inside &= inside - 1;
                self.consider(meshes.blocks.id(block, lane, instance));
            }
            if self.is_done() {
                return;
            }
        }
    }

    /// Takes a triangle whose edges the ray is inside, if it is nearer than the best so far. Not inlined: it is
    /// called about twice a ray.
    #[inline(never)]
    fn consider(&mut self, id: PrimitiveId) {
        let geometry = &self.bvh.geometry;
        let hit = resolve(geometry, self.ray, id);
        let within = hit.t > self.ray.t_min && hit.t < self.ray.t_max;
        let nearer = hit.t < self.best.t || (hit.t == self.best.t && id < self.best.id);
        if within && nearer && (!geometry.mesh(id).filtered || self.filter.accept(self.ray, &hit)) {
            self.best = hit;
        }
    }

    /// The distance beyond which nothing is of interest; equal distances are.
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.best.t.min(self.ray.t_max)
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        self.any && self.best.is_hit()
    }
}

/// A walk through nodes, nearest first, from leaf to leaf.
struct Search<'a> {
    nodes: &'a [WideNode],
    slabs: &'a Slabs,
    stack: &'a mut Stack,
    len: usize,
}

impl<'a> Search<'a> {
    #[inline(always)]
    fn begin(nodes: &'a [WideNode], slabs: &'a Slabs, stack: &'a mut Stack) -> Self {
        stack[0] = (0.0, Child::node(0));
        Self { nodes, slabs, stack, len: 1 }
    }

    /// The next leaf that the ray enters at `limit` or before.
    #[inline(always)]
    fn next_leaf(&mut self, limit: f32) -> Option<u32> {
        while self.len > 0 {
            self.len -= 1;
            let (entry, child) = self.stack[self.len];
            if entry > limit {
                continue;
            }
            match child.as_leaf() {
                Some(leaf) => return Some(leaf),
                None => self.open(&self.nodes[child.0 as usize], limit),
            }
        }
        None
    }

    /// Pushes the children that the ray meets, the nearest last.
    #[inline(always)]
    fn open(&mut self, node: &WideNode, limit: f32) {
        let (entries, mut met) = self.slabs.meet(node, limit);
        let bottom = self.len;
        while met != 0 {
            let i = met.trailing_zeros() as usize;
            met &= met - 1;
            // Insertion: few children are met, and often only one.
            let mut place = self.len;
            while place > bottom && self.stack[place - 1].0 < entries[i] {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = (entries[i], node.children[i]);
            self.len += 1;
        }
    }
}

/// A ray prepared for boxes.
struct Slabs {
    /// Reciprocal of the direction.
    reciprocal: [f32; 3],
    origin: [f32; 3],
    /// How much each axis' entry is early and exit is late, as a factor of the reciprocal.
    margin: [f32; 3],
    t_min: f32,
}

/// 16 units of round-off. A plane's distance (plane - origin) * reciprocal is off by at most 3 round-offs of
/// (|plane| + |origin|) * |reciprocal|, and the edge test displaces a corner by at most 5 of them; the sum is
/// doubled.
const MARGIN: f32 = 16.0 * crate::math::UNIT_ROUNDOFF;

impl Slabs {
    #[inline(always)]
    fn new(ray: &Ray, origin: Vec3, direction: Vec3) -> Self {
        // Finite even along an axis: the products below must not be 0 times infinity.
        const SMALLEST: f32 = 1e-18;
        let reciprocal = |d: f32| 1.0 / if d.abs() < SMALLEST { SMALLEST.copysign(d) } else { d };
        let reciprocal = direction.to_array().map(reciprocal);
        // The shear mixes the axes: the largest coordinate of all counts.
        let size = origin.abs().max_element();
        let margin = reciprocal.map(|r| r.abs() * size * MARGIN);
        Self { reciprocal, origin: origin.to_array(), margin, t_min: ray.t_min }
    }

    /// Where the ray enters each child, and a bit for each child that it meets up to `limit`.
    #[inline(always)]
    fn meet(&self, node: &WideNode, limit: f32) -> ([f32; WIDTH], u32) {
        let mut entries = [self.t_min; WIDTH];
        let mut exits = [limit; WIDTH];
        for axis in 0..3 {
            let (lower, upper) = (&node.planes[axis], &node.planes[3 + axis]);
            let is_negative = self.reciprocal[axis] < 0.0;
            let (near, far) = if is_negative { (upper, lower) } else { (lower, upper) };
            let (r, o, margin) = (self.reciprocal[axis], self.origin[axis], self.margin[axis]);
            let per_plane = r.abs() * MARGIN;
            for i in 0..WIDTH {
                let entry = (near[i] - o) * r - (margin + near[i].abs() * per_plane);
                let exit = (far[i] - o) * r + (margin + far[i].abs() * per_plane);
                entries[i] = if entry > entries[i] { entry } else { entries[i] };
                exits[i] = if exit < exits[i] { exit } else { exits[i] };
            }
        }
        let mut met = 0;
        for i in 0..WIDTH {
            met |= u32::from(entries[i] <= exits[i]) << i;
        }
        (entries, met & node.present)
    }
}
