//! One light's reuse in one frame.

use super::{
    history::{Generations, Placed, Viewpoint},
    options::Reuse,
};
use crate::{
    frame::{Emitter, Light},
    techniques::Reach,
};

/// A light's reuse in a frame, before the light's passes are made.
pub(crate) struct Frame<'a> {
    pub(crate) reuse: Reuse,
    pub(crate) generations: Generations,
    pub(crate) reach: Reach,
    /// The viewpoint of the frame recorded last.
    pub(crate) before: Option<Viewpoint>,
    /// Occluders that moved, for the geometry's mask.
    pub(crate) moved: &'a [Placed],
}

impl Frame<'_> {
    /// The other camera, and the tolerated error of its pixels, where any is kept at all: pixels have to be computed
    /// each on its own, and the light's shadows be asked at any point.
    pub(super) fn reprojection(&self, light: &Light) -> Option<(Viewpoint, f32)> {
        let is_fit = matches!(self.reach, Reach::Pixels(_))
            && !matches!(light.emitter, Emitter::Rect { .. });
        self.before.zip(self.reuse.reproject).filter(|_| is_fit)
    }
}
