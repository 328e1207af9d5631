//! A frame on the CPU.

use std::sync::LazyLock;

use tyndall::cpu::{CpuInputs, CpuLightInputs, render};
use tyndall_scene::{builtin::builtin, trace::Tracer};

use super::{checked, drawn::Drawn};
use crate::outcome::Outcome;

/// What blocks light where visibility is traced.
static OCCLUDERS: LazyLock<Tracer> =
    LazyLock::new(|| Tracer::new(&builtin("slats").unwrap_or_default()));

/// Computes a frame drawn from bytes.
pub fn run(bytes: &[u8]) -> Outcome {
    let drawn = Drawn::new(bytes);
    let lights: Vec<_> = drawn
        .lights
        .iter()
        .map(|pictures| CpuLightInputs {
            shadow_map: pictures.shadow_map.as_ref(),
            glass: pictures.glass.as_ref(),
            texture: pictures.texture.as_ref(),
        })
        .collect();
    let inputs = CpuInputs {
        size: drawn.size,
        depth: &drawn.depth,
        lights: &lights,
        occluders: Some(&*OCCLUDERS),
    };
    match render(&drawn.frame, &inputs, &drawn.techniques, &|_, _| ()) {
        Ok(picture) => checked(&picture.pixels, &(&drawn.frame, &drawn.techniques)),
        Err(_) => Outcome::Refused,
    }
}
