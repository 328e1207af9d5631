//! A scene in the device's memory, ready to be drawn by any pipeline.

use wgpu::{BindGroup, Device, Queue, RenderPass};

use super::{
    error::GpuSceneError,
    material::Materials,
    mesh::{DrawClass, Meshes},
    pipeline::Layouts,
    view::ViewUniform,
};
use crate::scene::Scene;

pub(super) struct UploadedScene {
    pub(super) device: Device,
    pub(super) queue: Queue,
    pub(super) layouts: Layouts,
    pub(super) meshes: Meshes,
    materials: Materials,
}

impl UploadedScene {
    pub(super) fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuSceneError> {
        let layouts = Layouts::new(device);
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            meshes: Meshes::new(device, scene)?,
            materials: Materials::new(device, queue, scene, &layouts.material)?,
            layouts,
        })
    }

    /// Group 0 of the pipelines that draw triangles.
    pub(super) fn view_bind_group(&self, view: &ViewUniform) -> BindGroup {
        self.layouts.view_bind_group(&self.device, view)
    }

    /// Draws one class, with its materials in group 1.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>, class: DrawClass) {
        self.meshes.draw(pass, class, Some(&self.materials));
    }

    /// Draws one class with a pipeline that reads no materials.
    pub(super) fn draw_plain(&self, pass: &mut RenderPass<'_>, class: DrawClass) {
        self.meshes.draw(pass, class, None);
    }
}
