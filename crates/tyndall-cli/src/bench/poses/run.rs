//! The tables: every technique from everywhere, over all scenes and scene by scene.

use std::ops::Range;

use tyndall::{
    frame::LightKind,
    techniques::{TABLE, TechniqueInfo},
};

use super::{
    camera::cameras,
    errors::{Errors, Located, Truth},
    stage::STAGES,
    worst::{SHARE, Worst, worst_of},
};
use crate::{
    bench::{
        report::{Bench, Report},
        table::{Cell, Table},
    },
    failure::Failure,
    load::ShotFrame,
    measure::{DrawnFrame, Place, Sparse, Visibility},
    progress::Progress,
};

/// Pictures from random places.
pub(in crate::bench) struct Poses {
    /// Cameras a scene.
    pub(in crate::bench) poses: usize,
    /// Width and height of the pictures, multiples of [`STEP`] \[pixels].
    pub(in crate::bench) size: [u32; 2],
}

/// Pixels from one that is compared to the next, across and down; which ones changes from camera to camera.
pub(in crate::bench) const STEP: u32 = 5;
/// Cameras from one that the CPU's side takes to the next; has no divisor in common with the kinds of camera.
const CPU_EVERY: usize = 3;

/// A technique on one processor, in one scene.
struct Trial {
    scene: &'static str,
    technique: &'static TechniqueInfo,
    place: Place,
    worst: Worst,
    pictures: u64,
    errors: Errors,
}

const COLUMNS: [&str; 14] = [
    "technique",
    "on",
    "light",
    "pictures",
    "pixels",
    "not finite",
    "p99",
    "at most",
    "largest error",
    "its worst",
    "pixels past it",
    "scene",
    "camera",
    "pixel",
];

/// Measures the suite.
pub(in crate::bench) fn run(
    suite: &Poses,
    bench: &Bench,
    progress: &mut Progress,
) -> Result<Report, Failure> {
    let mut trials = Vec::new();
    let mut notes = vec![
        format!(
            "{} cameras a scene, every {CPU_EVERY}rd of them on the CPU; {} x {} pixels, of which one of {STEP} x {STEP} is compared",
            suite.poses, suite.size[0], suite.size[1]
        ),
        "errors against the reference: of the same shadow map, of panels traced; relative to the pixel, to its picture's mean, or to \
         a hundredth of what they would be without shadows, whichever is most"
            .to_owned(),
        "p99: of the scene where it is largest; pixels past it: more wrong than the worst, and those by which over 1 % of a scene's \
         are more wrong than the bound of p99"
            .to_owned(),
    ];
    for (index, stage) in STAGES.iter().enumerate() {
        let Some(shot_frame) = stage.load(suite.size, bench, progress)? else {
            notes.push(format!(
                "skipped: the scene of \"{}\" is not among the assets",
                stage.name
            ));
            continue;
        };
        let name = format!("{} poses of {}", suite.poses, stage.name);
        trials.extend(progress.run(&name, |report| {
            let poses = index * suite.poses..(index + 1) * suite.poses;
            of_scene(stage.name, &shot_frame, poses, bench, report)
        })?);
    }
    let each: Vec<Vec<&Trial>> = trials.iter().map(|trial| vec![trial]).collect();
    Ok(Report {
        tables: vec![
            table(
                "each technique from random places",
                notes,
                &by_technique(&trials),
            ),
            table("scene by scene", Vec::new(), &each),
        ],
        missing: Vec::new(),
        faults: trials.iter().filter_map(Trial::fault).collect(),
    })
}

/// Every technique that can do the scene, in every place, by the cameras of these numbers.
fn of_scene(
    scene: &'static str,
    shot_frame: &ShotFrame,
    poses: Range<usize>,
    bench: &Bench,
    report: &dyn Fn(u64, u64),
) -> Result<Vec<Trial>, Failure> {
    let mut drawn = DrawnFrame::new(shot_frame, &bench.backend, &mut Progress::quiet())?;
    let mut trials = trials(scene, shot_frame, &drawn)?;
    let cameras = cameras(shot_frame, poses);
    for (done, (pose, camera)) in cameras.iter().enumerate() {
        drawn.look_from(*camera)?;
        let truth = truth(&drawn, *pose)?;
        for trial in &mut trials {
            if trial.place == Place::Cpu && done % CPU_EVERY != 0 {
                continue;
            }
            let technique = trial.technique.default_technique();
            let picture = drawn.in_scatter_at(&technique, trial.place)?;
            trial.errors.add(*pose, &picture, &truth);
            trial.pictures += 1;
        }
        report(done as u64 + 1, cameras.len() as u64);
    }
    Ok(trials)
}

