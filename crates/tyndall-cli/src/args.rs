//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum, builder::PossibleValuesParser};

use tyndall::techniques::Technique;

use crate::{
    backend::BackendChoice,
    bench::suite_names,
    layer::Layer,
    shot::{FrameRange, Override, technique_names},
};

/// Volumetric shadows in single-scattering media: fog, haze and air with shafts of light.
#[derive(Clone, Debug, Parser)]
#[command(name = "tyndall", version, after_help = EXAMPLES)]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  tyndall render builtin:church                     a built-in scene to church.png
  tyndall render model.glb -o model.png             frames the model, lights it, fills the air with haze
  tyndall render shot.toml -o shot.exr --layer final --layer inscatter
  tyndall compare shot.toml -o report               error and time of each technique, with pictures
  tyndall info model.glb                            what a scene holds

Exit codes: 0 done, 1 the input is wrong, 2 usage, 3 the device failed.";

/// The commands.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Render a shot or a scene to a picture
    Render(RenderArgs),
    /// Measure the error and time of techniques on a shot
    Compare(CompareArgs),
    /// Measure the papers' tables on this machine
    Bench(BenchArgs),
    /// Open a shot or a scene in a window
    View(ViewArgs),
    /// List adapters, limits and techniques, or what a scene or a shot holds
    Info(InfoArgs),
}

/// Arguments of `tyndall render`.
#[derive(Clone, Debug, Args)]
#[command(after_help = RENDER_EXAMPLES)]
pub struct RenderArgs {
    /// A shot (.toml) or a scene (.gltf, .glb or builtin:NAME)
    #[arg(value_name = "SHOT|SCENE")]
    pub input: PathBuf,
    /// The picture: .png is tone-mapped, .exr is linear; left out: the input's name with .png, in this folder
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// The technique of all lights without one of their own; takes the place of the shot's, and of its parameters where it is
    /// another one
    #[arg(long, value_name = "T", value_parser = PossibleValuesParser::new(technique_names()))]
    pub technique: Option<String>,
    /// Override a key of the shot by its dotted path; the value is TOML or a bare word
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<Override>,
    /// Backend that renders
    #[arg(long, value_name = "B", default_value = "auto")]
    pub backend: BackendChoice,
    /// Content of the picture; several layers go into one .exr by their names
    #[arg(long = "layer", value_name = "L", default_value = "final")]
    pub layers: Vec<Layer>,
    /// Exposure of a .png in EV: light is multiplied by 2^EV; left out: chosen by the picture's brightness
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = exposure)]
    pub exposure: Option<f32>,
    /// Write adapter, parameters, milliseconds a pass and bytes as JSON
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Render a sequence, from frame A to frame B; OUT's name holds #### or %04d, where the frame's number goes
    #[arg(long, value_name = "A..B")]
    pub frames: Option<FrameRange>,
    /// Skip frames whose files exist
    #[arg(long, requires = "frames")]
    pub resume: bool,
}

const RENDER_EXAMPLES: &str = "\
Examples:
  tyndall render builtin:church
  tyndall render shot.toml -o shot.exr --layer inscatter --technique reference
  tyndall render shot.toml --set light.0.shadow_map=4096 --set medium.sigma_s=[0.1,0.1,0.1]
  tyndall render model.glb --set size=[1920,1080] --set camera.eye=[0,2,5] --exposure -1.5
  tyndall render shot.toml --frames 0..59 -o frames/shot.####.png --resume

A .png holds one layer: light is exposed and tone-mapped (Khronos PBR Neutral), transmittance is shown as it is.
Depth in a .exr is the distance along the view ray in metres. Paths in a shot and in --set are relative to the shot's folder.
Frames of a sequence are written whole or not at all. Give the shot `frames = \"A..B\"` in [animation] to render parts of it
in several places: its keyframes, and the automatic exposure of its first frame, then hold for each part.";

/// Arguments of `tyndall compare`.
#[derive(Clone, Debug, Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub struct CompareArgs {
    /// A shot (.toml) or a scene (.gltf, .glb or builtin:NAME)
    pub shot: PathBuf,
    /// The techniques; left out: all that can do the shot's lights
    #[arg(long, value_name = "A,B,..", value_delimiter = ',', value_parser = PossibleValuesParser::new(compared_names()))]
    pub techniques: Vec<String>,
    /// Source of the reference's visibility
    #[arg(long, value_name = "V", default_value = "traced")]
    pub reference: ReferenceChoice,
    /// Folder of the report, made where it is missing; left out: the shot's name with -compare, in this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the numbers as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Override a key of the shot by its dotted path; the value is TOML or a bare word
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<Override>,
    /// Backend of techniques that run on both; the reference runs on the CPU
    #[arg(long, value_name = "B", default_value = "auto")]
    pub backend: BackendChoice,
}

const COMPARE_EXAMPLES: &str = "\
Examples:
  tyndall compare shot.toml                         all techniques, to shot-compare/report.html
  tyndall compare shot.toml --techniques ray-march --reference shadow-map -o out --json out.json

Each technique is measured at several settings, the shot's own among them: errors against the reference, times of frames
in turn. report.html opens from disk and needs no network; pictures lie beside it as .png and linear .exr.";

/// Techniques that can be compared with the reference: all others.
fn compared_names() -> Vec<&'static str> {
    let mut names = technique_names();
    names.retain(|name| {
        Technique::from_name(name).is_some_and(|technique| !technique.info().is_reference)
    });
    names
}

/// Source of the reference's visibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ReferenceChoice {
    /// The scene's triangles
    Traced,
    /// The shadow map's texels, which leaves out the map's own error
    ShadowMap,
}

/// Arguments of `tyndall bench`.
#[derive(Clone, Debug, Args)]
#[command(after_help = BENCH_HELP)]
pub struct BenchArgs {
    /// The tables to measure; left out: all
    #[arg(value_parser = PossibleValuesParser::new(suite_names()))]
    pub suite: Option<String>,
    /// Write the numbers as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Folder of the papers' scenes; left out: `shared/assets` of a folder above this one or above the program
    #[arg(long, value_name = "DIR")]
    pub assets: Option<PathBuf>,
}

const BENCH_HELP: &str = "\
Tables go to standard output, progress to standard error. Times are the device's timestamps, summed over a frame's passes
(on the CPU: wall-clock time): median [lower quartile, upper quartile] of at least 10 frames, fewer where a frame takes
seconds. Frames of all techniques of a table take turns. `x limit` is the time over that of a pass that reads depth buffer
and shadow map once and writes the output once. Scenes that are missing are stood in for by built-in ones, which is said.
`poses` fails where a value is not finite or a pixel is more wrong than its technique states.";

/// Arguments of `tyndall view`.
#[derive(Clone, Debug, Args)]
pub struct ViewArgs {
    /// A shot (.toml) or a scene (.gltf, .glb or builtin:NAME)
    #[arg(value_name = "SHOT|SCENE")]
    pub input: PathBuf,
}

/// Arguments of `tyndall info`.
#[derive(Clone, Debug, Args)]
pub struct InfoArgs {
    /// A shot (.toml) or a scene (.gltf, .glb or builtin:NAME); left out: the machine and the techniques
    #[arg(value_name = "SHOT|SCENE")]
    pub input: Option<PathBuf>,
}

fn exposure(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|ev: &f32| ev.abs() <= 100.0)
        .ok_or_else(|| "expected a number from -100 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn exposure_is_a_sane_number() {
        assert_eq!(exposure("-1.5"), Ok(-1.5));
        for text in ["nan", "inf", "1e9", "bright"] {
            assert!(exposure(text).is_err(), "{text}");
        }
    }
}
