//! Tyndall inside somebody else's renderer: it has its own device, encoder, depth buffer and shadow map, draws its own
//! scene, and asks for the haze in between. Writes a picture.
//!
//! ```sh
//! cargo run --release -p tyndall --example in_your_renderer -- picture.png
//! ```
//!
//! What the effect needs is all in [`Haze`]; the rest is the renderer's.

use std::{error::Error, sync::mpsc};

use bytemuck::{Pod, Zeroable};
use glam::{
    Affine3A, Mat4, Quat, Vec3,
    camera::rh::{proj::directx, view},
    vec3,
};
use tyndall::{
    CreateError, Effect, EffectOptions, EffectView, FrameInputs, LightInputs, OutputPrecision,
    PrepareError,
    frame::{
        Camera, DepthRange, Emitter, Frame, Light, Medium, MediumComponent, Phase, Projection,
        ShadowProjection,
    },
    techniques::TechniqueChoice,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt, DownloadBuffer};

/// Width and height of the picture [pixels].
const SIZE: [u32; 2] = [640, 360];
/// Side of the shadow map [texels].
const MAP: u32 = 1024;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

const EYE: Vec3 = vec3(6.5, 1.8, 9.0);
const TARGET: Vec3 = vec3(-0.5, 2.6, 0.0);
const YFOV: f32 = 1.0;
const NEAR: f32 = 0.1;
/// Where the haze ends [m]; the projection itself has no far plane.
const FAR: f32 = 30.0;
/// The way the sun's light travels, and its illuminance [W/m^2].
const SUN: Vec3 = vec3(0.35, -0.8, 0.3);
const ILLUMINANCE: f32 = 6.0;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("usage: in_your_renderer PICTURE.png")?;
    let Some((device, queue)) = pollster::block_on(open()) else {
        eprintln!("skipped: there is no GPU adapter");
        return Ok(());
    };
    let renderer = Renderer::new(&device);
    let mut haze = Haze::new(&device)?;

    haze.prepare(&device, &queue, &renderer.depth, &renderer.shadow_map)?;
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.draw(&mut encoder);
    haze.record(&mut encoder, &renderer.color);
    queue.submit([encoder.finish()]);

    let pixels = read(&device, &queue, renderer.color.texture())?;
    image::save_buffer(&path, &pixels, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
    println!("wrote {path}");
    Ok(())
}

/// Everything of Tyndall's that a renderer keeps.
struct Haze {
    effect: Effect,
    view: EffectView,
}

impl Haze {
    fn new(device: &wgpu::Device) -> Result<Self, CreateError> {
        let options = EffectOptions {
            target_format: COLOR,
            output: OutputPrecision::Half,
        };
        let effect = Effect::new(device, &options)?;
        let view = effect.create_view(device, SIZE)?;
        Ok(Self { effect, view })
    }

    /// Once a frame, before recording. All that can fail fails here.
    fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        depth: &wgpu::TextureView,
        shadow_map: &wgpu::Texture,
    ) -> Result<(), PrepareError> {
        // Tyndall reads shadow maps as arrays: of one layer, or of a cube's six.
        let shadow_map = shadow_map.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let inputs = FrameInputs {
            depth,
            lights: &[LightInputs {
                shadow_map: Some(&shadow_map),
                ..LightInputs::default()
            }],
        };
        self.effect.prepare(
            device,
            queue,
            &mut self.view,
            &inputs,
            &frame(),
            &TechniqueChoice::default(),
        )
    }

    /// After the renderer's own passes: the effect's passes, then one draw on the picture.
    fn record(&mut self, encoder: &mut wgpu::CommandEncoder, color: &wgpu::TextureView) {
        self.effect.record(encoder, &mut self.view, None);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("haze"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.effect.composite(&mut pass, &self.view);
    }
}

/// The renderer's camera and sun in Tyndall's terms, and the haze.
fn frame() -> Frame {
    let tangent = (0.5 * YFOV).tan();
    Frame {
        camera: Camera {
            eye: EYE.to_array(),
            forward: (TARGET - EYE).to_array(),
            up: Vec3::Y.to_array(),
            projection: Projection::Perspective {
                half_extent: [tangent * aspect(), tangent],
                center: [0.0; 2],
                near: NEAR,
                far: FAR,
            },
            depth_range: DepthRange::ReversedInfinite,
        },
        lights: vec![Light {
            emitter: Emitter::Directional {
                direction: SUN.to_array(),
                illuminance: [ILLUMINANCE; 3],
            },
            shadow: Some(ShadowProjection::Single {
                clip_from_world: map_from_world().to_cols_array_2d(),
                reversed_depth: false,
            }),
            texture: None,
        }],
        medium: Medium {
            components: vec![MediumComponent {
                sigma_s: [0.03, 0.031, 0.033],
                sigma_a: [0.004; 3],
                phase: Phase::HenyeyGreenstein { g: 0.5 },
            }],
        },
    }
}

