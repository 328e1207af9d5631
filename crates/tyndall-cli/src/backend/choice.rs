//! The choice of a backend, and the reason for it.

use clap::ValueEnum;
use tyndall::techniques::{Backends, TechniqueInfo};
use tyndall_scene::gpu::{NoAdapter, connect};

use super::{adapter::AdapterDescription, errors::DeviceErrors};
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
    /// Chooses where to render with this technique, and says on standard error what was taken and why.
    ///
    /// # Errors
    /// [`Failure::Usage`] where the technique doesn't run where it is asked to,
    /// [`Failure::Device`] where it needs a device and there is none.
    pub fn choose(choice: BackendChoice, technique: &TechniqueInfo) -> Result<Self, Failure> {
        let name = technique.name;
        match (choice, technique.backends) {
            (BackendChoice::Cpu, Backends::Gpu) => Err(Failure::Usage(anyhow::anyhow!(
                "technique {name} runs on the GPU only, not with --backend cpu"
            ))),
            (BackendChoice::Gpu, Backends::Cpu) => Err(Failure::Usage(anyhow::anyhow!(
                "technique {name} runs on the CPU only, not with --backend gpu"
            ))),
            (BackendChoice::Cpu, _) => Ok(Self::cpu("as asked")),
            (BackendChoice::Auto, Backends::Cpu) => {
                Ok(Self::cpu(&format!("technique {name} runs there only")))
            }
            (BackendChoice::Gpu, _) => Self::gpu("as asked").map_err(Failure::device),
            (BackendChoice::Auto, Backends::Gpu) => {
                Self::gpu(&format!("technique {name} runs there only")).map_err(Failure::device)
            }
            (BackendChoice::Auto, Backends::Both) => match Self::gpu("there is an adapter") {
                Err(NoAdapter::Adapter(_)) => Ok(Self::cpu("there is no graphics adapter")),
                found => found.map_err(Failure::device),
            },
        }
    }

    /// The adapter, on the GPU.
    pub fn adapter(&self) -> Option<&AdapterDescription> {
        match self {
            Self::Cpu => None,
            Self::Gpu(gpu) => Some(&gpu.adapter),
        }
    }

    fn cpu(reason: &str) -> Self {
        eprintln!("backend: CPU ({reason})");
        Self::Cpu
    }

    fn gpu(reason: &str) -> Result<Self, NoAdapter> {
        let (adapter, device, queue) = connect(wgpu::PowerPreference::HighPerformance)?;
        let adapter = AdapterDescription::of(&adapter);
        let AdapterDescription { name, api, .. } = &adapter;
        eprintln!("backend: GPU {name}, {api} ({reason})");
        Ok(Self::Gpu(Box::new(Gpu {
            errors: DeviceErrors::watch(&device),
            adapter,
            device,
            queue,
        })))
    }
}
