//! One frame of a shot, drawn once for all that is measured on it.

use std::{borrow::Cow, cell::OnceCell};

use tyndall::{
    cpu::CpuLightInputs,
    frame::Camera,
    techniques::{Backends, TABLE, Technique, TechniqueInfo, reference},
};

use super::{Visibility, limit::Limit, place::Place};
use crate::{
    backend::{Backend, Gpu},
    failure::Failure,
    load::ShotFrame,
    picture::Picture,
    progress::Progress,
    render::{
        Buffers, Needs, TechniqueInputs, cpu, depth,
        gpu::{DeviceShot, TimedView, Timestamps, ViewOptions, timed_frame},
    },
};

/// Relative error of the reference's quadrature, below that of anything it is compared with.
const REFERENCE_TOLERANCE: f64 = 1e-4;

/// A frame of a shot whose depth buffer and shadow maps are drawn.
pub struct DrawnFrame<'a> {
    pub(super) shot_frame: Cow<'a, ShotFrame>,
    drawn: Drawn<'a>,
}

/// Depth buffer and shadow maps.
enum Drawn<'a> {
    /// Drawn on the device, and read back when the first technique on the CPU asks for it.
    Gpu(Box<OnDevice<'a>>, OnceCell<Buffers>),
    /// Traced.
    Cpu(Buffers),
}

/// Depth buffer and shadow maps on a device, and the limit over them.
pub(super) struct OnDevice<'a> {
    pub(super) shot: DeviceShot<'a>,
    pub(super) limit: Limit,
    /// Each pass that drew them, and its time \[ms].
    passes: Vec<(String, f64)>,
}

