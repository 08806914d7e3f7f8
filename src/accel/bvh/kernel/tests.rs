//! Every kernel that the machine has, against exact or slow answers, and all against each other.

#[cfg(target_arch = "x86_64")]
use super::{Avx2, Avx512};
use super::{Kernel, Plain};
use crate::accel::bvh::block::{Block, Meshes, Numbers, SIZE, VERTICES};
use crate::accel::bvh::node::{Kind, Node, Reference, WIDTH};
use crate::accel::bvh::slot::Slot;
use crate::geometry::{Aabb, Ray, TriangleMesh, intersect_triangle};
use crate::math::Vec3;
use crate::sampling::CounterRng;
use bytemuck::Zeroable;

/// A test with some kernel.
trait Check {
    fn check<K: Kernel>(&mut self, kernel: K);
}

fn every_kernel(mut check: impl Check) {
    check.check(Plain);
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(kernel) = Avx2::detect() {
            check.check(kernel);
        }
        if let Some(kernel) = Avx512::detect() {
            check.check(kernel);
        }
    }
}

fn slot(ray: &Ray, size: f32) -> Box<Slot> {
    let mut slot = Box::new(Slot::zeroed());
    slot.prepare(ray.origin, ray.direction, size);
    (slot.t_min, slot.limit, slot.top) = (ray.t_min, ray.t_max, 3);
    slot
}

struct Rng(CounterRng);

impl Rng {
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.0.unit(), self.0.unit(), self.0.unit()) * 2.0 - Vec3::ONE
    }

    /// One in four runs along an axis, up or down.
    fn ray(&mut self, scale: f32) -> Ray {
        let (origin, target) = (self.point() * 2.0 * scale, self.point() * scale);
        let mut direction = (target - origin).normalize();
        if self.0.unit() < 0.25 {
            direction = Vec3::X.with_y(-0.0) * direction.x.signum();
        }
        let t_max = if self.0.unit() < 0.5 { f32::INFINITY } else { self.0.unit() * 4.0 * scale };
        Ray { t_max, ..Ray::new(origin, direction) }
    }

    fn boxes(&mut self, scale: f32) -> Vec<Aabb> {
        let n = 1 + (self.0.unit() * WIDTH as f32) as usize;
        let mut one = || {
            let (p, q) = (self.point() * scale, self.point() * 0.8 * scale);
            Aabb { min: p.min(p + q), max: p.max(p + q) }
        };
        (0..n.min(WIDTH)).map(|_| one()).collect()
    }
}

/// Where a ray is in a box, in `f64`; nothing if it misses it.
fn entry(ray: &Ray, bounds: &Aabb) -> Option<f64> {
    let (mut enter, mut leave) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for axis in 0..3 {
        let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
        let planes = [bounds.min[axis], bounds.max[axis]].map(|p| f64::from(p) - o);
        if d == 0.0 {
            if planes[0] > 0.0 || planes[1] < 0.0 {
                return None;
            }
            continue;
        }
        let t = planes.map(|p| p / d);
        (enter, leave) = (enter.max(t[0].min(t[1])), leave.min(t[0].max(t[1])));
    }
    (enter <= leave).then_some(enter)
}

/// All boxes that the ray meets are pushed, none that it misses by more than a grid's cell, nearest last.
struct Opens;

impl Check for Opens {
    fn check<K: Kernel>(&mut self, kernel: K) {
        let mut rng = Rng(CounterRng::new(0));
        let (mut met, mut pushed) = (0, 0);
        for round in 0..4000 {
            let scale = 10.0_f32.powi(round % 21 - 10);
            let boxes = rng.boxes(scale);
            let node = Node::new(&boxes, boxes.len() / 2, 64, Reference::new(Kind::Leaf, 100));
            let ray = rng.ray(scale);
            let hit = |i: &usize| entry(&ray, &boxes[*i]).is_some();
            let wanted: Vec<_> = (0..boxes.len()).filter(hit).collect();
            for ordered in [false, true] {
                let mut slot = slot(&ray, 2.0 * scale);
                let top = match ordered {
                    false => kernel.open::<false>(&mut slot, &node),
                    true => kernel.open::<true>(&mut slot, &node),
                };
                let found: Vec<_> = (3..top)
                    .map(|k| (0..WIDTH).find(|&i| node.child(i).0 == slot.references[k]))
                    .collect();
                assert!(wanted.iter().all(|&i| found.contains(&Some(i))), "{round}");
                let room = Vec3::splat(scale / 50.0);
                for &i in &found {
                    let bounds = boxes[i.expect("a child of the node")];
                    let wider = Aabb { min: bounds.min - room, max: bounds.max + room };
                    assert!(entry(&ray, &wider).is_some(), "{round} {i:?}");
                }
                if ordered {
                    let entries = &slot.entries[3..top];
                    assert!(entries.is_sorted_by(|a, b| a >= b), "{round}: {entries:?}");
                    // No later than where the box begins.
                    for (&i, &at) in found.iter().zip(entries) {
                        let exact = i.and_then(|i| entry(&ray, &boxes[i]));
                        assert!(exact.is_none_or(|exact| f64::from(at) <= exact), "{round}");
                    }
                }
                pushed += found.len();
                met += wanted.len();
            }
        }
        // The grid costs little.
        assert!(met > 2000 && pushed as f64 <= 1.1 * met as f64, "{met} {pushed}");
    }
}

#[test]
fn a_node_opens_to_the_children_that_are_met() {
    every_kernel(Opens);
}

