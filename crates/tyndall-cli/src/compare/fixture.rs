//! A comparison made by code, for tests.

use super::report::{Comparison, Report, Row, Setting, Subject};
use crate::{
    backend::AdapterDescription,
    measure::{PictureError, Place, Spread, Timing},
    picture::Picture,
};

/// Three settings of one technique.
pub(crate) fn report() -> Report {
    Report {
        subject: Subject {
            shot: "a <shot> & more".to_owned(),
            scene: "builtin:empty".to_owned(),
            command: ["tyndall", "compare", "a.toml"].map(str::to_owned).to_vec(),
            adapter: Some(AdapterDescription {
                name: "a GPU".to_owned(),
                driver: "a driver 1.0".to_owned(),
                api: "vulkan",
            }),
            left_out: vec!["magic: there is none".to_owned()],
        },
        size: [32, 24],
        date: "2026-01-01T00:00:00Z".to_owned(),
        reference: setting("reference", &[("tolerance", "0.001")], None),
        floor: Some(errors(1e-4)),
        limit: Some(timing("limit", 1.5)),
        exposure: 0.0,
        rows: [64, 256, 1024].map(row).to_vec(),
    }
}

/// Gradients, the rows' brighter than the reference by 10 %, 2.5 % and 0.625 %.
pub(crate) fn comparison() -> Comparison {
    Comparison {
        report: report(),
        reference: picture(1.0),
        pictures: [64.0, 256.0, 1024.0]
            .map(|steps| picture(1.0 + 6.4 / steps))
            .to_vec(),
    }
}

fn picture(scale: f32) -> Picture {
    let pixel = |x: usize, y: usize| [0.02 * x as f32, 0.03 * y as f32, 0.1].map(|v| v * scale);
    Picture {
        size: [32, 24],
        pixels: (0..24)
            .flat_map(|y| (0..32).map(move |x| pixel(x, y)))
            .collect(),
    }
}

fn row(steps: u32) -> Row {
    let (text, milliseconds) = (steps.to_string(), 0.1 * f64::from(steps));
    Row {
        setting: setting(
            "ray-march",
            &[("steps", &text), ("spacing", "equal")],
            Some(0),
        ),
        timing: timing("ray march", milliseconds),
        over_limit: Some(milliseconds / 1.5),
        errors: errors(6.4 / f64::from(steps)),
        steps: Some(steps.into()),
    }
}

fn timing(pass: &str, milliseconds: f64) -> Timing {
    let time = Spread {
        lower: 0.95 * milliseconds,
        median: milliseconds,
        upper: 1.1 * milliseconds,
    };
    Timing {
        place: Place::Gpu,
        frames: 10,
        wall: time,
        gpu: Some(time),
        passes: vec![(pass.to_owned(), time)],
        bytes: Some(12_288),
    }
}

fn errors(rel_mae: f64) -> PictureError {
    PictureError {
        rel_mae,
        rel_rmse: 1.3 * rel_mae,
        p99: 2.0 * rel_mae,
        bias: rel_mae,
    }
}

fn setting(technique: &str, parameters: &[(&str, &str)], varied: Option<usize>) -> Setting {
    let parameters: Vec<(String, String)> = parameters
        .iter()
        .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
        .collect();
    Setting {
        technique: technique.to_owned(),
        varied: varied.map(|index| parameters[index].clone()),
        parameters,
    }
}
