//! GPU machinery that knows nothing of techniques.

mod timer;

pub use timer::PassTimer;
