//! OBJ files to polygons, through `tobj`: the one file to replace when a faster parser is wanted.
//!
//! `tobj` parses the numbers, resolves relative indices and joins (vertex, uv, normal) triples to single
//! indices. Everything it does badly is kept from it by [`super::obj_filter`]: it never sees a line that it
//! would fail or panic on, a material, or a face whose corners lack an attribute that others of its group
//! have. It holds every position as `f64` until the end, and each group again: about 100 bytes a vertex.

use super::line_filter::Statements;
use super::obj_filter::ObjFilter;
use super::obj_scan::{Attributes, Scan};
use super::progress::Progress;
use crate::error::{Error, Result};
use std::path::Path;

/// Polygons with the same attributes, indexed: arrays are flat, as the parser leaves them.
#[derive(Debug)]
pub(super) struct PolygonGroup {
    /// Which arrays are filled.
    pub(super) attributes: Attributes,
    /// Number of polygons.
    pub(super) faces: usize,
    /// Three numbers a vertex.
    pub(super) positions: Vec<f64>,
    /// Two numbers a vertex, or empty.
    pub(super) uvs: Vec<f64>,
    /// Three numbers a vertex, or empty.
    pub(super) normals: Vec<f64>,
    /// The corners of all polygons.
    pub(super) corners: Vec<u32>,
    /// Corners of each polygon; empty when all have three.
    pub(super) arities: Vec<u32>,
}

/// A whole OBJ file.
#[derive(Debug)]
pub(super) struct ObjFile {
    /// Its polygons, in the order of the file.
    pub(super) groups: Vec<PolygonGroup>,
    /// Everything else.
    pub(super) scan: Scan,
}

/// Reads the file at `path`, as `progress` is told.
///
/// # Errors
/// When it cannot be read, or is not text.
pub(super) fn read_obj(path: &Path, progress: &Progress) -> Result<ObjFile> {
    let mut filter = ObjFilter::new(Statements::open_counted(path, progress)?);
    // Polygons as they are, one index for all attributes.
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    let loaded = tobj::load_obj_buf(&mut filter, &options, |_| Ok(Default::default()));
    let scan = filter.finish()?;
    let (models, _) = loaded
        .map_err(|e| Error::parse(path, 0, "", format!("the OBJ parser refuses this file: {e}")))?;
    let groups = scan.groups.iter().zip(models).map(|(group, model)| PolygonGroup {
        attributes: group.attributes,
        faces: group.faces,
        positions: model.mesh.positions,
        uvs: model.mesh.texcoords,
        normals: model.mesh.normals,
        corners: model.mesh.indices,
        arities: model.mesh.face_arities,
    });
    let groups = groups.collect();
    Ok(ObjFile { groups, scan })
}
