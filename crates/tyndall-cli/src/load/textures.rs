//! The textures that a shot's lights shine through, frame by frame.

use std::sync::Arc;

use tyndall::cpu::LightTexture;

use crate::{
    failure::Failure,
    light_texture::{TextureError, Textures},
    shot::{LightSpec, Location},
};

/// The textures of one light, and where the shot names their file.
pub(super) struct ShotTextures {
    textures: Textures,
    location: Location,
}

impl ShotTextures {
    /// Opens the texture's file, or finds those of its frames; `None` where the light has no texture.
    pub(super) fn open(light: &LightSpec) -> Result<Option<Self>, Failure> {
        let Some(texture) = &light.texture else {
            return Ok(None);
        };
        let location = texture.location.clone();
        match Textures::open(&texture.file) {
            Ok(textures) => Ok(Some(Self { textures, location })),
            Err(cause) => Err(at_texture(cause, location)),
        }
    }

    /// The texture of a frame.
    pub(super) fn at(&self, frame: u32) -> Result<Arc<LightTexture>, Failure> {
        let texture = self.textures.at(frame);
        texture.map_err(|cause| at_texture(cause, self.location.clone()))
    }
}

/// Names the place in the shot that names the texture.
fn at_texture(cause: TextureError, location: Location) -> Failure {
    Failure::Input(anyhow::Error::new(cause).context(location))
}
