//! Which technique computes which light.

#[cfg(feature = "gpu")]
use super::method::GpuMethod;
use super::{
    info::{Backends, TechniqueInfo},
    method::CpuMethod,
    table::{TABLE, Technique},
};
use crate::{
    error::PrepareError,
    frame::{Frame, Light, LightKind},
};

/// Which technique computes each light of a frame: the light's own, else the one for all, else the first of the
/// [`TABLE`] that can do it.
///
/// ```
/// use tyndall::techniques::{Technique, TechniqueChoice};
///
/// let one_for_all = TechniqueChoice::from(Technique::default());
/// let each_by_what_suits_it = TechniqueChoice::default();
/// let mut first_marched = TechniqueChoice::default();
/// first_marched.lights = vec![Technique::from_name("ray-march")];
/// # assert_ne!(one_for_all, each_by_what_suits_it);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TechniqueChoice {
    /// Computes every light that has none of its own.
    pub all: Option<Technique>,
    /// A light's own, by its index in the frame; a shorter list leaves the rest without.
    pub lights: Vec<Option<Technique>>,
}

impl From<Technique> for TechniqueChoice {
    fn from(technique: Technique) -> Self {
        Self {
            all: Some(technique),
            lights: Vec::new(),
        }
    }
}

impl TechniqueChoice {
    /// The technique of the light of this index, on this backend ([`Backends::Cpu`] or [`Backends::Gpu`]).
    pub fn of(&self, index: usize, light: &Light, backend: Backends) -> Technique {
        let own = self.lights.get(index).cloned().flatten();
        own.or_else(|| self.all.clone())
            .unwrap_or_else(|| first_that_can(light, backend))
    }

    /// The techniques of a frame's lights.
    ///
    /// # Errors
    /// Where more lights are named than there are, or a technique cannot do its light, the camera or the backend.
    pub(crate) fn resolve(
        &self,
        frame: &Frame,
        backend: Backends,
    ) -> Result<Vec<Technique>, PrepareError> {
        if self.lights.len() > frame.lights.len() {
            return Err(PrepareError::WrongSize {
                field: "techniques.lights".into(),
                expected: frame.lights.len(),
                found: self.lights.len(),
            });
        }
        if let Some(technique) = &self.all {
            check_backend(technique, backend)?;
            technique.method().check(&frame.camera)?;
        }
        let resolve = |(index, light)| {
            let technique = self.of(index, light, backend);
            check(&technique, index, light, backend)?;
            technique.method().check(&frame.camera)?;
            Ok(technique)
        };
        frame.lights.iter().enumerate().map(resolve).collect()
    }
}

fn first_that_can(light: &Light, backend: Backends) -> Technique {
    let can = |info: &&TechniqueInfo| {
        info.can(light.kind(), backend) && (info.reads.textures || light.texture.is_none())
    };
    let info = TABLE.iter().find(can);
    info.map_or_else(Technique::default, TechniqueInfo::default_technique)
}

impl Technique {
    /// Its work on the CPU.
    pub(crate) fn cpu(&self) -> Result<&dyn CpuMethod, PrepareError> {
        let method = self.method().cpu();
        method.ok_or_else(|| unsupported(self, "its work on the CPU".into()))
    }

    /// Its work on the GPU.
    #[cfg(feature = "gpu")]
    pub(crate) fn gpu(&self) -> Result<&dyn GpuMethod, PrepareError> {
        let method = self.method().gpu();
        method.ok_or_else(|| unsupported(self, "its work on the GPU".into()))
    }
}

fn unsupported(technique: &Technique, what: String) -> PrepareError {
    PrepareError::Unsupported {
        technique: technique.info().name,
        what,
    }
}

fn check_backend(technique: &Technique, backend: Backends) -> Result<(), PrepareError> {
    if technique.info().backends.include(backend) {
        return Ok(());
    }
    let place = match backend {
        Backends::Cpu => "the CPU",
        Backends::Gpu | Backends::Both => "the GPU",
    };
    Err(unsupported(technique, format!("its work on {place}")))
}

fn check(
    technique: &Technique,
    index: usize,
    light: &Light,
    backend: Backends,
) -> Result<(), PrepareError> {
    check_backend(technique, backend)?;
    let kind = light.kind();
    if !technique.info().lights.contains(&kind) {
        let what = format!("{} lights (lights[{index}])", kind.name());
        return Err(unsupported(technique, what));
    }
    if !technique.info().can(kind, backend) {
        let what = format!("{} lights on the CPU (lights[{index}])", kind.name());
        return Err(unsupported(technique, what));
    }
    if kind == LightKind::Rect && light.shadow.is_some() {
        let what = format!("a shadow map for a rectangular light (lights[{index}])");
        return Err(unsupported(technique, what));
    }
    Ok(())
}
