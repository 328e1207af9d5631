//! The block that all passes of temporal reuse read, and the state that they keep.

use super::{blocks::Pyramid, frame::Frame, options::ReuseMask};
use crate::{
    gpu::scope::LightScope,
    shader::{block, constant},
    techniques::Reach,
};

/// The most dispatches that look for stale pixels: one over the image's tiles, and one a level of the shadow map's blocks.
pub(super) const MAX_DISPATCHES: usize = 16;

block! {
    /// The shaders' `ReuseParams`.
    pub(super) struct ParamsUniform = "ReuseParams" in "tyndall::temporal::reuse", checked by reuse_params_is_laid_out_as_in_wgsl {
        pixels: [u32; 2],
        map: [u32; 2],
        faces: u32,
        generation_exact: u32,
        frames: u32,
        mask: u32,
        margin: f32,
        reach: u32,
        has_witness: u32,
        levels: u32,
        generation_ignoring_camera: u32,
        pad: [u32; 3],
        dispatches: [[u32; 4]; MAX_DISPATCHES],
    }
}

block! {
    /// The shaders' `ReuseState`.
    pub(super) struct State = "ReuseState" in "tyndall::temporal::reuse", checked by reuse_state_is_laid_out_as_in_wgsl {
        generation_exact: u32,
        kept: u32,
        pub(super) stale: u32,
        mode: u32,
        rest: u32,
        generation_ignoring_camera: u32,
        turn: u32,
    }
}

impl ParamsUniform {
    /// `dispatches`: workgroups of those that look for stale pixels, should any be looked for.
    pub(super) fn new(
        frame: &Frame<'_>,
        pyramid: &Pyramid,
        dispatches: impl IntoIterator<Item = [u32; 3]>,
        has_witness: bool,
        scope: &LightScope<'_>,
    ) -> Self {
        let mut slots = [[0; 4]; MAX_DISPATCHES];
        for (slot, [x, y, z]) in slots.iter_mut().zip(dispatches) {
            *slot = [x, y, z, 0];
        }
        let (reach, margin) = match frame.reach {
            Reach::Pixels(margin) => ("REUSE_RAY", margin),
            Reach::Image => ("REUSE_IMAGE", 0.0),
        };
        let mask = match frame.reuse.mask {
            ReuseMask::Change => "REUSE_CHANGE",
            ReuseMask::Geometry => "REUSE_GEOMETRY",
        };
        Self {
            pixels: scope.size,
            map: pyramid.map,
            faces: pyramid.faces,
            generation_exact: frame.generations.exact,
            frames: frame.reuse.frames.unwrap_or(u32::MAX),
            mask: constant(mask),
            margin,
            reach: constant(reach),
            has_witness: u32::from(has_witness),
            levels: pyramid.levels.len() as u32,
            generation_ignoring_camera: match frame.reprojection(scope.light) {
                Some(_) => frame.generations.ignoring_camera,
                None => 0,
            },
            pad: [0; 3],
            dispatches: slots,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::blocks::levels, MAX_DISPATCHES};

    #[test]
    fn levels_end_at_one_block_and_fit_the_dispatches() {
        for (map, expected) in [
            ([0, 0], vec![]),
            ([1, 1], vec![[1, 1]]),
            ([64, 20], vec![[8, 3], [4, 2], [2, 1], [1, 1]]),
        ] {
            assert_eq!(levels(map), expected);
        }
        assert!(levels([16_384; 2]).len() < MAX_DISPATCHES);
    }
}
