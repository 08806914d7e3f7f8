//! What can be said on the command line, each option in the type that it means. Parsing opens no file.

use super::compare::{Compare, EXAMPLES};
use super::samples::Samples;
use super::values::{
    Env, count, crop, direction, duration, env, field_of_view, filter, finite, named,
    override_material, point, replay, rgb_fractions, sampler, size, threads,
};
use crate::accel::{BuildOptions, Quality};
use crate::filter::Filter;
use crate::generate::Kind;
use crate::image::ToneMap;
use crate::math::{DVec3, Rgb};
use crate::os::Isa;
use crate::render::Aov;
use crate::sampling::Strategy;
use crate::scene::{Effects, Material};
use crate::study::bench::RayKind;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// A path tracer for large OBJ scenes on Embree.
#[derive(Debug, Parser)]
#[command(name = "glint", version, arg_required_else_help = true)]
pub(super) struct Glint {
    #[command(subcommand)]
    pub(super) command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Renders an OBJ model or a TOML scene to EXR, PNG or HDR.
    #[command(after_help = RENDER_EXAMPLES)]
    Render(Box<Render>),
    /// Says which effects a scene calls for, why, what they will cost and what is spared; renders nothing.
    #[command(after_help = PLAN_EXAMPLES)]
    Plan(Box<Render>),
    /// Races Embree against the in-house BVH on your own scenes, and proves that they agree.
    #[command(after_help = BENCH_EXAMPLES)]
    Bench(Bench),
    /// Says how far a picture is from another, in numbers and for the eye.
    #[command(after_help = EXAMPLES)]
    Compare(Compare),
    /// Writes a procedural OBJ model of any size, to test and to time with.
    #[command(after_help = GENERATE_EXAMPLES)]
    Generate(Generate),
    /// The sampling laboratory: what points in the plane are good for.
    Samples(Samples),
}

const RENDER_EXAMPLES: &str = "\
Examples:
  glint render model.obj
      MODEL.exr and MODEL.png in this folder, framed and lit automatically
  glint render model.obj -o out.png --size 1920x1080 --spp 256 --env sky:30,120
  glint render scene.toml -o out.exr --aov normal,albedo,depth --stats stats.json
  glint render model.obj --camera-from 3,2,5 --camera-to 0,1,0 --fov 35 --env studio.hdr
  glint render model.obj --override-material diffuse:0.7,0.7,0.7 --env constant:1,1,1";

/// `glint render`. The default is a command line that names no scene and says nothing.
#[derive(Debug, Default, Args)]
pub(super) struct Render {
    /// Scene file (.toml) or model (.obj)
    pub(super) scene: PathBuf,

