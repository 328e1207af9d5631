//! The effect in somebody's renderer: created once a device, prepared and recorded once a frame.

use std::sync::OnceLock;

use crate::{
    camera::CameraRays,
    composite::Composite,
    error::PrepareError,
    frame::{Emitter, Frame, Light},
    gpu::{
        PassTimer,
        pass::Pass,
        pool::Pool,
        scope::{LightScope, Shared},
        uniforms::{FrameUniform, LightUniform},
    },
    occluder::Occluder,
    techniques::{Backends, Programs},
    temporal::{self, History, Reuse, ReuseMask, Signature},
    validate,
};

/// What is fixed for the life of an [`Effect`].
#[derive(Clone, Copy, Debug)]
pub struct EffectOptions {
    /// Format of the colour target that [`Effect::composite`] draws on; must be blendable.
    pub target_format: wgpu::TextureFormat,
    /// Format of [`EffectView::output`].
    pub output: OutputPrecision,
}

/// Format of the in-scattered light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPrecision {
    /// `Rgba16Float`, for pictures.
    Half,
    /// `Rgba32Float`, for measuring.
    Full,
}

impl OutputPrecision {
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Half => wgpu::TextureFormat::Rgba16Float,
            Self::Full => wgpu::TextureFormat::Rgba32Float,
        }
    }
}

/// Why an effect or a view of it could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CreateError {
    /// The picture is empty or larger than the device's textures.
    #[error("a view must be 1 to {limit} pixels a side, found {} x {}", size[0], size[1])]
    Size {
        /// What was asked for [pixels].
        size: [u32; 2],
        /// The device's limit [pixels].
        limit: u32,
    },
    /// The device cannot blend the target's format.
    #[error("the target format must be blendable on this device, found {format:?}")]
    NotBlendable {
        /// What was asked for.
        format: wgpu::TextureFormat,
    },
}

/// The caller's pictures of one frame.
#[derive(Clone, Copy)]
pub struct FrameInputs<'a> {
    /// The depth buffer (2-D, one sample, depth aspect), of the view's size, in the camera's convention.
    pub depth: &'a wgpu::TextureView,
    /// One entry a light of the frame, in the same order.
    pub lights: &'a [LightInputs<'a>],
}

/// The caller's pictures of one light.
#[derive(Clone, Copy, Default)]
pub struct LightInputs<'a> {
    /// The shadow map: a depth texture viewed as a 2-D array of 1 layer, or of 6 for a cube.
    pub shadow_map: Option<&'a wgpu::TextureView>,
    /// Coloured glass: an `Rg32Uint` 2-D array, layer `face * layers + layer`; a texel is the layer's depth in the
    /// shadow map's convention as the bits of an f32, and its tint as three 10-bit square roots (red lowest). Layers come
    /// nearest to the light first, empty ones last.
    pub glass: Option<&'a wgpu::TextureView>,
    /// The light's texture: 2-D, filterable, linear when read. Temporal reuse takes its content to stay while the view is
    /// the same.
    pub texture: Option<&'a wgpu::TextureView>,
    /// All that may block this light, as triangles, for techniques that bound shadows by geometry (`hybrid`); `None`: not
    /// known.
    pub occluders: Option<&'a [Occluder<'a>]>,
    /// The surfaces that block a rectangular light; `None`: nothing does.
    pub points: Option<PointCloud<'a>>,
    /// A number that changes whenever the shadow map's content does: what a technique made of the map alone for the
    /// frame before, if that was recorded and submitted, is used again. `None`: the map may change from frame to frame.
    pub shadow_revision: Option<u64>,
}

/// Surfaces as points, of which maps are made for the samples of a rectangular light.
#[derive(Clone, Copy)]
pub struct PointCloud<'a> {
    /// A storage buffer of four floats a point: world-space position and the radius of the disc it stands for [m]. Any
    /// points that follow each other have to be a fair sample of the surfaces: each map takes its own.
    pub points: &'a wgpu::Buffer,
    /// Texels a side of a sample's map (16 to 1024).
    pub map_side: u32,
}

/// What shadows on surfaces are made of besides a frame's inputs.
#[derive(Clone, Debug, Default)]
pub struct SurfaceShadows {
    /// World-space normals of what each pixel sees, unit length in rgb, facing the viewer: 2-D, of floats, of the view's size.
    /// Samples of a light then count by the cosine of their angle to it, and the surface's slope says how far it is kept
    /// from shadowing itself. `None`, or a pixel of zeros: not known; they count as if the surface faced each.
    pub normals: Option<wgpu::TextureView>,
}

