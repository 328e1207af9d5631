//! A shot on a device: all commands render its frames by this code.
//!
//! [`DeviceShot`] holds everything that the techniques share: the scene, light maps, G-buffer and the effect.
//! [`DeviceView`] is a choice of techniques on it, with the textures that they work on.

use tyndall::{
    Effect, EffectView, FrameInputs, Occluder,
    gpu::PassTimer,
    techniques::{Backends, TechniqueChoice},
    temporal::Reuse,
};
use tyndall_scene::gpu::readback;
use wgpu::{CommandEncoder, TextureView};

use super::{
    effect::{counts, new_effect, picture, target_format},
    world::World,
};
use crate::{
    backend::Gpu,
    failure::Failure,
    load::ShotFrame,
    picture::Picture,
    render::needs::{Needs, reads_occluders},
};

/// A shot's scene on a device, with the textures that its camera and its lights are drawn on, and the effect.
pub(crate) struct DeviceShot<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) world: World,
    needs: Needs,
    effect: Effect,
}

/// The techniques of a shot's lights with the textures they work on.
pub(crate) struct DeviceView {
    techniques: TechniqueChoice,
    options: ViewOptions,
    view: EffectView,
}

/// Options of a [`DeviceView`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ViewOptions {
    /// Reuse of earlier frames.
    pub(crate) reuse: Option<Reuse>,
    /// Whether the technique is told when a light's maps change; else it has to take them for new in every frame.
    pub(crate) tracks_maps: bool,
}

impl<'a> DeviceShot<'a> {
    /// Uploads the scene and allocates.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn new(shot_frame: &ShotFrame, gpu: &'a Gpu, needs: Needs) -> Result<Self, Failure> {
        let format = target_format(&gpu.device);
        Ok(Self {
            world: World::new(shot_frame, gpu, needs, format)?,
            effect: new_effect(&gpu.device, format)?,
            gpu,
            needs,
        })
    }

    /// Makes the textures of techniques.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn view(
        &self,
        shot_frame: &ShotFrame,
        techniques: &TechniqueChoice,
        options: ViewOptions,
    ) -> Result<DeviceView, Failure> {
        let view = self.effect.create_view(&self.gpu.device, shot_frame.size);
        let mut view = view.map_err(Failure::device)?;
        view.set_reuse(options.reuse);
        let shadows = self.needs.surface_shadows;
        view.set_surface_shadows(shadows.then(|| self.world.surface_shadows()));
        Ok(DeviceView {
            techniques: techniques.clone(),
            options,
            view,
        })
    }

    /// Moves nodes, lights and textures to where they are in a frame that differs from the one given first in these, in
    /// camera and in medium alone.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub(crate) fn place(&mut self, shot_frame: &ShotFrame) -> Result<(), Failure> {
        self.world.place(shot_frame, self.gpu, self.needs)
    }

    /// Records the passes that draw the light maps and the G-buffer.
    pub(crate) fn draw(
        &self,
        shot_frame: &ShotFrame,
        encoder: &mut CommandEncoder,
        mut timer: Option<&mut PassTimer>,
    ) {
        self.world
            .draw_light_maps(shot_frame, encoder, timer.as_deref_mut());
        self.world.draw_g_buffer(shot_frame, encoder, timer);
    }

    /// The scene's triangles where they are in a frame, where a technique of the view reads them.
    ///
    /// # Errors
    /// [`Failure::Device`] where they cannot be uploaded.
    pub(crate) fn occluders(
        &self,
        view: &DeviceView,
        shot_frame: &ShotFrame,
    ) -> Result<Option<Vec<Occluder<'_>>>, Failure> {
        let lights = shot_frame.frame.lights.iter().enumerate();
        let techniques: Vec<_> = lights
            .map(|(index, light)| view.techniques.of(index, light, Backends::Gpu))
            .collect();
        reads_occluders(&techniques, view.options.reuse.as_ref())
            .then(|| self.world.occluders(shot_frame, self.gpu))
            .transpose()
    }

    /// Checks the frame and records the passes of a view's technique. The frame must have been drawn, and `occluders` be
    /// those of this frame.
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the frame.
    pub(crate) fn record(
        &self,
        view: &mut DeviceView,
        shot_frame: &ShotFrame,
        occluders: Option<&[Occluder<'_>]>,
        encoder: &mut CommandEncoder,
        timer: Option<&mut PassTimer>,
    ) -> Result<(), Failure> {
        let Gpu { device, queue, .. } = self.gpu;
        let mut lights = self.world.light_inputs(occluders);
        if !view.options.tracks_maps {
            for light in &mut lights {
                light.shadow_revision = None;
            }
        }
        let inputs = FrameInputs {
            depth: self.world.g_buffer().depth_view(),
            lights: &lights,
        };
        let DeviceView {
            techniques, view, ..
        } = view;
        let frame = &shot_frame.frame;
        self.effect
            .prepare(device, queue, view, &inputs, frame, techniques)
            .map_err(Failure::input)?;
        self.effect.record(encoder, view, timer);
        Ok(())
    }

    /// Records the lit surfaces on `target`, shadowed by what the view's technique found.
    pub(crate) fn draw_surfaces(
        &self,
        view: &DeviceView,
        shot_frame: &ShotFrame,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        timer: Option<&mut PassTimer>,
    ) {
        let lights = 0..shot_frame.frame.lights.len();
        let visibility: Vec<_> = lights
            .map(|light| view.view.surface_light_visibility(light))
            .collect();
        self.world
            .draw_surfaces(shot_frame, encoder, target, &visibility, timer);
    }

    /// Draws the composite in a pass on the surfaces.
    pub(crate) fn composite(&self, pass: &mut wgpu::RenderPass<'_>, view: &DeviceView) {
        self.effect.composite(pass, &view.view);
    }
}

impl DeviceView {
    /// In-scattered radiance [W/(m^2 sr)] and mean transmittance of the frame rendered last, pixel by pixel. Waits for the
    /// device.
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub(crate) fn output(&self, gpu: &Gpu) -> Result<Vec<f32>, Failure> {
        let output = self.view.output().texture();
        readback::texture_f32(&gpu.device, &gpu.queue, output).map_err(Failure::device)
    }

    /// In-scattered radiance of the frame rendered last [W/(m^2 sr)].
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub(crate) fn in_scatter(&self, gpu: &Gpu) -> Result<Picture, Failure> {
        Ok(picture(self.view.size(), &self.output(gpu)?))
    }

    /// Counts of the technique in the frame rendered last.
    ///
    /// # Errors
    /// [`Failure::Device`] where the device is lost.
    pub(crate) fn counts(&self, gpu: &Gpu) -> Result<Vec<(String, u64)>, Failure> {
        counts(&self.view, &gpu.device, &gpu.queue)
    }

    /// Textures and buffers of the technique \[bytes].
    pub(crate) fn bytes(&self) -> u64 {
        self.view.bytes()
    }
}
