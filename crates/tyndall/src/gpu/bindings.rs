//! What the package's shaders read of a frame and of a light: bind groups 0 and 1, for the library's passes and an engine's.

use wgpu::util::{BufferInitDescriptor, DeviceExt};

use super::{
    airlight::AirlightTextures,
    layout::{self, Absent},
    uniforms::{FrameUniform, LightUniform, LightVariant},
};
use crate::{
    camera::CameraRays,
    frame::{Frame, Light, LightKind, ShadowProjection},
    inputs::LightInputs,
    shader::Linked,
    shadow,
};

/// Bind groups of an engine's own shaders that import from the [package](crate::shader): group 0 is the frame, group 1 a
/// light. Made once a device; groups 2 and up are the engine's.
///
/// | group | binding | WGSL | what |
/// |---|---|---|---|
/// | 0 | 0 | `frame: Frame` | camera, and the medium's coefficients [1/m] |
/// | 0 | 1 | `frame_depth` | the depth buffer, in the camera's convention |
/// | 0 | 2 | `frame_lights_before` | black: it is the library's own passes' |
/// | 0 | 3 | `airlight_table` | airlight of point and spot lights in this medium |
/// | 1 | 0 | `light: Light` | the light |
/// | 1 | 1 | `shadow_map` | its shadow map |
/// | 1 | 2 | `shadow_glass` | its coloured glass |
/// | 1 | 3, 4 | `light_picture`, `light_sampler` | its texture, bilinear and clamped to the edge |
///
/// Positions in shaders are in world space relative to the camera's eye, in metres: `p_world - frame.camera.eye`. Light
/// comes in the units of [`Emitter`](crate::frame::Emitter): irradiances [W/m^2].
///
/// All stages may read the groups. Numbers are copied when a group is made: make them anew where frame or size change. A
/// pipeline is made for a kind of light, by [`Bindings::light_constants`]; lights of the same constants share it.
///
/// ```
/// use tyndall::{
///     LightInputs,
///     frame::Frame,
///     gpu::Bindings,
///     shader::{LinkError, Linker},
/// };
///
/// /// Light that reaches a surface, as radiance of a white one.
/// const LIT: &str = "
/// import tyndall::light::light::{Incident, light_incident};
/// import tyndall::shadow::shadow::{shadow_of_point, shadow_tint};
///
/// @group(2) @binding(0) var normals: texture_2d<f32>; // the engine's own
///
/// fn lit(point: vec3f, normal: vec3f) -> vec3f { // point: relative to the eye [m]
///     let incident = light_incident(point);
///     let cosine = max(-dot(normal, incident.direction), 0.0);
///     return shadow_tint(shadow_of_point(point)) * cosine * incident.irradiance / 3.14159265;
/// }
/// // ... and entry points
/// ";
///
/// fn draw(
///     (device, queue, bindings): (&wgpu::Device, &wgpu::Queue, &Bindings),
///     (frame, inputs, size): (&Frame, &[LightInputs<'_>], [u32; 2]),
///     (depth, own): (&wgpu::TextureView, &wgpu::BindGroupLayout),
/// ) -> Result<(), LinkError> {
///     let linked = Linker::new().module("engine::lit", LIT).link("engine::lit")?;
///     let [frame_layout, light_layout] = bindings.layouts();
///     let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
///         label: None,
///         bind_group_layouts: &[Some(frame_layout), Some(light_layout), Some(own)],
///         immediate_size: 0,
///     });
///     let frame_group = bindings.frame_group(device, queue, frame, size, Some(depth));
///     for (index, inputs) in inputs.iter().enumerate() {
///         let constants = Bindings::light_constants(&linked, &frame.lights[index], inputs);
///         let light_group = bindings.light_group(device, frame, index, inputs);
///         // A pipeline of `linked.wgsl`, `layout` and `constants`; then a draw with both groups.
/// #       let _ = (&layout, &frame_group, constants, light_group);
///     }
///     Ok(())
/// }
/// ```
pub struct Bindings {
    frame_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    absent: Absent,
    /// Bilinear, clamped to the edge.
    sampler: wgpu::Sampler,
    airlight: AirlightTextures,
}

