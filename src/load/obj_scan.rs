//! Takes an OBJ file apart, statement by statement: clean geometry goes on to the parser, the rest stays here.
//!
//! The parser sees only statements that it cannot fail on: `v`, `vt`, `vn` with finite numbers (unusable
//! ones are replaced by zeros, so that the numbering holds), faces whose corners exist and agree in what
//! they have, and `g` between faces with different attributes, so that it never makes one up. What the
//! parser would lose is recorded: the line and material of every face, and what was dropped and why.
//! The format is that of Wavefront's "Advanced Visualizer Manual", appendix B1. Must not build meshes.

use super::line_filter::{Statement, printable};
use super::obj_element::{Corner, Elements, List, parse_corner};
use super::warning_list::WarningList;
use crate::error::{Error, Location};
use crate::scene::MaterialId;
use std::collections::HashMap;
use std::io::Write;
use std::path::PathBuf;

/// Faces after which the next `o` or `g` of the file ends a group of ours: bounds what the parser holds
/// in its wide form (about 100 bytes a face) where the file allows it.
const LARGE_GROUP: usize = 1 << 16;

/// Statements without effect on the picture, or on polygons.
const IGNORED: &str = "p l s mg vp cstype deg bmat step parm trim hole scrv sp end con bevel c_interp \
    d_interp lod maplib usemap shadow_obj trace_obj ctech stech bzp bsp cdc cdp res";

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
    /// The name.
    pub(super) name: String,
    /// Line of its first use.
    pub(super) line: usize,
}

/// Names in the order of their first use, each once.
#[derive(Debug, Default)]
pub(super) struct Names {
    /// The names; the id of each is its index.
    pub(super) list: Vec<Named>,
    ids: HashMap<String, u32>,
}

impl Names {
    /// The id of `name`, which `line` uses.
    fn id(&mut self, name: &str, line: usize) -> u32 {
        if let Some(&id) = self.ids.get(name) {
            return id;
        }
        let id = u32::try_from(self.list.len()).unwrap_or(u32::MAX);
        self.ids.insert(name.to_string(), id);
        self.list.push(Named { name: name.to_string(), line });
        id
    }
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
    /// Materials that faces use; the empty name is no material.
    pub(super) materials: Names,
    /// What the last `usemtl` says, and its id once a face has used it.
    current_material: Named,
    current_id: Option<u32>,
    /// The texts behind `mtllib`.
    pub(super) libraries: Names,
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
    /// Nothing scanned yet of the file `path`.
    pub(super) fn new(path: PathBuf) -> Self {
        Self {
            path,
            elements: Default::default(),
            first_vertex: None,
            faces: Vec::new(),
            groups: Vec::new(),
            materials: Names::default(),
            current_material: Named { name: String::new(), line: 0 },
            current_id: None,
            libraries: Names::default(),
            warnings: WarningList::default(),
            dropped: 0,
            first_dropped: None,
            at_object_start: false,
            corners: Vec::new(),
        }
    }

    /// Takes note of a statement and appends to `output` what the parser shall see of it.
    pub(super) fn accept(&mut self, statement: Statement<'_>, output: &mut Vec<u8>) {
        match statement.keyword {
            "v" => self.element(List::Position, statement, output),
            "vt" => self.element(List::Uv, statement, output),
            "vn" => self.element(List::Normal, statement, output),
            "f" | "fo" => self.face(statement, output),
            "usemtl" => self.use_material(statement),
            "mtllib" => {
                self.libraries.id(statement.name(), statement.line);
            }
            "o" | "g" => self.at_object_start = true,
            keyword if IGNORED.split(' ').any(|ignored| ignored == keyword) => {}
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

    /// The current material, which a face uses now.
    fn material(&mut self) -> MaterialId {
        let Named { name, line } = &self.current_material;
        MaterialId(*self.current_id.get_or_insert_with(|| self.materials.id(name, *line)))
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