/// A number that says what a frame took, beside its time.
#[derive(Clone, Debug)]
pub struct Count {
    /// What it counts, and of which light.
    pub name: String,
    /// Where to find it.
    pub value: CountValue,
}

/// Where a [`Count`] is found.
#[derive(Clone, Debug)]
pub enum CountValue {
    /// Here.
    Known(u64),
    /// On the device, once the frame's passes have run: a u32 in a buffer of usage `COPY_SRC`.
    Written {
        /// The buffer.
        buffer: wgpu::Buffer,
        /// Where the number stands in it [bytes].
        offset: u64,
    },
}

/// The effect's pipelines. Immutable, one a device.
pub struct Effect {
    shared: Shared,
    programs: Programs,
    reuse: OnceLock<temporal::gpu::Programs>,
    composite: Composite,
}

/// What one camera needs: textures of its size, buffers, and the frame that was prepared last.
pub struct EffectView {
    size: [u32; 2],
    pool: Pool,
    passes: Vec<Pass>,
    counts: Vec<Count>,
    reuse: Option<Reuse>,
    history: History,
    surface_shadows: Option<SurfaceShadows>,
    /// One entry a light of the frame prepared last.
    visibilities: Vec<Option<wgpu::TextureView>>,
    /// Whether the frame prepared last was recorded.
    is_recorded: bool,
    output: wgpu::TextureView,
    composite: Option<wgpu::BindGroup>,
}

impl Effect {
    /// Lays out every pipeline. Those that depend on the kind of light are compiled when the first such light is
    /// prepared, and kept.
    ///
    /// # Errors
    /// Where the device cannot blend the target format.
    pub fn new(device: &wgpu::Device, options: &EffectOptions) -> Result<Self, CreateError> {
        let format = options.target_format;
        let features = format.guaranteed_format_features(device.features());
        if !features
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
        {
            return Err(CreateError::NotBlendable { format });
        }
        let shared = Shared::new(device, options.output.format());
        Ok(Self {
            programs: Programs::default(),
            reuse: OnceLock::new(),
            composite: Composite::new(device, &shared.frame_layout, format),
            shared,
        })
    }

    /// Makes the textures of a camera of this size [pixels].
    ///
    /// # Errors
    /// Where the size is zero or beyond the device's textures.
    pub fn create_view(
        &self,
        device: &wgpu::Device,
        size: [u32; 2],
    ) -> Result<EffectView, CreateError> {
        let limit = device.limits().max_texture_dimension_2d;
        if size.iter().any(|n| !(1..=limit).contains(n)) {
            return Err(CreateError::Size { size, limit });
        }
        let mut pool = Pool::default();
        let output = self.sum(device, &mut pool, size, 0);
        Ok(EffectView {
            size,
            pool,
            passes: Vec::new(),
            counts: Vec::new(),
            reuse: None,
            history: History::default(),
            surface_shadows: None,
            visibilities: Vec::new(),
            is_recorded: false,
            output,
            composite: None,
        })
    }

