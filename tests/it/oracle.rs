//! The exact oracle: against whole numbers and against planted errors. As the judge of the backends: `agreement`.

mod exhaustive;
mod noisy;
mod planted;
mod school;

use glint::geometry::{Geometry, Instance, Object, TriangleMesh};
use glint::math::{Affine, DAffine3, DMat3, DVec3};
use std::sync::Arc;

/// A world of these meshes alone.
pub(crate) fn world(meshes: Vec<TriangleMesh>) -> Arc<Geometry> {
    Arc::new(Geometry { meshes, ..Geometry::default() })
}

/// Every three positions a triangle.
pub(crate) fn soup(positions: Vec<[f32; 3]>) -> Arc<Geometry> {
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    world(vec![TriangleMesh::new(positions, triangles.collect(), false)])
}

/// Two instances of a mesh: turned, stretched and as large as `scale`, around 0; and the same as it is, at `shift`.
fn placed(mesh: TriangleMesh, scale: f64, shift: f64) -> Geometry {
    let turn = DMat3::from_cols(
        DVec3::new(0.6, 0.8, 0.0),
        DVec3::new(-0.8, 0.6, 0.0),
        DVec3::new(0.0, 0.0, 1.0),
    );
    let stretch = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 0.5) * scale);
    let place = |matrix3: DMat3, x: f64| {
        let map = DAffine3 { matrix3, translation: DVec3::new(x, 0.0, 0.0) };
        Instance::new(0, Affine::from_f64(&map))
    };
    Geometry {
        objects: vec![Object { meshes: vec![mesh] }],
        instances: vec![place(turn * stretch, 0.0), place(DMat3::IDENTITY, shift)],
        ..Geometry::default()
    }
}