impl<'a> DrawnFrame<'a> {
    /// Uploads and draws, or traces, the inputs of all techniques.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub fn new(
        shot_frame: &'a ShotFrame,
        backend: &'a Backend,
        progress: &mut Progress,
    ) -> Result<Self, Failure> {
        let drawn = match backend {
            Backend::Gpu(gpu) => {
                let device =
                    progress.run("upload and draw", |_| OnDevice::draw(shot_frame, gpu))?;
                Drawn::Gpu(Box::new(device), OnceCell::new())
            }
            Backend::Cpu => Drawn::Cpu(Buffers::trace(shot_frame, progress)),
        };
        Ok(Self {
            shot_frame: Cow::Borrowed(shot_frame),
            drawn,
        })
    }

    /// The frame.
    pub fn shot_frame(&self) -> &ShotFrame {
        &self.shot_frame
    }

    /// Draws, or traces, the depth buffer of another camera; the shadow maps stay.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub fn look_from(&mut self, camera: Camera) -> Result<(), Failure> {
        let shot_frame = self.shot_frame.to_mut();
        shot_frame.frame.camera = camera;
        match &mut self.drawn {
            Drawn::Gpu(device, read) => {
                device.draw_g_buffer(shot_frame)?;
                if let Some(buffers) = read.get_mut() {
                    buffers.depth = device.read_depth()?;
                }
                Ok(())
            }
            Drawn::Cpu(buffers) => {
                buffers.depth = depth(shot_frame, &|_, _| ());
                Ok(())
            }
        }
    }

    /// Each GPU pass that drew the shadow maps and the depth buffer, and its time \[ms], of one frame.
    pub fn draw_passes(&self) -> &[(String, f64)] {
        self.device().map_or(&[], |device| &device.passes)
    }

    /// Every technique that can do the shot's lights here, but the reference, in the table's order.
    pub fn techniques(&self) -> Vec<Technique> {
        TABLE
            .iter()
            .filter(|info| self.place(info).is_some())
            .map(TechniqueInfo::default_technique)
            .filter(|technique| !technique.info().is_reference)
            .collect()
    }

    /// The place where a technique runs: the GPU where both can; `None` where it can't do a light of the shot, or needs a
    /// device and there is none.
    pub fn place(&self, technique: &TechniqueInfo) -> Option<Place> {
        self.places(technique).first().copied()
    }

    /// Every place where a technique can do the kinds of the shot's lights, the GPU first.
    pub fn places(&self, technique: &TechniqueInfo) -> Vec<Place> {
        let lights = &self.shot_frame.frame.lights;
        let can = |backend| {
            lights
                .iter()
                .all(|light| technique.can(light.kind(), backend))
        };
        let on_gpu = (self.device().is_some() && can(Backends::Gpu)).then_some(Place::Gpu);
        let on_cpu = can(Backends::Cpu).then_some(Place::Cpu);
        on_gpu.into_iter().chain(on_cpu).collect()
    }

    /// In-scattered radiance by a technique [W/(m^2 sr)].
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the shot, [`Failure::Device`] where the GPU fails.
    pub fn in_scatter(&self, technique: &Technique) -> Result<Picture, Failure> {
        match self.device_for(technique)? {
            Some(device) => {
                let view = self.rendered(device, technique)?;
                view.view.in_scatter(device.shot.gpu)
            }
            None => self.in_scatter_on_cpu(technique),
        }
    }

    /// In-scattered radiance by a technique in one of its [places](Self::places) [W/(m^2 sr)].
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn in_scatter_at(&self, technique: &Technique, place: Place) -> Result<Picture, Failure> {
        match place {
            Place::Gpu => self.in_scatter(technique),
            Place::Cpu => self.in_scatter_on_cpu(technique),
        }
    }

    /// The picture that is taken for true: exact visibility, from the scene or from the drawn shadow maps, and converged
    /// quadrature.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn reference(&self, visibility: Visibility) -> Result<Picture, Failure> {
        self.in_scatter(&converged(visibility))
    }

    /// Counts of a technique in one frame; none on the CPU.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn counts(&self, technique: &Technique) -> Result<Vec<(String, u64)>, Failure> {
        match self.device_for(technique)? {
            Some(device) => {
                let view = self.rendered(device, technique)?;
                view.view.counts(device.shot.gpu)
            }
            None => Ok(Vec::new()),
        }
    }

    /// A technique on the device, once it has rendered a frame.
    fn rendered(&self, device: &OnDevice<'a>, technique: &Technique) -> Result<TimedView, Failure> {
        let options = ViewOptions::default();
        let mut view = TimedView::new(
            &device.shot,
            &self.shot_frame,
            &technique.clone().into(),
            options,
        )?;
        view.frame(&device.shot, &self.shot_frame)?;
        Ok(view)
    }

    /// The device, where the technique runs on it.
    pub(super) fn device_for(
        &self,
        technique: &Technique,
    ) -> Result<Option<&OnDevice<'a>>, Failure> {
        let info = technique.info();
        match self.place(info) {
            Some(Place::Gpu) => Ok(self.device()),
            Some(Place::Cpu) => Ok(None),
            None => Err(Failure::Input(anyhow::anyhow!(
                "technique {} cannot do this shot's lights here",
                info.name
            ))),
        }
    }

    /// As [`DrawnFrame::in_scatter`], on the CPU wherever else the technique could run.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn in_scatter_on_cpu(&self, technique: &Technique) -> Result<Picture, Failure> {
        let buffers = self.buffers()?;
        let inputs = TechniqueInputs::of(std::slice::from_ref(technique));
        let lights = self.light_inputs(buffers, inputs.shadow_maps);
        let (shot_frame, depth) = (&self.shot_frame, &buffers.depth);
        let techniques = technique.clone().into();
        let pixels = cpu::in_scatter(shot_frame, &techniques, depth, &lights, &|_, _| ())?;
        Ok(Picture {
            size: self.shot_frame.size,
            pixels,
        })
    }

    /// The lights' inputs on the CPU; without shadow maps nothing but the scene itself blocks them.
    pub(super) fn light_inputs<'b>(
        &'b self,
        buffers: &'b Buffers,
        shadow_maps: bool,
    ) -> Vec<CpuLightInputs<'b>> {
        let mut lights = cpu::light_inputs(&self.shot_frame, &buffers.lights);
        if !shadow_maps {
            for light in &mut lights {
                *light = CpuLightInputs {
                    texture: light.texture,
                    ..Default::default()
                };
            }
        }
        lights
    }

    pub(super) fn device(&self) -> Option<&OnDevice<'a>> {
        match &self.drawn {
            Drawn::Gpu(device, _) => Some(device),
            Drawn::Cpu(_) => None,
        }
    }

    /// Depth buffer and light maps in main memory.
    pub(super) fn buffers(&self) -> Result<&Buffers, Failure> {
        match &self.drawn {
            Drawn::Cpu(buffers) => Ok(buffers),
            Drawn::Gpu(device, cell) => match cell.get() {
                Some(buffers) => Ok(buffers),
                None => {
                    let read = device.read()?;
                    Ok(cell.get_or_init(|| read))
                }
            },
        }
    }
}

impl<'a> OnDevice<'a> {
    fn draw(shot_frame: &ShotFrame, gpu: &'a Gpu) -> Result<Self, Failure> {
        let draw = || {
            let mut shot = DeviceShot::new(shot_frame, gpu, Needs::IN_SCATTER)?;
            let mut timestamps = Timestamps::new(&gpu.device);
            Ok(Self {
                passes: shot.draw_and_wait(shot_frame, &mut timestamps)?,
                limit: Limit::new(&gpu.device, &shot.world),
                shot,
            })
        };
        gpu.errors.else_result(draw())
    }

    fn draw_g_buffer(&self, shot_frame: &ShotFrame) -> Result<(), Failure> {
        let world = &self.shot.world;
        let mut untimed = Timestamps::none();
        let draw = timed_frame(self.shot.gpu, &mut untimed, |encoder, _| {
            world.draw_g_buffer(shot_frame, encoder, None);
            Ok(())
        });
        draw.map(|_| ())
    }

    fn read_depth(&self) -> Result<Vec<f32>, Failure> {
        let gpu = self.shot.gpu;
        gpu.errors.else_result(self.shot.world.read_depth(gpu))
    }

    fn read(&self) -> Result<Buffers, Failure> {
        let gpu = self.shot.gpu;
        gpu.errors.else_result(self.shot.world.read(gpu))
    }
}

/// The reference at a tolerance below the error of anything it is compared with.
pub fn converged(visibility: Visibility) -> Technique {
    Technique::Reference(reference::Params {
        tolerance: REFERENCE_TOLERANCE,
        visibility,
    })
}
