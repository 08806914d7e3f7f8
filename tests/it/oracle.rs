//! The exact oracle: against rationals, against planted errors, and as the judge of the backends.

mod backends;

use glint::geometry::{Geometry, TriangleMesh};
use std::sync::Arc;

/// A world of these meshes alone.
fn world(meshes: Vec<TriangleMesh>) -> Arc<Geometry> {
    Arc::new(Geometry { meshes, ..Geometry::default() })
}
