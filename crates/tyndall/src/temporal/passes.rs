//! A light's passes about any technique, kept from frame to frame.

use super::{
    frame::Frame,
    history::{History, Signature},
    options::{Reuse, ReuseMask},
    wrap::wrap,
};
use crate::{
    gpu::pool::Owner,
    gpu::{pass::LightPasses, program::STENCIL_FORMAT, scope::LightScope},
    techniques::{GpuMethod, Technique},
};

/// The passes of one light that is kept from frame to frame. The `scope` is that of the light without reuse; `alone` is
/// its bind group 0 without the lights before.
pub(crate) fn passes(
    history: &mut History,
    (technique, method): (&Technique, &dyn GpuMethod),
    reuse: Reuse,
    mut scope: LightScope<'_>,
    alone: wgpu::BindGroup,
) -> LightPasses {
    let inputs = &scope.inputs;
    let of_frame = (scope.frame, technique);
    let signature = Signature::new(of_frame, scope.light, scope.variant, reuse, inputs);
    let moved = match reuse.mask {
        ReuseMask::Change => Vec::new(),
        ReuseMask::Geometry => history.moved(scope.index, inputs.occluders.unwrap_or_default()),
    };
    let frame = Frame {
        reuse,
        generations: history.generations(scope.index, signature),
        reach: method.reach(),
        before: history.before(),
        moved: &moved,
    };
    let attachment = |scope: &mut LightScope<'_>, name, format| {
        let key = (Owner::Light(scope.index), name);
        scope.pool.attachment(scope.device, key, scope.size, format)
    };
    let output = scope.shared.output;
    let kept = attachment(&mut scope, "kept in-scatter", output);
    let stencil = attachment(&mut scope, "reuse stencil", STENCIL_FORMAT);
    let sum = std::mem::replace(&mut scope.target, kept);
    let with_lights_before = std::mem::replace(&mut scope.frame_group, alone);
    scope.stencil = Some(stencil);
    let own = method.passes(&mut scope);
    wrap(own, &frame, (sum, with_lights_before), &mut scope)
}
