//! The techniques, and the one table of them. Each folder's first page is its manual.

pub mod epipolar_sampling;
pub mod hybrid;
pub mod imperfect_voxelized;
pub mod incremental;
pub mod light_volume;
pub mod min_max;
mod params;
pub mod ray_march;
pub mod reference;
pub mod voxelized;

use crate::{cpu::CpuScene, error::PrepareError, frame::Frame};
use params::Parameters;
#[cfg(feature = "gpu")]
use {
    crate::{
        effect::LightInputs,
        frame::Light,
        gpu::{pass::Pass, scope::LightScope},
        temporal::Reach,
    },
    std::sync::OnceLock,
};

pub use params::{ParamError, ParamInfo, Value};

/// A technique and its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Technique {
    /// Quadrature in f64 to a stated tolerance.
    Reference(reference::Params),
    /// Brute force.
    RayMarch(ray_march::Params),
    /// 1-D min-max mipmaps.
    MinMax(min_max::Params),
    /// Incremental integration.
    Incremental(incremental::Params),
    /// Polygonal light volumes.
    LightVolume(light_volume::Params),
    /// Epipolar sampling.
    Epipolar(epipolar_sampling::Params),
    /// Shadow volumes and steps.
    Hybrid(hybrid::Params),
    /// Voxelized shadow volumes.
    Voxelized(voxelized::Params),
    /// Imperfect voxelized shadow volumes.
    ImperfectVoxelized(imperfect_voxelized::Params),
}

/// Which backends a technique runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backends {
    /// CPU only.
    Cpu,
    /// GPU only.
    Gpu,
    /// Both.
    Both,
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// Parallel light.
    Directional,
    /// A point.
    Point,
    /// A point with a cone.
    Spot,
    /// A rectangle.
    Rect,
}

impl LightKind {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Directional => "directional",
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Rect => "rect",
        }
    }
}

/// A technique's entry in the table.
pub struct TechniqueInfo {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// One line: what it is.
    pub about: &'static str,
    /// Where it was published.
    pub citation: &'static str,
    /// The kinds of light it can do.
    pub lights: &'static [LightKind],
    /// Where it runs.
    pub backends: Backends,
    /// The technique with its default parameters.
    pub default: fn() -> Technique,
}

/// Every technique, in the order they are listed to people; the first is the default.
pub const TABLE: &[TechniqueInfo] = &[
    min_max::INFO,
    imperfect_voxelized::INFO,
    ray_march::INFO,
    epipolar_sampling::INFO,
    light_volume::INFO,
    hybrid::INFO,
    voxelized::INFO,
    incremental::INFO,
    reference::INFO,
];

impl Default for Technique {
    fn default() -> Self {
        (TABLE[0].default)()
    }
}

impl Technique {
    /// The technique of this name with default parameters.
    pub fn from_name(name: &str) -> Option<Self> {
        TABLE.iter().find(|t| t.name == name).map(|t| (t.default)())
    }

    /// The first of the table that can do lights of these kinds, with default parameters.
    pub fn default_for(kinds: &[LightKind]) -> Self {
        let can = |info: &&TechniqueInfo| kinds.iter().all(|kind| info.lights.contains(kind));
        TABLE
            .iter()
            .find(can)
            .map_or_else(Self::default, |info| (info.default)())
    }

