//! A shot set up once, and whatever is measured on it.

use std::{borrow::Cow, cell::OnceCell, time::Instant};

use tyndall::{
    cpu::CpuLightInputs,
    frame::{Camera, LightKind},
    techniques::{Backends, TABLE, Technique, TechniqueInfo, reference},
};

use super::{
    Budget, Timing, Timings, Visibility,
    device::{DeviceStage, DeviceTechnique},
    timing::{FrameTime, interleave},
};
use crate::{
    failure::Failure,
    picture::Picture,
    progress::Stages,
    render::{
        Backend, Buffers,
        cpu::{self, depth},
        gpu::Timestamps,
        reads_shadow_maps,
    },
    setup::Setup,
};

/// Relative error of the reference's quadrature, below that of anything it is compared with.
const REFERENCE_TOLERANCE: f64 = 1e-4;

/// Where a technique runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the device.
    Gpu,
    /// On all cores.
    Cpu,
}

impl Place {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "GPU",
            Self::Cpu => "CPU",
        }
    }
}

/// A shot whose scene is loaded and whose depth buffer and shadow maps are drawn.
pub struct Stage<'a> {
    setup: Cow<'a, Setup>,
    drawn: Drawn<'a>,
}

/// Depth buffer and shadow maps.
enum Drawn<'a> {
    /// Drawn on the device, and read back when the first technique on the CPU asks for it.
    Gpu(Box<DeviceStage<'a>>, OnceCell<Buffers>),
    /// Traced.
    Cpu(Buffers),
}

