//! The renderer: boxes in the sun. Its shader has Tyndall evaluate the light and look up the shadow.

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Mat4, Quat, Vec3, vec3};
use tyndall::{
    LightInputs,
    gpu::Bindings,
    shader::{LinkError, Linker},
};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use super::{COLOR, EYE, SIZE, clip_from_world, frame, map_from_world};

/// Side of the shadow map \[texels].
const MAP: u32 = 1024;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A box on the GPU.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct BoxInstance {
    world_from_local: [[f32; 4]; 4],
    color: [f32; 3],
}

impl BoxInstance {
    fn new(center: Vec3, half_size: Vec3, rotation: Quat, color: [f32; 3]) -> Self {
        let affine = Affine3A::from_scale_rotation_translation(half_size, rotation, center);
        Self {
            world_from_local: Mat4::from(affine).to_cols_array_2d(),
            color,
        }
    }
}

/// A floor, a roof of beams, and a cube on its corner.
fn boxes() -> Vec<BoxInstance> {
    let beam = |i: i32| {
        let center = vec3(1.3 * i as f32, 5.5, 0.0);
        BoxInstance::new(
            center,
            vec3(0.4, 0.15, 6.0),
            Quat::IDENTITY,
            [0.45, 0.3, 0.2],
        )
    };
    let floor = BoxInstance::new(
        vec3(0.0, -0.1, 0.0),
        vec3(30.0, 0.1, 30.0),
        Quat::IDENTITY,
        [0.4; 3],
    );
    let turned =
        Quat::from_rotation_y(0.6) * Quat::from_rotation_x(0.7) * Quat::from_rotation_z(0.8);
    let cube = BoxInstance::new(vec3(0.0, 2.2, 0.0), Vec3::ONE, turned, [0.7, 0.2, 0.15]);
    (-5..=5).map(beam).chain([floor, cube]).collect()
}

/// A camera or a light in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct ViewUniform {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 3],
    pad: f32,
}

/// A small forward renderer with one shadow map.
pub(crate) struct Renderer {
    pub(crate) color: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    /// As Tyndall reads shadow maps: an array of one layer.
    pub(crate) shadow_map: wgpu::TextureView,
    shadow_target: wgpu::TextureView,
    shadow_pass: Pass,
    color_pass: Pass,
    boxes: wgpu::Buffer,
    count: u32,
}

/// A pipeline and what it reads, group by group.
struct Pass {
    pipeline: wgpu::RenderPipeline,
    groups: Vec<wgpu::BindGroup>,
}

impl Renderer {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, LinkError> {
        // Group 0 is the renderer's own, and bound in both passes.
        let shader = Linker::new()
            .group(0, 1)
            .group(1, 2)
            .module("renderer::boxes", include_str!("boxes.wesl"))
            .link("renderer::boxes")?;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("boxes"),
            source: wgpu::ShaderSource::Wgsl(shader.wgsl.as_str().into()),
        });
        let map = texture(device, [MAP; 2], DEPTH);
        let shadow_map = map.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let view_layout = view_layout(device);
        let view = |clip_from_world| view_group(device, &view_layout, clip_from_world);

        let shadow = BoxPipeline {
            module: &module,
            groups: &[Some(&view_layout)],
            nearer: wgpu::CompareFunction::Less,
            color: None,
        };
        // Groups 1 and 2 are Tyndall's: the frame, without the depth buffer that the pass draws on, and the sun.
        let (frame, bindings) = (frame(), Bindings::new(device));
        let inputs = LightInputs {
            shadow_map: Some(&shadow_map),
            ..LightInputs::default()
        };
        let [frame_layout, light_layout] = bindings.layouts();
        let constants = Bindings::light_constants(&shader, &frame.lights[0], &inputs);
        let color = BoxPipeline {
            module: &module,
            groups: &[Some(&view_layout), Some(frame_layout), Some(light_layout)],
            // Reversed depth: nearer is larger.
            nearer: wgpu::CompareFunction::Greater,
            color: Some((COLOR, &constants)),
        };
        let boxes = boxes();
        Ok(Self {
            color: texture(device, SIZE, COLOR).create_view(&Default::default()),
            depth: texture(device, SIZE, DEPTH).create_view(&Default::default()),
            shadow_target: map.create_view(&Default::default()),
            shadow_pass: Pass {
                pipeline: shadow.create(device),
                groups: vec![view(map_from_world())],
            },
            color_pass: Pass {
                pipeline: color.create(device),
                groups: vec![
                    view(clip_from_world()),
                    bindings.frame_group(device, queue, &frame, SIZE, None),
                    bindings.light_group(device, &frame, 0, &inputs),
                ],
            },
            shadow_map,
            boxes: device.create_buffer_init(&BufferInitDescriptor {
                label: Some("boxes"),
                contents: bytemuck::cast_slice(&boxes),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            count: boxes.len() as u32,
        })
    }

    pub(crate) fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        self.pass(encoder, &self.shadow_pass, None, &self.shadow_target, 1.0);
        self.pass(
            encoder,
            &self.color_pass,
            Some(&self.color),
            &self.depth,
            0.0,
        );
    }

    fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pass: &Pass,
        color: Option<&wgpu::TextureView>,
        depth: &wgpu::TextureView,
        far_value: f32,
    ) {
        let sky = wgpu::Color {
            r: 0.02,
            g: 0.03,
            b: 0.05,
            a: 1.0,
        };
        let target = color.map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(sky),
                store: wgpu::StoreOp::Store,
            },
        });
        let targets: Vec<_> = target.into_iter().map(Some).collect();
        let mut recorded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("boxes"),
            color_attachments: &targets,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(far_value),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        recorded.set_pipeline(&pass.pipeline);
        for (i, group) in pass.groups.iter().enumerate() {
            recorded.set_bind_group(i as u32, group, &[]);
        }
        recorded.set_vertex_buffer(0, self.boxes.slice(..));
        recorded.draw(0..36, 0..self.count);
    }
}

/// A texture that is drawn on and read.
fn texture(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Draws boxes; without a colour, only their depth.
struct BoxPipeline<'a> {
    module: &'a wgpu::ShaderModule,
    groups: &'a [Option<&'a wgpu::BindGroupLayout>],
    nearer: wgpu::CompareFunction,
    /// The target's format, and the constants of the fragment stage.
    color: Option<(wgpu::TextureFormat, &'a [(&'a str, f64)])>,
}

impl BoxPipeline<'_> {
    fn create(&self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        const ATTRIBUTES: [wgpu::VertexAttribute; 5] = wgpu::vertex_attr_array![
            0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x3
        ];
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("boxes"),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let (format, constants) = self.color.unzip();
        let targets: Vec<_> = format
            .map(|format| Some(format.into()))
            .into_iter()
            .collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("boxes"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some("box_vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<BoxInstance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &ATTRIBUTES,
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(self.nearer),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: constants.map(|constants| wgpu::FragmentState {
                module: self.module,
                entry_point: Some("lit_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants,
                    ..Default::default()
                },
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The renderer's own group.
fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

fn view_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    clip_from_world: Mat4,
) -> wgpu::BindGroup {
    let view = ViewUniform {
        clip_from_world: clip_from_world.to_cols_array_2d(),
        eye: EYE.to_array(),
        pad: 0.0,
    };
    let view = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("view"),
        contents: bytemuck::bytes_of(&view),
        usage: wgpu::BufferUsages::UNIFORM,
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: view.as_entire_binding(),
        }],
    })
}
