//! A slow OBJ parser that is plain to see right, to judge the loader by.
//!
//! Holds the whole file and copies what it needs; shares no code with the loader. Its rules, in words: a
//! face is kept when it has three corners or more and each names a vertex above it that has three finite
//! numbers; it has texture coordinates (normals) when every corner names one that can be used.

#![expect(clippy::unwrap_used, reason = "a test may unwrap, and so may its helpers")]

use glint::load::LoadedModel;
use glint::math::DVec3;

/// One corner of a face, by value.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    pub(crate) position: DVec3,
    pub(crate) uv: Option<[f64; 2]>,
    pub(crate) normal: Option<DVec3>,
}

/// A face that can be rendered.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) line: u32,
    /// As `usemtl` names it; "default" without.
    pub(crate) material: String,
    pub(crate) corners: Vec<Corner>,
}

impl Face {
    /// Whether no three of its corners span an area.
    pub(crate) fn is_flat(&self) -> bool {
        let outline: Vec<DVec3> = self.corners.iter().map(|corner| corner.position).collect();
        triples(&outline).all(|triple| area(&triple) == DVec3::ZERO)
    }
}

/// The faces of the text of an OBJ file.
pub(crate) fn parse(bytes: &[u8]) -> Vec<Face> {
    let (mut positions, mut uvs, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    let mut material = "default".to_string();
    let mut faces = Vec::new();
    for (line, statement) in statements(bytes) {
        let mut words = statement.split_whitespace();
        let keyword = words.next().unwrap();
        let rest = statement[keyword.len()..].trim();
        // Numbers end where a word begins with '#'.
        let words: Vec<&str> = words.take_while(|word| !word.starts_with('#')).collect();
        match keyword {
            "v" => {
                positions.push(finite(&words, 3, 3).filter(|v| v.iter().all(|x| x.abs() < 5e17)))
            }
            "vt" => uvs.push(finite(&words, 1, 2).filter(|v| v.iter().all(|x| x.abs() < 3e38))),
            "vn" => normals.push(finite(&words, 3, 3).filter(|v| v.iter().any(|x| *x != 0.0))),
            "usemtl" => material = material_name(rest),
            "f" | "fo" => {
                let corner = |word: &&str| -> Option<Corner> {
                    let mut parts: Vec<&str> = word.split('/').collect();
                    if parts.len() > 3 {
                        return None;
                    }
                    parts.resize(3, "");
                    let position = named(parts[0], &positions)??.clone()?;
                    let uv = named(parts[1], &uvs)?.cloned().flatten();
                    let normal = named(parts[2], &normals)?.cloned().flatten();
                    Some(Corner {
                        position: DVec3::from_slice(&position),
                        uv: uv.map(|uv: Vec<f64>| [uv[0], uv.get(1).copied().unwrap_or(0.0)]),
                        normal: normal.map(|n: Vec<f64>| DVec3::from_slice(&n)),
                    })
                };
                let corners: Option<Vec<Corner>> = words.iter().map(corner).collect();
                let Some(mut corners) = corners.filter(|corners| corners.len() >= 3) else {
                    continue;
                };
                let has_uvs = corners.iter().all(|c| c.uv.is_some());
                let has_normals = corners.iter().all(|c| c.normal.is_some());
                for corner in &mut corners {
                    corner.uv = corner.uv.filter(|_| has_uvs);
                    corner.normal = corner.normal.filter(|_| has_normals);
                }
                faces.push(Face { line, material: material.clone(), corners });
            }
            _ => {}
        }
    }
    faces
}

/// The element that an index names: `None` for a broken reference, `Some(None)` for none at all.
fn named<'a, T>(index: &str, list: &'a [T]) -> Option<Option<&'a T>> {
    if index.is_empty() {
        return Some(None);
    }
    match index.parse::<i64>().ok()? {
        i if i > 0 => list.get(usize::try_from(i).unwrap() - 1).map(Some),
        i if i < 0 && i.unsigned_abs() <= list.len() as u64 => {
            Some(Some(&list[list.len() - usize::try_from(i.unsigned_abs()).unwrap()]))
        }
        _ => None,
    }
}

