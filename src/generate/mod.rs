//! Procedural models of any size, streamed as OBJ text: what large scenes are tested and timed with.
//!
//! The same request gives the same bytes on every machine. No mesh is held in memory, so that the disk is
//! the only limit. Must not know files: it writes to any [`Write`], and the caller names them.

mod city;
mod foliage;
mod hairball;
mod materials;
mod obj_writer;
mod shapes;
mod sphereflake;
mod terrain;

use obj_writer::ObjWriter;
use std::io::{self, Write};

/// What can be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Mountains: a height field, triangles of similar size.
    Terrain,
    /// Houses with thousands of emissive windows.
    City,
    /// Spheres on spheres: detail of every size, smooth normals.
    Sphereflake,
    /// Trees with cut-out leaves.
    Foliage,
    /// Long thin triangles in every direction.
    Hairball,
}

impl Kind {
    /// Every kind with its name.
    pub const ALL: [(&'static str, Self); 5] = [
        ("terrain", Self::Terrain),
        ("city", Self::City),
        ("sphereflake", Self::Sphereflake),
        ("foliage", Self::Foliage),
        ("hairball", Self::Hairball),
    ];

    /// Whether its materials need the image [`cut_out`].
    pub fn has_cut_out(self) -> bool {
        self == Self::Foliage
    }
}

/// The fewest triangles of a model: with less, most kinds have no shape.
pub const FEWEST_TRIANGLES: u64 = 2000;

/// A model to generate.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// What it shows.
    pub kind: Kind,
    /// How many triangles it has, exactly; at least [`FEWEST_TRIANGLES`].
    pub triangles: u64,
    /// Models with different seeds differ.
    pub seed: u64,
}

/// How much was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Triangles.
    pub triangles: u64,
    /// Positions.
    pub vertices: u64,
    /// Bytes of text.
    pub bytes: u64,
}

/// Told now and then how many triangles are written; an error ends the work.
pub type Progress<'a> = &'a mut dyn FnMut(u64) -> io::Result<()>;

/// Writes the OBJ text of `model`, which names the material library `library`.
///
/// # Errors
/// When `out` or `progress` fails, or the model has fewer triangles than [`FEWEST_TRIANGLES`].
pub fn write_obj(
    model: &Model,
    library: &str,
    out: &mut dyn Write,
    progress: Progress<'_>,
) -> io::Result<Written> {
    if model.triangles < FEWEST_TRIANGLES {
        let reason = format!("a model has at least {FEWEST_TRIANGLES} triangles");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    }
    let name = Kind::ALL.iter().find(|(_, kind)| *kind == model.kind).map_or("", |(name, _)| name);
    let comment =
        format!("glint generate {name} --triangles {} --seed {}", model.triangles, model.seed);
    let mut obj = ObjWriter::new(out, progress, &comment, library);
    match model.kind {
        Kind::Terrain => terrain::write(&mut obj, model)?,
        Kind::City => city::write(&mut obj, model)?,
        Kind::Sphereflake => sphereflake::write(&mut obj, model)?,
        Kind::Foliage => foliage::write(&mut obj, model)?,
        Kind::Hairball => hairball::write(&mut obj, model)?,
    }
    obj.finish()
}

/// The MTL text of models of this kind, which names the image `cut_out` if [`Kind::has_cut_out`].
pub fn material_library(kind: Kind, cut_out: &str) -> String {
    materials::library(kind, cut_out)
}

/// The opacity of leaves: grey texels, row-major with the top row first, and the side of the square.
pub fn cut_out() -> (Vec<[u8; 1]>, u32) {
    (foliage::leaf_shape(), foliage::SHAPE_SIDE)
}
