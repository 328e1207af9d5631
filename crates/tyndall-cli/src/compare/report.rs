//! A comparison: its numbers, as they go into the page and into JSON, and its pictures.

use serde_json::{Map, Value, json};

use crate::{
    backend::AdapterDescription,
    measure::{PictureError, Spread, Timing},
    picture::Picture,
};

/// A report and the pictures that it is about.
pub struct Comparison {
    /// The numbers.
    pub report: Report,
    /// In-scattered radiance that is taken for true [W/(m^2 sr)].
    pub reference: Picture,
    /// In-scattered radiance of each of the report's rows [W/(m^2 sr)].
    pub pictures: Vec<Picture>,
}

/// A comparison of techniques on one shot.
#[derive(Clone, Debug)]
pub struct Report {
    /// Shot, scene and machine.
    pub subject: Subject,
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// When it was measured (UTC, RFC 3339).
    pub date: String,
    /// The technique that is taken for true.
    pub reference: Setting,
    /// Errors of what the shadow maps converge to, where the reference traces the scene: no technique that reads the maps
    /// can be better but by luck.
    pub floor: Option<PictureError>,
    /// The pass that reads depth and shadow map once and writes the output once; `None` on the CPU.
    pub limit: Option<Timing>,
    /// Exposure of all pictures \[EV].
    pub exposure: f32,
    /// A technique at a setting each, in the order of the table of techniques.
    pub rows: Vec<Row>,
}

/// Shot, scene and machine of a comparison, for people.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The shot's name.
    pub shot: String,
    /// Its scene.
    pub scene: String,
    /// The command line.
    pub command: Vec<String>,
    /// The device; `None` where all was done on the CPU.
    pub adapter: Option<AdapterDescription>,
    /// Techniques that are not compared, and why.
    pub left_out: Vec<String>,
}

/// A technique and its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The technique's name.
    pub technique: String,
    /// Its parameters' keys and values.
    pub parameters: Vec<(String, String)>,
    /// Key and value of the parameter that tells this setting from the technique's others; `None` where there is one setting.
    pub varied: Option<(String, String)>,
}

impl Setting {
    /// Its name for people: the technique, and the parameter that tells it from the technique's other settings.
    pub fn label(&self) -> String {
        match &self.varied {
            Some((key, value)) => format!("{} {key} {value}", self.technique),
            None => self.technique.clone(),
        }
    }

    /// The label as the stem of a file's name.
    pub fn file_stem(&self) -> String {
        let label = self.label().to_lowercase();
        let is_kept = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '.';
        label.replace(|c| !is_kept(c), "-")
    }
}

/// Costs of a technique at a setting, and its distance from the reference.
#[derive(Clone, Debug)]
pub struct Row {
    /// The technique and its parameters.
    pub setting: Setting,
    /// Its place and times.
    pub timing: Timing,
    /// Its total time as a multiple of the limit's; `None` on the CPU.
    pub over_limit: Option<f64>,
    /// Errors of the in-scattered radiance.
    pub errors: PictureError,
    /// Steps a ray, over all lights; `None` where the technique has no fixed count.
    pub steps: Option<u64>,
}

impl Report {
    /// The report as JSON. Times are milliseconds; a number that is not finite is `null`.
    pub fn to_json(&self) -> Value {
        json!({
            "tyndall": env!("CARGO_PKG_VERSION"),
            "shot": self.subject.shot,
            "scene": self.subject.scene,
            "size": self.size,
            "command": self.subject.command,
            "date": self.date,
            "adapter": self.subject.adapter.as_ref().map(|adapter| json!({
                "name": adapter.name,
                "driver": adapter.driver,
                "backend": adapter.api,
            })),
            "reference": self.reference.to_json(),
            "shadow_map_floor": self.floor.as_ref().map(errors),
            "limit": self.limit.as_ref().map(timing),
            "exposure_ev": self.exposure,
            "rows": self.rows.iter().map(Row::to_json).collect::<Vec<_>>(),
            "left_out": self.subject.left_out,
        })
    }
}

impl Setting {
    fn to_json(&self) -> Value {
        let text = |(key, value): &(String, String)| (key.clone(), json!(value));
        json!({
            "technique": self.technique,
            "parameters": self.parameters.iter().map(text).collect::<Map<_, _>>(),
        })
    }
}

impl Row {
    fn to_json(&self) -> Value {
        json!({
            "setting": self.setting.to_json(),
            "label": self.setting.label(),
            "timing": timing(&self.timing),
            "over_limit": self.over_limit,
            "errors": errors(&self.errors),
            "steps": self.steps,
        })
    }
}

fn timing(timing: &Timing) -> Value {
    let passes = timing.passes.iter();
    json!({
        "place": timing.place.name(),
        "frames": timing.frames,
        "total": spread(&timing.total()),
        "wall": spread(&timing.wall),
        "passes": passes
            .map(|(name, time)| json!({ "name": name, "time": spread(time) }))
            .collect::<Vec<_>>(),
        "bytes": timing.bytes,
    })
}

fn spread(time: &Spread) -> Value {
    json!({ "lower": time.lower, "median": time.median, "upper": time.upper })
}

fn errors(errors: &PictureError) -> Value {
    json!({
        "rel_mae": errors.rel_mae,
        "rel_rmse": errors.rel_rmse,
        "p99": errors.p99,
        "bias": errors.bias,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_say_what_varies_and_stems_are_safe_names() {
        let setting = |varied: Option<(&str, &str)>| Setting {
            technique: "ray-march".to_owned(),
            parameters: Vec::new(),
            varied: varied.map(|(key, value)| (key.to_owned(), value.to_owned())),
        };
        for (varied, label, stem) in [
            (None, "ray-march", "ray-march"),
            (
                Some(("steps", "64")),
                "ray-march steps 64",
                "ray-march-steps-64",
            ),
            (
                Some(("error", "0.5")),
                "ray-march error 0.5",
                "ray-march-error-0.5",
            ),
            (
                Some(("a", "../B\"")),
                "ray-march a ../B\"",
                "ray-march-a-..-b-",
            ),
        ] {
            let setting = setting(varied);
            assert_eq!(
                (setting.label().as_str(), setting.file_stem().as_str()),
                (label, stem)
            );
        }
    }
}
