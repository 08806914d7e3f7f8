//! What the backends are judged on: closed surfaces of all sizes, generated models, instances; rays through nothing
//! in particular, and rays aimed at corners and edges.

use super::{placed, world};
use crate::accel::sphere;
use crate::support::effort;
use glint::accel::oracle::Oracle;
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Geometry, Instance, NONE, Object, PrimitiveId, Ray, TriangleMesh};
use glint::math::{Affine, DAffine3, DMat3, DVec3, Vec3};
use glint::sampling::CounterRng;
use std::sync::Arc;

pub(super) struct Scene {
    pub(super) name: String,
    pub(super) geometry: Arc<Geometry>,
    /// Whether squares of its coordinates have room in an `f32`, and maps in an `f32` keep its detail.
    pub(super) is_ordinary: bool,
}

const EXTREME: [&str; 3] = ["sphere of 1e-12", "sphere of 1e30", "placed far away"];

/// Every scene. The generated models have many more triangles in the full tier.
pub(super) fn all() -> Vec<Scene> {
    let mut scenes = Vec::new();
    let mut add = |name: &str, geometry: Arc<Geometry>| {
        let is_ordinary = !EXTREME.contains(&name);
        scenes.push(Scene { name: name.into(), geometry, is_ordinary });
    };
    let ball = |center: Vec3, radius: f32| world(vec![sphere(center, radius, 32, false)]);
    add("sphere", ball(Vec3::ZERO, 1.0));
    add("sphere far away", ball(Vec3::new(1e4, -3e4, 2e4), 1.0));
    add("sphere of 1e-12", ball(Vec3::ZERO, 1e-12));
    add("sphere of 1e30", ball(Vec3::ZERO, 1e30));
    for (name, kind) in Kind::ALL {
        add(name, world(vec![generated(kind, effort(20_000, 1_000_000) as u64)]));
    }
    let mut turned = placed(sphere(Vec3::Z, 0.5, 24, false), 0.7, 2.0);
    turned.meshes.push(sphere(Vec3::ZERO, 3.0, 24, false));
    add("instances", Arc::new(turned));
    // Squeezed two hundredfold, and placed so far away that `f32` has little left for it.
    let squeezed = DMat3::from_diagonal(DVec3::new(1.0, 200.0, 1.0));
    for (name, matrix3, x) in
        [("squeezed", squeezed, 0.0), ("placed far away", DMat3::IDENTITY, 1e5)]
    {
        let map = DAffine3 { matrix3, translation: DVec3::new(x, 0.3 * x, 0.1) };
        let geometry = Geometry {
            objects: vec![Object { meshes: vec![sphere(Vec3::X, 0.5, 24, false)] }],
            instances: vec![Instance::new(0, Affine::from_f64(&map))],
            ..Geometry::default()
        };
        add(name, Arc::new(geometry));
    }
    scenes
}

/// The triangles of a generated model, read from its text without what loading does besides.
fn generated(kind: Kind, triangles: u64) -> TriangleMesh {
    let mut text = Vec::new();
    let model = Model { kind, triangles, seed: 0 };
    write_obj(&model, "model.mtl", &mut text, &mut |_| Ok(())).expect("memory");
    let text = String::from_utf8(text).expect("text");
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let three = |word: fn(&str) -> f64| {
            let mut words = line.split_whitespace().skip(1).map(word);
            [0; 3].map(|_| words.next().expect("three words"))
        };
        if line.starts_with("v ") {
            positions.push(three(|w| w.parse().expect("a number")).map(|x| x as f32));
        } else if line.starts_with("f ") {
            let index = |w: &str| w.split('/').next().and_then(|i| i.parse().ok()).expect("index");
            triangles.push(three(index).map(|i| i as u32 - 1));
        }
    }
    TriangleMesh::new(positions, triangles, false)
}

/// `n` rays from anywhere in the scene's box to anywhere in it; `aimed` at corners, and at points of edges.
pub(super) fn rays(geometry: &Geometry, n: usize, aimed: bool) -> Vec<Ray> {
    let bounds = geometry.bounds();
    let mut rng = CounterRng::new(0);
    let mut unit = move || rng.unit();
    let mut rays = Vec::with_capacity(n);
    while rays.len() < n {
        let mut inside = || bounds.min + bounds.extent() * Vec3::new(unit(), unit(), unit());
        let (origin, mut target) = (inside(), inside());
        if aimed {
            let [a, b, _] = geometry.world_vertices(any(geometry, &mut unit)).0;
            let s = [0.0, 0.5, f64::from(unit())][rays.len() % 3];
            target = (a + (b - a) * s).as_vec3();
        }
        let direction = target - origin;
        if direction != Vec3::ZERO {
            rays.push(Ray { id: rays.len() as u32, ..Ray::new(origin, direction) });
        }
    }
    rays
}

/// Some triangle.
fn any(geometry: &Geometry, unit: &mut impl FnMut() -> f32) -> PrimitiveId {
    let mut below = |n: usize| (unit() * n as f32) as u32;
    let instance = below(geometry.instances.len() + geometry.meshes.len());
    let instance = if (instance as usize) < geometry.instances.len() { instance } else { NONE };
    let id = PrimitiveId { instance, geometry: 0, primitive: 0 };
    PrimitiveId { primitive: below(geometry.mesh(id).triangles.len()), ..id }
}

/// Every scene with its oracle, one after the other.
pub(super) fn each(mut judge: impl FnMut(&Scene, &Oracle)) {
    for scene in all() {
        let oracle = Oracle::build(scene.geometry.clone());
        judge(&scene, &oracle);
    }
}