    /// All that can fail: checks the frame and its inputs, and uploads what the passes read.
    ///
    /// # Errors
    /// Where the frame or an input is out of range, missing or of the wrong kind, or the technique cannot do it on
    /// the GPU. The view then still holds the frame that was prepared before.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        view: &mut EffectView,
        inputs: &FrameInputs<'_>,
        frame: &Frame,
    ) -> Result<(), PrepareError> {
        validate::frame(frame)?;
        validate::technique(frame, Backends::Gpu)?;
        validate::gpu_inputs(frame, inputs, view.size)?;
        if let Some(shadows) = &view.surface_shadows {
            validate::surface_shadows(shadows, view.size)?;
        }
        // With no light at all, a black one still writes the transmittance.
        let black = (BLACK, LightInputs::default());
        let lights: Vec<(Light, LightInputs<'_>)> = if frame.lights.is_empty() {
            vec![black]
        } else {
            let inputs = inputs.lights.iter().copied();
            frame.lights.iter().copied().zip(inputs).collect()
        };
        for (i, (light, light_inputs)) in lights.iter().enumerate() {
            frame
                .technique
                .check_gpu(&device.limits(), view.size, i, light, light_inputs)?;
            if let Some(reuse) = &view.reuse {
                let limits = device.limits();
                temporal::gpu::check(reuse, &limits, view.size, i, light, light_inputs)?;
            }
        }

        let rays = CameraRays::new(&frame.camera, view.size);
        let uniform = FrameUniform::new(frame, &rays, view.size);
        view.pool.begin(view.is_recorded);
        let seen_from = temporal::Viewpoint {
            camera: uniform.camera,
            eye: rays.eye,
        };
        view.history
            .begin(lights.len(), view.is_recorded, seen_from);
        let frame_uniform_buffer = view.pool.uniform(device, queue, (None, "frame"), &uniform);
        let (mut passes, mut counts) = (Vec::new(), Vec::new());
        let mut visibilities = Vec::new();
        let mut before = self.shared.absent.light.clone();
        for (i, (light, light_inputs)) in lights.iter().enumerate() {
            let has_glass = light_inputs.glass.is_some();
            let (light_uniform, variant) = LightUniform::new(light, rays.eye, has_glass);
            let buffer = view
                .pool
                .uniform(device, queue, (Some(i), "light"), &light_uniform);
            // The sum of the lights goes to and fro between two pictures; the second is made with the second light.
            let target = self.sum(device, &mut view.pool, view.size, i % 2);
            let frame_group =
                self.frame_group(device, &frame_uniform_buffer, inputs.depth, &before);
            let mut scope = LightScope {
                device,
                queue,
                shared: &self.shared,
                pool: &mut view.pool,
                frame,
                rays: &rays,
                size: view.size,
                index: i,
                light,
                inputs: *light_inputs,
                variant,
                frame_group,
                light_group: self.light_group(device, &buffer, light_inputs),
                target: target.clone(),
                stencil: None,
                witness: None,
                surface_shadows: view.surface_shadows.as_ref(),
                visibility: None,
                counts: &mut counts,
            };
            match view.reuse {
                None => passes.extend(frame.technique.passes(&self.programs, &mut scope)),
                Some(reuse) => {
                    let absent = &self.shared.absent.light;
                    let alone =
                        self.frame_group(device, &frame_uniform_buffer, inputs.depth, absent);
                    passes.extend(self.keep(&mut view.history, &mut scope, alone, reuse));
                }
            }
            visibilities.push(scope.visibility);
            before = target;
        }
        view.pool.end();
        view.passes = passes;
        view.counts = counts;
        view.visibilities = visibilities;
        view.is_recorded = false;
        view.composite =
            Some(self.frame_group(device, &frame_uniform_buffer, inputs.depth, &before));
        view.output = before;
        Ok(())
    }

    /// Records the passes of the frame that was prepared last; none before the first.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &mut EffectView,
        mut timer: Option<&mut PassTimer>,
    ) {
        view.is_recorded = true;
        for pass in &view.passes {
            pass.record(encoder, timer.as_deref_mut());
        }
    }

    /// Draws target * transmittance + in-scatter in the caller's pass, exactly per channel. The pass has one colour
    /// target of [`EffectOptions::target_format`] and of the view's size, no depth and one sample; its alpha stays.
    pub fn composite(&self, pass: &mut wgpu::RenderPass<'_>, view: &EffectView) {
        if let Some(frame) = &view.composite {
            self.composite.draw(pass, frame);
        }
    }

    /// The passes of one light that is kept from frame to frame. `alone` is bind group 0 without the lights before.
    fn keep(
        &self,
        history: &mut History,
        scope: &mut LightScope<'_>,
        alone: wgpu::BindGroup,
        reuse: Reuse,
    ) -> Vec<Pass> {
        let technique = &scope.frame.technique;
        let make = || temporal::gpu::Programs::new(scope.device, &self.shared);
        let programs = self.reuse.get_or_init(make);
        let inputs = &scope.inputs;
        let signature = Signature::new(scope.frame, scope.light, scope.variant, reuse, inputs);
        let moved = match reuse.mask {
            ReuseMask::Change => Vec::new(),
            ReuseMask::Geometry => history.moved(scope.index, inputs.occluders.unwrap_or_default()),
        };
        let frame = temporal::gpu::Frame {
            reuse,
            generations: history.generations(scope.index, signature),
            reach: technique.reach(),
            before: history.before(),
            moved: &moved,
        };
        let kept = temporal::gpu::kept(scope);
        let sum = std::mem::replace(&mut scope.target, kept.clone());
        let with_lights_before = std::mem::replace(&mut scope.frame_group, alone);
        scope.stencil = Some(temporal::gpu::stencil(scope));
        let passes = technique.passes(&self.programs, scope);
        let mut passes = temporal::gpu::wrap(passes, &frame, programs, scope);
        scope.frame_group = with_lights_before;
        passes.push(temporal::gpu::add(&frame, &kept, sum, programs, scope));
        passes
    }

    fn frame_group(
        &self,
        device: &wgpu::Device,
        uniform: &wgpu::Buffer,
        depth: &wgpu::TextureView,
        lights_before: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall frame"),
            layout: &self.shared.frame_layout,
            entries: &[
                buffer_entry(0, uniform),
                texture_entry(1, depth),
                texture_entry(2, lights_before),
            ],
        })
    }

    fn light_group(
        &self,
        device: &wgpu::Device,
        uniform: &wgpu::Buffer,
        inputs: &LightInputs<'_>,
    ) -> wgpu::BindGroup {
        let absent = &self.shared.absent;
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tyndall light"),
            layout: &self.shared.light_layout,
            entries: &[
                buffer_entry(0, uniform),
                texture_entry(1, inputs.shadow_map.unwrap_or(&absent.shadow_map)),
                texture_entry(2, inputs.glass.unwrap_or(&absent.glass)),
                texture_entry(3, inputs.texture.unwrap_or(&absent.picture)),
                wgpu::BindGroupEntry {
                    binding: 4,
                    resource: wgpu::BindingResource::Sampler(&self.shared.sampler),
                },
            ],
        })
    }

    /// One of the two pictures that sum up the lights.
    fn sum(
        &self,
        device: &wgpu::Device,
        pool: &mut Pool,
        size: [u32; 2],
        which: usize,
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let key = (None, ["in-scatter, even", "in-scatter, odd"][which]);
        pool.texture(device, key, extent(size), 1, self.shared.output, usage)
            .create_view(&wgpu::TextureViewDescriptor::default())
    }
}

