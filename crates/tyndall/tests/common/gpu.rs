//! A stage on the GPU: its inputs as textures, and the effect's output read back.

use std::sync::OnceLock;

use tyndall::{
    Effect, EffectOptions, FrameInputs, LightInputs, OutputPrecision,
    cpu::{GlassMap, LightTexture},
    frame::ShadowProjection,
    techniques::{Technique, TechniqueChoice},
};
use tyndall_testkit::{
    device::{TestDevice, device},
    picture::Picture,
};
use wgpu::util::{DeviceExt, TextureDataOrder};

use super::{SIZE, Stage, StageLight, picture};

/// The target that stages are composited on.
pub(crate) const TARGET: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// An effect for stages.
pub(crate) fn effect(gpu: &TestDevice) -> Effect {
    let options = EffectOptions {
        target_format: TARGET,
        output: OutputPrecision::Full,
    };
    Effect::new(&gpu.device, &options).expect("a blendable target")
}

/// A stage's textures on the GPU.
pub(crate) struct Uploaded {
    pub(crate) depth: wgpu::TextureView,
    lights: Vec<[Option<wgpu::TextureView>; 3]>,
}

impl Uploaded {
    pub(crate) fn new(gpu: &TestDevice, stage: &Stage) -> Self {
        Self::sized(SIZE, gpu, stage)
    }

    /// The textures of a stage of this size \[pixels].
    pub(crate) fn sized(size: [u32; 2], gpu: &TestDevice, stage: &Stage) -> Self {
        let light = |(light, pictures): (&tyndall::frame::Light, &StageLight)| {
            let faces = match light.shadow {
                Some(ShadowProjection::Cube { .. }) => 6,
                _ => 1,
            };
            [
                pictures
                    .shadow_map
                    .as_ref()
                    .map(|m| array(&depth_texture(gpu, m.size, faces, &m.depth))),
                pictures.glass.as_ref().map(|g| glass(gpu, faces, g)),
                pictures.texture.as_ref().map(|t| light_texture(gpu, t)),
            ]
        };
        Self {
            depth: depth_texture(gpu, size, 1, &stage.depth).create_view(&Default::default()),
            lights: stage
                .frame
                .lights
                .iter()
                .zip(&stage.lights)
                .map(light)
                .collect(),
        }
    }

    pub(crate) fn light_inputs(&self) -> Vec<LightInputs<'_>> {
        self.lights
            .iter()
            .map(|[shadow_map, glass, texture]| LightInputs {
                shadow_map: shadow_map.as_ref(),
                glass: glass.as_ref(),
                texture: texture.as_ref(),
                ..LightInputs::default()
            })
            .collect()
    }
}

/// The output of a technique: rgb in-scatter, a mean transmittance.
pub(crate) fn output(
    gpu: &TestDevice,
    effect: &Effect,
    stage: &Stage,
    technique: Technique,
) -> Vec<[f32; 4]> {
    let frame = stage.frame.clone();
    let frame_by = TechniqueChoice::from(technique);
    let uploaded = Uploaded::new(gpu, stage);
    let lights = uploaded.light_inputs();
    let inputs = FrameInputs {
        depth: &uploaded.depth,
        lights: &lights,
    };
    let mut view = effect.create_view(&gpu.device, SIZE).expect("a good size");
    effect
        .prepare(
            &gpu.device,
            &gpu.queue,
            &mut view,
            &inputs,
            &frame,
            &frame_by,
        )
        .expect("a good stage");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    effect.record(&mut encoder, &mut view, None);
    gpu.queue.submit([encoder.finish()]);
    gpu.read_texture(view.output().texture()).expect("readable")
}

/// In-scatter by the GPU backend.
pub(crate) fn on_gpu(
    gpu: &TestDevice,
    effect: &Effect,
    stage: &Stage,
    technique: Technique,
) -> Picture {
    picture(&output(gpu, effect, stage, technique))
}

fn array(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

fn glass(gpu: &TestDevice, faces: u32, map: &GlassMap) -> wgpu::TextureView {
    let pack = |[r, g, b, depth]: &[f32; 4]| {
        let root = |x: &f32| (x.sqrt() * 1023.0).round() as u32;
        [depth.to_bits(), root(r) | root(g) << 10 | root(b) << 20]
    };
    let texels: Vec<[u32; 2]> = map.texels.iter().map(pack).collect();
    let format = wgpu::TextureFormat::Rg32Uint;
    array(&upload(
        gpu,
        format,
        map.size,
        faces * map.layers,
        bytemuck::cast_slice(&texels),
    ))
}

fn light_texture(gpu: &TestDevice, map: &LightTexture) -> wgpu::TextureView {
    let half = |x: f32| half::f16::from_f32(x).to_bits();
    let texels: Vec<[u16; 4]> = map
        .texels
        .iter()
        .map(|[r, g, b]| [half(*r), half(*g), half(*b), half(1.0)])
        .collect();
    let format = wgpu::TextureFormat::Rgba16Float;
    upload(gpu, format, map.size, 1, bytemuck::cast_slice(&texels)).create_view(&Default::default())
}

fn upload(
    gpu: &TestDevice,
    format: wgpu::TextureFormat,
    size: [u32; 2],
    layers: u32,
    bytes: &[u8],
) -> wgpu::Texture {
    let descriptor = descriptor(format, size, layers);
    gpu.device.create_texture_with_data(
        &gpu.queue,
        &descriptor,
        TextureDataOrder::LayerMajor,
        bytes,
    )
}

fn descriptor(
    format: wgpu::TextureFormat,
    size: [u32; 2],
    layers: u32,
) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    }
}

const WRITE_DEPTH: &str = "
@group(0) @binding(0) var values: texture_2d<f32>;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(2.0 * vec2f(vec2u((i << 1u) & 2u, i & 2u)) - 1.0, 0.0, 1.0);
}
@fragment fn write(@builtin(position) p: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(values, vec2u(p.xy), 0).r;
}";

fn depth_writer(gpu: &TestDevice, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(WRITE_DEPTH.into()),
        });
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("write"),
                compilation_options: Default::default(),
                targets: &[],
            }),
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            multiview_mask: None,
            cache: None,
        })
}

/// A depth texture of these values; they can only be drawn, not copied.
fn depth_texture(gpu: &TestDevice, size: [u32; 2], layers: u32, values: &[f32]) -> wgpu::Texture {
    let format = wgpu::TextureFormat::Depth32Float;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        ..descriptor(format, size, layers)
    });
    // Made once for the device that most tests share; pipelines of one device are nothing to another.
    static WRITER: OnceLock<wgpu::RenderPipeline> = OnceLock::new();
    let is_shared = device().is_ok_and(|shared| std::ptr::eq(shared, gpu));
    let pipeline = if is_shared {
        WRITER.get_or_init(|| depth_writer(gpu, format)).clone()
    } else {
        depth_writer(gpu, format)
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for (layer, values) in values.chunks((size[0] * size[1]) as usize).enumerate() {
        let source = upload(
            gpu,
            wgpu::TextureFormat::R32Float,
            size,
            1,
            bytemuck::cast_slice(values),
        );
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(
                    &source.create_view(&Default::default()),
                ),
            }],
        });
        let target = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer as u32,
            array_layer_count: Some(1),
            ..Default::default()
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    texture
}
