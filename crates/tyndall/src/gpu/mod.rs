//! GPU machinery that knows nothing of techniques: passes, pipelines, resources, uniforms, timing.

pub(crate) mod airlight;
mod bindings;
mod by_type;
pub(crate) mod cache;
mod camera;
mod floats;
pub(crate) mod layout;
mod light;
pub(crate) mod limits;
pub(crate) mod pass;
pub(crate) mod pool;
pub(crate) mod program;
pub(crate) mod scope;
pub(crate) mod shader;
pub(crate) mod shared;
mod timer;
pub(crate) mod uniforms;

pub use bindings::Bindings;
pub use timer::PassTimer;