    /// Its entry in the [`TABLE`].
    pub fn info(&self) -> &'static TechniqueInfo {
        match self {
            Self::Reference(_) => &reference::INFO,
            Self::RayMarch(_) => &ray_march::INFO,
            Self::MinMax(_) => &min_max::INFO,
            Self::Incremental(_) => &incremental::INFO,
            Self::LightVolume(_) => &light_volume::INFO,
            Self::Epipolar(_) => &epipolar_sampling::INFO,
            Self::Hybrid(_) => &hybrid::INFO,
            Self::Voxelized(_) => &voxelized::INFO,
            Self::ImperfectVoxelized(_) => &imperfect_voxelized::INFO,
        }
    }

    /// Its parameters: as they are now, and what each may be.
    pub fn params(&self) -> Vec<ParamInfo> {
        match self {
            Self::Reference(p) => p.list(),
            Self::RayMarch(p) => p.list(),
            Self::MinMax(p) => p.list(),
            Self::Incremental(p) => p.list(),
            Self::LightVolume(p) => p.list(),
            Self::Epipolar(p) => p.list(),
            Self::Hybrid(p) => p.list(),
            Self::Voxelized(p) => p.list(),
            Self::ImperfectVoxelized(p) => p.list(),
        }
    }

    /// Sets one parameter.
    ///
    /// # Errors
    /// Where there is no such key or the value is not of its range.
    pub fn set(&mut self, key: &str, value: &Value) -> Result<(), ParamError> {
        match self {
            Self::Reference(p) => p.set(key, value),
            Self::RayMarch(p) => p.set(key, value),
            Self::MinMax(p) => p.set(key, value),
            Self::Incremental(p) => p.set(key, value),
            Self::LightVolume(p) => p.set(key, value),
            Self::Epipolar(p) => p.set(key, value),
            Self::Hybrid(p) => p.set(key, value),
            Self::Voxelized(p) => p.set(key, value),
            Self::ImperfectVoxelized(p) => p.set(key, value),
        }
    }

    /// Checks what its parameters ask of a frame, on any backend.
    pub(crate) fn check(&self, frame: &Frame) -> Result<(), PrepareError> {
        match self {
            Self::MinMax(p) => min_max::svd::check(p, &frame.camera),
            _ => Ok(()),
        }
    }

    /// What computes a ray on the CPU.
    pub(crate) fn cpu<'a>(
        &'a self,
        scene: &'a CpuScene<'a>,
    ) -> Result<Box<dyn crate::cpu::RayIntegrator + 'a>, PrepareError> {
        match self {
            Self::Reference(p) => reference::cpu::integrator(p, scene),
            Self::RayMarch(p) => ray_march::cpu::integrator(p, scene),
            Self::MinMax(p) => Ok(min_max::cpu::integrator(p, scene)),
            Self::Incremental(p) => incremental::cpu::integrator(p, scene),
            // The table says they are the GPU's.
            Self::LightVolume(_)
            | Self::Epipolar(_)
            | Self::Hybrid(_)
            | Self::Voxelized(_)
            | Self::ImperfectVoxelized(_) => Err(PrepareError::Unsupported {
                technique: self.info().name,
                what: "its work on the CPU".into(),
            }),
        }
    }
}

/// The GPU programs of every technique, made when it is first prepared.
#[cfg(feature = "gpu")]
#[derive(Default)]
pub(crate) struct Programs {
    ray_march: OnceLock<ray_march::gpu::Programs>,
    min_max: OnceLock<min_max::gpu::Programs>,
    light_volume: OnceLock<light_volume::gpu::Programs>,
    epipolar: OnceLock<epipolar_sampling::gpu::Programs>,
    hybrid: OnceLock<hybrid::gpu::Programs>,
    voxelized: OnceLock<voxelized::gpu::Programs>,
    imperfect_voxelized: OnceLock<imperfect_voxelized::gpu::Programs>,
}

#[cfg(feature = "gpu")]
impl Technique {
    /// Checks what the device's limits say about a light, before anything is made.
    pub(crate) fn check_gpu(
        &self,
        limits: &wgpu::Limits,
        size: [u32; 2],
        index: usize,
        light: &Light,
        inputs: &LightInputs<'_>,
    ) -> Result<(), PrepareError> {
        match self {
            Self::LightVolume(p) => light_volume::gpu::check(p, limits, index, light, inputs),
            Self::MinMax(p) => min_max::gpu::check(p, limits, index, light, inputs),
            Self::Epipolar(p) => p.check_gpu(limits, size, index, light, inputs),
            Self::RayMarch(p) => ray_march::gpu::check(p, limits, size, index, light, inputs),
            Self::Voxelized(p) => voxelized::gpu::check(p, limits, index),
            Self::ImperfectVoxelized(p) => {
                imperfect_voxelized::gpu::check(p, limits, size, index, inputs)
            }
            Self::Hybrid(_) => hybrid::gpu::check(limits, index, inputs),
            _ => Ok(()),
        }
    }

