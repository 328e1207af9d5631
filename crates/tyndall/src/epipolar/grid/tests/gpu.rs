//! The GPU's twins: `epipolar.wesl`, and the cells of `rectify.wesl`.

use bytemuck::bytes_of;
use tyndall_testkit::{
    device::{TestDevice, device_or_skip},
    wgsl,
};
use wgpu::util::{DeviceExt, TextureDataOrder};

use super::*;
use crate::{
    frame::{Frame, Medium},
    gpu::uniforms::{FrameUniform, LightUniform, LightVariant},
    passes::epipolar::EpipolarUniform,
    shader::tests::{harness, in_one_group},
    shadow::depths::DepthRanges,
};

/// A case's uniform blocks.
struct Blocks {
    frame: wgpu::Buffer,
    light: wgpu::Buffer,
    grid: wgpu::Buffer,
    variant: LightVariant,
}

impl Blocks {
    fn new(gpu: &TestDevice, case: &Case, grid: &EpipolarGrid) -> Self {
        let frame = Frame {
            camera: case.camera,
            lights: vec![case.light],
            medium: Medium {
                components: Vec::new(),
            },
        };
        let rays = case.rays();
        let (light, variant) = LightUniform::new(&case.light, &case.camera, 0);
        let uniform = |contents: &[u8]| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: None,
                    contents,
                    usage: wgpu::BufferUsages::UNIFORM,
                })
        };
        Self {
            frame: uniform(bytes_of(&FrameUniform::new(&frame, &rays, SIZE))),
            light: uniform(bytes_of(&light)),
            grid: uniform(bytes_of(&EpipolarUniform::new(grid, 64))),
            variant,
        }
    }

    /// The test's own text as the harness can bind it, all in group 0 and made for one kind of light.
    fn module(&self, own: &str) -> String {
        let LightVariant { kind, shadow, .. } = self.variant;
        let overrides = [("LIGHT_KIND", kind), ("SHADOW_KIND", shadow)];
        in_one_group(&harness(own, &[], &overrides))
    }

    fn evaluate<const N: usize>(
        &self,
        gpu: &TestDevice,
        own: &str,
        textures: &[(u32, &wgpu::TextureView)],
        expression: &str,
        inputs: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let module = self.module(own);
        let buffers = [(0, &self.frame), (10, &self.light), (20, &self.grid)];
        let buffers = buffers.map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
        let textures = textures.iter().map(|(binding, view)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: wgpu::BindingResource::TextureView(view),
        });
        let bindings: Vec<_> = buffers.into_iter().chain(textures).collect();
        wgsl::evaluate_with(gpu, &[&module], &bindings, expression, inputs)
            .expect("the shader runs")
    }
}

/// Ray (x, y), share of its length, sample, and the ends of a light ray.
const TWINS: &str = "
import tyndall::camera::camera::camera_ray;
import tyndall::light::light::light;
import tyndall::passes::epipolar::epipolar::{
    epipolar, epipolar_crossing, epipolar_gamma, epipolar_ray, epipolar_shadow_range, epipolar_slice};
import tyndall::shadow::shadow::shadow_map;
fn twins_ray(x: array<f32, 5>) -> vec4f {
    let used = light.cube_depth.x;
    let ray = camera_ray(vec2f(x[0], x[1]), 0.0);
    let r = epipolar_ray(epipolar, ray);
    let sample = (epipolar_gamma(r, x[2] * ray.length) - epipolar.gamma_start) / epipolar.gamma_step;
    let crossing = epipolar_crossing(r, epipolar.gamma_start + floor(sample) * epipolar.gamma_step);
    return vec4f(f32(epipolar_slice(epipolar, r)), r.b, sample, crossing / ray.length + 0.0 * used);
}
fn twins_shadow(x: array<f32, 5>) -> vec4f {
    let ray = camera_ray(vec2f(x[0], x[1]), 0.0);
    let gamma = epipolar.gamma_start + (floor(x[2] * 63.0) + vec2f(0.0, 1.0)) * epipolar.gamma_step;
    return vec4f(epipolar_shadow_range(epipolar, gamma, vec2f(20.0 * x[3], 20.0 * x[3] + 5.0 * x[4])),
        0.0 * (ray.length + light.cube_depth.x), 0.0);
}";

