//! A set of points from text: two numbers a line.
//!
//! Blank lines count for nothing, and neither does what follows a `#`. Knows nothing of files: `cli` reads
//! them.

use crate::error::{Error, Result};

/// The points of `text`, one `x y` a line, separated by spaces, tabs or a comma, both in [0, 1). `name` is what errors
/// call the text: the path of its file.
///
/// # Errors
/// The first line that is not two numbers in [0, 1), or a text without points.
pub fn points_from_text(text: &str, name: &str) -> Result<Vec<[f64; 2]>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let wrong = |message: String| Error::parse(name, index + 1, line, message);
        let is_between = |c: char| c.is_whitespace() || c == ',';
        let words: Vec<&str> = content.split(is_between).filter(|word| !word.is_empty()).collect();
        let &[x, y] = &words[..] else {
            let numbers =
                if words.len() == 1 { "1 word" } else { &format!("{} words", words.len()) };
            return Err(wrong(format!(
                "{numbers} where a point `x y` is due: write two numbers with a space between them"
            )));
        };
        points.push([coordinate(x).map_err(wrong)?, coordinate(y).map_err(wrong)?]);
    }
    if points.is_empty() {
        let message = "no points: write two numbers in [0, 1) a line, with a space between them";
        return Err(Error::parse(name, 0, "", message));
    }
    Ok(points)
}

/// A number in [0, 1), or what is wrong with the word.
fn coordinate(word: &str) -> std::result::Result<f64, String> {
    let value: f64 = word
        .parse()
        .map_err(|_| format!("`{word}` is not a number: write it like 0.25, with a point"))?;
    if value.is_nan() {
        return Err(format!(
            "`{word}` is no place: leave the point out or give it a number in [0, 1)"
        ));
    }
    if !(0.0..1.0).contains(&value) {
        let advice = "divide all points by the size of their square, and wrap 1 to 0";
        return Err(format!("`{word}` is outside of [0, 1): {advice}"));
    }
    // -0 becomes 0.
    Ok(value + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_blanks_tabs_commas_and_line_ends_of_every_kind() {
        let text = "\u{feff}# two points\r\n\r\n 0.25\t5e-1 # first\r\n\n-0, 0.999999\n#end";
        let points = points_from_text(text, "points.txt").unwrap();
        assert_eq!(points, [[0.25, 0.5], [0.0, 0.999_999]]);
        assert!(points[1][0].is_sign_positive());
    }

    #[test]
    fn every_mistake_has_its_line_and_advice() {
        for (text, line, says) in [
            ("0 0\n0.5", 2, "1 word where"),
            ("0 0\n\n0.5 0.5 0.5", 3, "3 words where"),
            ("0,5 0,5", 1, "4 words where"),
            ("0.5;0.5,0", 1, "`0.5;0.5` is not a number"),
            ("0 0\n# a\n0.5 x", 3, "`x` is not a number"),
            ("0 1", 1, "`1` is outside of [0, 1)"),
            ("-0.1 0", 1, "`-0.1` is outside of [0, 1)"),
            ("inf 0", 1, "`inf` is outside of [0, 1)"),
            ("1e400 0", 1, "`1e400` is outside of [0, 1)"),
            ("0 NaN", 1, "`NaN` is no place"),
        ] {
            let message = points_from_text(text, "p.txt").unwrap_err().to_string();
            assert!(message.starts_with(&format!("p.txt:{line}: ")), "{message}");
            assert!(message.contains(says), "{message}");
        }
        let message = points_from_text("# nothing\n", "p.txt").unwrap_err().to_string();
        assert!(message.starts_with("p.txt: no points: write"), "{message}");
    }
}
