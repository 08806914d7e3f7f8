//! Which sets `glint samples` is about: strategies by name, and files of points.

use crate::cli::progress;
use crate::error::{Error, Result, unknown_name};
use crate::lab::exhibit::{Exhibit, measured};
use crate::lab::measure::{Measures, measure, points_from_text};
use crate::sampling::Strategy;
use clap::Args;
use indicatif::ProgressBar;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The most points that are measured: half a minute of pairwise sums.
const MOST_POINTS: i64 = 1 << 17;

/// Options that name sets.
#[derive(Debug, Args)]
pub(super) struct Sets {
    /// Files of points: two numbers in [0, 1) a line, with a space or a comma between them; # begins a comment
    files: Vec<PathBuf>,
    /// Strategies: all, or a list of grid, random, jittered, n-rooks, multi-jittered, correlated-multi-jittered, dart-throwing,
    /// poisson-disk, centroidal-voronoi, bounded-voronoi, blue-noise, halton, hammersley, sobol and pmj02
    /// [default: all, unless there are files]
    #[arg(long, value_name = "NAME,...", value_parser = strategies)]
    sampler: Option<Strategies>,
    /// Points of a set, at most 131072 (drawn: 32768): measuring takes a time that grows with their square
    #[arg(short = 'n', long, value_name = "N", default_value_t = 256,
          value_parser = clap::value_parser!(u32).range(1..=MOST_POINTS))]
    pub(super) count: u32,
    /// Random seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,
    /// Print the measures as JSON to standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Print nothing but errors and what was asked for
    #[arg(short, long)]
    pub(super) quiet: bool,
}

/// What `--sampler` names.
#[derive(Clone, Debug)]
struct Strategies {
    list: Vec<Strategy>,
    /// Whether those that have no set of the wanted size are left out, not refused.
    is_all: bool,
}

fn strategies(text: &str) -> std::result::Result<Strategies, String> {
    let known = || Strategy::ALL.iter().copied().filter(|strategy| strategy.has_sets());
    if text == "all" {
        return Ok(Strategies { list: known().collect(), is_all: true });
    }
    let named = |name: &str| {
        if name == "all" {
            return Err("`all` stands alone: it is every sampler".into());
        }
        if name == Strategy::ScreenSobol.name() {
            return Err("sobol-blue-noise shares one set out among pixels: it is for glint render and zoneplate".into());
        }
        let found = known().find(|strategy| strategy.name() == name);
        let names = known().map(Strategy::name).chain(["all"]);
        found.ok_or_else(|| unknown_name("sampler", name, names))
    };
    let list: std::result::Result<_, String> =
        text.split(',').map(|name| named(name.trim())).collect();
    Ok(Strategies { list: list?, is_all: false })
}

impl Sets {
    /// Files of points.
    pub(super) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The strategies that are wanted and have sets of the wanted size.
    ///
    /// # Errors
    /// A usage error for a strategy named that has none.
    pub(super) fn strategies(&self) -> Result<Vec<Strategy>> {
        let mut wanted = self.wanted()?;
        if wanted.is_all {
            wanted.list.retain(|strategy| strategy.allows(self.count));
        }
        wanted.list.iter().try_for_each(|strategy| strategy.check(self.count))?;
        Ok(wanted.list)
    }

    fn wanted(&self) -> Result<Strategies> {
        match &self.sampler {
            Some(wanted) => Ok(wanted.clone()),
            None if self.files.is_empty() => strategies("all").map_err(Error::Usage),
            None => Ok(Strategies { list: Vec::new(), is_all: false }),
        }
    }

    /// Says which of all strategies have no set of the wanted size.
    fn say_what_is_left_out(&self) -> Result<()> {
        let wanted = self.wanted()?;
        let refused = wanted.list.iter().filter_map(|strategy| strategy.check(self.count).err());
        if !self.quiet {
            for why in refused {
                let _ = writeln!(std::io::stderr(), "left out: {why}");
            }
        }
        Ok(())
    }

    /// Something of every set: of points with the name of their file, and of strategies.
    ///
    /// # Errors
    /// As [`Self::strategies`]; where a file cannot be read or is no set of points.
    pub(super) fn each<T>(
        &self,
        of_points: impl Fn(&str, Vec<[f64; 2]>) -> Result<T>,
        of_strategy: impl Fn(Strategy) -> Result<T>,
    ) -> Result<Vec<T>> {
        let strategies = self.strategies()?;
        self.say_what_is_left_out()?;
        let bar = self.bar(self.files.len() + strategies.len());
        let mut found = Vec::new();
        for file in &self.files {
            found.push(of_points(&file.display().to_string(), points(file)?)?);
            bar.inc(1);
        }
        for strategy in strategies {
            found.push(of_strategy(strategy)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(found)
    }

    /// Every set, with all about it, of at most so many points.
    ///
    /// # Errors
    /// As [`Self::each`]; a usage error for a set of more points, before it is measured.
    pub(super) fn exhibits(&self, most: usize) -> Result<Vec<Exhibit>> {
        let check = |name: &str, count: usize| match count > most {
            true => Err(Error::Usage(format!("{name}: {count} points; at most {most} are drawn"))),
            false => Ok(()),
        };
        self.each(
            |name, points| {
                check(name, points.len())?;
                Ok(Exhibit::of_points(name, points))
            },
            |strategy| {
                check(strategy.name(), self.count as usize)?;
                Exhibit::of_strategy(strategy, self.count, self.seed)
            },
        )
    }

    /// The measures of every set.
    ///
    /// # Errors
    /// As [`Self::each`].
    pub(super) fn measures(&self) -> Result<Vec<Measures>> {
        self.each(
            |name, points| Ok(measure(name, &points)),
            |strategy| measured(strategy, self.count, self.seed),
        )
    }

    /// A bar of so many steps; nothing where it is quiet or there is no terminal.
    pub(super) fn bar(&self, steps: usize) -> ProgressBar {
        progress::steps(steps, self.quiet)
    }
}

fn points(file: &Path) -> Result<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(file).map_err(|e| Error::io(file, "read", e))?;
    let points = points_from_text(&text, &file.display().to_string())?;
    if points.len() as i64 > MOST_POINTS {
        let (name, count) = (file.display(), points.len());
        return Err(Error::Usage(format!(
            "{name}: {count} points; measuring takes a time that grows with their square, and {MOST_POINTS} are the most"
        )));
    }
    Ok(points)
}
