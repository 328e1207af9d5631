//! Buffers and textures that the passes of one light hand on.

use wgpu::{BindingResource, TextureFormat};

use super::{
    params::{Criterion, Params, Show},
    sizes::Sizes,
};
use crate::{
    epipolar::epipole::Epipole,
    gpu::{pass::Workgroups, scope::LightScope},
    shader::{block, constant},
};

block! {
    /// The shaders' `SamplingParams`.
    pub(crate) struct ParamsUniform = "SamplingParams" in "tyndall::techniques::epipolar_sampling::common", checked by sampling_params_is_laid_out_as_in_wgsl {
        pub(crate) epipole: [f32; 3],
        pub(crate) slices: u32,
        pub(crate) axis: [f32; 3],
        pub(crate) samples: u32,
        pub(crate) initial_step: u32,
        pub(crate) threshold: f32,
        pub(crate) criterion: u32,
        pub(crate) columns: u32,
        pub(crate) levels: u32,
        pub(crate) downscale: u32,
        pub(crate) show: u32,
        pub(crate) least_weight: f32,
        pub(crate) coarse_size: [u32; 2],
        pub(crate) arc: [f32; 2],
    }
}

impl ParamsUniform {
    fn new(params: &Params, sizes: &Sizes, epipole: &Epipole) -> Self {
        Self {
            epipole: epipole.place.as_vec3().to_array(),
            slices: sizes.slices,
            axis: epipole.axis.as_vec3().to_array(),
            samples: sizes.samples,
            initial_step: params.initial_step,
            threshold: params.threshold as f32,
            criterion: constant(match params.criterion {
                Criterion::Depth => "SAMPLING_CRITERION_DEPTH",
                Criterion::InScatter => "SAMPLING_CRITERION_IN_SCATTER",
            }),
            columns: sizes.columns,
            levels: sizes.levels,
            downscale: params.downscale,
            show: constant(match params.show {
                Show::Light => "SAMPLING_SHOW_LIGHT",
                Show::Samples => "SAMPLING_SHOW_SAMPLES",
                Show::DepthBreaks => "SAMPLING_SHOW_DEPTH_BREAKS",
                Show::Corrected => "SAMPLING_SHOW_CORRECTED",
                Show::InScatter => "SAMPLING_SHOW_IN_SCATTER",
            }),
            least_weight: sizes.least_weight(),
            coarse_size: sizes.coarse,
            arc: epipole.arc.map(|x| x as f32),
        }
    }
}

/// A list that one pass fills and a later one works off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    /// Samples to march.
    Samples,
    /// Pixels to correct at the resolution that samples are unwarped to.
    Coarse,
    /// Pixels to correct at full resolution, after upscaling.
    Upscaled,
}

impl List {
    /// Its number in the shaders.
    pub(super) fn index(self) -> u32 {
        constant(match self {
            Self::Samples => "SAMPLING_LIST_SAMPLES",
            Self::Coarse => "SAMPLING_LIST_COARSE",
            Self::Upscaled => "SAMPLING_LIST_UPSCALED",
        })
    }
}

/// Buffers and textures that the passes of one light hand on.
pub(super) struct Resources {
    pub(super) params: wgpu::Buffer,
    pub(super) lines: wgpu::Buffer,
    pub(super) depth: wgpu::Buffer,
    pub(super) sources: wgpu::Buffer,
    /// Lengths of the lists, each the arguments of an indirect draw.
    pub(super) counts: wgpu::Buffer,
    /// Workgroups that take the lists, each the arguments of an indirect dispatch.
    pub(super) dispatches: wgpu::Buffer,
    pub(super) marched: wgpu::Buffer,
    pub(super) traces: wgpu::Buffer,
    pub(super) nodes: wgpu::Buffer,
    /// Mean visibility of marched samples.
    pub(super) values: wgpu::Buffer,
    /// Mean visibility of all samples, and their depth.
    pub(super) samples: wgpu::TextureView,
}

