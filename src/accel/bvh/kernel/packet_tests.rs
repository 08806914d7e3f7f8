//! Packets against the same rays one at a time: the same children, the same triangles, the same distances, to the bit.

use super::{Avx512, Kernel, PacketKernel, Plain, Touched};
use crate::accel::bvh::block::{Block, Meshes, Numbers, SIZE, VERTICES};
use crate::accel::bvh::node::{Kind, Node, Reference, WIDTH};
use crate::accel::bvh::packet::{Packet, Packets, RAYS, is_coherent};
use crate::accel::bvh::slot::{Found, Slot};
use crate::geometry::{Aabb, NONE, Ray, TriangleMesh};
use crate::math::Vec3;
use crate::sampling::CounterRng;
use bytemuck::Zeroable;

const ROOT: Reference = Reference::new(Kind::Node, 0);

/// Rays from around one place to around another; nothing if they do not stay together.
fn rays(rng: &mut CounterRng, scale: f32, spread: f32) -> Option<[Ray; RAYS]> {
    let mut point = || Vec3::new(rng.unit(), rng.unit(), rng.unit()) * 2.0 - Vec3::ONE;
    let (from, to) = (point() * 3.0, point());
    let (along_an_axis, is_steep) = (point().x > 0.5, point().x > 0.5);
    let rays = std::array::from_fn(|i| {
        let origin = from + point() * spread * (i % 3) as f32;
        let mut towards = to + point() * spread - origin;
        if is_steep {
            // From ordinary to next to nothing, where products with large coordinates overflow.
            towards.y *= 10.0_f32.powi(-(i as i32));
            towards.z *= 10.0_f32.powi(i as i32 - 15);
        }
        let direction = if along_an_axis { Vec3::X.with_y(-0.0) } else { towards };
        let t_max = if i % 4 == 0 { 0.5 + 2.0 * point().y.abs() } else { f32::INFINITY };
        let direction = if scale < 1e15 { direction * scale } else { direction };
        Ray { t_min: 0.1 * (i % 2) as f32, t_max, ..Ray::new(origin * scale, direction) }
    });
    is_coherent(&rays).then_some(rays)
}

fn slot(ray: &Ray, size: f32) -> Box<Slot> {
    let mut slot = Box::new(Slot::zeroed());
    slot.prepare(ray.origin, ray.direction, size);
    slot.t_min = ray.t_min;
    slot.limit = if ray.t_max.is_finite() { ray.t_max.next_down() } else { f32::MAX };
    slot
}

/// Calls `check` with many packets: from rays side by side to such that merely point into the same octant.
fn every_packet(check: impl Fn(Avx512, &mut Packet, &[Ray; RAYS], f32, &mut CounterRng)) {
    let Some(kernel) = Avx512::detect() else { return };
    let mut packets = Packets::zeroed(1).expect("memory");
    let mut rng = CounterRng::new(0);
    let mut count = 0;
    for round in 0..6000 {
        let scale = 10.0_f32.powi(round % 41 - 10);
        let spread = [0.001, 0.03, 0.3][round as usize % 3];
        if let Some(rays) = rays(&mut rng, scale, spread) {
            packets[0].begin(kernel, &rays, 0, scale, ROOT);
            check(kernel, &mut packets[0], &rays, scale, &mut rng);
            count += 1;
        }
    }
    assert!(count > 2000, "{count}");
}

