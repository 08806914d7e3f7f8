//! Stands between an OBJ file and the parser: passes on clean geometry, keeps the rest for itself.
//!
//! The parser sees only statements that it cannot fail on: `v`, `vt`, `vn` with finite numbers (unusable
//! ones are replaced by zeros, so that the numbering holds), faces whose corners exist and agree in what
//! they have, and `g` between faces with different attributes, so that it never makes one up. What the
//! parser would lose is recorded here: the line and material of every face, and what was dropped and why.
//! The format is Wavefront's "Advanced Visualizer Manual", appendix B1. Must not build meshes.

use super::line_filter::{Statement, Statements, printable};
use super::obj_element::{Corner, Elements, List, parse_corner};
use super::warning_list::WarningList;
use crate::error::{Error, Location, Result};
use crate::scene::MaterialId;
use std::collections::HashMap;
use std::io::{BufRead, Read, Write};
use std::path::PathBuf;

/// Clean text made at a time, in bytes.
const OUTPUT_BYTES: usize = 1 << 15;

/// Faces after which the next `o` or `g` of the file ends a group of ours: bounds what the parser holds
/// in its wide form (about 100 bytes a face) where the file allows it.
const LARGE_GROUP: usize = 1 << 16;

/// Statements without effect on the picture, or on polygons.
const IGNORED: [&str; 31] = [
    "p",
    "l",
    "s",
    "mg",
    "vp",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "maplib",
    "usemap",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "bzp",
    "bsp",
    "cdc",
    "cdp",
    "res",
];

/// Which attributes the corners of a face have, all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Attributes {
    /// Texture coordinates.
    pub(super) uvs: bool,
    /// Normals.
    pub(super) normals: bool,
}

/// A face that was passed on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Line of the file.
    pub(super) line: u32,
    /// Index into [`Scan::materials`].
    pub(super) material: MaterialId,
}

/// Faces that follow each other and have the same attributes; the parser makes one model of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// What they all have.
    pub(super) attributes: Attributes,
    /// How many they are.
    pub(super) faces: usize,
}

/// A name that a file uses, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Named {
    /// The name; empty for faces without a material.
    pub(super) name: String,
    /// Line of its first use.
    pub(super) line: usize,
}

/// What the filter found besides geometry.
#[derive(Debug)]
pub(super) struct Scan {
    path: PathBuf,
    elements: [Elements; 3],
    /// First usable vertex.
    pub(super) first_vertex: Option<[f64; 3]>,
    /// Every face passed on, in order.
    pub(super) faces: Vec<Face>,
    /// The same faces in groups.
    pub(super) groups: Vec<Group>,
    /// Materials that faces use, in order of first use.
    pub(super) materials: Vec<Named>,
    material_ids: HashMap<String, MaterialId>,
    current_material: Named,
    current_id: Option<MaterialId>,
    /// Every distinct text behind `mtllib`.
    pub(super) libraries: Vec<Named>,
    /// Everything that was dropped or repaired.
    pub(super) warnings: WarningList,
    /// How many faces were dropped, and the first of them as an error.
    pub(super) dropped: usize,
    pub(super) first_dropped: Option<Error>,
    /// An `o` or `g` came after the last face.
    at_object_start: bool,
    corners: Vec<Corner>,
}