    /// Image to write, .exr, .png or .hdr; may be repeated [default: SCENE.exr and SCENE.png here]
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub(super) output: Vec<PathBuf>,
    /// Extra layers for the EXR: normal, albedo, depth, position, uv, primitive, material, samples, variance
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = named("AOV", &Aov::ALL),
          help_heading = "Output")]
    pub(super) aov: Vec<Aov>,
    /// Exposure of PNG files in stops [default: automatic]
    #[arg(long, value_name = "EV", value_parser = finite, allow_negative_numbers = true, help_heading = "Output")]
    pub(super) exposure: Option<f32>,
    /// Tone map of PNG files: none, aces, agx or reinhard [default: agx]
    #[arg(long, value_name = "NAME", value_parser = named("tone map", &ToneMap::ALL), help_heading = "Output")]
    pub(super) tonemap: Option<ToneMap>,
    /// Hide the environment from the camera; PNG files show this sRGB colour (0..1) instead
    #[arg(long, value_name = "R,G,B", value_parser = rgb_fractions, help_heading = "Output")]
    pub(super) background: Option<Rgb>,
    /// Write statistics as JSON
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(super) stats: Option<PathBuf>,
    /// Write a page with the effects, their reasons, and the bill as stacked bars
    #[arg(long, value_name = "FILE.html", help_heading = "Output")]
    pub(super) report: Option<PathBuf>,
    /// Print statistics as JSON to standard output
    #[arg(long, help_heading = "Output")]
    pub(super) json: bool,
    /// Print nothing but errors
    #[arg(short, long, help_heading = "Output")]
    pub(super) quiet: bool,

    /// Image size in pixels [default: 1280x720]
    #[arg(long, value_name = "WxH", value_parser = size, help_heading = "Image")]
    pub(super) size: Option<[u32; 2]>,
    /// Render only these pixels; x1 and y1 are exclusive
    #[arg(long, value_name = "x0,y0,x1,y1", value_parser = crop, help_heading = "Image")]
    pub(super) crop: Option<[u32; 4]>,
    /// Samples per pixel [default: 128]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), help_heading = "Image")]
    pub(super) spp: Option<u64>,
    /// Path segments: 1 shows emitters only, 2 adds direct light [default: unbounded]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Image")]
    pub(super) max_depth: Option<u32>,
    /// Effects to simulate: auto, all, whitted, direct, ambient-occlusion, path, or a list such as all,no-refraction
    /// (glint plan --help names them all) [default: auto]
    #[arg(long, value_name = "NAME,...", help_heading = "Image")]
    pub(super) effects: Option<Effects>,
    /// Sampler: sobol, sobol-blue-noise, pmj02, halton, hammersley, jittered, multi-jittered, correlated-multi-jittered,
    /// n-rooks, poisson-disk, dart-throwing, centroidal-voronoi, blue-noise, random, or grid (biased) [default: sobol]
    #[arg(long, value_name = "NAME", value_parser = sampler, help_heading = "Image")]
    pub(super) sampler: Option<Strategy>,
    /// Pixel filter: box, tent, gaussian, mitchell, blackman-harris or lanczos [default: blackman-harris]
    #[arg(long, value_name = "NAME[:RADIUS]", value_parser = filter, help_heading = "Image")]
    pub(super) filter: Option<Filter>,
    /// Random seed [default: 0]
    #[arg(long, value_name = "N", help_heading = "Image")]
    pub(super) seed: Option<u64>,

    /// Camera of the scene file to use [default: the first]
    #[arg(long, value_name = "NAME", help_heading = "Camera")]
    pub(super) camera: Option<String>,
    /// Camera position [default: framed automatically]
    #[arg(long, value_name = "x,y,z", value_parser = point, allow_hyphen_values = true, help_heading = "Camera")]
    pub(super) camera_from: Option<DVec3>,
    /// Point in the middle of the picture
    #[arg(long, value_name = "x,y,z", value_parser = point, allow_hyphen_values = true, help_heading = "Camera")]
    pub(super) camera_to: Option<DVec3>,
    /// Upward direction in the picture
    #[arg(long, value_name = "x,y,z", value_parser = direction, allow_hyphen_values = true, help_heading = "Camera")]
    pub(super) camera_up: Option<DVec3>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEGREES", value_parser = field_of_view, help_heading = "Camera")]
    pub(super) fov: Option<f64>,

    /// Light around the scene: constant:R,G,B, sky:ELEVATION,AZIMUTH (degrees), or an .hdr or .exr file
    #[arg(long, value_name = "ENV", value_parser = env, help_heading = "Scene")]
    pub(super) env: Option<Env>,
    /// Give every surface one material: diffuse:R,G,B
    #[arg(long, value_name = "MATERIAL", value_parser = override_material, help_heading = "Scene")]
    pub(super) override_material: Option<Material>,
    /// Which axis of the scene is up [default: y]
    #[arg(long, value_enum, help_heading = "Scene")]
    pub(super) up: Option<Up>,
    /// Exit with 3 if anything in the scene had to be dropped or repaired
    #[arg(long, help_heading = "Scene")]
    pub(super) strict: bool,

    /// Backend that finds what rays hit
    #[arg(long, value_enum, default_value_t = Backend::Auto, help_heading = "Machine")]
    pub(super) accel: Backend,
    /// Use no wider vector instructions than these; the picture is the same [default: the widest]
    #[arg(long, value_name = "NAME", value_parser = named("instruction set", &Isa::ALL), help_heading = "Machine")]
    pub(super) isa: Option<Isa>,
    #[command(flatten)]
    pub(super) build: Build,
    /// Threads to use, up to 1024; 0 is one a core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = threads, help_heading = "Machine")]
    pub(super) threads: usize,
    /// Trace one sample of one pixel and print what it met
    #[arg(long, value_name = "x,y,sample", value_parser = replay, help_heading = "Machine")]
    pub(super) replay: Option<([u32; 2], u64)>,
}