impl Resources {
    pub(super) fn new(params: &Params, sizes: &Sizes, scope: &mut LightScope<'_>) -> Self {
        let margin = constant("SCREEN_MARGIN_PIXELS").into();
        let epipole = Epipole::new(scope.rays, scope.size, &scope.light.emitter, margin);
        let uniform = ParamsUniform::new(params, sizes, &epipole);
        let bytes = sizes.bytes();
        let lists = constant("SAMPLING_LISTS").into();
        Self {
            params: scope.uniform("epipolar params", &uniform),
            lines: scope.storage("slice ends", bytes.lines),
            depth: scope.storage("sample depths", bytes.depth),
            sources: scope.storage("interpolation sources", bytes.sources),
            counts: scope.indirect_draws("list lengths", lists),
            dispatches: scope.indirect("list workgroups", lists),
            marched: scope.storage("marched samples", bytes.sources),
            traces: scope.storage("slice directions", bytes.traces),
            nodes: scope.storage("min/max trees", bytes.nodes),
            values: scope.storage("marched values", bytes.values),
            samples: scope.storage_texture(
                "sample values",
                [sizes.samples, sizes.slices],
                TextureFormat::Rgba32Float,
            ),
        }
    }

    /// The rectangular texture, and the list of its pixels that are corrected.
    pub(super) fn rectangular(&self, sizes: &Sizes, scope: &mut LightScope<'_>) -> Image {
        let format = TextureFormat::Rgba32Float;
        Image {
            list: scope.storage("corrected pixels", sizes.bytes().coarse_list),
            values: scope.storage_texture("rectangular values", sizes.coarse, format),
        }
    }

    /// The workgroups that take a list.
    pub(super) fn workgroups(&self, list: List) -> Workgroups {
        let bytes = size_of::<wgpu::util::DispatchIndirectArgs>() as u64;
        Workgroups::Indirect(self.dispatches.clone(), bytes * u64::from(list.index()))
    }

    /// The draw of as many points as a list has.
    pub(super) fn points(&self, list: List) -> (wgpu::Buffer, u64) {
        let words = constant("SAMPLING_COUNT") * list.index();
        (self.counts.clone(), 4 * u64::from(words))
    }
}

/// Mean visibilities in a rectangular texture, and the list of its pixels that are marched.
pub(super) struct Image {
    pub(super) list: wgpu::Buffer,
    pub(super) values: wgpu::TextureView,
}

pub(super) fn texture(texture: &wgpu::TextureView) -> BindingResource<'_> {
    BindingResource::TextureView(texture)
}

pub(super) fn buffer(buffer: &wgpu::Buffer) -> BindingResource<'_> {
    buffer.as_entire_binding()
}

#[cfg(test)]
mod tests {
    use tyndall_testkit::{device::device_or_skip, samples, wgsl};

    use crate::shader::{constant, tests::harness};

    /// The largest list is one of all pixels of a large texture.
    #[test]
    fn every_entry_of_a_list_has_an_invocation() {
        let Some(gpu) = device_or_skip("workgroups that march a list") else {
            return;
        };
        let imports = "
import tyndall::techniques::epipolar_sampling::common::{sampling_march_entry, sampling_march_groups};
";
        let module = harness(imports, &[], &[]);
        let [group, columns] = ["SAMPLING_MARCH_GROUP", "SAMPLING_MARCH_COLUMNS"].map(constant);
        let row = (group * columns) as f32;
        // Single precision holds these lengths.
        let mut inputs = samples::in_box(9, 500, [1.0..=16_777_216.0_f32]);
        inputs.extend([1.0, 64.0, 65.0, row, row + 1.0, 2.0 * row].map(|n| [n]));
        let expression = "vec2f(sampling_march_groups(u32(x[0]))), \
             f32(sampling_march_entry(vec3u(SAMPLING_MARCH_COLUMNS * SAMPLING_MARCH_GROUP - 1u, 0u, 0u))), \
             f32(sampling_march_entry(vec3u(0u, 1u, 0u)))";
        let found = wgsl::evaluate(gpu, &[&module], expression, &inputs).expect("the shader runs");
        for ([count], [x, y, last, next]) in inputs.iter().zip(found) {
            let count = count.floor();
            assert!(x <= 65_535.0 && y <= 65_535.0, "{count}: {x} x {y}");
            assert!(y == 1.0 || x == columns as f32, "{count}: {x} x {y}");
            let entries = group as f32 * x * y;
            assert!(
                entries >= count && entries - count < row,
                "{count}: {x} x {y}"
            );
            assert_eq!([last + 1.0, next], [row; 2]);
        }
    }
}