    /// How far from its own ray a pixel's last pass looks.
    pub(crate) fn reach(&self) -> Reach {
        match self {
            Self::RayMarch(_) | Self::Hybrid(_) => Reach::Pixels(0.0),
            Self::MinMax(p) => min_max::gpu::reach(p),
            _ => Reach::Picture,
        }
    }

    /// The passes of one light on the GPU.
    pub(crate) fn passes(&self, programs: &Programs, scope: &mut LightScope<'_>) -> Vec<Pass> {
        let (device, shared) = (scope.device, scope.shared);
        match self {
            Self::RayMarch(p) => {
                let make = || ray_march::gpu::Programs::new(device, shared);
                ray_march::gpu::passes(p, programs.ray_march.get_or_init(make), scope)
            }
            Self::MinMax(p) => {
                let programs = &programs.min_max;
                let programs = programs.get_or_init(|| min_max::gpu::Programs::new(device, shared));
                min_max::gpu::passes(p, programs, scope)
            }
            Self::LightVolume(p) => {
                let programs = &programs.light_volume;
                let programs =
                    programs.get_or_init(|| light_volume::gpu::Programs::new(device, shared));
                light_volume::gpu::passes(p, programs, scope)
            }
            Self::Epipolar(p) => {
                let make = || epipolar_sampling::gpu::Programs::new(device, shared);
                epipolar_sampling::gpu::passes(p, programs.epipolar.get_or_init(make), scope)
            }
            Self::Hybrid(p) => {
                let make = || hybrid::gpu::Programs::new(device, shared);
                hybrid::gpu::passes(p, programs.hybrid.get_or_init(make), scope)
            }
            Self::Voxelized(p) => {
                let make = || voxelized::gpu::Programs::new(device, shared);
                voxelized::gpu::passes(p, programs.voxelized.get_or_init(make), scope)
            }
            Self::ImperfectVoxelized(p) => {
                let make = || imperfect_voxelized::gpu::Programs::new(device, shared);
                let programs = programs.imperfect_voxelized.get_or_init(make);
                imperfect_voxelized::gpu::passes(p, programs, scope)
            }
            // Refused by the table: they have no GPU side.
            Self::Reference(_) | Self::Incremental(_) => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_find_their_entry() {
        for entry in TABLE {
            let technique = Technique::from_name(entry.name).expect("in the table");
            assert_eq!(technique.info().name, entry.name);
            assert_eq!(TABLE.iter().filter(|t| t.name == entry.name).count(), 1);
        }
        assert_eq!(Technique::from_name("magic"), None);
    }

    #[test]
    fn every_default_can_be_set_again() {
        for entry in TABLE {
            let mut technique = (entry.default)();
            for param in technique.params() {
                technique
                    .set(param.key, &param.default)
                    .expect("a default is in range");
            }
            assert_eq!(technique, (entry.default)());
        }
    }

    #[test]
    fn wrong_parameters_are_refused_with_what_was_expected() {
        let mut technique = Technique::from_name("ray-march").expect("in the table");
        let before = technique.clone();
        let unknown = technique.set("stepz", &Value::Integer(3)).unwrap_err();
        assert_eq!(
            unknown.to_string(),
            "technique `ray-march` has no parameter `stepz`; it has steps, spacing, points"
        );
        for wrong in [
            Value::Integer(0),
            Value::Integer(-4),
            Value::Real(12.5),
            Value::Word("many".into()),
        ] {
            let error = technique.set("steps", &wrong).unwrap_err();
            assert!(
                error.to_string().contains(&format!("found {wrong}")),
                "{error}"
            );
        }
        assert_eq!(technique, before);
    }
}