#[test]
fn wgsl_twin_agrees() {
    let Some(gpu) = device_or_skip("epipolar.wgsl") else {
        return;
    };
    // Largest differences of b and S [steps], of the place among the samples, and of the crossing [share of the ray].
    let mut worst = [0.0_f64; 4];
    let (mut rays, mut elsewhere) = (0, 0);
    for (i, case) in Case::many(45).enumerate() {
        let Some(grid) = case.grid(0) else { continue };
        let blocks = Blocks::new(gpu, &case, &grid);
        let inputs: Vec<[f32; 5]> = points(i, 500).iter().map(|x| x.map(|x| x as f32)).collect();
        let found = blocks.evaluate(gpu, TWINS, &[], "twins_ray(x)", &inputs);
        let camera = case.rays();
        for (x, found) in inputs.iter().zip(found) {
            let x = x.map(f64::from);
            let [slice, b, sample, crossing] = found.map(f64::from);
            let ray = camera.ray_to_far(x[0], x[1]);
            let Some(place) = grid.ray(&ray) else {
                continue;
            };
            rays += 1;
            elsewhere += usize::from(slice as usize != place.slice);
            worst[0] = worst[0].max((b - place.b).abs());
            let exact = grid.sample_at(&place, x[2] * ray.length);
            worst[2] = worst[2].max((sample - exact).abs());
            if (0.0..grid.samples as f64).contains(&sample) {
                let exact = grid.crossing(&place, sample as usize) / ray.length;
                worst[3] =
                    worst[3].max((crossing - exact).abs().min((crossing / exact - 1.0).abs()));
            }
        }
        let found = blocks.evaluate(gpu, TWINS, &[], "twins_shadow(x)", &inputs);
        for (x, found) in inputs.iter().zip(found) {
            let x = x.map(f64::from);
            let sample = (63.0 * x[2]).floor() as usize;
            let gammas = [sample, sample + 1].map(|n| grid.gamma(n));
            let ends = [20.0 * x[3], 20.0 * x[3] + 5.0 * x[4]];
            for (found, exact) in found.iter().zip(grid.shadow_range(gammas, ends)) {
                worst[1] = worst[1].max((f64::from(*found) - exact).abs());
            }
        }
    }
    // Measured on lavapipe: 0.013 and 0.082 steps, 8e-4 samples, 3e-4 of a ray. `tree_pack` leaves room for the first two.
    let bounds = [0.025, 0.1, 2e-3, 6e-4];
    let within = worst.iter().zip(bounds).all(|(w, bound)| *w < bound);
    // At a slice's very border f32 may take the one beside it.
    assert!(
        within && elsewhere * 1000 < rays,
        "{worst:?}, {elsewhere} of {rays}"
    );
}

const CELL: &str = "
import tyndall::gpu::frame::frame;
import tyndall::passes::epipolar::epipolar::{epipolar, epipolar_outward};
import tyndall::techniques::min_max::rectify::{rectify_cell, rectify_side};
fn cell_of(x: array<f32, 2>, level: u32) -> vec4f {
    let e = epipolar;
    let used = frame.camera.near;
    let alphas = e.alpha_start + e.alpha_step * vec2f(x[0], x[0] + 1.0);
    let outward = mat2x3f(epipolar_outward(e, alphas.x), epipolar_outward(e, alphas.y));
    let a = rectify_side(outward, alphas, e.gamma_start + x[1] * e.gamma_step);
    let b = rectify_side(outward, alphas, e.gamma_start + (x[1] + 1.0) * e.gamma_step);
    let node = rectify_cell(a, b, level).x;
    return vec4f(f32(node & 0xffffu), f32(node >> 16u), used, 0.0);
}";

/// The pyramid that `passes::pyramid::build` draws, made on the CPU, from its first level on.
fn pyramid(gpu: &TestDevice, shadows: &Shadows<'_>) -> wgpu::TextureView {
    let ranges = DepthRanges::new(shadows);
    let (faces, levels) = (shadows.faces().len() as u32, MAP.ilog2());
    let mut texels = Vec::new();
    for face in 0..faces {
        for level in 0..levels {
            let side = 2 << level;
            for i in 0..(MAP / side).pow(2) {
                let first = [i % (MAP / side) * side, i / (MAP / side) * side];
                let exact = ranges.over(face as usize, first, first.map(|n| n + side - 1));
                texels.extend(exact.map(|d| d as f32));
            }
        }
    }
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: MAP / 2,
                height: MAP / 2,
                depth_or_array_layers: faces,
            },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rg32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// A shadow map, or its glass, of which nothing but the size is read.
fn sized_map(gpu: &TestDevice, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: MAP,
            height: MAP,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// As `cells_hold_every_light_ray_in_them`, of the GPU's nodes.
#[test]
fn the_gpus_cells_hold_every_light_ray_in_them() {
    let Some(gpu) = device_or_skip("rectify.wgsl") else {
        return;
    };
    let map = sized_map(gpu, wgpu::TextureFormat::Depth32Float);
    let glass = sized_map(gpu, wgpu::TextureFormat::Rg32Uint);
    let mut tightness = Tightness::default();
    for (i, case) in Case::many(90).enumerate() {
        let Some(grid) = case.grid([3, 40, 300][i % 3]) else {
            continue;
        };
        let shadows = case.shadows();
        let ray = |[_, _, slice, sample, across]: &[f64; 5]| {
            LightRay::in_cell(&grid, &shadows, [*slice, *sample, *across])
        };
        let rays: Vec<LightRay> = points(i, 1000).iter().map(ray).collect();
        let inputs: Vec<[f32; 2]> = rays
            .iter()
            .map(|ray| [ray.slice as f32, ray.sample as f32])
            .collect();
        let found = Blocks::new(gpu, &case, &grid).evaluate(
            gpu,
            CELL,
            &[(11, &map), (12, &glass), (21, &pyramid(gpu, &shadows))],
            // As in the pass, one level for all: not every driver takes a level of each thread's own.
            &format!("cell_of(x, {}u)", i / 3 % 3),
            &inputs,
        );
        for (ray, found) in rays.into_iter().zip(found) {
            let leaf = [found[0], found[1]].map(|n| n as u16);
            assert!(ray.is_held_by(leaf), "{}: {leaf:?} {ray:?}", case.name);
            tightness.add(leaf);
        }
    }
    // Measured on lavapipe: 11 % and 49 %.
    tightness.check(0.15, 0.45);
}
