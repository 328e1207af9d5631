//! `tyndall render`.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use crate::{
    args::RenderArgs,
    backend::Backend,
    failure::Failure,
    layer::{Layer, Layers},
    load::LoadedShot,
    output::{Format, Pattern, check_folder, write_atomically},
    picture::automatic_exposure,
    progress::Progress,
    render::{self, Rendered, Renderer},
    shot::{FrameRange, Shot},
    stats::{FrameStats, Stats},
};

pub(super) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let job = Job::new(args)?;
    match args.frames {
        Some(frames) => job.render_sequence(frames),
        None => job.render_picture(),
    }
}

/// A job that the command line asks for, checked as far as it can be before any work is done.
struct Job<'a> {
    args: &'a RenderArgs,
    start: Instant,
    layers: Vec<Layer>,
    format: Format,
    output: PathBuf,
    shot: Shot,
}

impl<'a> Job<'a> {
    fn new(args: &'a RenderArgs) -> Result<Self, Failure> {
        let start = Instant::now();
        let layers = distinct(&args.layers);
        let given = args.output.as_deref();
        if let Some(file) = given {
            Format::of(file, &layers).map_err(Failure::usage)?;
            if args.frames.is_some() {
                Pattern::of(file).map_err(Failure::usage)?;
            }
        }
        let shot = Shot::load(&args.input, args.technique.as_deref(), &args.overrides)
            .map_err(Failure::input)?;
        let number = args.frames.map_or("", |_| ".####");
        let default = || PathBuf::from(format!("{}{number}.png", shot.name()));
        let output = given.map_or_else(default, Into::into);
        let format = Format::of(&output, &layers).map_err(Failure::usage)?;
        for file in std::iter::once(&output).chain(&args.stats) {
            check_folder(file).map_err(Failure::input)?;
        }
        Ok(Self {
            args,
            start,
            layers,
            format,
            output,
            shot,
        })
    }

    fn backend(&self) -> Result<Backend, Failure> {
        Backend::choose(self.args.backend, &self.shot.named_techniques())
    }

    fn render_picture(&self) -> Result<(), Failure> {
        let mut progress = Progress::default();
        let backend = self.backend()?;
        let shot_frame = match &self.shot.animation {
            None => LoadedShot::at_rest(&self.shot, &mut progress)?.frame(0)?,
            Some(animation) => {
                let frames = animation.frames.unwrap_or(FrameRange { first: 0, last: 0 });
                let first = frames.first;
                eprintln!("note: the shot is a sequence; its frame {first} is rendered");
                LoadedShot::moving(&self.shot, frames, &mut progress)?.frame(first)?
            }
        };
        let rendered = render::render(&shot_frame, &backend, &self.layers, &mut progress)?;
        let ev = self.exposure(&rendered.layers);
        self.write(&self.output, &rendered.layers, ev)?;
        eprintln!("wrote {}", self.output.display());
        self.write_stats(&backend, Some(&rendered), &[], &progress)
    }

    fn render_sequence(&self, frames: FrameRange) -> Result<(), Failure> {
        let pattern = Pattern::of(&self.output).map_err(Failure::usage)?;
        let wanted = self.wanted(frames, &pattern);
        let Some(&first_wanted) = wanted.first() else {
            return Ok(());
        };
        let mut progress = Progress::default();
        let backend = self.backend()?;
        let mut loaded = LoadedShot::moving(&self.shot, frames, &mut progress)?;
        let (temporal, layers) = (self.shot.temporal.as_ref(), &self.layers);
        let mut renderer = {
            let first = loaded.frame(first_wanted)?;
            Renderer::new(&first, temporal, &backend, layers, &mut progress)?
        };
        let mut ev = None;
        let mut done = Vec::new();
        let mut last = None;
        progress.each(&format!("frames {frames}"), &wanted, |&number| {
            let ev = match ev {
                Some(ev) => ev,
                None => *ev.insert(self.first_exposure(&mut loaded, &mut renderer)?),
            };
            let start = Instant::now();
            let rendered = renderer.render(&loaded.frame(number)?, &mut Progress::quiet())?;
            let file = pattern.file(number);
            self.write(&file, &rendered.layers, ev)?;
            done.push(FrameStats {
                frame: number,
                passes: rendered.passes.clone(),
                counts: rendered.counts.clone(),
            });
            last = Some(rendered);
            let milliseconds = start.elapsed().as_secs_f64() * 1e3;
            Ok(format!("wrote {}: {milliseconds:.0} ms", file.display()))
        })?;
        self.write_stats(&backend, last.as_ref(), &done, &progress)
    }

    /// The frames that are to be rendered; says how many are skipped because their files exist.
    fn wanted(&self, frames: FrameRange, pattern: &Pattern) -> Vec<u32> {
        let is_skipped = |frame: &u32| self.args.resume && pattern.file(*frame).exists();
        let (skipped, wanted): (Vec<u32>, _) = frames.frames().partition(is_skipped);
        if !skipped.is_empty() {
            let count = skipped.len();
            eprintln!("frames {frames}: {count} skipped, their files exist");
        }
        wanted
    }

    /// The exposure of all frames of a sequence \[EV]: that of its first, for one that follows each frame flickers.
    fn first_exposure(
        &self,
        loaded: &mut LoadedShot,
        renderer: &mut Renderer<'_>,
    ) -> Result<f32, Failure> {
        if self.args.exposure.is_some() || self.format == Format::Exr {
            return Ok(self.args.exposure.unwrap_or_default());
        }
        let first = loaded.frame(loaded.range().first)?;
        let rendered = renderer.render(&first, &mut Progress::quiet())?;
        Ok(self.exposure(&rendered.layers))
    }

    /// The exposure of a PNG \[EV]; says the automatic one, so that it can be given next time.
    fn exposure(&self, layers: &Layers) -> f32 {
        match (self.format, self.args.exposure, layers.first()) {
            (Format::Exr, ..) => 0.0,
            (Format::Png, Some(ev), _) => ev,
            (_, _, Some((Layer::Final | Layer::Inscatter | Layer::Surface, picture))) => {
                let ev = automatic_exposure(picture);
                eprintln!("exposure: {ev:.2} EV (automatic)");
                ev
            }
            _ => 0.0,
        }
    }

    fn write(&self, file: &Path, layers: &Layers, ev: f32) -> Result<(), Failure> {
        self.format.write(file, layers, ev).map_err(Failure::input)
    }

    fn write_stats(
        &self,
        backend: &Backend,
        rendered: Option<&Rendered>,
        frames: &[FrameStats],
        progress: &Progress,
    ) -> Result<(), Failure> {
        let (Some(file), Some(rendered)) = (&self.args.stats, rendered) else {
            return Ok(());
        };
        let stats = Stats {
            adapter: backend.adapter(),
            technique: self.shot.technique.as_ref(),
            size: self.shot.size,
            layers: &self.layers,
            rendered,
            frames,
            stages: progress.times(),
            total: self.start.elapsed().as_secs_f64() * 1e3,
            command: std::env::args().collect(),
        };
        let text = format!("{:#}\n", stats.to_json());
        write_atomically(file, text.as_bytes()).map_err(Failure::input)
    }
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