#[test]
fn a_packet_opens_to_what_its_rays_meet_one_by_one() {
    every_packet(|kernel, packet, rays, scale, rng| {
        let n = 1 + (rng.unit() * WIDTH as f32) as usize % WIDTH;
        let mut point =
            || (Vec3::new(rng.unit(), rng.unit(), rng.unit()) * 2.0 - Vec3::ONE) * scale;
        let boxes: Vec<_> = (0..n)
            .map(|_| {
                let (p, q) = (point(), point() * 0.4);
                Aabb { min: p.min(p + q), max: p.max(p + q) }
            })
            .collect();
        let node = Node::new(&boxes, n / 2, 64, Reference::new(Kind::Leaf, 100));
        // Some have ended.
        let active = (rng.unit() * 65536.0) as u16 | 1;
        for ordered in [false, true] {
            packet.top = 2;
            let top = match ordered {
                false => PacketKernel::open::<false>(kernel, packet, &node, active),
                true => PacketKernel::open::<true>(kernel, packet, &node, active),
            };
            for (i, ray) in rays.iter().enumerate() {
                let mut alone = slot(ray, scale);
                let end = Kernel::open::<true>(kernel, &mut alone, &node);
                let mut wanted: Vec<_> =
                    (0..end).map(|k| (alone.references[k], alone.entries[k])).collect();
                let mut found: Vec<_> = (2..top)
                    .map(|k| (packet.references[k], packet.entries[k][i]))
                    .filter(|(_, entry)| entry.is_finite())
                    .collect();
                if active >> i & 1 == 0 {
                    wanted.clear();
                }
                wanted.sort_by_key(|child| child.0);
                found.sort_by_key(|child| child.0);
                assert_eq!(found.len(), wanted.len());
                for (found, wanted) in found.iter().zip(&wanted) {
                    // The stack of one ray has the lowest bits for the order.
                    assert_eq!(found.0, wanted.0);
                    assert_eq!(found.1.to_bits() & !15, wanted.1.to_bits());
                }
            }
        }
    });
}

#[test]
fn a_packet_hits_what_its_rays_hit_one_by_one() {
    every_packet(|kernel, packet, rays, scale, rng| {
        let points = [(); VERTICES]
            .map(|()| (Vec3::new(rng.unit(), rng.unit(), rng.unit()) * 2.0 - Vec3::ONE) * scale);
        let n = 1 + (rng.unit() * SIZE as f32) as usize % SIZE;
        let mut corner = || (rng.unit() * VERTICES as f32) as u32 % VERTICES as u32;
        let triangles: Vec<_> = (0..n).map(|_| [corner(), corner(), corner()]).collect();
        let meshes = [TriangleMesh::new(points.map(|p| p.to_array()).to_vec(), triangles, false)];
        let numbers: Vec<u32> = (0..n as u32).collect();
        let block = Block::new(&Meshes::new(&meshes, &Numbers::new(&meshes)), &numbers, 0);
        let active = (rng.unit() * 65536.0) as u16 | 1;
        let mut touched = [Touched::default(); SIZE];
        let any = PacketKernel::inside(kernel, packet, &block, active, &mut touched);
        for (i, ray) in rays.iter().enumerate() {
            let alone = slot(ray, scale);
            let one = Plain.inside(&alone.shear, &block);
            for (lane, touched) in touched.iter().enumerate().take(n) {
                let is_active = u32::from(active >> i & 1);
                let found = (touched.inside >> i & 1, touched.unsure >> i & 1);
                let wanted = [one.inside, one.unsure].map(|mask| (mask >> lane & is_active) as u16);
                assert_eq!(found, (wanted[0], wanted[1]));
                assert_eq!(any >> lane & 1 != 0, touched.inside != 0);
                let all = PacketKernel::distances(kernel, packet, &block, lane);
                let distances = Plain.distances(&alone, &block);
                if found == (1, 0) {
                    assert_eq!(all.t[i].to_bits(), distances.t[lane].to_bits());
                    let within = (all.nearer | all.level) >> i & 1;
                    assert_eq!(u32::from(within), distances.within >> lane & 1);
                }
            }
        }
        let (t, before) = ([0.25; RAYS], packet.limit);
        let found = Found { leaf: Reference::new(Kind::Leaf, 7), lane: 3, instance: NONE };
        kernel.take::<false>(packet, &t, active, found);
        for (i, before) in before.into_iter().enumerate() {
            let is_taken = active >> i & 1 != 0;
            assert_eq!(packet.best(i) == found, is_taken);
            assert_eq!(packet.limit[i], if is_taken { 0.25 } else { before });
        }
    });
}
