//! Parses and validates WGSL without a device, and compares its structs' layouts with Rust's.

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// WGSL that parses and validates.
#[derive(Debug)]
pub struct Shader {
    module: naga::Module,
}

/// What is wrong with a shader.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// It does not parse; the text shows where.
    #[error("{0}")]
    Parse(String),
    /// It parses but is not valid; the text shows where.
    #[error("{0}")]
    Invalid(String),
    /// It has no struct of this name.
    #[error("expected a struct `{name}`, found {found}")]
    NoStruct {
        /// The name.
        name: String,
        /// The structs there are, joined by commas.
        found: String,
    },
}

/// Where the members of a struct lie \[bytes].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// The whole struct with its trailing padding.
    pub size: usize,
    /// The members in order, without padding members.
    pub members: Vec<MemberLayout>,
}

/// Where one member of a struct lies \[bytes].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemberLayout {
    /// Its name.
    pub name: String,
    /// From the struct's start.
    pub offset: usize,
    /// Without padding behind it.
    pub size: usize,
}

impl Shader {
    /// Joins `modules` in order, parses and validates them with the capabilities WebGPU guarantees.
    ///
    /// # Errors
    /// Where the joined text does not parse or is not valid.
    pub fn new(modules: &[&str]) -> Result<Self, ShaderError> {
        let source = modules.join("\n");
        let module = naga::front::wgsl::parse_str(&source)
            .map_err(|error| ShaderError::Parse(error.emit_to_string(&source)))?;
        Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .map_err(|error| ShaderError::Invalid(error.emit_to_string(&source)))?;
        Ok(Self { module })
    }

    /// Layout of the struct `name`, to be compared with [`rust_layout!`](crate::rust_layout).
    ///
    /// # Errors
    /// Where there is no such struct.
    pub fn struct_layout(&self, name: &str) -> Result<StructLayout, ShaderError> {
        self.structs()
            .find(|(found, ..)| *found == name)
            .map(|(_, members, span)| StructLayout {
                size: span as usize,
                members: members.iter().map(|m| self.member_layout(m)).collect(),
            })
            .ok_or_else(|| ShaderError::NoStruct {
                name: name.to_owned(),
                found: self.structs().map(|s| s.0).collect::<Vec<_>>().join(", "),
            })
    }

    fn structs(&self) -> impl Iterator<Item = (&str, &[naga::StructMember], u32)> {
        self.module
            .types
            .iter()
            .filter_map(|(_, ty)| match &ty.inner {
                naga::TypeInner::Struct { members, span } => {
                    Some((ty.name.as_deref()?, members.as_slice(), *span))
                }
                _ => None,
            })
    }

    fn member_layout(&self, member: &naga::StructMember) -> MemberLayout {
        let inner = &self.module.types[member.ty].inner;
        MemberLayout {
            name: member.name.clone().unwrap_or_default(),
            offset: member.offset as usize,
            size: inner.size(self.module.to_ctx()) as usize,
        }
    }
}

/// Layout of a Rust struct as a [`StructLayout`](crate::shader::StructLayout): name the members a shader knows, in its order, and leave out the padding.
///
/// ```
/// #[repr(C)]
/// struct Ball { center: [f32; 3], radius: f32, color: [f32; 3], _pad: f32 }
/// let shader = tyndall_testkit::shader::Shader::new(&["struct Ball { center: vec3f, radius: f32, color: vec3f }"])?;
/// assert_eq!(shader.struct_layout("Ball")?, tyndall_testkit::rust_layout!(Ball { center, radius, color }));
/// # Ok::<(), tyndall_testkit::shader::ShaderError>(())
/// ```
#[macro_export]
macro_rules! rust_layout {
    ($type:ty { $($member:ident),+ $(,)? }) => {
        $crate::shader::StructLayout {
            size: ::std::mem::size_of::<$type>(),
            members: vec![$($crate::shader::MemberLayout {
                name: stringify!($member).to_owned(),
                offset: ::std::mem::offset_of!($type, $member),
                size: $crate::shader::size_of_member(|value: &$type| &value.$member),
            }),+],
        }
    };
}

/// Size of what a getter points at \[bytes]; for [`rust_layout!`](crate::rust_layout).
pub fn size_of_member<T, M>(_: impl Fn(&T) -> &M) -> usize {
    size_of::<M>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: &str = "struct Ball { center: vec3f, radius: f32, color: vec3f }";

    #[repr(C)]
    struct Ball {
        center: [f32; 3],
        radius: f32,
        color: [f32; 3],
        _pad: f32,
    }

    #[repr(C)]
    struct Swapped {
        radius: f32,
        center: [f32; 3],
        color: [f32; 3],
        _pad: f32,
    }

    #[repr(C)]
    struct Unpadded {
        center: [f32; 3],
        radius: f32,
        color: [f32; 3],
    }

    #[repr(C)]
    struct Wider {
        center: [f32; 3],
        radius: f32,
        color: [f32; 4],
    }

    #[test]
    fn equal_layouts_are_equal_and_others_are_not() {
        let ball = Shader::new(&[BALL]).unwrap().struct_layout("Ball").unwrap();
        assert_eq!(
            ball,
            rust_layout!(Ball {
                center,
                radius,
                color
            })
        );
        assert_ne!(ball, rust_layout!(Ball { center, radius }));
        assert_ne!(
            ball,
            rust_layout!(Swapped {
                center,
                radius,
                color
            })
        );
        assert_ne!(
            ball,
            rust_layout!(Unpadded {
                center,
                radius,
                color
            })
        );
        assert_ne!(
            ball,
            rust_layout!(Wider {
                center,
                radius,
                color
            })
        );
    }

    #[test]
    fn modules_are_joined() {
        let twice = "fn twice(x: f32) -> f32 { return 2.0 * x; }";
        let user = "fn four(x: f32) -> f32 { return twice(twice(x)); }";
        assert!(Shader::new(&[twice, user]).is_ok());
        assert!(
            matches!(Shader::new(&[user]), Err(ShaderError::Parse(text)) if text.contains("twice"))
        );
    }

    #[test]
    fn what_parses_may_still_be_invalid() {
        let no_return = "fn nothing() -> f32 { }";
        assert!(matches!(
            Shader::new(&[no_return]),
            Err(ShaderError::Invalid(_))
        ));
    }

    #[test]
    fn a_struct_that_is_not_there_is_named() {
        let error = Shader::new(&[BALL])
            .unwrap()
            .struct_layout("Bell")
            .unwrap_err();
        assert_eq!(error.to_string(), "expected a struct `Bell`, found Ball");
    }
}