impl<'a> Stage<'a> {
    /// Uploads and draws, or traces, what all techniques read.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub fn new(
        setup: &'a Setup,
        backend: &'a Backend,
        stages: &mut Stages,
    ) -> Result<Self, Failure> {
        let drawn = match backend {
            Backend::Gpu(gpu) => {
                let device = stages.run("upload and draw", |_| DeviceStage::new(setup, gpu))?;
                Drawn::Gpu(Box::new(device), OnceCell::new())
            }
            Backend::Cpu => Drawn::Cpu(Buffers::trace(setup, stages)),
        };
        Ok(Self {
            setup: Cow::Borrowed(setup),
            drawn,
        })
    }

    /// The shot.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Draws, or traces, the depth buffer of another camera; the shadow maps stay.
    ///
    /// # Errors
    /// [`Failure::Device`] where the GPU fails.
    pub fn look_from(&mut self, camera: Camera) -> Result<(), Failure> {
        self.setup.to_mut().frame.camera = camera;
        match &mut self.drawn {
            Drawn::Gpu(device, read) => {
                *read = OnceCell::new();
                device.look_from(camera)
            }
            Drawn::Cpu(buffers) => {
                buffers.depth = depth(&self.setup, &|_, _| ());
                Ok(())
            }
        }
    }

    /// Each GPU pass that drew the shadow maps and the depth buffer, and its time [ms], of one frame.
    pub fn drawn(&self) -> &[(String, f64)] {
        self.device().map_or(&[], DeviceStage::drawn)
    }

    /// Every technique that can do the shot's lights on this stage, but the reference, in the table's order.
    pub fn techniques(&self) -> Vec<Technique> {
        TABLE
            .iter()
            .filter(|info| self.place(info).is_some())
            .map(|info| info.default_technique())
            .filter(|technique| !technique.info().is_reference)
            .collect()
    }

    /// Where a technique runs on this stage: on the GPU where both can; `None` where it can't do a light of the
    /// shot, or needs a device and there is none.
    pub fn place(&self, technique: &TechniqueInfo) -> Option<Place> {
        let mut lights = self.setup.frame.lights.iter();
        if !lights.all(|light| technique.lights.contains(&LightKind::of(&light.emitter))) {
            return None;
        }
        match (technique.backends, self.device()) {
            (Backends::Gpu | Backends::Both, Some(_)) => Some(Place::Gpu),
            (Backends::Cpu | Backends::Both, _) => Some(Place::Cpu),
            (Backends::Gpu, None) => None,
        }
    }

    /// In-scattered radiance by a technique [W/(m^2 sr)].
    ///
    /// # Errors
    /// [`Failure::Input`] where the technique can't do the shot, [`Failure::Device`] where the GPU fails.
    pub fn in_scatter(&self, technique: &Technique) -> Result<Picture, Failure> {
        match self.device_for(technique)? {
            Some(device) => {
                let mut technique = device.technique(technique, false)?;
                technique.frame()?;
                technique.in_scatter()
            }
            None => self.in_scatter_on_cpu(technique),
        }
    }

    /// The picture that is taken for true: exact visibility, from the scene or from the stage's shadow maps, and converged
    /// quadrature.
    ///
    /// # Errors
    /// [`Failure`], as for [`Stage::in_scatter`].
    pub fn reference(&self, visibility: Visibility) -> Result<Picture, Failure> {
        self.in_scatter(&converged(visibility))
    }

    /// Times techniques in turn: one frame of each, and one of the limit, a round.
    ///
    /// # Errors
    /// [`Failure`], as for [`Stage::in_scatter`].
    pub fn time(&self, techniques: &[Technique], budget: &Budget) -> Result<Timings, Failure> {
        let contenders = techniques
            .iter()
            .map(|technique| self.contender(technique, false))
            .collect::<Result<Vec<_>, _>>()?;
        let (timings, limit) = self.time_contenders(contenders, budget)?;
        Ok(Timings {
            techniques: techniques.iter().cloned().zip(timings).collect(),
            limit,
        })
    }

    /// Times techniques in turn, each twice: as if the shadow maps changed every frame, and saying that they don't.
    /// Also the time of the limit, where there is one.
    ///
    /// # Errors
    /// [`Failure`], as for [`Stage::in_scatter`].
    pub fn time_with_stable_maps(
        &self,
        techniques: &[Technique],
        budget: &Budget,
    ) -> Result<(Vec<[Timing; 2]>, Option<Timing>), Failure> {
        let twice = techniques.iter().flat_map(|t| [(t, false), (t, true)]);
        let contenders = twice
            .map(|(technique, is_stable)| self.contender(technique, is_stable))
            .collect::<Result<Vec<_>, _>>()?;
        let (timings, limit) = self.time_contenders(contenders, budget)?;
        let (pairs, _) = timings.as_chunks::<2>();
        Ok((pairs.to_vec(), limit))
    }

    /// What a technique counts in a frame; nothing on the CPU.
    ///
    /// # Errors
    /// [`Failure`], as for [`Stage::in_scatter`].
    pub fn counts(&self, technique: &Technique) -> Result<Vec<(String, u64)>, Failure> {
        match self.device_for(technique)? {
            Some(device) => {
                let mut technique = device.technique(technique, false)?;
                technique.frame()?;
                technique.counts()
            }
            None => Ok(Vec::new()),
        }
    }

    /// Times of the contenders, and of the limit.
    fn time_contenders<'s>(
        &'s self,
        mut contenders: Vec<Contender<'s>>,
        budget: &Budget,
    ) -> Result<(Vec<Timing>, Option<Timing>), Failure> {
        if let Some(device) = self.device().filter(|device| device.has_limit()) {
            contenders.push(Contender::Limit(device, device.timestamps()));
        }
        let mut runs: Vec<_> = contenders.iter_mut().map(|c| || c.frame()).collect();
        let frames = interleave(&mut runs, budget)?;
        let timings = contenders.iter().zip(&frames);
        let mut timings: Vec<Timing> = timings
            .map(|(c, frames)| Timing::new(c.place(), c.bytes(), frames))
            .collect();
        let has_limit = matches!(contenders.last(), Some(Contender::Limit(..)));
        let limit = timings.pop_if(|_| has_limit);
        Ok((timings, limit))
    }

    fn contender<'s>(
        &'s self,
        technique: &'s Technique,
        has_stable_maps: bool,
    ) -> Result<Contender<'s>, Failure> {
        Ok(match self.device_for(technique)? {
            Some(device) => Contender::Gpu(Box::new(device.technique(technique, has_stable_maps)?)),
            None => {
                // What is read back but once is no part of a frame.
                self.buffers()?;
                Contender::Cpu(self, technique)
            }
        })
    }

    /// The device, where the technique runs on it.
    fn device_for(&self, technique: &Technique) -> Result<Option<&DeviceStage<'a>>, Failure> {
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

    /// As [`Stage::in_scatter`], on the CPU wherever else the technique could run.
    ///
    /// # Errors
    /// [`Failure`], as for [`Stage::in_scatter`].
    pub fn in_scatter_on_cpu(&self, technique: &Technique) -> Result<Picture, Failure> {
        let buffers = self.buffers()?;
        let mut lights = cpu::light_inputs(&self.setup, &buffers.lights);
        if !reads_shadow_maps(technique) {
            for light in &mut lights {
                *light = CpuLightInputs {
                    texture: light.texture,
                    ..Default::default()
                };
            }
        }
        let frame = self.setup.frame.clone();
        let techniques = technique.clone().into();
        let (setup, depth) = (&self.setup, &buffers.depth);
        let pixels = cpu::in_scatter(setup, frame, depth, &lights, &techniques, &|_, _| ())?;
        Ok(Picture {
            size: self.setup.size,
            pixels,
        })
    }

    fn device(&self) -> Option<&DeviceStage<'a>> {
        match &self.drawn {
            Drawn::Gpu(device, _) => Some(device),
            Drawn::Cpu(_) => None,
        }
    }

    fn buffers(&self) -> Result<&Buffers, Failure> {
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

/// The reference at a tolerance below the error of anything it is compared with.
pub fn converged(visibility: Visibility) -> Technique {
    Technique::Reference(reference::Params {
        tolerance: REFERENCE_TOLERANCE,
        visibility,
    })
}

/// What gets frames in turn.
enum Contender<'a> {
    Gpu(Box<DeviceTechnique<'a>>),
    Cpu(&'a Stage<'a>, &'a Technique),
    Limit(&'a DeviceStage<'a>, Timestamps),
}

impl Contender<'_> {
    fn frame(&mut self) -> Result<FrameTime, Failure> {
        match self {
            Self::Gpu(technique) => technique.frame(),
            Self::Limit(device, timestamps) => device.limit_frame(timestamps),
            Self::Cpu(stage, technique) => {
                let start = Instant::now();
                stage.in_scatter_on_cpu(technique)?;
                Ok(FrameTime {
                    wall: start.elapsed().as_secs_f64() * 1e3,
                    passes: Vec::new(),
                })
            }
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Gpu(_) | Self::Limit(..) => Place::Gpu,
            Self::Cpu(..) => Place::Cpu,
        }
    }

    /// Known once a frame was rendered.
    fn bytes(&self) -> Option<u64> {
        match self {
            Self::Gpu(technique) => Some(technique.bytes()),
            Self::Limit(..) | Self::Cpu(..) => None,
        }
    }
}
