//! The one table of phase functions: a line each. The place of a line is the function's number in the shaders.

use super::function::{MAX_PARAMS, PhaseFunction, PhaseInfo, PhaseParam};

macro_rules! table {
    ($($(#[$doc:meta])* $variant:ident $({ $($field:ident),+ })? in $file:ident),+ $(,)?) => {
        /// A phase function of cos(theta), the cosine between the way light travels and the way it is scattered [1/sr].
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Phase {
            $(
                $(#[$doc])*
                $variant $({
                    $(
                        #[doc = concat!(
                            "See [`", stringify!($variant), "`](super::", stringify!($file), "::", stringify!($variant),
                            "::", stringify!($field), ")."
                        )]
                        $field: f32
                    ),+
                })?
            ),+
        }

        /// Every phase function, in the order of their numbers in the shaders.
        pub const TABLE: &[PhaseInfo] = &[$(super::$file::$variant::INFO),+];

        /// The file of each, without its ending, in the same order.
        #[cfg(feature = "gpu")]
        pub(crate) const FILES: &[&str] = &[$(stringify!($file)),+];

        enum Number {
            $($variant),+
        }

        impl Phase {
            /// The phase function of this name with these parameters, in the order of its fields; those that it does not
            /// have are left out. `None` where there is none of this name.
            pub fn from_name(name: &str, values: [f32; MAX_PARAMS]) -> Option<Self> {
                let mut values = values.into_iter();
                $(if name == super::$file::$variant::INFO.name {
                    return Some(Self::$variant $({ $($field: values.next()?),+ })?);
                })+
                None
            }

            /// Its entry in the [`TABLE`].
            pub fn info(self) -> &'static PhaseInfo {
                match self {
                    $(Self::$variant { .. } => const { &super::$file::$variant::INFO }),+
                }
            }

            /// Its place in the [`TABLE`], from 0, which the shaders know it by.
            pub fn number(self) -> u32 {
                match self {
                    $(Self::$variant { .. } => Number::$variant as u32),+
                }
            }

            /// Its parameters in the order of its fields, filled up with zeros.
            pub fn values(self) -> [f32; MAX_PARAMS] {
                match self {
                    $(Self::$variant $({ $($field),+ })? => filled(&[$($($field),+)?])),+
                }
            }

            /// The phase function's value at `cos_theta` [1/sr].
            pub fn evaluate(self, cos_theta: f64) -> f64 {
                match self {
                    $(Self::$variant $({ $($field),+ })? => {
                        (super::$file::$variant $({ $($field),+ })?).evaluate(cos_theta)
                    }),+
                }
            }

            /// The mean of cos(theta) over the sphere.
            pub fn mean_cosine(self) -> f64 {
                match self {
                    $(Self::$variant $({ $($field),+ })? => {
                        (super::$file::$variant $({ $($field),+ })?).mean_cosine()
                    }),+
                }
            }
        }
    };
}

table! {
    /// Evenly: 1 / 4 pi.
    Isotropic in isotropic,
    /// Small particles: 3 / 16 pi (1 + cos^2).
    Rayleigh in rayleigh,
    /// Henyey & Greenstein 1941.
    HenyeyGreenstein { g } in henyey_greenstein,
    /// Cornette & Shanks 1992.
    CornetteShanks { g } in cornette_shanks,
    /// Draine 2003.
    Draine { g, alpha } in draine,
}

impl Phase {
    /// Its parameters and their values.
    pub fn params(self) -> impl Iterator<Item = (&'static PhaseParam, f32)> {
        self.info().params.iter().zip(self.values())
    }
}

/// The values with zeros behind them.
fn filled(values: &[f32]) -> [f32; MAX_PARAMS] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or_default())
}