impl Scan {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            elements: Default::default(),
            first_vertex: None,
            faces: Vec::new(),
            groups: Vec::new(),
            materials: Vec::new(),
            material_ids: HashMap::new(),
            current_material: Named { name: String::new(), line: 0 },
            current_id: None,
            libraries: Vec::new(),
            warnings: WarningList::default(),
            dropped: 0,
            first_dropped: None,
            at_object_start: false,
            corners: Vec::new(),
        }
    }

    /// Takes note of a statement and appends to `output` what the parser shall see of it.
    fn accept(&mut self, statement: Statement<'_>, output: &mut Vec<u8>) {
        match statement.keyword() {
            "v" => self.element(List::Position, statement, output),
            "vt" => self.element(List::Uv, statement, output),
            "vn" => self.element(List::Normal, statement, output),
            "f" | "fo" => self.face(statement, output),
            "usemtl" => self.use_material(statement),
            "mtllib" => {
                let library = Named { name: statement.name().to_string(), line: statement.line };
                if !self.libraries.iter().any(|known| known.name == library.name) {
                    self.libraries.push(library);
                }
            }
            "o" | "g" => self.at_object_start = true,
            keyword if IGNORED.contains(&keyword) => {}
            "curv" | "curv2" | "surf" => self.warn("free-form surfaces", statement, |text| {
                format!("{text:?}: free-form curves and surfaces are not rendered, only polygons")
            }),
            _ => self.warn("unknown statements", statement, |text| {
                format!("{text:?} is not a statement of OBJ files; ignored")
            }),
        }
    }

    fn element(&mut self, list: List, statement: Statement<'_>, output: &mut Vec<u8>) {
        let numbers = statement.numbers();
        let parsed = list.parse(&mut numbers.split_whitespace());
        self.elements[list as usize].push(parsed.is_ok());
        let (keyword, used) = match list {
            List::Position => ("v", 3),
            List::Uv => ("vt", 2),
            List::Normal => ("vn", 3),
        };
        output.extend_from_slice(keyword.as_bytes());
        let words = parsed.is_ok().then(|| numbers.split_whitespace());
        let words = words.into_iter().flatten().chain(std::iter::repeat("0"));
        for word in words.take(used) {
            output.push(b' ');
            output.extend_from_slice(word.as_bytes());
        }
        output.push(b'\n');
        match parsed {
            Ok(position) if list == List::Position => {
                self.first_vertex.get_or_insert(position);
            }
            Ok(_) => {}
            Err(reason) => {
                let (kind, consequence) = match list {
                    List::Position => ("unusable vertices", "faces that use it are dropped"),
                    List::Uv => ("unusable texture coordinates", "faces that use it have none"),
                    List::Normal => ("unusable normals", "faces that use it have none"),
                };
                self.warn(kind, statement, |text| format!("{text:?}: {reason}; {consequence}"));
            }
        }
    }

    fn face(&mut self, statement: Statement<'_>, output: &mut Vec<u8>) {
        let words = statement.numbers();
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        match self.read_corners(words, &mut corners) {
            Err(reason) => self.drop_face(statement, &reason),
            Ok(()) => {
                let attributes = Attributes {
                    uvs: self.have_all(&corners, List::Uv, statement),
                    normals: self.have_all(&corners, List::Normal, statement),
                };
                self.count_in_group(attributes, output);
                let line = u32::try_from(statement.line).unwrap_or(u32::MAX);
                let material = self.material();
                self.faces.push(Face { line, material });
                write_face(&corners, attributes, words, output);
            }
        }
        self.corners = corners;
    }

    fn read_corners(
        &self,
        words: &str,
        corners: &mut Vec<Corner>,
    ) -> std::result::Result<(), String> {
        for word in words.split_whitespace() {
            let corner = parse_corner(word, &self.elements)?;
            if !self.elements[0].is_usable(corner[0]) {
                return Err(format!("vertex {} is unusable", corner[0]));
            }
            corners.push(corner);
        }
        if corners.len() < 3 { Err("a face needs three corners".to_string()) } else { Ok(()) }
    }

    /// Whether every corner has a usable element of `list`; warns when only some have.
    fn have_all(&mut self, corners: &[Corner], list: List, statement: Statement<'_>) -> bool {
        let elements = &self.elements[list as usize];
        let number = |corner: &Corner| corner[list as usize];
        let named = corners.iter().filter(|corner| number(corner) != 0).count();
        let usable = || corners.iter().all(|corner| elements.is_usable(number(corner)));
        if named == 0 || (named == corners.len() && usable()) {
            return named > 0;
        }
        let (kind, noun) = match list {
            List::Normal => ("faces without their normals", "normals"),
            _ => ("faces without their texture coordinates", "texture coordinates"),
        };
        self.warn(kind, statement, |text| {
            format!("{text:?}: not all of its {noun} can be used, so it gets none")
        });
        false
    }

    fn drop_face(&mut self, statement: Statement<'_>, reason: &str) {
        self.dropped += 1;
        self.first_dropped.get_or_insert_with(|| {
            Error::parse(&self.path, statement.line, printable(statement.text), reason)
        });
        self.warn("faces dropped", statement, |text| format!("{text:?}: {reason}; face dropped"));
    }

    /// Counts a face in the current group, or begins another for it.
    fn count_in_group(&mut self, attributes: Attributes, output: &mut Vec<u8>) {
        let may_end = std::mem::take(&mut self.at_object_start);
        match self.groups.last_mut() {
            Some(group)
                if group.attributes == attributes && !(may_end && group.faces >= LARGE_GROUP) =>
            {
                group.faces += 1;
            }
            _ => {
                output.extend_from_slice(b"g\n");
                self.groups.push(Group { attributes, faces: 1 });
            }
        }
    }

    fn use_material(&mut self, statement: Statement<'_>) {
        let name = statement.name();
        if name.is_empty() {
            self.warn("nameless materials", statement, |_| {
                "usemtl needs a name; the faces below get the default material".to_string()
            });
        }
        self.current_material = Named { name: name.to_string(), line: statement.line };
        self.current_id = None;
    }

    /// Index of the current material, which a face uses now.
    fn material(&mut self) -> MaterialId {
        if let Some(id) = self.current_id {
            return id;
        }
        let next = MaterialId(u32::try_from(self.materials.len()).unwrap_or(u32::MAX));
        let current = &self.current_material;
        let materials = &mut self.materials;
        let id = *self.material_ids.entry(current.name.clone()).or_insert_with(|| {
            materials.push(current.clone());
            next
        });
        self.current_id = Some(id);
        id
    }

    fn warn(
        &mut self,
        kind: &'static str,
        statement: Statement<'_>,
        message: impl FnOnce(&str) -> String,
    ) {
        let location = Location::new(&self.path, statement.line);
        self.warnings.add(kind, location, || {
            let start: String = statement.text.chars().take(60).collect();
            message(&start)
        });
    }
}

