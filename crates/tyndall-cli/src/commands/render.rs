//! `tyndall render`.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use crate::{
    args::RenderArgs,
    failure::Failure,
    layer::{Layer, Layers},
    output::{Format, check_folder, write_atomically},
    picture::automatic_exposure,
    progress::Stages,
    render::{self, Backend},
    setup::Setup,
    shot::Shot,
    stats::Stats,
};

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    if args.frames.is_some() {
        return Err(Failure::not_there_yet("--frames"));
    }
    let layers = distinct(&args.layers);
    let given = args.output.as_deref();
    let format = given
        .map_or(Ok(Format::Png), |file| Format::of(file, &layers))
        .map_err(Failure::usage)?;
    let shot = Shot::load(&args.input, args.technique.as_deref(), &args.overrides)
        .map_err(Failure::input)?;
    let output = given.map_or_else(|| PathBuf::from(format!("{}.png", shot.name())), Into::into);
    Format::of(&output, &layers).map_err(Failure::usage)?;
    for file in std::iter::once(&output).chain(&args.stats) {
        check_folder(file).map_err(Failure::input)?;
    }
    if shot.temporal.is_some() || shot.animation.is_some() {
        eprintln!("note: the shot is a sequence; its first frame is rendered");
    }

    let mut stages = Stages::default();
    let backend = Backend::choose(args.backend, shot.technique.info())?;
    let setup = Setup::new(&shot, &mut stages)?;
    let rendered = render::render(&setup, &backend, &layers, &mut stages)?;
    let ev = match format {
        Format::Png => exposure(args.exposure, &rendered.layers),
        Format::Exr => 0.0,
    };
    format
        .write(&output, &rendered.layers, ev)
        .map_err(Failure::input)?;
    eprintln!("wrote {}", output.display());
    if let Some(file) = &args.stats {
        let stats = Stats {
            adapter: backend.adapter(),
            technique: &shot.technique,
            size: shot.size,
            layers: &layers,
            rendered: &rendered,
            stages: stages.times(),
            total: start.elapsed().as_secs_f64() * 1e3,
            command: std::env::args().collect(),
        };
        write_stats(file, &stats)?;
    }
    Ok(())
}

/// Each layer once, in the order of the command line.
fn distinct(layers: &[Layer]) -> Vec<Layer> {
    let mut seen = Vec::new();
    for layer in layers {
        if !seen.contains(layer) {
            seen.push(*layer);
        }
    }
    seen
}

/// The exposure of a PNG [EV]; says the automatic one, so that it can be given next time.
fn exposure(fixed: Option<f32>, layers: &Layers) -> f32 {
    match (fixed, layers.first()) {
        (Some(ev), _) => ev,
        (None, Some((Layer::Final | Layer::Inscatter | Layer::Surface, picture))) => {
            let ev = automatic_exposure(picture);
            eprintln!("exposure: {ev:.2} EV (automatic)");
            ev
        }
        (None, _) => 0.0,
    }
}

fn write_stats(file: &Path, stats: &Stats<'_>) -> Result<(), Failure> {
    let text = format!("{:#}\n", stats.to_json());
    write_atomically(file, text.as_bytes()).map_err(Failure::input)
}
