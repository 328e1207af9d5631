//! A batch of a rectangular light's samples, marched.

use super::params::{INFO, Params};
use crate::{
    error::PrepareError,
    frame::Emitter,
    gpu::{
        pass::Pass,
        program::ComputeProgram,
        scope::{LightScope, Shared},
    },
    passes::imperfect::{
        area::{AreaLight, Maps},
        buffers as imperfect,
    },
    techniques::method::LightRequest,
};

/// Steps of all samples together that an invocation takes in one dispatch: drivers end what runs for too long, Mesa's
/// lavapipe without a word after 65535 turns of all loops, of which a step takes some.
const MOST_STEPS: u32 = 16_384;

/// The maps of a light's samples, as many at once as one dispatch may march.
pub(super) fn maps(params: &Params, scope: &LightScope<'_>, area: &AreaLight) -> Maps {
    let (count, limits) = (area.positions.len() as u32, scope.device.limits());
    let at_once = count.min((MOST_STEPS / params.steps).max(1));
    Maps::new(&scope.inputs, params.points, at_once, 0, &limits)
}

/// Light of all batches so far, a pixel each.
pub(super) fn sums(scope: &mut LightScope<'_>) -> wgpu::Buffer {
    let bytes = sums_bytes(scope.size);
    scope.storage("marched light", bytes)
}

fn sums_bytes(size: [u32; 2]) -> u64 {
    16 * u64::from(size[0]) * u64::from(size[1])
}

/// Refuses a rectangular light whose buffers the device cannot bind.
pub(super) fn check(params: &Params, request: &LightRequest<'_>) -> Result<(), PrepareError> {
    let LightRequest {
        limits,
        size,
        index,
        light,
        inputs,
    } = *request;
    if !matches!(light.emitter, Emitter::Rect { .. }) {
        return Ok(());
    }
    Maps::new(inputs, params.points, 1, 0, limits).check(
        INFO.name,
        index,
        limits,
        &[("marched light", sums_bytes(size))],
    )
}

pub(super) struct MarchArea(ComputeProgram);

impl MarchArea {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::ray_march::area";
        Self(ComputeProgram::new(
            device,
            shared,
            module,
            "ray_march_area",
        ))
    }

    /// Adds the samples of a batch.
    pub(super) fn pass(
        &self,
        scope: &LightScope<'_>,
        buffers: &imperfect::Buffers,
        index: u32,
        params: &wgpu::Buffer,
        sums: &wgpu::Buffer,
    ) -> Pass {
        let resources = [
            buffers.batches.binding(index),
            buffers.samples.as_entire_binding(),
            buffers.maps.as_entire_binding(),
            buffers.colors.as_entire_binding(),
            params.as_entire_binding(),
            sums.as_entire_binding(),
        ];
        let [width, height] = scope.size;
        let workgroups = self.0.workgroups([width, height, 1]);
        scope.compute(&self.0, "ray march", &resources, workgroups)
    }
}