const PLAN_EXAMPLES: &str = "\
Examples:
  glint plan scene.toml
      the table of effects: on or off, why, in which line of which file, what it will cost
  glint plan model.obj --effects all,no-refraction
      how much light, and how much time, refraction is
  glint plan scene.toml --json

It takes the options of `glint render`: put `plan` in place of `render` in any command line.

--effects: auto (what the scene calls for), all (everything runs; the picture is the same), path (auto), direct, whitted,
ambient-occlusion; or a list, which begins with one of these, with an effect (that, shadows and both ways of finding lights) or
with no-EFFECT (auto without it), and adds EFFECT or takes out no-EFFECT. Effects: emission, environment, direct, shadows,
diffuse, glossy, mirror, refraction, absorption, caustics, textures, normal-maps, cut-outs, depth-of-field, light-sampling,
scatter-sampling.";

const BENCH_EXAMPLES: &str = "\
Examples:
  glint bench model.obj
      builds, memory and rays per second of every backend, in about two minutes
  glint bench city.obj scene.toml -o report.html
      one page with bars for both scenes
  glint bench model.obj --kinds primary,shadow --time 20s
  glint bench model.obj --isa avx2 --threads 1 --repetitions 15 --json > avx2.json
  glint bench scene.toml --frame
      instead of rays: seconds of the same whole frame on each backend, and which pixels differ

A contestant is timed only if its answers are right: those that differ from Embree's robust mode, and a sample of
those that all agree on, go before an exact oracle, which knows no tolerance. It excuses what the rounding of the
in-house BVH's kernel is proven to be worth. Embree may besides choose freely among what is equally near, or an ulp
behind, and be wrong once in 10 000 rays. Of whole frames, only the bytes are compared.
--quality and --low-memory are for the in-house BVH; with --frame, for Embree as well.
Exit code 3: answers of a contestant were wrong; a frame changed from one time to the next; or more than 0.2 % of
its pixels differ between the backends (at 16 samples a pixel; more at more).";

/// `glint bench`.
#[derive(Debug, Args)]
pub(super) struct Bench {
    /// Models (.obj) or scene files (.toml); for rays nothing is read of materials, so that cut-outs are solid
    #[arg(required = true, value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,

    /// Write a page with tables and bars
    #[arg(short, long, value_name = "FILE.html", help_heading = "Output")]
    pub(super) output: Option<PathBuf>,
    /// Print everything as JSON to standard output, and the tables to standard error
    #[arg(long, help_heading = "Output")]
    pub(super) json: bool,
    /// Print nothing but errors, and the JSON if asked for
    #[arg(short, long, help_heading = "Output")]
    pub(super) quiet: bool,