/// The face as the parser shall see it: as written when all that is written is used.
fn write_face(corners: &[Corner], attributes: Attributes, words: &str, output: &mut Vec<u8>) {
    output.push(b'f');
    let agrees =
        |[_, uv, n]: &Corner| (*uv != 0) == attributes.uvs && (*n != 0) == attributes.normals;
    if corners.iter().all(agrees) {
        output.push(b' ');
        output.extend_from_slice(words.as_bytes());
    } else {
        for [vertex, uv, normal] in corners {
            // Writing to a vector cannot fail.
            let _ = match (attributes.uvs, attributes.normals) {
                (true, true) => write!(output, " {vertex}/{uv}/{normal}"),
                (true, false) => write!(output, " {vertex}/{uv}"),
                (false, true) => write!(output, " {vertex}//{normal}"),
                (false, false) => write!(output, " {vertex}"),
            };
        }
    }
    output.push(b'\n');
}

/// The clean text of an OBJ file, to be read by the parser.
#[derive(Debug)]
pub(super) struct ObjFilter<R> {
    statements: Statements<R>,
    scan: Scan,
    output: Vec<u8>,
    consumed: usize,
    failure: Option<Error>,
}

impl<R: BufRead> ObjFilter<R> {
    /// Filters `statements`.
    pub(super) fn new(statements: Statements<R>) -> Self {
        let scan = Scan::new(statements.path().to_path_buf());
        Self { statements, scan, output: Vec::new(), consumed: 0, failure: None }
    }

    /// What was found, after everything was read.
    ///
    /// # Errors
    /// What kept the file from being read to its end.
    pub(super) fn finish(self) -> Result<Scan> {
        self.failure.map_or(Ok(self.scan), Err)
    }

    fn refill(&mut self) -> Result<()> {
        self.output.clear();
        self.consumed = 0;
        while self.output.len() < OUTPUT_BYTES {
            let Some(statement) = self.statements.next()? else { break };
            self.scan.accept(statement, &mut self.output);
        }
        Ok(())
    }
}

impl<R: BufRead> BufRead for ObjFilter<R> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.consumed == self.output.len()
            && let Err(error) = self.refill()
        {
            self.failure = Some(error);
            return Err(std::io::Error::other("see ObjFilter::finish"));
        }
        Ok(&self.output[self.consumed..])
    }

    fn consume(&mut self, amount: usize) {
        self.consumed += amount;
    }
}

impl<R: BufRead> Read for ObjFilter<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let available = self.fill_buf()?;
        let n = available.len().min(buffer.len());
        buffer[..n].copy_from_slice(&available[..n]);
        self.consume(n);
        Ok(n)
    }
}