fn block(corners: &[[Vec3; 3]]) -> Block {
    let positions = corners.iter().flatten().map(|p| p.to_array()).collect();
    let triangles: Vec<u32> = (0..corners.len() as u32).collect();
    let indices = triangles.iter().map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let meshes = [TriangleMesh::new(positions, indices, false)];
    Block::new(&Meshes::new(&meshes, &Numbers::new(&meshes)), &triangles, 0)
}

/// The same triangles as in the other kernels, at the distances of the routine that makes the hit.
#[derive(Default)]
struct Triangles {
    first: Option<Vec<(u32, u32)>>,
}

impl Check for Triangles {
    fn check<K: Kernel>(&mut self, kernel: K) {
        let mut rng = Rng(CounterRng::new(1));
        let mut answers = Vec::new();
        let mut counts = [0, 0];
        for round in 0..4000 {
            let scale = 10.0_f32.powi(round % 61 - 30);
            let n = 1 + round as usize % SIZE;
            // Each between three of nine points, so that every vertex has its turn in every corner.
            let points = [(); VERTICES].map(|()| rng.point() * scale);
            let mut below = |n: usize| (rng.0.unit() * n as f32) as usize;
            let mut three = || {
                let (first, step) = (below(VERTICES), 1 + below(VERTICES - 1));
                [0, 1, 2].map(|i| points[(first + i * step) % VERTICES])
            };
            let corners: Vec<_> = (0..n).map(|_| three()).collect();
            let block = block(&corners);
            let mut ray = rng.ray(scale);
            if round % 3 == 0 {
                // Through a corner or an edge.
                let target = corners[0][0].lerp(corners[0][1], (round % 2) as f32 * 0.3);
                ray.direction = target - ray.origin;
            }
            let slot = slot(&ray, 2.0 * scale);
            let inside = kernel.inside(&slot.shear, &block);
            answers.push((inside.inside, inside.unsure));
            let distances = kernel.distances(&slot, &block);
            for lane in 0..SIZE {
                let is_inside = inside.inside >> lane & 1 != 0;
                // What is near an edge is to be asked again: more than is inside, and seldom.
                let with_exact_products = lane < n && slot.shear.is_inside(&block, lane);
                assert!(is_inside || !with_exact_products, "{round} {lane}");
                let is_sure = is_inside && inside.unsure >> lane & 1 == 0;
                assert!(!is_sure || with_exact_products, "{round} {lane}");
                // At ordinary scales, and not aimed at an edge.
                if round % 3 != 0 && (20..40).contains(&(round % 61)) {
                    counts[usize::from(is_sure)] += usize::from(is_inside);
                }
                let triangle = corners[if lane < n { lane } else { 0 }].map(Vec3::as_dvec3);
                let t = intersect_triangle(&Ray { t_min: f32::MIN, ..ray }, &triangle).t;
                if is_sure {
                    assert_eq!(distances.t[lane].to_bits(), t.to_bits(), "{round} {lane}");
                    let within = t > ray.t_min && t <= ray.t_max;
                    assert_eq!(distances.within >> lane & 1 != 0, within, "{round} {lane}");
                }
            }
        }
        let hits = answers.iter().filter(|(inside, _)| *inside != 0).count();
        assert!(hits > 500 && 100 * counts[0] < counts[1], "{hits} {counts:?}");
        assert_eq!(self.first.get_or_insert_with(|| answers.clone()), &answers);
    }
}

#[test]
fn triangles_are_the_same_in_every_kernel() {
    every_kernel(Triangles::default());
}

/// Exactly on an edge counts for both of its triangles, whichever way they are wound; edge-on counts for none.
struct Edges;

impl Check for Edges {
    fn check<K: Kernel>(&mut self, kernel: K) {
        let corner = |x: f32, y: f32| Vec3::new(x, y, 5.0);
        let (a, b, c, d) = (corner(0., 0.), corner(4., 0.), corner(0., 4.), corner(-4., 0.));
        let block = block(&[[a, b, c], [a, c, d], [c, a, d], [a, a + Vec3::Z, c + Vec3::Z]]);
        let slot = slot(&Ray::new(Vec3::new(0.0, 1.0, 0.0), Vec3::Z), 8.0);
        let inside = kernel.inside(&slot.shear, &block);
        assert_eq!((inside.inside, inside.unsure), (15, 15));
        assert_eq!(
            [0, 1, 2, 3].map(|i| slot.shear.is_inside(&block, i)),
            [true, true, true, false]
        );
    }
}

#[test]
fn edges_belong_to_both_sides() {
    every_kernel(Edges);
}

/// What is entered beyond the limit goes, the rest keeps its order.
struct Prunes;

impl Check for Prunes {
    fn check<K: Kernel>(&mut self, kernel: K) {
        let mut rng = CounterRng::new(2);
        for top in 0..70 {
            let mut slot = slot(&Ray::new(Vec3::ZERO, Vec3::X), 1.0);
            slot.limit = 0.5;
            slot.top = top;
            for k in 0..top as usize {
                slot.references[k] = k as u32;
                slot.entries[k] = if k % 7 == 0 { f32::NEG_INFINITY } else { rng.unit() };
            }
            slot.entries[top as usize / 2] = 0.5;
            let before = slot.entries;
            let kept = kernel.prune(&mut slot);
            let wanted: Vec<_> = (0..top).filter(|&k| before[k as usize] <= 0.5).collect();
            assert_eq!(&slot.references[..kept], wanted);
            for (entry, &k) in slot.entries.iter().zip(&wanted) {
                assert_eq!(*entry, before[k as usize]);
            }
        }
    }
}

#[test]
fn stacks_are_pruned() {
    every_kernel(Prunes);
}
