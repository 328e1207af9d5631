//! GPU machinery that knows nothing of techniques: shader modules, uniforms, layouts, timing.

pub(crate) mod layout;
pub(crate) mod pipeline;
pub(crate) mod shader;
mod timer;
pub(crate) mod uniforms;

pub use timer::PassTimer;
