//! Loading: a shot with everything it names ([`LoadedShot`]), and its frames ([`ShotFrame`]).

mod extent;
mod frame;
mod motion;
mod offset;
mod origin;
mod scene;
mod shot;
mod textures;

#[cfg(test)]
mod tests;

pub(crate) use frame::built;
pub use frame::{LazyTracer, LightExtras, ShotFrame};
pub use scene::load_scene;
pub use shot::LoadedShot;
