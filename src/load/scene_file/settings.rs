//! `[film]` and `[render]`: what the command line can override.

use super::source::Source;
use super::value::{Count, Finite, List};
use crate::error::Result;
use crate::filter::Filter;
use crate::image::ToneMap;
use crate::sampling::Strategy;
use crate::scene::{Effects, SceneSettings};
use serde::Deserialize;
use toml::Spanned;

/// `[film]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct FilmTable {
    size: Option<List<Count<65536>, 2>>,
    filter: Option<Spanned<String>>,
    exposure: Option<Finite>,
    tonemap: Option<Spanned<String>>,
}

/// `[render]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RenderTable {
    spp: Option<Count<{ i64::MAX as u64 }>>,
    max_depth: Option<Count<{ u32::MAX as u64 }>>,
    effects: Option<Spanned<String>>,
    sampler: Option<Spanned<String>>,
    seed: Option<u64>,
}

/// The settings of both tables.
///
/// # Errors
/// For an unknown filter, tone map, set of effects or sampler.
pub(super) fn settings(
    film: &FilmTable,
    render: &RenderTable,
    source: Source,
) -> Result<SceneSettings> {
    let check = |name: &Option<Spanned<String>>, what, known: &[&str]| match name {
        Some(name) if !known.contains(&name.get_ref().as_str()) => {
            let known = known.iter().copied();
            Err(source.unknown_name(name.span(), what, name.get_ref(), known))
        }
        _ => Ok(()),
    };
    check(&film.tonemap, "tone map", &ToneMap::ALL.map(|tonemap| tonemap.0))?;
    if let Some(effects) = &render.effects {
        let parsed = effects.get_ref().parse::<Effects>();
        parsed.map_err(|message| source.error(effects.span(), message))?;
    }
    if let Some(sampler) = &render.sampler {
        Strategy::sampler(sampler.get_ref())
            .map_err(|e| source.error(sampler.span(), e.to_string()))?;
    }
    if let Some(filter) = &film.filter {
        Filter::parse(filter.get_ref()).map_err(|e| source.error(filter.span(), e.to_string()))?;
    }
    let text = |name: &Option<Spanned<String>>| name.as_ref().map(|name| name.get_ref().clone());
    Ok(SceneSettings {
        size: film.size.map(|size| size.0.map(|count| count.0 as u32)),
        samples_per_pixel: render.spp.map(|count| count.0),
        max_depth: render.max_depth.map(|count| count.0 as u32),
        effects: text(&render.effects),
        sampler: text(&render.sampler),
        seed: render.seed,
        filter: text(&film.filter),
        exposure: film.exposure.map(|stops| stops.0),
        tonemap: text(&film.tonemap),
    })
}
