//! The report of `--stats`: adapter, technique and layers of a render, and the cost of each part of it.

use serde_json::{Map, Value, json};
use tyndall::techniques::{self, Technique};

use crate::{backend::AdapterDescription, layer::Layer, render::Rendered};

/// A render and its costs.
pub struct Stats<'a> {
    /// The adapter; `None` on the CPU.
    pub adapter: Option<&'a AdapterDescription>,
    /// The technique of all lights that name none; `None` where the shot leaves it to the lights' kinds.
    pub technique: Option<&'a Technique>,
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// Layers that were asked for.
    pub layers: &'a [Layer],
    /// The rendered layers; of a sequence those of the last frame.
    pub rendered: &'a Rendered,
    /// The frames of a sequence, in order; empty of a single picture.
    pub frames: &'a [FrameStats],
    /// Wall-clock milliseconds of each stage of the command, in order.
    pub stages: &'a [(String, f64)],
    /// Wall-clock milliseconds from the command's start to the written picture.
    pub total: f64,
    /// The command line.
    pub command: Vec<String>,
}

/// A frame of a sequence and its costs.
pub struct FrameStats {
    /// Its number.
    pub frame: u32,
    /// GPU passes and their milliseconds, in order.
    pub passes: Vec<(String, f64)>,
    /// Counts of the technique.
    pub counts: Vec<(String, u64)>,
}

impl FrameStats {
    fn to_json(&self) -> Value {
        json!({
            "frame": self.frame,
            "passes": times(&self.passes),
            "counts": counts(&self.counts),
        })
    }
}

impl Stats<'_> {
    /// The report as JSON. Times are milliseconds.
    pub fn to_json(&self) -> Value {
        let mut report = self.of_picture();
        if !self.frames.is_empty() {
            report["frames"] = self.frames.iter().map(FrameStats::to_json).collect();
        }
        report
    }

    fn of_picture(&self) -> Value {
        let lights = &self.rendered.techniques;
        let technique = self.technique.or(lights.first()).cloned();
        let technique = technique.unwrap_or_default();
        let light = |technique: &Technique| {
            let name = technique.info().name;
            json!({ "technique": name, "parameters": parameters(technique) })
        };
        json!({
            "tyndall": env!("CARGO_PKG_VERSION"),
            "command": self.command,
            "backend": if self.adapter.is_some() { "gpu" } else { "cpu" },
            "adapter": self.adapter.map(|adapter| json!({
                "name": adapter.name,
                "driver": adapter.driver,
                "backend": adapter.api,
            })),
            "technique": technique.info().name,
            "parameters": parameters(&technique),
            "lights": lights.iter().map(light).collect::<Vec<_>>(),
            "size": self.size,
            "layers": self.layers.iter().map(|layer| layer.name()).collect::<Vec<_>>(),
            "passes": times(&self.rendered.passes),
            "stages": times(self.stages),
            "total_ms": self.total,
            "bytes": bytes(&self.rendered.bytes),
            "counts": counts(&self.rendered.counts),
        })
    }
}

fn parameters(technique: &Technique) -> Map<String, Value> {
    technique
        .params()
        .into_iter()
        .map(|param| {
            let value = match param.value {
                techniques::Value::Integer(number) => json!(number),
                techniques::Value::Real(number) => json!(number),
                techniques::Value::Word(word) => json!(word),
                techniques::Value::Bool(yes) => json!(yes),
            };
            (param.key.to_owned(), value)
        })
        .collect()
}

fn times(times: &[(String, f64)]) -> Vec<Value> {
    times
        .iter()
        .map(|(name, milliseconds)| json!({ "name": name, "ms": milliseconds }))
        .collect()
}

fn counts(counts: &[(String, u64)]) -> Map<String, Value> {
    let entry = |(name, count): &(String, u64)| (name.clone(), json!(count));
    counts.iter().map(entry).collect()
}

fn bytes(parts: &[(&'static str, u64)]) -> Map<String, Value> {
    let total = parts.iter().map(|(_, bytes)| bytes).sum::<u64>();
    parts
        .iter()
        .copied()
        .chain([("total", total)])
        .map(|(name, bytes)| (name.to_owned(), json!(bytes)))
        .collect()
}
