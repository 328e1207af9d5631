//! Tyndall inside somebody else's renderer: it has its own device, encoder, depth buffer and shadow map, draws its own
//! scene, and asks for the haze in between. Its own shader, `boxes.wesl`, imports light and shadow from Tyndall's package.
//! Writes a picture.
//!
//! ```sh
//! cargo run --release -p tyndall --example in_your_renderer -- picture.png
//! ```
//!
//! What the effect needs is all in [`Haze`]; the renderer is in `renderer.rs`.

mod device;
mod renderer;

use std::error::Error;

use glam::{
    Mat4, Vec3,
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

use renderer::Renderer;

/// Width and height of the picture \[pixels].
const SIZE: [u32; 2] = [640, 360];
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

const EYE: Vec3 = vec3(6.5, 1.8, 9.0);
const TARGET: Vec3 = vec3(-0.5, 2.6, 0.0);
const YFOV: f32 = 1.0;
const NEAR: f32 = 0.1;
/// Where the haze ends \[m]; the projection itself has no far plane.
const FAR: f32 = 30.0;
/// The way the sun's light travels, and its illuminance [W/m^2].
const SUN: Vec3 = vec3(0.35, -0.8, 0.3);
const ILLUMINANCE: f32 = 6.0;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("usage: in_your_renderer PICTURE.png")?;
    let Some((device, queue)) = pollster::block_on(device::open()) else {
        eprintln!("skipped: there is no GPU adapter");
        return Ok(());
    };
    let renderer = Renderer::new(&device, &queue)?;
    let mut haze = Haze::new(&device)?;

    haze.prepare(&device, &queue, &renderer.depth, &renderer.shadow_map)?;
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.draw(&mut encoder);
    haze.record(&mut encoder, &renderer.color);
    queue.submit([encoder.finish()]);

    let pixels = device::read(&device, &queue, renderer.color.texture())?;
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
        shadow_map: &wgpu::TextureView,
    ) -> Result<(), PrepareError> {
        let inputs = FrameInputs {
            depth,
            lights: &[LightInputs {
                shadow_map: Some(shadow_map),
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
