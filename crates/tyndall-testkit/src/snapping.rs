//! Measures what a rasteriser may round: it moves vertices to a grid of sub-pixels, the device's own.
//!
//! Vulkan asks for 4 bits of sub-pixels at least (`subPixelPrecisionBits`), and SwiftShader has no more; lavapipe has 8. A vertex
//! moves by half a step at most, and so does any point of a triangle, which is a mean of its corners: what a pixel shows is what
//! its triangle has within half a step of the pixel's centre. That is tested by tracing all over this square.

use crate::device::{ReadBackError, TestDevice};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Rows of the measurement, a left edge each.
const ROWS: u32 = 256;
/// Steps of the edges from row to row, a pixel.
const STEPS: f64 = 2048.0;

/// Rectangles whose left edges pass the centres of the first column's pixels step by step.
const EDGES: &str = "
    @vertex
    fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) row: u32) -> @builtin(position) vec4f {
        let left = 0.5 + (f32(row) - 128.0) / 2048.0;
        let pixel = vec2f(select(left, 2.0, (corner & 1u) == 1u), f32(row + (corner >> 1u)));
        return vec4f(pixel.x - 1.0, 1.0 - pixel.y / 128.0, 0.5, 1.0);
    }
    @fragment
    fn fragment() -> @location(0) f32 {
        return 1.0;
    }";

/// The farthest that the device moves an edge, within a step of the measurement \[pixels].
///
/// # Errors
/// Where the device does not finish its work.
pub fn half_step(gpu: &TestDevice) -> Result<f64, ReadBackError> {
    let covered = edges(gpu)?;
    let offset = |row: usize| (row as f64 - f64::from(ROWS / 2)) / STEPS;
    let moved = (0..covered.len()).filter(|&row| covered[row] != (offset(row) <= 0.0));
    Ok(moved.map(|row| offset(row).abs()).fold(0.0, f64::max) + 1.0 / STEPS)
}

/// Asks the device which rows' edges are left of their pixels' centres.
fn edges(gpu: &TestDevice) -> Result<Vec<bool>, ReadBackError> {
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(EDGES.into()),
        });
    let pipeline = gpu
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..Default::default()
            },
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: 2,
            height: ROWS,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..4, 0..ROWS);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    let texels: Vec<[f32; 2]> = gpu.read_texture(&target)?;
    Ok(texels.iter().map(|row| row[0] == 1.0).collect())
}

/// Shifts over the square that a point may have been moved within, its borders included, `side` (> 1) to a side \[pixels].
///
/// # Errors
/// As [`half_step`].
pub fn shifts(gpu: &TestDevice, side: u32) -> Result<Vec<[f64; 2]>, ReadBackError> {
    let half = half_step(gpu)?;
    let at = |i: u32| half * (2.0 * f64::from(i) / f64::from(side - 1) - 1.0);
    let place = |i: u32| [at(i % side), at(i / side)];
    Ok((0..side * side).map(place).collect())
}

/// The values nearest to those found that lie within what is expected of all shifts: pixel by pixel, channel by channel.
///
/// # Panics
/// Where lengths differ, or nothing is expected.
pub fn nearest<T: PartialOrd + Copy>(found: &[T], expected: &[impl AsRef<[T]>]) -> Vec<T> {
    let expected: Vec<&[T]> = expected.iter().map(AsRef::as_ref).collect();
    assert!(!expected.is_empty(), "nothing is expected");
    assert!(expected.iter().all(|values| values.len() == found.len()));
    let least = |a: T, b: T| if b < a { b } else { a };
    let most = |a: T, b: T| if b > a { b } else { a };
    let clamped = |(i, &value): (usize, &T)| {
        let of_all = expected[1..].iter().map(|values| values[i]);
        let low = of_all.clone().fold(expected[0][i], least);
        let high = of_all.fold(expected[0][i], most);
        least(most(value, low), high)
    };
    found.iter().enumerate().map(clamped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::device_or_skip;

    #[test]
    fn the_grid_is_as_fine_as_vulkan_asks() {
        let Some(gpu) = device_or_skip("the grid of sub-pixels") else {
            return;
        };
        let covered = edges(gpu).expect("the device reads back");
        assert!(covered[0] && !covered[ROWS as usize - 1]);
        let half = half_step(gpu).expect("the device reads back");
        eprintln!("{}: vertices move by {half} pixels", gpu.info.name);
        assert!(half <= 1.0 / 32.0 + 1.0 / STEPS, "{half}");
    }

    #[test]
    fn nearest_values_are_within_all_that_is_expected() {
        let expected = [vec![0.0, 2.0, 1.0], vec![1.0, 1.0, 1.0]];
        assert_eq!(nearest(&[0.5, 3.0, 0.0], &expected), [0.5, 2.0, 1.0]);
    }
}
