//! The choice of a backend, and the reason for it.

use clap::ValueEnum;
use tyndall::techniques::{Backends, TechniqueInfo};
use tyndall_scene::gpu::{NoAdapter, connect};

use super::{adapter::AdapterDescription, errors::DeviceErrors, quiet::quiet_unless_it_fails};
use crate::failure::Failure;

/// The choice of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BackendChoice {
    /// The GPU where there is an adapter and the technique runs there, else the CPU
    Auto,
    /// The GPU, or fail
    Gpu,
    /// The CPU, with nothing installed
    Cpu,
}

/// The CPU or a device.
pub enum Backend {
    /// All cores of the CPU.
    Cpu,
    /// A device.
    Gpu(Box<Gpu>),
}

/// A device and the adapter it came from.
pub struct Gpu {
    pub(crate) adapter: AdapterDescription,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) errors: DeviceErrors,
}

impl Backend {
    /// Chooses where to render with these techniques, and says on standard error what was taken and why; what drivers
    /// say there meanwhile, only where it fails.
    ///
    /// # Errors
    /// [`Failure::Usage`] where a technique doesn't run where it is asked to, or no backend runs all of them,
    /// [`Failure::Device`] where one needs a device and there is none.
    pub fn choose(
        choice: BackendChoice,
        techniques: &[&'static TechniqueInfo],
    ) -> Result<Self, Failure> {
        let (backend, reason) = quiet_unless_it_fails(|| Self::find(choice, techniques))?;
        match backend.adapter() {
            None => eprintln!("backend: CPU ({reason})"),
            Some(AdapterDescription { name, api, .. }) => {
                eprintln!("backend: GPU {name}, {api} ({reason})");
            }
        }
        Ok(backend)
    }

    /// The backend and the reason for it.
    fn find(
        choice: BackendChoice,
        techniques: &[&'static TechniqueInfo],
    ) -> Result<(Self, String), Failure> {
        let cpu = |reason: &str| Ok((Self::Cpu, reason.to_owned()));
        let gpu = |reason: &str| Ok::<_, NoAdapter>((Self::gpu()?, reason.to_owned()));
        let on = |backends| techniques.iter().find(|info| info.backends == backends);
        let name = |info: &&TechniqueInfo| info.name;
        match (
            choice,
            on(Backends::Cpu).map(name),
            on(Backends::Gpu).map(name),
        ) {
            (BackendChoice::Cpu, _, Some(name)) => Err(Failure::Usage(anyhow::anyhow!(
                "technique {name} runs on the GPU only, not with --backend cpu"
            ))),
            (BackendChoice::Gpu, Some(name), _) => Err(Failure::Usage(anyhow::anyhow!(
                "technique {name} runs on the CPU only, not with --backend gpu"
            ))),
            (BackendChoice::Auto, Some(cpu), Some(gpu)) => Err(Failure::Usage(anyhow::anyhow!(
                "technique {cpu} runs on the CPU only, and {gpu} on the GPU only"
            ))),
            (BackendChoice::Cpu, ..) => cpu("as asked"),
            (BackendChoice::Auto, Some(name), None) => {
                cpu(&format!("technique {name} runs there only"))
            }
            (BackendChoice::Gpu, ..) => gpu("as asked").map_err(Failure::device),
            (BackendChoice::Auto, None, Some(name)) => {
                gpu(&format!("technique {name} runs there only")).map_err(Failure::device)
            }
            (BackendChoice::Auto, None, None) => match gpu("there is an adapter") {
                Err(NoAdapter::Adapter(_)) => cpu("there is no graphics adapter"),
                found => found.map_err(Failure::device),
            },
        }
    }

    /// This backend among those of a technique: [`Backends::Cpu`] or [`Backends::Gpu`].
    pub fn side(&self) -> Backends {
        match self {
            Self::Cpu => Backends::Cpu,
            Self::Gpu(_) => Backends::Gpu,
        }
    }

    /// The adapter, on the GPU.
    pub fn adapter(&self) -> Option<&AdapterDescription> {
        match self {
            Self::Cpu => None,
            Self::Gpu(gpu) => Some(&gpu.adapter),
        }
    }

    fn gpu() -> Result<Self, NoAdapter> {
        let (adapter, device, queue) = connect(wgpu::PowerPreference::HighPerformance)?;
        let adapter = AdapterDescription::of(&adapter);
        Ok(Self::Gpu(Box::new(Gpu {
            errors: DeviceErrors::watch(&device),
            adapter,
            device,
            queue,
        })))
    }
}