impl Bindings {
    /// Makes the layouts, and what is bound in place of absent inputs.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            frame_layout: layout::frame(device),
            light_layout: layout::light(device),
            absent: Absent::new(device),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("tyndall bilinear"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            airlight: AirlightTextures::default(),
        }
    }

    /// The layouts of bind groups 0 (frame) and 1 (light).
    pub fn layouts(&self) -> [&wgpu::BindGroupLayout; 2] {
        [&self.frame_layout, &self.light_layout]
    }

    /// Bind group 0 of a picture of `size` \[pixels]. Without a depth buffer, because the pass draws on it or has none, every
    /// read of it gives 0. The first frame of a medium with point or spot lights makes its airlight tables.
    pub fn frame_group(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &Frame,
        size: [u32; 2],
        depth: Option<&wgpu::TextureView>,
    ) -> wgpu::BindGroup {
        let rays = CameraRays::new(&frame.camera, size);
        let uniform = uniform(device, &FrameUniform::new(frame, &rays, size));
        let depth = depth.unwrap_or(&self.absent.depth);
        let airlight = self.airlight(device, queue, frame);
        self.frame_group_of(device, &uniform, depth, &airlight, &self.absent.light)
    }

    /// Bind group 1 of a light of the frame. Where an input is `None`, the light is unshadowed, without glass, or white.
    ///
    /// # Panics
    /// If the frame has no light of this index.
    pub fn light_group(
        &self,
        device: &wgpu::Device,
        frame: &Frame,
        index: usize,
        inputs: &LightInputs<'_>,
    ) -> wgpu::BindGroup {
        let light = with_inputs(&frame.lights[index], inputs);
        let (light, _) = LightUniform::new(&light, &frame.camera, inputs.glass_layers(&light));
        self.light_group_of(device, &uniform(device, &light), inputs)
    }

    /// Pipeline constants of a kind of light: `LIGHT_KIND`, `LIGHT_TEXTURE`, `SHADOW_KIND` and `SHADOW_GLASS_LAYERS`, without
    /// those that the linked shader does not declare, for wgpu refuses them. Lights of equal constants share pipelines.
    /// `MEDIUM_PHASES` is not among them: such pipelines do any medium.
    pub fn light_constants(
        shader: &Linked,
        light: &Light,
        inputs: &LightInputs<'_>,
    ) -> Vec<(&'static str, f64)> {
        let light = with_inputs(light, inputs);
        let variant = LightVariant::new(&light, inputs.glass_layers(&light));
        let mut constants = variant.constants().to_vec();
        constants.retain(|(name, _)| *name != "MEDIUM_PHASES" && shader.declares(name));
        constants
    }

    /// Bind group 0 of a uniform buffer and textures.
    pub(crate) fn frame_group_of(
        &self,
        device: &wgpu::Device,
        uniform: &wgpu::Buffer,
        depth: &wgpu::TextureView,
        airlight: &wgpu::TextureView,
        lights_before: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall frame"),
            layout: &self.frame_layout,
            entries: &[
                buffer_entry(0, uniform),
                texture_entry(1, depth),
                texture_entry(2, lights_before),
                texture_entry(3, airlight),
            ],
        })
    }

    /// Bind group 1 of a uniform buffer and a light's textures.
    pub(crate) fn light_group_of(
        &self,
        device: &wgpu::Device,
        uniform: &wgpu::Buffer,
        inputs: &LightInputs<'_>,
    ) -> wgpu::BindGroup {
        let absent = &self.absent;
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall light"),
            layout: &self.light_layout,
            entries: &[
                buffer_entry(0, uniform),
                texture_entry(1, inputs.shadow_map.unwrap_or(&absent.shadow_map)),
                texture_entry(2, inputs.glass.unwrap_or(&absent.glass)),
                texture_entry(3, inputs.texture.unwrap_or(&absent.texture)),
                wgpu::BindGroupEntry {
                    binding: 4,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        })
    }

    /// The airlight tables of the frame's medium, one layer a component; only point and spot lights read them.
    pub(crate) fn airlight(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &Frame,
    ) -> wgpu::TextureView {
        let is_read = |light: &Light| matches!(light.kind(), LightKind::Point | LightKind::Spot);
        if frame.lights.iter().any(is_read) {
            self.airlight.of(device, queue, &frame.medium)
        } else {
            self.absent.airlight.clone()
        }
    }

    /// Black, where light is expected.
    pub(crate) fn no_light(&self) -> &wgpu::TextureView {
        &self.absent.light
    }
}

/// The light as far as there are inputs for it; a cube needs a light with a position.
fn with_inputs(light: &Light, inputs: &LightInputs<'_>) -> Light {
    let is_mapped = |projection: &ShadowProjection| {
        inputs.shadow_map.is_some() && shadow::faces(&light.emitter, projection).is_some()
    };
    Light {
        shadow: light.shadow.filter(is_mapped),
        texture: light.texture.filter(|_| inputs.texture.is_some()),
        ..*light
    }
}

fn uniform<T: bytemuck::Pod>(device: &wgpu::Device, value: &T) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: Some("tyndall bindings"),
        contents: bytemuck::bytes_of(value),
        usage: wgpu::BufferUsages::UNIFORM,
    })
}

fn buffer_entry(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: buffer.as_entire_binding(),
    }
}

fn texture_entry(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{frame::Emitter, shader::Linker};

    #[test]
    fn constants_are_those_the_shader_declares() {
        let light = Light {
            emitter: Emitter::Point {
                position: [0.0; 3],
                intensity: [1.0; 3],
                radius: 0.0,
            },
            shadow: Some(ShadowProjection::Cube {
                near: 0.1,
                far: 10.0,
                reversed_depth: true,
            }),
            texture: None,
        };
        let constants = |module: &str| {
            let linked = Linker::new().link(module).expect("a module of the package");
            Bindings::light_constants(&linked, &light, &LightInputs::default())
        };
        assert_eq!(constants("tyndall::physics::transmittance"), []);
        let of_light = [("LIGHT_KIND", 1.0), ("LIGHT_TEXTURE", 0.0)];
        assert_eq!(constants("tyndall::light::light"), of_light);
        // Without a map in its inputs, the light is unshadowed.
        let of_shadow = [("SHADOW_KIND", 0.0), ("SHADOW_GLASS_LAYERS", 0.0)];
        assert_eq!(constants("tyndall::shadow::shadow")[2..], of_shadow);
    }
}