/// The first `most` words as finite numbers, of which there must be `least`.
fn finite(words: &[&str], least: usize, most: usize) -> Option<Vec<f64>> {
    let words = &words[..words.len().min(most)];
    let numbers: Option<Vec<f64>> =
        words.iter().map(|w| w.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    numbers.filter(|numbers| numbers.len() >= least)
}

/// A name ends before a '#' that stands between blanks.
fn material_name(rest: &str) -> String {
    let characters: Vec<char> = format!(" {rest} ").chars().collect();
    let is_comment = |w: &[char]| w[0].is_whitespace() && w[1] == '#' && w[2].is_whitespace();
    let end = characters.windows(3).position(is_comment).unwrap_or(characters.len());
    let name = characters[..end].iter().collect::<String>().trim().to_string();
    if name.is_empty() { "default".to_string() } else { name }
}

/// The statements with the lines they begin on.
fn statements(bytes: &[u8]) -> Vec<(u32, String)> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    // Latin-1 makes one character of each byte; what is UTF-8 is made so again at the end.
    let text: String = bytes.iter().map(|&b| char::from(b)).collect();
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let mut found = Vec::new();
    let mut lines = text.split('\n').enumerate();
    while let Some((i, line)) = lines.next() {
        let mut statement = line.to_string();
        let is_comment = statement.trim_ascii_start().starts_with('#');
        while !is_comment && statement.trim_ascii_end().ends_with('\\') {
            statement.truncate(statement.trim_ascii_end().len() - 1);
            match lines.next() {
                Some((_, next)) => statement = statement + " " + next,
                None => break,
            }
        }
        let bytes: Vec<u8> = statement.chars().map(|c| c as u8).collect();
        let statement = String::from_utf8(bytes).unwrap_or(statement).trim().to_string();
        if !is_comment && !statement.is_empty() {
            found.push((u32::try_from(i + 1).unwrap(), statement));
        }
    }
    found
}

/// Asserts that `loaded` has exactly the surface of `faces`: every face's triangles with its line,
/// material and attributes, and nothing else.
pub(crate) fn assert_same(loaded: &LoadedModel, faces: &[Face], name: &str) {
    let has = |face: &Face| (face.corners[0].uv.is_some(), face.corners[0].normal.is_some());
    let mut triangles_seen = 0;
    for attributes in [(false, false), (false, true), (true, false), (true, true)] {
        let faces = faces.iter().filter(|face| has(face) == attributes);
        let meshes = &loaded.model.meshes;
        let mesh = meshes.iter().find(|m| (!m.uvs.is_empty(), !m.normals.is_empty()) == attributes);
        let lines = mesh.map_or(&[][..], |mesh| &mesh.lines);
        let mut next = 0;
        for face in faces {
            let here = next..next + lines[next..].iter().take_while(|&&l| l == face.line).count();
            next = here.end;
            assert!(
                here.len() <= face.corners.len() - 2,
                "{name}:{}: too many triangles",
                face.line
            );
            let origin = mesh.map_or(DVec3::ZERO, |mesh| mesh.origin);
            let stored = |corner: &Corner| (corner.position - origin).as_vec3();
            let mut covered = DVec3::ZERO;
            for t in here.clone() {
                let mesh = mesh.unwrap();
                let id = mesh.materials[t];
                assert_eq!(
                    loaded.materials[id.index()].name,
                    face.material,
                    "{name}:{}",
                    face.line
                );
                let corners = mesh.triangles[t].map(|i| {
                    let position = mesh.positions[i as usize];
                    let matches = |corner: &&Corner| {
                        let i = i as usize;
                        stored(corner).to_array() == position
                            && corner.uv.is_none_or(|uv| mesh.uvs[i] == uv.map(|x| x as f32))
                            && corner.normal.is_none_or(|n| same_direction(n, mesh.normals[i]))
                    };
                    let is_corner = face.corners.iter().any(|corner| matches(&corner));
                    assert!(is_corner, "{name}:{}: {position:?} is not a corner", face.line);
                    DVec3::from_array(position.map(f64::from))
                });
                covered += area(&corners);
            }
            // However a polygon is cut, the area vectors of the triangles add up to its own.
            let outline: Vec<DVec3> = face.corners.iter().map(|c| stored(c).as_dvec3()).collect();
            let size = outline.iter().map(|p| (*p - outline[0]).length()).fold(0.0, f64::max);
            let error = (covered - area(&outline)).length();
            assert!(error <= 1e-12 * size * size, "{name}:{}: not covered", face.line);
            // Three corners on a line may make a triangle without area, which is left out.
            if triples(&outline).all(|triple| area(&triple) != DVec3::ZERO) {
                assert_eq!(here.len(), outline.len() - 2, "{name}:{}: triangles", face.line);
            }
        }
        assert_eq!(next, lines.len(), "{name}: triangles that no face explains");
        triangles_seen += lines.len();
    }
    let total: usize = loaded.model.meshes.iter().map(|m| m.triangles.len()).sum();
    assert_eq!(triangles_seen, total, "{name}: two meshes with the same attributes");
}

fn same_direction(expected: DVec3, stored: [f32; 3]) -> bool {
    let stored = DVec3::from_array(stored.map(f64::from));
    let scaled = expected / expected.abs().max_element();
    (stored - scaled / scaled.length()).length() < 1e-6
}

/// Area vector of a closed outline (twice the area, along the normal).
fn area(outline: &[DVec3]) -> DVec3 {
    let next = |i: usize| outline[(i + 1) % outline.len()];
    (0..outline.len()).map(|i| (outline[i] - outline[0]).cross(next(i) - outline[0])).sum()
}

/// Every three corners, in order.
fn triples(outline: &[DVec3]) -> impl Iterator<Item = [DVec3; 3]> {
    let n = outline.len();
    let pairs = (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)));
    pairs.flat_map(move |(i, j)| (j + 1..n).map(move |k| [outline[i], outline[j], outline[k]]))
}
