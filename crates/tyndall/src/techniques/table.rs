//! The one table of techniques: a line each, the default first.

use super::{
    epipolar_sampling, hybrid, imperfect_voxelized, incremental,
    info::TechniqueInfo,
    light_volume,
    method::Method,
    min_max,
    params::{ParamError, ParamInfo, Parameters, Value},
    ray_march, reference, voxelized,
};
use crate::frame::LightKind;

macro_rules! table {
    ($($(#[$doc:meta])* $variant:ident($folder:ident)),+ $(,)?) => {
        /// A technique and its parameters.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Technique {
            $($(#[$doc])* $variant($folder::Params)),+
        }

        /// Every technique, in the order they are listed to people; the first is the default.
        pub const TABLE: &[TechniqueInfo] = &[$($folder::Params::INFO),+];

        impl TechniqueInfo {
            /// The technique with its default parameters.
            pub fn default_technique(&self) -> Technique {
                $(if self.name == $folder::Params::INFO.name {
                    return Technique::$variant($folder::Params::default());
                })+
                Technique::default()
            }
        }

        impl Technique {
            /// Its entry in the [`TABLE`].
            pub fn info(&self) -> &'static TechniqueInfo {
                match self {
                    $(Self::$variant(_) => const { &$folder::Params::INFO }),+
                }
            }

            /// Its parameters: as they are now, and what each may be.
            pub fn params(&self) -> Vec<ParamInfo> {
                match self {
                    $(Self::$variant(params) => params.list()),+
                }
            }

            /// Sets one parameter.
            ///
            /// # Errors
            /// Where there is no such key or the value is not of its range.
            pub fn set(&mut self, key: &str, value: &Value) -> Result<(), ParamError> {
                match self {
                    $(Self::$variant(params) => params.set(key, value)),+
                }
            }

            /// What it does.
            pub(crate) fn method(&self) -> &dyn Method {
                match self {
                    $(Self::$variant(params) => params),+
                }
            }
        }
    };
}

table! {
    /// 1-D min-max mipmaps.
    MinMax(min_max),
    /// Imperfect voxelized shadow volumes.
    ImperfectVoxelized(imperfect_voxelized),
    /// Brute force.
    RayMarch(ray_march),
    /// Epipolar sampling.
    Epipolar(epipolar_sampling),
    /// Polygonal light volumes.
    LightVolume(light_volume),
    /// Shadow volumes and steps.
    Hybrid(hybrid),
    /// Voxelized shadow volumes.
    Voxelized(voxelized),
    /// Incremental integration.
    Incremental(incremental),
    /// Quadrature in f64 to a stated tolerance.
    Reference(reference),
}

impl Default for Technique {
    fn default() -> Self {
        Self::MinMax(min_max::Params::default())
    }
}

impl Technique {
    /// The technique of this name with default parameters.
    pub fn from_name(name: &str) -> Option<Self> {
        let info = TABLE.iter().find(|info| info.name == name)?;
        Some(info.default_technique())
    }

    /// The first of the table that can do lights of these kinds, with default parameters.
    pub fn default_for(kinds: &[LightKind]) -> Self {
        let can = |info: &&TechniqueInfo| kinds.iter().all(|kind| info.lights.contains(kind));
        let info = TABLE.iter().find(can);
        info.map_or_else(Self::default, TechniqueInfo::default_technique)
    }
}
