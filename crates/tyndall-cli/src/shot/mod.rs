//! Shots: scene, camera, lights, medium and technique of one picture, read from a TOML file, a scene file and `--set`.

mod animation;
mod camera;
mod error;
mod file;
mod light;
mod medium;
mod overrides;
mod reader;
mod source;
mod technique;
mod tree;

#[cfg(test)]
mod tests;

pub use animation::{
    Animation, FrameRange, Move, MoveTarget, Temporal, TemporalMask, TemporalShow,
};
pub(crate) use camera::SceneCameras;
pub use camera::{CameraBase, CameraSpec};
pub use error::{Location, Origin, Problem, ShotError};
pub use file::Shot;
pub use light::{LightSpec, TextureSpec};
pub use overrides::{Override, OverrideError};
pub use source::SceneSource;
pub(crate) use technique::names as technique_names;
