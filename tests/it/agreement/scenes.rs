//! What the backends are compared on: closed surfaces of all sizes and places, one in the other and twice in the
//! same place, generated models, instances, cut-outs, triangles that hardly are any, and real models where there are.

use crate::accel::sphere;
use crate::oracle::{soup, world};
use crate::support::effort;
use glint::accel::HitFilter;
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Geometry, Hit, Instance, Object, Ray, TriangleMesh};
use glint::load::load_scene;
use glint::math::{Affine, DAffine3, DMat3, DVec3, Vec3};
use glint::sampling::{CounterRng, warp};
use glint::world::World;
use std::path::Path;
use std::sync::Arc;

pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) geometry: Arc<Geometry>,
    /// Whether squares of its coordinates have room in an `f32`, and maps in an `f32` keep its detail. Where
    /// not, Embree may do as it likes.
    pub(crate) is_ordinary: bool,
}

/// Cuts squares out of every triangle that is marked as filtered.
pub(crate) struct Holes;

impl HitFilter for Holes {
    fn accept(&self, _: &Ray, candidate: &Hit) -> bool {
        let cell = |x: f32| (x * 5.0) as u32;
        (cell(candidate.u) + cell(candidate.v)) % 2 == 0
    }
}

type Maker = fn() -> Arc<Geometry>;

const ORDINARY: [(&str, Maker); 13] = [
    ("sphere", || world(vec![sphere(Vec3::ZERO, 1.0, 32, false)])),
    ("sphere far away", || world(vec![sphere(Vec3::new(1e4, -3e4, 2e4), 1.0, 32, false)])),
    ("spheres within spheres", nested),
    ("terrain", || world(vec![generated(Kind::Terrain)])),
    ("terrain 1e6 away", terrain_far_away),
    ("city", || world(vec![generated(Kind::City)])),
    ("sphereflake", || world(vec![generated(Kind::Sphereflake)])),
    ("foliage with holes", || {
        world(vec![TriangleMesh { filtered: true, ..generated(Kind::Foliage) }])
    }),
    ("hairball", || world(vec![generated(Kind::Hairball)])),
    ("ribbons", ribbons),
    ("hardly triangles", hardly_triangles),
    ("instances", instances),
    ("squeezed instance", || {
        placed_once(DMat3::from_diagonal(DVec3::new(1.0, 200.0, 1.0)), DVec3::new(0.0, 0.0, 0.1))
    }),
];

const EXTREME: [(&str, Maker); 3] = [
    ("sphere of 1e-12", || world(vec![sphere(Vec3::ZERO, 1e-12, 32, false)])),
    ("sphere of 1e30", || world(vec![sphere(Vec3::ZERO, 1e30, 32, false)])),
    ("instance far away", || placed_once(DMat3::IDENTITY, DVec3::new(1e5, 3e4, 0.1))),
];

/// A scan, a CAD part with sharp edges and large flat faces, and a model of quads.
const REAL: [&str; 3] = ["stanford-bunny", "rocker-arm", "beast"];

/// Calls `visit` with every scene, one after the other.
pub(crate) fn each(mut visit: impl FnMut(&Scene)) {
    for (scenes, is_ordinary) in [(&ORDINARY[..], true), (&EXTREME[..], false)] {
        for (name, make) in scenes {
            visit(&Scene { name: (*name).into(), geometry: make(), is_ordinary });
        }
    }
    real(visit);
}

/// The real models, where there are: in `GLINT_MODELS`, or beside the repository.
#[expect(clippy::print_stdout, reason = "whoever reads the table should know what is missing")]
fn real(mut visit: impl FnMut(&Scene)) {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/models");
    let folder = std::env::var_os("GLINT_MODELS").map_or(beside, Into::into);
    for name in REAL {
        let path = folder.join(name).join(format!("{name}.obj"));
        if !path.is_file() {
            println!("not compared, for it is not there: {}", path.display());
            continue;
        }
        let model = load_scene(&path).and_then(World::compile).expect("it loads");
        visit(&Scene { name: name.into(), geometry: model.geometry.clone(), is_ordinary: true });
    }
}

