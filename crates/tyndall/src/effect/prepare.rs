//! Preparing a frame: all that can fail, and what its passes are.

use super::{device::Effect, view::EffectView};
use crate::{
    camera::CameraRays,
    error::PrepareError,
    frame::{Emitter, Frame, Light},
    gpu::{
        pass::LightPasses,
        pool::Owner,
        scope::{LightScope, Shared},
        uniforms::{FrameUniform, LightUniform},
    },
    inputs::{FrameInputs, LightInputs},
    techniques::{Backends, LightRequest, Technique, TechniqueChoice},
    temporal::{self, Viewpoint},
    validate,
};

/// A light of the frame that is being prepared.
struct PlannedLight<'a> {
    light: Light,
    inputs: LightInputs<'a>,
    technique: Technique,
}

/// Makes a light that shines nowhere: with no light at all, it still has the transmittance written.
fn black<'a>(techniques: &TechniqueChoice) -> PlannedLight<'a> {
    let light = Light {
        emitter: Emitter::Directional {
            direction: [0.0, -1.0, 0.0],
            illuminance: [0.0; 3],
        },
        shadow: None,
        texture: None,
    };
    let technique = techniques.of(0, &light, Backends::Gpu);
    PlannedLight {
        light,
        inputs: LightInputs::default(),
        technique: if technique.info().can(light.kind(), Backends::Gpu) {
            technique
        } else {
            Technique::default()
        },
    }
}

/// Resources that the passes of a frame's lights share.
struct FrameParts<'a> {
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
    frame: &'a Frame,
    rays: CameraRays,
    depth: &'a wgpu::TextureView,
    uniform: wgpu::Buffer,
    airlight: wgpu::TextureView,
}

impl FrameParts<'_> {
    /// Bind group 0 with these lights before.
    fn group(&self, effect: &Shared, lights_before: &wgpu::TextureView) -> wgpu::BindGroup {
        let (uniform, depth, airlight) = (&self.uniform, self.depth, &self.airlight);
        let bindings = &effect.bindings;
        bindings.frame_group_of(self.device, uniform, depth, airlight, lights_before)
    }
}

impl Effect {
    /// Checks the frame and its inputs, and uploads what the passes read. All that can fail is done here.
    ///
    /// # Errors
    /// Fails if the frame or an input is out of range, missing or of the wrong kind, or a light's technique cannot do it on
    /// the GPU. The view then still holds the frame that was prepared before.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        view: &mut EffectView,
        inputs: &FrameInputs<'_>,
        frame: &Frame,
        techniques: &TechniqueChoice,
    ) -> Result<(), PrepareError> {
        let lights = plan(device, view, inputs, frame, techniques)?;
        let parts = begin(
            &self.shared,
            device,
            queue,
            view,
            inputs,
            frame,
            lights.len(),
        );
        let mut before = self.shared.bindings.no_light().clone();
        for (index, light) in lights.iter().enumerate() {
            // The sum of the lights goes to and fro between two textures; the second is made with the second light.
            let sum = self.sum(device, &mut view.pool, view.size, index % 2);
            let passes = self.passes(&parts, view, (index, light), &before, sum.clone())?;
            view.passes.extend(passes.before);
            view.passes.push(passes.last);
            view.visibilities.push(passes.visibility);
            before = sum;
        }
        view.pool.end();
        view.composite = Some(parts.group(&self.shared, &before));
        view.output = before;
        Ok(())
    }

    /// The passes of one light; the last of them adds it to the lights `before` and writes the `sum`.
    fn passes(
        &self,
        parts: &FrameParts<'_>,
        view: &mut EffectView,
        (index, planned): (usize, &PlannedLight<'_>),
        before: &wgpu::TextureView,
        sum: wgpu::TextureView,
    ) -> Result<LightPasses, PrepareError> {
        let FrameParts {
            device,
            queue,
            frame,
            ..
        } = *parts;
        let PlannedLight {
            light,
            inputs,
            technique,
        } = planned;
        let method = technique.gpu()?;
        let (uniform, variant) =
            LightUniform::new(light, &frame.camera, inputs.glass_layers(light));
        let variant = variant.within(&frame.medium);
        let key = (Owner::Light(index), "light");
        let uniform = view.pool.uniform(device, queue, key, &uniform);
        let group = |lights_before| parts.group(&self.shared, lights_before);
        let light_group = self
            .shared
            .bindings
            .light_group_of(device, &uniform, inputs);
        let mut scope = LightScope {
            device,
            queue,
            shared: &self.shared,
            pool: &mut view.pool,
            frame,
            rays: &parts.rays,
            size: view.size,
            index,
            light,
            inputs: *inputs,
            variant,
            frame_group: group(before),
            light_group,
            target: sum,
            stencil: None,
            surface_shadows: view.surface_shadows.as_ref(),
            counts: &mut view.counts,
        };
        Ok(match view.reuse {
            None => method.passes(&mut scope),
            Some(reuse) => {
                let alone = group(self.shared.bindings.no_light());
                temporal::passes(&mut view.history, (technique, method), reuse, scope, alone)
            }
        })
    }
}

/// Checks everything, and says which technique computes which light.
fn plan<'a>(
    device: &wgpu::Device,
    view: &EffectView,
    inputs: &FrameInputs<'a>,
    frame: &Frame,
    techniques: &TechniqueChoice,
) -> Result<Vec<PlannedLight<'a>>, PrepareError> {
    validate::frame(frame)?;
    let resolved = techniques.resolve(frame, Backends::Gpu)?;
    validate::gpu_inputs(frame, inputs, view.size)?;
    if let Some(shadows) = &view.surface_shadows {
        validate::surface_shadows(shadows, view.size)?;
    }
    let given = frame.lights.iter().zip(inputs.lights).zip(resolved);
    let mut lights: Vec<PlannedLight<'a>> = given
        .map(|((light, inputs), technique)| PlannedLight {
            light: *light,
            inputs: *inputs,
            technique,
        })
        .collect();
    if lights.is_empty() {
        lights.push(black(techniques));
    }
    let limits = device.limits();
    for (index, planned) in lights.iter().enumerate() {
        let request = LightRequest {
            limits: &limits,
            size: view.size,
            index,
            light: &planned.light,
            inputs: &planned.inputs,
        };
        planned.technique.gpu()?.check_light(&request)?;
        if let Some(reuse) = &view.reuse {
            temporal::check(reuse, &request)?;
        }
    }
    Ok(lights)
}

/// Begins a frame of so many lights: what all of them read is uploaded.
fn begin<'a>(
    effect: &Shared,
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
    view: &mut EffectView,
    inputs: &FrameInputs<'a>,
    frame: &'a Frame,
    lights: usize,
) -> FrameParts<'a> {
    let rays = CameraRays::new(&frame.camera, view.size);
    let uniform = FrameUniform::new(frame, &rays, view.size);
    let seen_from = Viewpoint {
        camera: uniform.camera,
        eye: rays.eye,
    };
    view.pool.begin(view.is_recorded);
    view.history.begin(lights, view.is_recorded, seen_from);
    view.is_recorded = false;
    view.passes.clear();
    view.counts.clear();
    view.visibilities.clear();
    let uniform = view
        .pool
        .uniform(device, queue, (Owner::View, "frame"), &uniform);
    let airlight = effect.bindings.airlight(device, queue, frame);
    FrameParts {
        device,
        queue,
        frame,
        rays,
        depth: inputs.depth,
        uniform,
        airlight,
    }
}
