//! The text of an OBJ file, streamed: what is written is forgotten, but for how much it was.
//!
//! Source: Wavefront's OBJ specification (1995). Numbers have six decimals, so shapes should be larger than
//! 0.001. Must not know what the triangles show.

use super::{Progress, Written};
use crate::math::Vec3;
use std::io::{self, Write};

/// Text is passed on in pieces of at least this many bytes.
const PIECE: usize = 1 << 16;

/// The corner of a triangle, by the numbers that its parts got when they were written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Corner {
    /// A position.
    Plain(u64),
    /// A position and a texture coordinate.
    Textured(u64, u64),
    /// A position and a normal.
    Smooth(u64, u64),
}

/// An OBJ file that is being written.
pub(super) struct ObjWriter<'a> {
    out: &'a mut dyn Write,
    progress: Progress<'a>,
    text: Vec<u8>,
    material: &'static str,
    written: Written,
    normals: u64,
    uvs: u64,
}

impl<'a> ObjWriter<'a> {
    /// Begins the file: a comment, and the name of its material library.
    pub(super) fn new(
        out: &'a mut dyn Write,
        progress: Progress<'a>,
        comment: &str,
        library: &str,
    ) -> Self {
        let text = format!("# {comment}\nmtllib {library}\n").into_bytes();
        let written = Written::default();
        Self { out, progress, text, material: "", written, normals: 0, uvs: 0 }
    }

    /// The triangles that follow are of `material`.
    pub(super) fn material(&mut self, material: &'static str) {
        if material != self.material {
            self.material = material;
            self.text.extend_from_slice(b"usemtl ");
            self.text.extend_from_slice(material.as_bytes());
            self.text.push(b'\n');
        }
    }

    /// Writes a position; its number, from 1.
    pub(super) fn position(&mut self, p: Vec3) -> u64 {
        self.numbers(b"v", &p.to_array());
        self.written.vertices += 1;
        self.written.vertices
    }

    /// Writes a unit normal; its number, from 1.
    pub(super) fn normal(&mut self, n: Vec3) -> u64 {
        self.numbers(b"vn", &n.to_array());
        self.normals += 1;
        self.normals
    }

    /// Writes a texture coordinate; its number, from 1.
    pub(super) fn uv(&mut self, uv: [f32; 2]) -> u64 {
        self.numbers(b"vt", &uv);
        self.uvs += 1;
        self.uvs
    }

    /// Writes a triangle, counter-clockwise from outside.
    ///
    /// # Errors
    /// When the file cannot be written, or `progress` says no.
    pub(super) fn triangle(&mut self, corners: [Corner; 3]) -> io::Result<()> {
        self.text.push(b'f');
        for corner in corners {
            self.text.push(b' ');
            match corner {
                Corner::Plain(position) => push_integer(&mut self.text, position),
                Corner::Textured(position, uv) => {
                    push_integer(&mut self.text, position);
                    self.text.push(b'/');
                    push_integer(&mut self.text, uv);
                }
                Corner::Smooth(position, normal) => {
                    push_integer(&mut self.text, position);
                    self.text.extend_from_slice(b"//");
                    push_integer(&mut self.text, normal);
                }
            }
        }
        self.text.push(b'\n');
        self.written.triangles += 1;
        if self.text.len() < PIECE { Ok(()) } else { self.pass_on() }
    }

    /// Writes the two triangles of a quadrilateral.
    ///
    /// # Errors
    /// As [`Self::triangle`].
    pub(super) fn quad(&mut self, [a, b, c, d]: [Corner; 4]) -> io::Result<()> {
        self.triangle([a, b, c])?;
        self.triangle([a, c, d])
    }

    /// Ends the file; how much was written.
    ///
    /// # Errors
    /// As [`Self::triangle`].
    pub(super) fn finish(mut self) -> io::Result<Written> {
        self.pass_on()?;
        Ok(self.written)
    }

    fn pass_on(&mut self) -> io::Result<()> {
        self.out.write_all(&self.text)?;
        self.written.bytes += self.text.len() as u64;
        self.text.clear();
        (self.progress)(self.written.triangles)
    }

    fn numbers(&mut self, keyword: &[u8], numbers: &[f32]) {
        self.text.extend_from_slice(keyword);
        for &number in numbers {
            self.text.push(b' ');
            push_decimal(&mut self.text, number);
        }
        self.text.push(b'\n');
    }
}

/// Appends `value`, rounded to six decimals, without zeros at the end.
fn push_decimal(text: &mut Vec<u8>, value: f32) {
    const ONE: u64 = 1_000_000;
    let millionths = (f64::from(value) * ONE as f64).round() as i64;
    if millionths < 0 {
        text.push(b'-');
    }
    let millionths = millionths.unsigned_abs();
    push_integer(text, millionths / ONE);
    let (mut rest, mut digit) = (millionths % ONE, ONE / 10);
    if rest > 0 {
        text.push(b'.');
    }
    while rest > 0 {
        text.push(b'0' + (rest / digit) as u8);
        rest %= digit;
        digit /= 10;
    }
}

fn push_integer(text: &mut Vec<u8>, mut value: u64) {
    let mut digits = [0; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    text.extend_from_slice(&digits[start..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_round_trip() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-0.5, "-0.5"),
            (0.000_001, "0.000001"),
            (-12.030_5, "-12.0305"),
            (0.999_999_9, "1"),
            (1e-9, "0"),
            (123_456.0, "123456"),
        ] {
            let mut text = Vec::new();
            push_decimal(&mut text, value);
            assert_eq!(String::from_utf8_lossy(&text), expected);
        }
        let mut text = Vec::new();
        push_integer(&mut text, u64::MAX);
        assert_eq!(String::from_utf8_lossy(&text), u64::MAX.to_string());
    }
}
