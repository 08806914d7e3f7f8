//! The values of options, read from words: whatever is wrong in itself is found here, before any file is opened.

use crate::error::unknown_name;
use crate::filter::Filter;
use crate::math::{DVec3, Rgb};
use crate::sampling::Strategy;
use crate::scene::{ColorInput, Environment, Material, Surface};
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

/// `--env`.
#[derive(Clone, Debug)]
pub(super) enum Env {
    /// Needs no file.
    Computed(Environment),
    /// An image.
    File(PathBuf),
}

/// A parser of the names `all`; `kind` is what they name.
pub(super) fn named<T: Copy>(
    kind: &'static str,
    all: &'static [(&'static str, T)],
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |name| {
        let found = all.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
        found.ok_or_else(|| unknown_name(kind, name, all.iter().map(|(known, _)| *known)))
    }
}

pub(super) fn sampler(text: &str) -> Result<Strategy, String> {
    Strategy::sampler(text).map_err(|error| error.to_string())
}

pub(super) fn filter(text: &str) -> Result<Filter, String> {
    Filter::parse(text).map_err(|error| error.to_string())
}

/// `N` numbers separated by commas.
fn numbers<T: FromStr, const N: usize>(text: &str) -> Result<[T; N], String> {
    let parsed: Option<Vec<T>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    parsed
        .and_then(|values| <[T; N]>::try_from(values).ok())
        .ok_or_else(|| format!("expected {N} numbers separated by commas"))
}

pub(super) fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "expected a number".into())
}

/// Three coordinates within the range of scene files.
pub(super) fn point(text: &str) -> Result<DVec3, String> {
    let p = DVec3::from_array(numbers(text)?);
    // A NaN is in no range.
    let valid = p.to_array().iter().all(|x| x.abs() <= 1e15);
    if valid { Ok(p) } else { Err("a coordinate is a number from -1e15 to 1e15".into()) }
}

pub(super) fn direction(text: &str) -> Result<DVec3, String> {
    let d = point(text)?;
    if d == DVec3::ZERO { Err("0,0,0 is no direction".into()) } else { Ok(d) }
}

pub(super) fn field_of_view(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|v| *v > 0.0 && *v < 180.0);
    degrees.ok_or_else(|| "expected an angle above 0 and below 180 degrees".into())
}

/// Three finite numbers that are not negative.
fn rgb(text: &str) -> Result<Rgb, String> {
    let c = numbers::<f32, 3>(text)?;
    let valid = c.iter().all(|v| v.is_finite() && *v >= 0.0);
    if valid { Ok(Rgb::from(c)) } else { Err("a colour is three numbers of at least 0".into()) }
}

/// Three numbers from 0 to 1.
pub(super) fn rgb_fractions(text: &str) -> Result<Rgb, String> {
    let c = rgb(text)?;
    if c.max_channel() <= 1.0 { Ok(c) } else { Err("expected three numbers from 0 to 1".into()) }
}

pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, as in 1280x720")?;
    let side = |text: &str| match text.trim().parse::<u32>() {
        Ok(n @ 1..=65_536) => Ok(n),
        _ => Err(format!("`{text}` is not a number of pixels from 1 to 65536")),
    };
    Ok([side(width)?, side(height)?])
}

pub(super) fn crop(text: &str) -> Result<[u32; 4], String> {
    let [x0, y0, x1, y1] = numbers(text)?;
    if x0 < x1 && y0 < y1 {
        Ok([x0, y0, x1, y1])
    } else {
        Err("expected x0 < x1 and y0 < y1".into())
    }
}

pub(super) fn replay(text: &str) -> Result<([u32; 2], u64), String> {
    let [x, y, sample] = numbers::<u64, 3>(text)?;
    let side = |n: u64| u32::try_from(n).map_err(|_| format!("{n} is not a pixel"));
    Ok(([side(x)?, side(y)?], sample))
}

/// More threads than any machine runs would only take their time to start.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    let n = text.parse().ok().filter(|n| *n <= 1024);
    n.ok_or_else(|| "expected a number of threads from 0 to 1024".into())
}

/// The material that `--override-material` gives to every surface.
pub(super) fn override_material(text: &str) -> Result<Material, String> {
    let albedo = text.strip_prefix("diffuse:").ok_or("expected diffuse:R,G,B")?;
    let albedo = ColorInput::constant(rgb_fractions(albedo)?);
    Ok(Material::new("override", Surface::Lambert { albedo }))
}

pub(super) fn env(text: &str) -> Result<Env, String> {
    if let Some(values) = text.strip_prefix("constant:") {
        return Ok(Env::Computed(Environment::Constant { radiance: rgb(values)? }));
    }
    let Some(values) = text.strip_prefix("sky:") else { return Ok(Env::File(text.into())) };
    let [elevation, azimuth]: [f64; 2] = numbers(values)?;
    if !((-90.0..=90.0).contains(&elevation) && azimuth.is_finite()) {
        return Err("expected an elevation from -90 to 90 degrees and any azimuth".into());
    }
    Ok(Env::Computed(Environment::Sky {
        elevation,
        azimuth,
        turbidity: 3.0,
        ground_albedo: Rgb::splat(0.3),
        scale: 1.0,
    }))
}

/// A whole number above zero, with a suffix that multiplies it or without.
pub(super) fn count(text: &str) -> Result<u64, String> {
    let suffixes = [('k', 1000), ('K', 1000), ('M', 1_000_000), ('G', 1_000_000_000)];
    let suffixed = suffixes.iter().find_map(|(s, factor)| Some((text.strip_suffix(*s)?, *factor)));
    let (digits, factor) = suffixed.unwrap_or((text, 1));
    let number = digits.parse::<u64>().ok().and_then(|n| n.checked_mul(factor));
    number
        .filter(|n| *n > 0)
        .ok_or_else(|| "expected a number above 0, as in 500000, 500k or 2M".into())
}

/// A length of time with its unit.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    let parsed = humantime::parse_duration(text).ok().filter(|time| !time.is_zero());
    parsed.ok_or_else(|| "expected a time above 0 with its unit, as in 90s, 2m or 1m30s".into())
}
