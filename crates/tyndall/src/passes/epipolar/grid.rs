//! The epipolar grid for shaders: the uniform of `epipolar.wesl`.

use glam::DVec3;

use crate::{
    epipolar::grid::{EpipolarGrid, GridScene},
    gpu::scope::LightScope,
    light::LightModel,
    shader::block,
    shadow,
};

block! {
    /// The shaders' `Epipolar`.
    pub(crate) struct EpipolarUniform = "Epipolar" in "tyndall::passes::epipolar::epipolar", checked by epipolar_is_laid_out_as_in_wgsl {
        pub(crate) axis: [f32; 3],
        pub(crate) distance: f32,
        pub(crate) across_x: [f32; 3],
        pub(crate) alpha_start: f32,
        pub(crate) across_y: [f32; 3],
        pub(crate) alpha_step: f32,
        pub(crate) gamma_start: f32,
        pub(crate) gamma_step: f32,
        pub(crate) b_start: f32,
        pub(crate) b_scale: f32,
        pub(crate) slices: u32,
        pub(crate) samples: u32,
        pub(crate) least_off_axis: f32,
        pub(crate) cotangent: f32,
        pub(crate) tint_start: f32,
        pub(crate) tint_step: f32,
        pub(crate) tint_columns: u32,
        pub(crate) turns: u32,
        pub(crate) position: [f32; 3],
        pub(crate) pad: u32,
    }
}

impl EpipolarUniform {
    /// A grid with so many columns of tints a slice.
    pub(crate) fn new(grid: &EpipolarGrid, tint_columns: usize) -> Self {
        let [alpha_start, alpha_step] = grid.slices.start_and_step().map(|x| x as f32);
        let floats = |v: DVec3| v.as_vec3().to_array();
        Self {
            axis: floats(grid.axis),
            distance: grid.local.unwrap_or(0.0) as f32,
            across_x: floats(grid.across[0]),
            alpha_start,
            across_y: floats(grid.across[1]),
            alpha_step,
            gamma_start: grid.gamma_start as f32,
            gamma_step: grid.gamma_step as f32,
            b_start: grid.b_start as f32,
            b_scale: grid.b_scale as f32,
            slices: grid.slices.count as u32,
            samples: grid.samples as u32,
            least_off_axis: grid.least_off_axis as f32,
            cotangent: grid.cotangent as f32,
            tint_start: grid.tint_range[0] as f32,
            tint_step: ((grid.tint_range[1] - grid.tint_range[0]) / tint_columns as f64) as f32,
            tint_columns: tint_columns as u32,
            turns: u32::from(grid.slices.is_full_turn()),
            position: floats(grid.light - grid.eye),
            pad: 0,
        }
    }

    /// No slices: every ray is to be walked.
    pub(crate) const NONE: Self = Self {
        axis: [0.0, 0.0, 1.0],
        distance: 1.0,
        across_x: [1.0, 0.0, 0.0],
        alpha_start: 0.0,
        across_y: [0.0, 1.0, 0.0],
        alpha_step: 1.0,
        gamma_start: 0.0,
        gamma_step: 1.0,
        b_start: 0.0,
        b_scale: 1.0,
        slices: 1,
        samples: 1,
        least_off_axis: f32::MAX,
        cotangent: 0.0,
        tint_start: 0.0,
        tint_step: 1.0,
        tint_columns: 64,
        turns: 0,
        position: [0.0; 3],
        pad: 0,
    };
}

/// Makes something of a prepared light, given as grids see it, with `side` texels of its map a side; `None` of a light
/// without a model.
pub(crate) fn with_scene<T>(
    scope: &LightScope<'_>,
    side: usize,
    make: impl FnOnce(&GridScene<'_>) -> Option<T>,
) -> Option<T> {
    let light = scope.light;
    let faces = light
        .shadow
        .and_then(|projection| shadow::faces(&light.emitter, &projection))
        .unwrap_or_default();
    let models = LightModel::samples(light, &scope.frame.camera, None);
    let model = models.first()?;
    make(&GridScene {
        camera: scope.rays,
        size: scope.size,
        light: model.source(),
        cone: model.cone(),
        faces: &faces,
        side,
    })
}
