//! The arguments of MTL texture statements: options, then a file name that may contain spaces.

use super::mtl::parse_number;

/// A texture as a library names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureStatement {
    /// Line of the statement.
    pub(super) line: usize,
    /// File name, as written.
    pub(super) file: String,
    /// Option `-s`.
    pub(super) scale: [f32; 2],
    /// Option `-o`.
    pub(super) offset: [f32; 2],
    /// Option `-clamp`.
    pub(super) clamp: bool,
    /// Option `-bm`.
    pub(super) bump_multiplier: f32,
}

/// Parses `text`, the arguments of a texture statement on `line`.
///
/// # Errors
/// A message when an option is malformed or unknown, or the file name is missing.
pub(super) fn parse_texture(text: &str, line: usize) -> Result<TextureStatement, String> {
    let mut texture = TextureStatement {
        line,
        file: String::new(),
        scale: [1.0; 2],
        offset: [0.0; 2],
        clamp: false,
        bump_multiplier: 1.0,
    };
    let mut rest = text.trim();
    while let Some(option) = rest.split_whitespace().next().filter(|word| is_option(word)) {
        rest = rest[option.len()..].trim_start();
        match option.to_lowercase().as_str() {
            "-s" => texture.scale = take_vector(&mut rest, 1.0)?,
            "-o" => texture.offset = take_vector(&mut rest, 0.0)?,
            "-clamp" => texture.clamp = take_word(&mut rest, option)?.eq_ignore_ascii_case("on"),
            "-bm" => texture.bump_multiplier = parse_number(take_word(&mut rest, option)?)?,
            "-t" => {
                take_vector(&mut rest, 0.0)?;
            }
            "-mm" => {
                take_word(&mut rest, option)?;
                take_word(&mut rest, option)?;
            }
            "-blendu" | "-blendv" | "-cc" | "-boost" | "-texres" | "-imfchan" | "-type" => {
                take_word(&mut rest, option)?;
            }
            _ => return Err(format!("{option:?} is not a texture option")),
        }
    }
    if rest.is_empty() {
        return Err("the name of an image file is missing".to_string());
    }
    texture.file = rest.to_string();
    Ok(texture)
}

/// Whether a word is an option: a minus, then letters only ("-5.png" and "-" are file names).
fn is_option(word: &str) -> bool {
    word.strip_prefix('-')
        .is_some_and(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphabetic()))
}

/// Takes the one argument of `option`.
fn take_word<'a>(rest: &mut &'a str, option: &str) -> Result<&'a str, String> {
    let word = rest.split_whitespace().next().ok_or_else(|| format!("{option} needs a value"))?;
    *rest = rest[word.len()..].trim_start();
    Ok(word)
}

/// Takes one to three numbers, of which the first two matter; `missing` stands for those not given. A
/// number that nothing follows is the name of the file.
fn take_vector(rest: &mut &str, missing: f32) -> Result<[f32; 2], String> {
    let mut vector = [missing; 3];
    for (i, number) in vector.iter_mut().enumerate() {
        let word = rest.split_whitespace().next().unwrap_or_default();
        let later = rest[word.len()..].trim_start();
        match parse_number(word) {
            Ok(found) if !later.is_empty() => *number = found,
            Err(reason) if i == 0 => return Err(reason),
            _ => break,
        }
        *rest = later;
    }
    Ok([vector[0], vector[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(file: &str) -> TextureStatement {
        TextureStatement {
            line: 7,
            file: file.to_string(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
            bump_multiplier: 1.0,
        }
    }

    #[test]
    fn options_and_names() {
        for (text, expected) in [
            ("a.png", plain("a.png")),
            ("  my wood - dark.png ", plain("my wood - dark.png")),
            ("-s 2 3 4 a.png", TextureStatement { scale: [2.0, 3.0], ..plain("a.png") }),
            ("-s 2 a b.png", TextureStatement { scale: [2.0, 1.0], ..plain("a b.png") }),
            ("-s 2 3 4.png", TextureStatement { scale: [2.0, 3.0], ..plain("4.png") }),
            ("-s 2 3 4", TextureStatement { scale: [2.0, 3.0], ..plain("4") }),
            ("-o .5 -1 0\ta.png", TextureStatement { offset: [0.5, -1.0], ..plain("a.png") }),
            ("-clamp on a.png", TextureStatement { clamp: true, ..plain("a.png") }),
            ("-clamp off a.png", plain("a.png")),
            ("-bm 0.3 a.png", TextureStatement { bump_multiplier: 0.3, ..plain("a.png") }),
            ("-blendu on -blendv off -cc on -boost 2 -mm 0 1 -t 1 1 1 a.png", plain("a.png")),
            ("-texres 512 -imfchan r -type cube_top -mm 0 1 a.png", plain("a.png")),
            ("tex\\wood.png", plain("tex\\wood.png")),
            ("-5.png", plain("-5.png")),
        ] {
            assert_eq!(parse_texture(text, 7).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn malformed_statements() {
        for text in ["", "  ", "-s a.png", "-bm a.png", "-bm", "-clamp", "-bm 1", "-frob 1 a.png"] {
            assert!(parse_texture(text, 1).is_err(), "{text}");
        }
    }
}
