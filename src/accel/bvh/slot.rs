//! One ray on its way: what it is, where it is, what it has left for later.
//!
//! Knows references, not what they refer to.

use super::build::HALVE_FROM;
use super::hierarchy::Hierarchy;
use super::kernel::Inside;
use super::node::{Reference, WIDTH};
use super::ray::BoxRay;
use super::woop::Shear;
use crate::geometry::{Geometry, NONE, Ray};
use crate::math::{Vec3, Vec4};
use crate::os::Arena;
use bytemuck::Zeroable;
use std::alloc::{Layout, handle_alloc_error};
use std::hint::select_unpredictable;

/// References that a stack has room for, with what vectors are written beyond its top: both levels as deep as
/// the builder's limit on depth lets them be, with all but one child of every node left for later.
pub(super) const ROOM: usize = 2 * (HALVE_FROM as usize + 30) * (WIDTH - 1) + 5 + SPARE;

/// What vectors write beyond a stack's top.
pub(super) const SPARE: usize = WIDTH;

/// A ray in flight.
#[derive(Clone, Copy, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Slot {
    /// In the space in which it is: the world's or an object's. So is the shear.
    pub(super) boxes: BoxRay,
    pub(super) t_min: f32,
    /// The distance beyond which nothing is of interest; equal distances are.
    pub(super) limit: f32,
    /// What it does next.
    pub(super) next: Reference,
    /// Elements on its stack.
    pub(super) top: u32,
    pub(super) shear: Shear,
    /// In the space in which it is; the fourth elements are 0.
    pub(super) origin: [f32; 4],
    pub(super) direction: [f32; 4],
    /// Place in the batch.
    pub(super) ray: u32,
    /// That it is in, or none.
    pub(super) instance: u32,
    pub(super) best: Found,
    /// Of the triangles of the leaf that is next.
    pub(super) inside: Inside,
    /// What is left for later, and where the ray enters it: the nearest last.
    pub(super) references: [u32; ROOM],
    pub(super) entries: [f32; ROOM],
    /// An odd number of cache lines from slot to slot: they do not fall on the same places of the cache.
    unused: [u32; 3],
}

/// A triangle that the ray hits, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Zeroable)]
#[repr(C)]
pub(super) struct Found {
    pub(super) leaf: Reference,
    pub(super) lane: u32,
    pub(super) instance: u32,
}

impl Found {
    /// Nothing so far.
    pub(super) const NONE: Self = Self { leaf: Reference::NOTHING, lane: 0, instance: NONE };

    /// This one if `condition`, otherwise the other. Without a branch.
    #[inline(always)]
    pub(super) fn or(self, other: Self, condition: bool) -> Self {
        let select = |this, other| select_unpredictable(condition, this, other);
        Self {
            leaf: Reference(select(self.leaf.0, other.leaf.0)),
            lane: select(self.lane, other.lane),
            instance: select(self.instance, other.instance),
        }
    }

    /// Whether it is a triangle.
    #[inline(always)]
    pub(super) fn is_hit(self) -> bool {
        self.leaf != Reference::NOTHING
    }
}

const _: () = assert!(size_of::<Slot>() / 64 % 2 == 1);

/// Slots on huge pages.
pub(super) type Slots = Arena<Slot>;

/// That many slots. Without memory for them the program ends, as it does wherever memory that small is lacking.
#[cold]
pub(super) fn slots(count: usize) -> Slots {
    let missing = || handle_alloc_error(Layout::new::<Slot>());
    Arena::zeroed(count).unwrap_or_else(missing)
}

impl Slot {
    /// Takes the top off a stack of that height.
    #[inline(always)]
    pub(super) fn pop(&mut self, top: usize) -> Reference {
        // Never empty: the reference that ends it is at the bottom.
        let top = top - 1;
        self.top = top as u32;
        debug_assert!(top < ROOM);
        // SAFETY: `Bvh::build` refuses hierarchies of which a walk could leave more for later than there is room for.
        self.next = Reference(unsafe { *self.references.get_unchecked(top) });
        self.next
    }

    #[inline(always)]
    fn push(&mut self, reference: Reference) {
        let top = self.top as usize;
        self.references[top] = reference.0;
        // Never pruned.
        self.entries[top] = f32::NEG_INFINITY;
        self.top += 1;
    }

    /// Before any ray: done.
    pub(super) fn reset(&mut self) {
        (self.ray, self.best) = (u32::MAX, Found::NONE);
        self.next = Reference::DONE;
        self.top = 0;
        // At the bottom for good.
        self.push(Reference::DONE);
    }

    /// Begins with a ray, of that place in its batch; what it does first.
    #[inline(always)]
    pub(super) fn begin(&mut self, ray: &Ray, place: u32, hierarchy: &Hierarchy) {
        self.ray = place;
        self.best = Found::NONE;
        // Not -0, whose bits do not sort as a distance.
        self.t_min = ray.t_min + 0.0;
        // A hit at t_max does not count, one at the best so far does: the float before it, for a positive one.
        let before = f32::from_bits(ray.t_max.to_bits().wrapping_sub(1));
        self.limit = if ray.t_max > 0.0 { before } else { f32::NEG_INFINITY };
        self.in_world(ray, hierarchy);
        self.top = 1;
        let (origin, direction) = (Vec4::from(self.origin), Vec4::from(self.direction));
        // Infinities and what is not a number leave no zeros.
        let is_finite = (origin * 0.0 + direction * 0.0).cmpeq(Vec4::ZERO).all();
        if is_finite && direction.cmpne(Vec4::ZERO).any() {
            if let Some(root) = hierarchy.instances.root {
                self.push(root);
            }
            if let Some(root) = hierarchy.own.root {
                self.push(root);
            }
        }
    }

    /// Enters the object of an instance. The ray keeps its parameter: its direction is not normalised.
    #[inline(never)]
    pub(super) fn enter(
        &mut self,
        ray: &Ray,
        instance: u32,
        hierarchy: &Hierarchy,
        geometry: &Geometry,
    ) {
        let map = &hierarchy.object_from_world[instance as usize];
        let origin = map.transform_point3(ray.origin.as_dvec3()).as_vec3();
        let direction = map.transform_vector3(ray.direction.as_dvec3()).as_vec3();
        let tree = hierarchy.tree_of(geometry, instance);
        self.instance = instance;
        self.prepare(origin, direction, tree.size);
        self.push(Reference::LEAVE);
        if let Some(root) = tree.root {
            self.push(root);
        }
    }

    /// Back to the world.
    #[inline(never)]
    pub(super) fn leave(&mut self, ray: &Ray, hierarchy: &Hierarchy) {
        self.in_world(ray, hierarchy);
    }

    #[inline(always)]
    fn in_world(&mut self, ray: &Ray, hierarchy: &Hierarchy) {
        self.instance = NONE;
        self.prepare(ray.origin, ray.direction, hierarchy.world_size);
    }

    /// The ray's line in the space in which it is.
    pub(super) fn mapped(&self) -> Ray {
        let ([ox, oy, oz, _], [dx, dy, dz, _]) = (self.origin, self.direction);
        Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz))
    }

    /// For a tree whose largest coordinate is `size`.
    #[inline(always)]
    pub(super) fn prepare(&mut self, origin: Vec3, direction: Vec3, size: f32) {
        let (origin, direction) = (origin.extend(0.0), direction.extend(0.0));
        (self.origin, self.direction) = (origin.to_array(), direction.to_array());
        let size = origin.abs().max_element() + size;
        self.boxes = BoxRay::new(origin, direction, size);
        self.shear = Shear::new(&self.origin, &self.direction, size);
    }
}
