//! `tyndall compare`.

use std::path::PathBuf;

use tyndall::techniques::{Backends, TABLE, Technique, TechniqueInfo};

use crate::{
    args::{CompareArgs, ReferenceChoice},
    backend::Backend,
    compare::{Comparison, Subject, files, settings},
    failure::Failure,
    load::LoadedShot,
    measure::{DrawnFrame, Visibility},
    output::check_folder,
    progress::Progress,
    shot::Shot,
};

pub(super) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let shot = Shot::load(&args.shot, None, &args.overrides).map_err(Failure::input)?;
    if let Some(file) = &args.json {
        check_folder(file).map_err(Failure::input)?;
    }
    let folder = args.output.clone();
    let folder = folder.unwrap_or_else(|| PathBuf::from(format!("{}-compare", shot.name())));
    if shot.temporal.is_some() || shot.animation.is_some() {
        eprintln!("note: the shot is a sequence; its first frame is compared");
    }
    let mut lights = shot.lights.iter().flatten();
    if lights.any(|light| light.technique.is_some()) {
        eprintln!("note: each technique computes all lights, whatever technique a light names");
    }

    let mut progress = Progress::default();
    let backend = Backend::choose(args.backend, &[decisive(&args.techniques)])?;
    let shot_frame = LoadedShot::at_rest(&shot, &mut progress)?.frame(0)?;
    let drawn = DrawnFrame::new(&shot_frame, &backend, &mut progress)?;
    let techniques = techniques(args, &shot, &drawn)?;
    let candidates: Vec<_> = techniques.iter().flat_map(settings::candidates).collect();
    files::make_folder(&folder).map_err(Failure::input)?;

    let visibility = match args.reference {
        ReferenceChoice::Traced => Visibility::Traced,
        ReferenceChoice::ShadowMap => Visibility::ShadowMap,
    };
    let subject = Subject {
        shot: shot.name(),
        scene: shot.scene.to_string(),
        command: std::env::args().collect(),
        adapter: backend.adapter().cloned(),
        left_out: left_out(args, &techniques),
    };
    let comparison = Comparison::measure(subject, &drawn, &candidates, visibility, &mut progress)?;
    let page = files::write(&comparison, &folder).map_err(Failure::input)?;
    eprintln!("wrote {}", page.display());
    if let Some(file) = &args.json {
        files::write_json(&comparison.report, file).map_err(Failure::input)?;
        eprintln!("wrote {}", file.display());
    }
    Ok(())
}

/// The technique that decides on the backend: one that runs on the GPU only, else one that can run there, else any.
fn decisive(names: &[String]) -> &'static TechniqueInfo {
    let is_chosen =
        |info: &&TechniqueInfo| names.is_empty() || names.iter().any(|n| n == info.name);
    let chosen = || TABLE.iter().filter(is_chosen);
    let backends: &[_] = if names.is_empty() {
        &[Backends::Both]
    } else {
        &[Backends::Gpu, Backends::Both]
    };
    backends
        .iter()
        .find_map(|backends| chosen().find(|info| info.backends == *backends))
        .or_else(|| chosen().next())
        .unwrap_or(&TABLE[0])
}

/// The techniques of the command line, or all that can do the shot; the shot's own has the shot's parameters.
fn techniques(
    args: &CompareArgs,
    shot: &Shot,
    drawn: &DrawnFrame<'_>,
) -> Result<Vec<Technique>, Failure> {
    let mut techniques = drawn.techniques();
    if !args.techniques.is_empty() {
        for name in &args.techniques {
            if !techniques.iter().any(|t| t.info().name == name) {
                return Err(Failure::Input(anyhow::anyhow!(
                    "technique {name} cannot do this shot's lights here"
                )));
            }
        }
        techniques.retain(|t| args.techniques.iter().any(|name| name == t.info().name));
    }
    for technique in &mut techniques {
        let own = shot.technique.as_ref();
        if let Some(own) = own.filter(|own| own.info().name == technique.info().name) {
            *technique = own.clone();
        }
    }
    Ok(techniques)
}

/// Techniques that the shot is too much for, where all are wanted.
fn left_out(args: &CompareArgs, techniques: &[Technique]) -> Vec<String> {
    if !args.techniques.is_empty() {
        return Vec::new();
    }
    TABLE
        .iter()
        .filter(|info| !info.is_reference)
        .filter(|info| techniques.iter().all(|t| t.info().name != info.name))
        .map(|info| format!("{}: cannot do this shot's lights here", info.name))
        .collect()
}
