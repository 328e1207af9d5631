//! Point clouds on the device.

use wgpu::{
    Buffer, BufferUsages, Device,
    util::{BufferInitDescriptor, DeviceExt},
};

/// Uploads points, four floats each, as [`tyndall::PointCloud`] takes them.
pub fn upload_point_cloud(device: &Device, points: &[[f32; 4]]) -> Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: Some("points of the scene"),
        contents: bytemuck::cast_slice(points),
        usage: BufferUsages::STORAGE,
    })
}
