//! The words of `v`, `vt`, `vn` and `f` statements: numbers and corner references, checked.
//!
//! Stops everything that a parser further down would choke on, with a message that says why. Must not
//! know where the numbers are stored.

use std::str::SplitWhitespace;

/// Coordinates beyond this are refused: the difference of two must have a square that `f32` holds, with
/// room to spare (Embree's limit for the same reason is 1.844e18).
const LARGEST_COORDINATE: f64 = (1_u64 << 59) as f64;

/// The three lists that a corner can refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    /// Lines `v`.
    Position,
    /// Lines `vt`.
    Uv,
    /// Lines `vn`.
    Normal,
}

impl List {
    /// All of them, in the order of a corner's indices.
    pub(super) const ALL: [Self; 3] = [Self::Position, Self::Uv, Self::Normal];

    /// What one element is called in messages.
    pub(super) const fn noun(self) -> &'static str {
        match self {
            Self::Position => "vertex",
            Self::Uv => "texture coordinate",
            Self::Normal => "normal",
        }
    }

    /// The numbers of one element that matter, from the words behind the keyword; the colours and
    /// weights that may follow them are none of the surface's business.
    ///
    /// # Errors
    /// A message when a number is missing, unreadable or of no use.
    pub(super) fn parse(self, words: &mut SplitWhitespace<'_>) -> Result<[f64; 3], String> {
        let mut numbers = [0.0_f64; 3];
        let (required, used) = match self {
            Self::Position | Self::Normal => (3, 3),
            Self::Uv => (1, 2),
        };
        for (i, number) in numbers.iter_mut().enumerate().take(used) {
            let Some(word) = words.next() else {
                if i < required {
                    return Err(format!("a {} needs {required} numbers", self.noun()));
                }
                break;
            };
            *number = word.parse().map_err(|_| format!("{word:?} is not a number"))?;
        }
        let finite = numbers.iter().all(|x| x.is_finite());
        let largest = numbers.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        match self {
            Self::Position if !finite || largest > LARGEST_COORDINATE => {
                Err("coordinates must be finite and below 5e17".to_string())
            }
            Self::Uv if !finite || largest > f64::from(f32::MAX) => {
                Err("texture coordinates must be finite".to_string())
            }
            Self::Normal if !finite || largest == 0.0 => {
                Err("a normal must be finite and have a length".to_string())
            }
            _ => Ok(numbers),
        }
    }
}

/// How many elements of one list have been read, and which of them are unusable.
#[derive(Debug, Default)]
pub(super) struct Elements {
    count: usize,
    /// Numbers of unusable elements, from 1, ascending.
    unusable: Vec<usize>,
}

impl Elements {
    /// One more element was read.
    pub(super) fn push(&mut self, usable: bool) {
        self.count += 1;
        if !usable {
            self.unusable.push(self.count);
        }
    }

    /// Whether element `number` (from 1) may be used.
    pub(super) fn is_usable(&self, number: usize) -> bool {
        self.unusable.is_empty() || self.unusable.binary_search(&number).is_err()
    }
}

/// Numbers (from 1) of the vertex, texture coordinate and normal of one corner; 0 where it has none.
pub(super) type Corner = [usize; 3];

/// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn`. Negative numbers count back from the last element read.
///
/// # Errors
/// A message when it is not of this form or refers to something that does not exist at this line.
pub(super) fn parse_corner(word: &str, elements: &[Elements; 3]) -> Result<Corner, String> {
    let mut corner = [0; 3];
    let mut parts = word.split('/');
    for (list, number) in List::ALL.into_iter().zip(&mut corner) {
        let part = parts.next().unwrap_or_default();
        if part.is_empty() {
            continue;
        }
        let count = elements[list as usize].count;
        let found: i64 = part
            .parse()
            .map_err(|_| format!("{word:?} is not a corner; write v, v/vt, v//vn or v/vt/vn"))?;
        let from_start =
            if found < 0 { found.saturating_add_unsigned(count as u64 + 1) } else { found };
        *number = usize::try_from(from_start).unwrap_or_default();
        if *number == 0 || *number > count {
            let noun = list.noun();
            return Err(match found {
                0 => format!("{noun} 0 does not exist; numbers start at 1"),
                _ => format!("{noun} {found} does not exist: {count} are defined above this line"),
            });
        }
    }
    if corner[0] == 0 || parts.next().is_some() {
        return Err(format!("{word:?} is not a corner; write v, v/vt, v//vn or v/vt/vn"));
    }
    Ok(corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elements(counts: [usize; 3]) -> [Elements; 3] {
        counts.map(|count| Elements { count, unusable: Vec::new() })
    }

    #[test]
    fn corners() {
        let elements = elements([8, 4, 2]);
        for (word, corner) in [
            ("8", [8, 0, 0]),
            ("1/2", [1, 2, 0]),
            ("1//2", [1, 0, 2]),
            ("1/4/2", [1, 4, 2]),
            ("-1/-4/-2", [8, 1, 1]),
            ("-8", [1, 0, 0]),
            ("3/", [3, 0, 0]),
            ("3//", [3, 0, 0]),
            ("+3", [3, 0, 0]),
        ] {
            assert_eq!(parse_corner(word, &elements).unwrap(), corner, "{word}");
        }
        for word in [
            "0",
            "9",
            "-9",
            "1/5",
            "1/0",
            "1//3",
            "1//-3",
            "/1",
            "//",
            "x",
            "1.0",
            "1/2/1/1",
            "1/x",
            "99999999999999999999",
            "9223372036854775807",
            "-9223372036854775808",
            "3#x",
        ] {
            assert!(parse_corner(word, &elements).is_err(), "{word}");
        }
    }

    #[test]
    fn numbers() {
        let parse = |list: List, text: &str| list.parse(&mut text.split_whitespace());
        assert_eq!(parse(List::Position, "1 -2e-3 .5 0.25").unwrap(), [1.0, -2e-3, 0.5]);
        assert_eq!(parse(List::Position, "1 2 3 red green blue").unwrap(), [1.0, 2.0, 3.0]);
        assert_eq!(parse(List::Uv, "0.5").unwrap(), [0.5, 0.0, 0.0]);
        assert_eq!(parse(List::Uv, "0.5 1 nan").unwrap(), [0.5, 1.0, 0.0]);
        for text in ["", "1 2", "1 2 x", "1,5 0 0", "nan 0 0", "0 inf 0", "0 0 1e400", "6e17 0 0"] {
            assert!(parse(List::Position, text).is_err(), "{text}");
        }
        assert!(parse(List::Normal, "0 0 0").is_err());
        assert!(parse(List::Normal, "0 nan 0").is_err());
        assert!(parse(List::Normal, "0 1e-300 0").is_ok());
        assert!(parse(List::Uv, "1e39").is_err());
    }
}
