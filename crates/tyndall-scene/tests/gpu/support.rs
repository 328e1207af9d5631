//! Common parts of the tests.

use tyndall_scene::{
    gpu::{SceneRenderer, readback},
    scene::Scene,
};
use tyndall_testkit::{device::TestDevice, metrics::compare, picture::Picture};

pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

pub(crate) fn renderer(gpu: &TestDevice, scene: &Scene) -> SceneRenderer {
    SceneRenderer::new(&gpu.device, &gpu.queue, scene, FORMAT).unwrap()
}

pub(crate) fn read(gpu: &TestDevice, texture: &wgpu::Texture) -> Vec<f32> {
    readback::texture_f32(&gpu.device, &gpu.queue, texture).unwrap()
}

pub(crate) fn record(gpu: &TestDevice, passes: impl FnOnce(&mut wgpu::CommandEncoder)) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    passes(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
}

pub(crate) fn color_target(gpu: &TestDevice, [width, height]: [u32; 2]) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The first `kept` of every `of` numbers.
pub(crate) fn channels(values: &[f32], of: usize, kept: usize) -> Vec<f32> {
    let texels = values.chunks_exact(of);
    texels.flat_map(|texel| &texel[..kept]).copied().collect()
}

/// Fraction of values that differ by more than `tolerance`, and the largest difference among the others.
pub(crate) fn differing(found: &[f32], expected: &[f32], tolerance: f32) -> (f64, f32) {
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().chain(expected).all(|v| v.is_finite()));
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let (more, less): (Vec<f32>, Vec<f32>) = differences.partition(|&d| d > tolerance);
    (
        more.len() as f64 / found.len() as f64,
        less.into_iter().fold(0.0, f32::max),
    )
}

/// Relative mean absolute error of linear RGB.
pub(crate) fn rel_mae(found: &[f32], expected: &[f32], size: [u32; 2]) -> f64 {
    let image = |values: &[f32]| {
        let (pixels, _) = values.as_chunks::<3>();
        let pixels = pixels.iter().map(|pixel| pixel.map(f64::from)).collect();
        Picture::new(size.map(|n| n as usize), pixels).unwrap()
    };
    compare(&image(found), &image(expected)).unwrap().rel_mae
}

#[test]
fn differences_are_counted() {
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.0], 0.1), (0.0, 0.0));
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.5], 0.1), (0.5, 0.0));
    assert_eq!(differing(&[0.0, 1.0], &[0.0, 1.5], 1.0), (0.0, 0.5));
}