/// Spheres one in the other, the nearest two an ulp apart, and the outermost twice.
fn nested() -> Arc<Geometry> {
    let radii = [0.5, 1.0, 1.0 + f32::EPSILON, 2.0, 2.0];
    world(radii.map(|radius| sphere(Vec3::ZERO, radius, 24, false)).to_vec())
}

fn terrain_far_away() -> Arc<Geometry> {
    let terrain = generated(Kind::Terrain);
    let moved = |p: &[f32; 3]| [p[0] + 1e6, p[1] - 2e6, p[2] + 3e6];
    let positions = terrain.positions.iter().map(moved).collect();
    world(vec![TriangleMesh::new(positions, terrain.triangles.to_vec(), false)])
}

/// Strips a thousand times as long as wide, in every direction.
fn ribbons() -> Arc<Geometry> {
    let mut rng = CounterRng::new(0);
    let mut direction = move || warp::sphere([rng.unit(), rng.unit()]);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for _ in 0..500 {
        let (start, along) = (direction(), direction());
        let across = along.any_orthonormal_vector() * 0.001;
        for i in 0..=8_u32 {
            let n = positions.len() as u32;
            let middle = start + along * (i as f32 / 8.0);
            positions.extend([(middle - across).to_array(), (middle + across).to_array()]);
            if i > 0 {
                triangles.extend([[n - 2, n - 1, n], [n - 1, n + 1, n]]);
            }
        }
    }
    world(vec![TriangleMesh::new(positions, triangles, false)])
}

/// Points, lines, needles of every width, copies, and a wall behind them; corners on a coarse grid, so that much is
/// in line and edge-on.
fn hardly_triangles() -> Arc<Geometry> {
    let mut rng = CounterRng::new(0);
    let mut grid = |n: f32| Vec3::new(rng.unit(), rng.unit(), rng.unit()).map(|x| (x * n).floor());
    let mut corners = Vec::new();
    for i in 0..2000 {
        let (a, b, c) = (grid(8.0), grid(8.0), grid(8.0));
        let width = 10.0_f32.powi(-(i / 5 % 9));
        corners.extend(match i % 5 {
            0 => [a, a, a],
            1 => [a, b, (a + b) * 0.5],
            2 => [a, b, b + (c - b) * width],
            3 => [a, a + (b - a) * width, a + (c - a) * width],
            _ => [a, b, c],
        });
    }
    corners.extend_from_within(0..300);
    corners.extend([[-9.0, -9.0], [25.0, -9.0], [-9.0, 25.0]].map(|[x, y]| Vec3::new(x, y, 9.0)));
    soup(corners.iter().map(|p| p.to_array()).collect())
}

fn instances() -> Arc<Geometry> {
    let turn = DMat3::from_rotation_y(0.7) * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 0.5));
    let place = |i: u32| {
        let translation = DVec3::new(f64::from(i % 4), f64::from(i / 4), 0.3 * f64::from(i));
        let matrix3 = if i.is_multiple_of(3) { DMat3::IDENTITY } else { turn };
        Instance::new(i % 2, Affine::from_f64(&DAffine3 { matrix3, translation }))
    };
    // The last two in the same place.
    let maps = (0..12).chain([10]).map(place).collect();
    let leaves = sphere(Vec3::Z, 0.4, 12, true);
    Arc::new(Geometry {
        meshes: vec![sphere(Vec3::new(1.5, 1.5, 1.5), 5.0, 24, false)],
        objects: vec![
            Object { meshes: vec![sphere(Vec3::ZERO, 0.5, 24, false)] },
            Object { meshes: vec![sphere(Vec3::X, 0.5, 16, false), leaves] },
        ],
        instances: maps,
    })
}

fn placed_once(matrix3: DMat3, translation: DVec3) -> Arc<Geometry> {
    let map = DAffine3 { matrix3, translation };
    Arc::new(Geometry {
        objects: vec![Object { meshes: vec![sphere(Vec3::X, 0.5, 24, false)] }],
        instances: vec![Instance::new(0, Affine::from_f64(&map))],
        ..Geometry::default()
    })
}

/// The triangles of a generated model, read from its text without what loading does besides.
fn generated(kind: Kind) -> TriangleMesh {
    let mut text = Vec::new();
    let model = Model { kind, triangles: effort(20_000, 1_000_000) as u64, seed: 0 };
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