impl EffectView {
    /// In-scattered radiance [W/(m^2 sr)] in rgb, mean transmittance to the surface in a; of the frame recorded last.
    /// The view may be another one after `prepare` with another number of lights.
    pub fn output(&self) -> &wgpu::TextureView {
        &self.output
    }

    /// What is kept of earlier frames from now on; `None`, as at first: nothing.
    pub fn set_reuse(&mut self, reuse: Option<Reuse>) {
        self.reuse = reuse;
    }

    /// Asks for shadows of rectangular lights on surfaces, from the next frame prepared on; `None`, as at first: nobody wants
    /// them, and they cost nothing.
    pub fn set_surface_shadows(&mut self, shadows: Option<SurfaceShadows>) {
        self.surface_shadows = shadows;
    }

    /// How much of a light (its index in the frame) reaches the surface that each pixel sees, of the frame recorded last:
    /// `Rgba16Float`, of the view's size, 0 to 1 in each of rgb, 1 in a; 1 where no light would arrive. It is the mean over
    /// the light's samples, weighed by what each would send there: its share of the light's picture, the emitter's cosine,
    /// 1 / d^2, extinction on the way, and the surface's cosine where [`SurfaceShadows::normals`] are given. So the irradiance
    /// of a shadowed surface is that of the unshadowed one, times this. What a pixel without a surface holds is that of the
    /// end of its ray on the far plane.
    ///
    /// `None` where [`EffectView::set_surface_shadows`] did not ask for it, where there is no such light, and with any
    /// technique but `ivsv`, whose voxels it is read from. The view may be another one after each `prepare`.
    pub fn surface_light_visibility(&self, light: usize) -> Option<&wgpu::TextureView> {
        self.visibilities.get(light)?.as_ref()
    }

    /// The passes of the frame prepared last.
    #[cfg(test)]
    pub(crate) fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// Width and height [pixels].
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What the frame prepared last counts, light by light.
    pub fn counts(&self) -> &[Count] {
        &self.counts
    }

    /// Bytes of the textures and buffers this view holds.
    pub fn bytes(&self) -> u64 {
        self.pool.bytes()
    }
}

/// Stands in where a frame has no light.
const BLACK: Light = Light {
    emitter: Emitter::Directional {
        direction: [0.0, -1.0, 0.0],
        illuminance: [0.0; 3],
    },
    shadow: None,
    texture: None,
};

/// The extent of a plain 2-D texture.
fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

fn buffer_entry(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: buffer.as_entire_binding(),
    }
}

fn texture_entry(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    }
}