fn aspect() -> f32 {
    SIZE[0] as f32 / SIZE[1] as f32
}

fn clip_from_world() -> Mat4 {
    let projection = directx::perspective_infinite_reverse(YFOV, aspect(), NEAR);
    projection * view::look_at_mat4(EYE, TARGET, Vec3::Y)
}

fn map_from_world() -> Mat4 {
    let direction = SUN.normalize();
    let projection = directx::orthographic(-10.0, 10.0, -10.0, 10.0, 0.0, 40.0);
    projection * view::look_to_mat4(-20.0 * direction, direction, Vec3::Z)
}

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

/// What the sun is in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SunUniform {
    clip_from_world: [[f32; 4]; 4],
    to_light: [f32; 3],
    illuminance: f32,
}

/// A small forward renderer with one shadow map.
struct Renderer {
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    shadow_map: wgpu::Texture,
    shadow_pass: Pass,
    color_pass: Pass,
    boxes: wgpu::Buffer,
    count: u32,
}

/// A pipeline and what it reads.
struct Pass {
    pipeline: wgpu::RenderPipeline,
    groups: Vec<wgpu::BindGroup>,
}

impl Renderer {
    fn new(device: &wgpu::Device) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("in_your_renderer.wgsl"));
        let shadow_map = texture(device, [MAP; 2], DEPTH);
        let boxes = boxes();
        let shadow = pipeline(device, &module, wgpu::CompareFunction::Less, None);
        // Reversed depth: nearer is larger.
        let color = pipeline(device, &module, wgpu::CompareFunction::Greater, Some(COLOR));
        Self {
            color: texture(device, SIZE, COLOR).create_view(&Default::default()),
            depth: texture(device, SIZE, DEPTH).create_view(&Default::default()),
            shadow_pass: Pass {
                groups: vec![view_group(device, &shadow, map_from_world())],
                pipeline: shadow,
            },
            color_pass: Pass {
                groups: vec![
                    view_group(device, &color, clip_from_world()),
                    sun_group(device, &color, &shadow_map),
                ],
                pipeline: color,
            },
            shadow_map,
            boxes: device.create_buffer_init(&BufferInitDescriptor {
                label: Some("boxes"),
                contents: bytemuck::cast_slice(&boxes),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            count: boxes.len() as u32,
        }
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        let shadow_map = self.shadow_map.create_view(&Default::default());
        self.pass(encoder, &self.shadow_pass, None, &shadow_map, 1.0);
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
fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    nearer: wgpu::CompareFunction,
    color: Option<wgpu::TextureFormat>,
) -> wgpu::RenderPipeline {
    const ATTRIBUTES: [wgpu::VertexAttribute; 5] = wgpu::vertex_attr_array![
        0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x3
    ];
    let targets: Vec<_> = color
        .map(|format| Some(format.into()))
        .into_iter()
        .collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("boxes"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
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
            depth_compare: Some(nearer),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: color.is_some().then(|| wgpu::FragmentState {
            module,
            entry_point: Some("lit_fragment"),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn uniform(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents,
        usage: wgpu::BufferUsages::UNIFORM,
    })
}

fn view_group(
    device: &wgpu::Device,
    pipeline: &wgpu::RenderPipeline,
    clip_from_world: Mat4,
) -> wgpu::BindGroup {
    let view = uniform(device, bytemuck::bytes_of(&clip_from_world.to_cols_array()));
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: view.as_entire_binding(),
        }],
    })
}

fn sun_group(
    device: &wgpu::Device,
    pipeline: &wgpu::RenderPipeline,
    shadow_map: &wgpu::Texture,
) -> wgpu::BindGroup {
    let sun = SunUniform {
        clip_from_world: map_from_world().to_cols_array_2d(),
        to_light: (-SUN.normalize()).to_array(),
        illuminance: ILLUMINANCE,
    };
    let sun = uniform(device, bytemuck::bytes_of(&sun));
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        compare: Some(wgpu::CompareFunction::LessEqual),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let shadow_map = shadow_map.create_view(&Default::default());
    let resources = [
        sun.as_entire_binding(),
        wgpu::BindingResource::TextureView(&shadow_map),
        wgpu::BindingResource::Sampler(&sampler),
    ];
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("sun"),
        layout: &pipeline.get_bind_group_layout(1),
        entries: &entries,
    })
}

async fn open() -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&Default::default()).await.ok()?;
    adapter.request_device(&Default::default()).await.ok()
}

/// The bytes of a texture of 4-byte texels whose rows are a multiple of 256 bytes, as copies want them.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let bytes_per_row = 4 * texture.width();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(bytes_per_row * texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes_per_row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    let (sender, receiver) = mpsc::channel();
    DownloadBuffer::read_buffer(device, queue, &buffer.slice(..), move |result| {
        // The receiver outlives the poll below.
        let _ = sender.send(result);
    });
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(receiver.recv()??.to_vec())
}
