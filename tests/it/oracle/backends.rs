//! The backends before the oracle: every answer to rays of many kinds, in closed, cluttered and instanced scenes.

use super::world;
use crate::accel::sphere;
use glint::accel::oracle::{Class, Judgement, Oracle};
use glint::accel::{Accelerator, AcceptAll, HitFilter};
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Geometry, Hit, Instance, Object, Ray, TriangleMesh};
use glint::math::{Affine, DAffine3, DMat3, DVec3, Vec3};
use glint::sampling::{CounterRng, warp};
use std::collections::BTreeMap;
use std::sync::Arc;

fn generated(kind: Kind, triangles: u64) -> TriangleMesh {
    let mut text = Vec::new();
    let model = Model { kind, triangles, seed: 0 };
    write_obj(&model, "model.mtl", &mut text, &mut |_| Ok(())).expect("memory");
    let text = String::from_utf8(text).expect("text");
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words = || line.split_whitespace().skip(1);
        if line.starts_with("v ") {
            let p: Vec<f32> = words().map(|w| w.parse().unwrap()).collect();
            positions.push([p[0], p[1], p[2]]);
        } else if line.starts_with("f ") {
            let index = |w: &str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
            let f: Vec<u32> = words().map(index).collect();
            triangles.push([f[0], f[1], f[2]]);
        }
    }
    TriangleMesh::new(positions, triangles, false)
}

fn rays(geometry: &Geometry, n: usize, aimed: bool) -> Vec<Ray> {
    let bounds = geometry.bounds();
    let mut rng = CounterRng::new(0);
    let mut unit = move || rng.unit();
    let meshes: Vec<_> = geometry.meshes.iter().collect();
    let mut rays = Vec::new();
    while rays.len() < n {
        let mut inside = || bounds.min + bounds.extent() * Vec3::new(unit(), unit(), unit());
        let (o, mut target) = (inside(), inside());
        if aimed {
            let mesh = meshes[(unit() * meshes.len() as f32) as usize];
            let c = mesh.vertices((unit() * mesh.triangles.len() as f32) as u32);
            let s = unit();
            target = match rays.len() % 3 {
                0 => c[0],
                1 => c[0] + (c[1] - c[0]) * s,
                _ => (c[1] + c[2]) * 0.5,
            };
        }
        let d = target - o;
        if d != Vec3::ZERO {
            rays.push(Ray { id: rays.len() as u32, ..Ray::new(o, d) });
        }
    }
    rays
}

fn judge<A: Accelerator, F: HitFilter>(
    name: &str,
    backend: &A,
    oracle: &Oracle,
    filter: &F,
    rays: &[Ray],
) {
    let mut hits = vec![Hit::MISS; rays.len()];
    backend.closest(rays, filter, &mut hits);
    let mut counts: BTreeMap<Class, usize> = BTreeMap::new();
    let (mut unlawful, mut ulps) = (0, 0.0_f64);
    let mut shown = 0;
    let start = std::time::Instant::now();
    for (ray, hit) in rays.iter().zip(&hits) {
        let j: Judgement = oracle.judge(ray, filter, hit.id);
        *counts.entry(j.class).or_default() += 1;
        if !j.is_lawful() {
            unlawful += 1;
            if shown < 5 {
                shown += 1;
                println!("   {ray:?} {:?} {j:?}", hit.id);
            }
        }
        if let Some(o) = j.outside { ulps = ulps.max(o.ratio()); }
        if let Some(o) = j.overlooked { ulps = ulps.max(o.edge.ratio()); }
    }
    println!("{name}: {counts:?}, unlawful {unlawful}, most {ulps:.3}, {:.2} us a ray", start.elapsed().as_secs_f64() * 1e6 / rays.len() as f64);
}

#[test]
fn explore() {
    let n: usize = std::env::var("N").map_or(20_000, |n| n.parse().unwrap());
    let t: u64 = std::env::var("T").map_or(100_000, |n| n.parse().unwrap());
    let mut scenes: Vec<(String, Arc<Geometry>)> = vec![
        ("sphere".into(), world(vec![sphere(Vec3::ZERO, 1.0, 64, false)])),
        ("far sphere".into(), world(vec![sphere(Vec3::new(1e4, -3e4, 2e4), 1.0, 64, false)])),
    ];
    for (name, kind) in Kind::ALL {
        scenes.push((name.into(), world(vec![generated(kind, t)])));
    }
    for (name, geometry) in scenes {
        let start = std::time::Instant::now();
        let oracle = Oracle::build(geometry.clone());
        println!("{name} built in {:.2} s", start.elapsed().as_secs_f64());
        for aimed in [false, true] {
            let rays = rays(&geometry, n, aimed);
            let bvh = glint::accel::bvh::Bvh::build(geometry.clone(), 1).unwrap();
            judge(&format!("{name} {aimed} bvh"), &bvh, &oracle, &AcceptAll, &rays);
            let embree = glint::accel::embree::EmbreeAccelerator::build(geometry.clone(), 1).unwrap();
            judge(&format!("{name} {aimed} embree"), &embree, &oracle, &AcceptAll, &rays);
        }
    }
    let turn = DMat3::from_cols(DVec3::new(0.6, 0.8, 0.0), DVec3::new(-0.8, 0.6, 0.0), DVec3::Z);
    let place = |linear: DMat3, x: f64| {
        let map = DAffine3 { matrix3: linear, translation: DVec3::new(x, 0.3, -0.2) };
        Instance::new(0, Affine::from_f64(&map))
    };
    let instanced = Arc::new(Geometry {
        objects: vec![Object { meshes: vec![sphere(Vec3::Z, 0.5, 24, false)] }],
        instances: vec![
            place(turn * 0.7, 2.0), place(turn, 0.0),
            place(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 0.5)), -2.0),
            place(turn*DMat3::from_diagonal(DVec3::new(1.0, 200.0, 0.5)), -2.0),
        ],
        ..Geometry::default()
    });
    let oracle = Oracle::build(instanced.clone());
    let mut aimed = rays(&instanced, n, false);
    for (i, ray) in aimed.iter_mut().enumerate() {
        let id = glint::geometry::PrimitiveId { instance: (i % 4) as u32, geometry: 0, primitive: (i / 4 % 1152) as u32 };
        let v = instanced.world_vertices(id).0;
        let target = if i % 3 == 0 { v[0] } else { (v[0] + v[1]) * 0.5 };
        ray.direction = (target - ray.origin.as_dvec3()).as_vec3();
    }
    for rays in [rays(&instanced, n, false), aimed] {
        let bvh = glint::accel::bvh::Bvh::build(instanced.clone(), 1).unwrap();
        judge("instanced bvh", &bvh, &oracle, &AcceptAll, &rays);
        let embree = glint::accel::embree::EmbreeAccelerator::build(instanced.clone(), 1).unwrap();
        judge("instanced embree", &embree, &oracle, &AcceptAll, &rays);
    }
}