/// Nothing measured yet.
fn trials(
    scene: &'static str,
    shot_frame: &ShotFrame,
    drawn: &DrawnFrame<'_>,
) -> Result<Vec<Trial>, Failure> {
    let mut trials = Vec::new();
    for technique in TABLE {
        if technique.is_reference || !reads_all(technique, shot_frame) {
            continue;
        }
        for place in drawn.places(technique) {
            trials.push(Trial {
                scene,
                technique,
                place,
                worst: worst_of(technique.name, shot_frame).ok_or_else(|| {
                    Failure::Input(anyhow::anyhow!("{} states no worst", technique.name))
                })?,
                pictures: 0,
                errors: Errors::default(),
            });
        }
    }
    Ok(trials)
}

/// Whether a technique reads all that the scene holds before its lights.
fn reads_all(technique: &TechniqueInfo, shot_frame: &ShotFrame) -> bool {
    let mut lights = shot_frame.frame.lights.iter();
    let has_glass = shot_frame.tracer.has_tinted_glass();
    (technique.reads.glass || !has_glass)
        && (technique.reads.textures || lights.all(|light| light.texture.is_none()))
}

/// Other pixels for each camera. Lights without a map, which panels are, are traced.
fn truth(drawn: &DrawnFrame<'_>, pose: usize) -> Result<Truth, Failure> {
    let sparse = Sparse {
        step: STEP,
        first: [pose as u32 % STEP, pose as u32 / STEP % STEP],
    };
    let lights = &drawn.shot_frame().frame.lights;
    let has_panel = lights.iter().any(|light| light.kind() == LightKind::Rect);
    let visibility = if has_panel {
        Visibility::Traced
    } else {
        Visibility::ShadowMap
    };
    let picture = drawn.sparse_reference(visibility, sparse)?;
    Ok(Truth::new(
        &picture,
        &drawn.sparse_unshadowed(sparse)?,
        sparse,
    ))
}

/// The trials of one technique, place and kind of light together, in the order in which they come.
fn by_technique(trials: &[Trial]) -> Vec<Vec<&Trial>> {
    let mut groups: Vec<Vec<&Trial>> = Vec::new();
    for trial in trials {
        let key = |of: &Trial| (of.technique.name, of.place, of.worst.light);
        match groups.iter_mut().find(|group| key(group[0]) == key(trial)) {
            Some(group) => group.push(trial),
            None => groups.push(vec![trial]),
        }
    }
    groups.sort_by_key(|group| {
        TABLE
            .iter()
            .position(|info| info.name == group[0].technique.name)
    });
    groups
}

fn table(title: &str, notes: Vec<String>, groups: &[Vec<&Trial>]) -> Table {
    Table {
        title: title.to_owned(),
        notes,
        columns: COLUMNS.to_vec(),
        rows: groups.iter().filter_map(|group| row(group)).collect(),
    }
}

/// Trials of one technique, place and kind of light: the worst of them, and the sum of their counts.
fn row(trials: &[&Trial]) -> Option<Vec<Cell>> {
    let of_error = |a: &&&Trial, b: &&&Trial| {
        let [a, b] = [a, b].map(|trial| trial.errors.largest.error);
        a.total_cmp(&b)
    };
    let worst = trials.iter().max_by(of_error)?;
    let p99 = trials.iter().map(|trial| trial.errors.all_but(SHARE));
    let count =
        |of: &dyn Fn(&Trial) -> u64| Cell::Count(trials.iter().map(|trial| of(trial)).sum());
    let Located { error, pose, pixel } = worst.errors.largest;
    Some(vec![
        Cell::text(worst.technique.name),
        Cell::text(worst.place.name()),
        Cell::text(worst.worst.light),
        count(&|trial| trial.pictures),
        count(&|trial| trial.errors.pixels()),
        count(&|trial| trial.errors.not_finite),
        Cell::Number(p99.fold(0.0, f64::max)),
        Cell::Number(worst.worst.usual),
        Cell::Number(error),
        Cell::Number(worst.worst.most),
        count(&Trial::past),
        Cell::text(worst.scene),
        Cell::Count(pose as u64),
        Cell::text(format!("{} {}", pixel[0], pixel[1])),
    ])
}

impl Trial {
    fn past(&self) -> u64 {
        self.worst.past(&self.errors)
    }

    /// What is wrong with it, if anything is.
    fn fault(&self) -> Option<String> {
        let (not_finite, past) = (self.errors.not_finite, self.past());
        let (name, place, scene) = (self.technique.name, self.place.name(), self.scene);
        (not_finite + past > 0).then(|| {
            format!("{name} on the {place}, {scene}: {not_finite} pixels are not finite, {past} past its worst")
        })
    }
}
