//! The mesh's parameters as the shaders read them.

use crate::shader::block;

block! {
    /// The shaders' `LightVolumeParams`.
    pub(super) struct ParamsUniform = "LightVolumeParams" in "tyndall::techniques::light_volume::mesh", checked by light_volume_params_is_laid_out_as_in_wgsl {
        pub(super) world_from_clip: [[f32; 4]; 4],
        pub(super) far_plane: [f32; 4],
        pub(super) cells: [u32; 2],
        pub(super) pitch: u32,
        pub(super) rows: u32,
        pub(super) tolerance: f32,
        pub(super) capacity: u32,
        pub(super) mirrored: u32,
        pub(super) pad: u32,
    }
}