    /// Race whole frames, as `glint render` makes them, not rays; count and list the pixels that differ
    #[arg(long, conflicts_with_all = ["rays", "kinds", "all_calls"], help_heading = "Frame")]
    pub(super) frame: bool,
    /// Size of the frame
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, default_value = "640x360", requires = "frame",
          help_heading = "Frame")]
    pub(super) size: [u32; 2],
    /// Samples per pixel of the frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), default_value_t = 16,
          requires = "frame", help_heading = "Frame")]
    pub(super) spp: u64,

    /// Sampler of the frame, as of glint render
    #[arg(long, value_name = "NAME", value_parser = sampler, requires = "frame", help_heading = "Frame")]
    pub(super) sampler: Option<Strategy>,

    /// Rays of each kind; k, M and G multiply it
    #[arg(long, value_name = "N", default_value = "131072", value_parser = count, help_heading = "Race")]
    pub(super) rays: u64,
    /// Kinds of rays: primary, first-bounce, deep-bounce, shadow, ambient-occlusion, random [default: all]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = named("kind of rays", &RayKind::ALL),
          help_heading = "Race")]
    pub(super) kinds: Vec<RayKind>,
    /// Numbers of threads to race on, one after the other; 0 is one a core [default: 1,0]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = threads, help_heading = "Race")]
    pub(super) threads: Vec<usize>,
    /// Widest instructions for both sides: portable, avx2 or avx512 [default: all that there are]
    #[arg(long, value_name = "NAME", value_parser = named("instruction set", &Isa::ALL), help_heading = "Race")]
    pub(super) isa: Option<Isa>,
    /// Time for each scene, building included, the oracle on top; what there is time for is repeated
    #[arg(long, value_name = "TIME", default_value = "2m", value_parser = duration, help_heading = "Race")]
    pub(super) time: Duration,
    /// Take every time exactly so often, however long that is
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000), help_heading = "Race")]
    pub(super) repetitions: Option<u64>,
    /// Race all of Embree's calls for several rays, not only the best two of a short trial
    #[arg(long, help_heading = "Race")]
    pub(super) all_calls: bool,
    /// Which axis of the scene is up [default: y]
    #[arg(long, value_enum, help_heading = "Race")]
    pub(super) up: Option<Up>,
    #[command(flatten)]
    pub(super) build: Build,
}

/// How hierarchies are built.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct Build {
    /// Work on the hierarchy that finds what rays hit: fast, default or high; the picture is the same
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = named("quality", &Quality::ALL),
          help_heading = "Machine")]
    pub(super) quality: Quality,
    /// Hierarchy in half of the memory, for rays about half as fast; the picture is the same
    #[arg(long, help_heading = "Machine")]
    pub(super) low_memory: bool,
}

impl Build {
    pub(super) fn options(self, threads: usize) -> BuildOptions {
        BuildOptions { threads, quality: self.quality, is_compact: self.low_memory }
    }
}

const GENERATE_EXAMPLES: &str = "\
Examples:
  glint generate terrain -o terrain.obj --triangles 2M
      terrain.obj and terrain.mtl, 2 000 000 triangles
  glint generate city -o city.obj --triangles 500k --seed 7
  glint generate foliage -o grove.obj --triangles 10M
      grove.obj, grove.mtl and grove-leaf.png";

/// `glint generate`.
#[derive(Debug, Args)]
pub(super) struct Generate {
    /// What to generate: terrain, city, sphereflake, foliage or hairball
    #[arg(value_parser = named("model", &Kind::ALL))]
    pub(super) kind: Kind,
    /// Model to write, .obj; its materials go beside it, under the same name
    #[arg(short, long, value_name = "FILE.obj")]
    pub(super) output: PathBuf,
    /// Number of triangles, at least 2000; k, M and G multiply it
    #[arg(long, value_name = "N", value_parser = count)]
    pub(super) triangles: u64,
    /// Random seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,
    /// Print nothing but errors
    #[arg(short, long)]
    pub(super) quiet: bool,
}

/// Backends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    /// Debian's Embree
    Embree,
    /// The in-house BVH
    Bvh,
    /// The faster one on this machine: the in-house BVH where it has AVX-512
    #[default]
    Auto,
}

/// Axes that can be up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Up {
    /// +y
    Y,
    /// +z
    Z,
}

impl Up {
    pub(super) fn direction(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_a_command_line_that_says_nothing() {
        let said = Glint::try_parse_from(["glint", "render", "a.obj"]).expect("it parses");
        let nothing = Render { scene: "a.obj".into(), ..Render::default() };
        assert_eq!(format!("{said:?}"), format!("Glint {{ command: Render({nothing:?}) }}"));
    }
}
