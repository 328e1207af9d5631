//! The effect in somebody's renderer: created once a device, prepared and recorded once a frame.

mod device;
mod options;
mod prepare;
mod view;

pub use device::Effect;
pub use options::{CreateError, EffectOptions, OutputPrecision};
pub use view::EffectView;
