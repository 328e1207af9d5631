//! GPU stages that several techniques use; each knows the machinery of `gpu` and no technique.

pub(crate) mod composite;
pub(crate) mod epipolar;
pub(crate) mod fill;
pub(crate) mod imperfect;
pub(crate) mod occluder;
pub(crate) mod pyramid;
pub(crate) mod voxels;
