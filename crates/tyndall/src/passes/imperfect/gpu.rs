//! The maps of a rectangular light's samples in a storage buffer, batch by batch.

use std::{f64::consts::TAU, sync::Arc};

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::{
    error::PrepareError,
    frame::Emitter,
    gpu::{
        cache, layout, limits,
        pass::Pass,
        program::ComputeProgram,
        scope::{Blocks, LightScope, Shared},
    },
    inputs::LightInputs,
    light::halton::halton,
    passes::fill::Fill,
    physics::reals,
};

/// Samples and projection.
pub(crate) const IMPERFECT: &str = include_str!("imperfect.wgsl");
/// Look-ups; needs batch, samples and maps.
pub(crate) const LOOKUP: &str = include_str!("lookup.wgsl");
const COLORS: &str = include_str!("colors.wgsl");
pub(super) const SPLAT: &str = include_str!("splat.wgsl");
pub(super) const PULL_PUSH: &str = include_str!("pull_push.wgsl");

/// Samples that a workgroup takes.
const THREADS: u32 = 64;
/// Points that a workgroup takes.
const POINTS: u32 = 512;
/// Texels a side that a workgroup of `pull_push.wgsl` takes.
const BLOCK: u32 = 32;
/// From a sample's map to the next one's turn about the normal, in turns.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// What a texel holds that nothing was drawn on.
pub(crate) const NOTHING: u32 = u32::MAX;

/// `ImperfectBatch` of `imperfect.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct BatchUniform {
    pub(crate) first: u32,
    pub(crate) count: u32,
    pub(crate) total: u32,
    pub(crate) side: u32,
    pub(crate) points: u32,
    pub(crate) cloud: u32,
    pub(crate) spread: f32,
    pub(crate) share: f32,
}

/// `ImperfectSample` of `imperfect.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SampleUniform {
    pub(crate) position: [f32; 3],
    pub(crate) first_point: u32,
    pub(crate) world: [f32; 3],
    pad_world: u32,
    pub(crate) tangent: [f32; 3],
    pad_tangent: u32,
}

/// A rectangle taken as samples, and what their maps are made of.
#[derive(Clone, Debug, Default)]
pub(crate) struct AreaLight {
    /// World-space positions [m].
    pub(crate) positions: Vec<DVec3>,
    /// Unit, the way it shines.
    pub(crate) normal: DVec3,
    /// The light's area over the number of samples [m^2].
    share: f64,
}

/// How the maps of a light are made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Maps {
    /// Texels a side; 0: nothing blocks the light.
    pub(crate) side: u32,
    /// Points a map.
    pub(crate) points: u32,
    /// Points there are.
    pub(crate) cloud: u32,
    /// Samples that are taken at once.
    pub(crate) batch: u32,
}

impl AreaLight {
    /// `None` where the light is no rectangle. Samples are Halton's points.
    pub(crate) fn new(emitter: &Emitter) -> Option<Self> {
        let Emitter::Rect {
            center,
            edge_x,
            edge_y,
            samples,
            ..
        } = *emitter
        else {
            return None;
        };
        let (edge_x, edge_y) = (reals(edge_x), reals(edge_y));
        let position = |i| {
            let [u, v] = halton(i);
            reals(center) + (u - 0.5) * edge_x + (v - 0.5) * edge_y
        };
        let normal = edge_x.cross(edge_y);
        Some(Self {
            positions: (0..samples).map(position).collect(),
            normal: normal.normalize_or_zero(),
            share: normal.length() / f64::from(samples),
        })
    }

    /// As shaders see the samples from this eye.
    pub(crate) fn samples(&self, eye: DVec3, maps: &Maps) -> Vec<SampleUniform> {
        let (x, y) = self.normal.any_orthonormal_pair();
        let sample = |(i, position): (usize, &DVec3)| {
            let turn = DVec3::new(
                (TAU * GOLDEN * i as f64).cos(),
                (TAU * GOLDEN * i as f64).sin(),
                0.0,
            );
            let first = i as u64 * u64::from(maps.points) % u64::from(maps.cloud.max(1));
            SampleUniform {
                position: (*position - eye).as_vec3().to_array(),
                first_point: first as u32,
                world: position.as_vec3().to_array(),
                pad_world: 0,
                tangent: (turn.x * x + turn.y * y).as_vec3().to_array(),
                pad_tangent: 0,
            }
        };
        self.positions.iter().enumerate().map(sample).collect()
    }

    /// The samples in batches.
    pub(crate) fn batches(&self, maps: &Maps) -> Vec<BatchUniform> {
        let total = self.positions.len() as u32;
        let batch = |first: u32| BatchUniform {
            first,
            count: maps.batch.min(total - first),
            total,
            side: maps.side,
            points: maps.points,
            cloud: maps.cloud,
            // Fewer points stand for larger discs.
            spread: (f64::from(maps.cloud) / f64::from(maps.points.max(1))).sqrt() as f32,
            share: self.share as f32,
        };
        (0..total).step_by(maps.batch as usize).map(batch).collect()
    }
}

impl Maps {
    /// Of `points` points each, or as many as texels where that is 0; as many at once as the device binds, up to
    /// `at_once`, where each takes `bytes` besides its map.
    pub(crate) fn new(
        inputs: &LightInputs<'_>,
        points: u32,
        at_once: u32,
        bytes: u64,
        limits: &wgpu::Limits,
    ) -> Self {
        let cloud = inputs.points.map_or(0, |cloud| cloud.points.size() / 16) as u32;
        let side = inputs.points.map_or(0, |cloud| cloud.map_side);
        let points = if points == 0 { side * side } else { points };
        let one = Self {
            side,
            points: points.min(cloud),
            cloud,
            batch: 1,
        };
        let most = limits.max_storage_buffer_binding_size / one.bytes().max(bytes);
        Self {
            batch: u64::from(at_once).min(most).max(1) as u32,
            ..one
        }
    }

    /// Refuses what the device cannot bind: a sample's map, the points, and these bytes of `what`.
    pub(crate) fn check(
        &self,
        technique: &'static str,
        index: usize,
        limits: &wgpu::Limits,
        others: &[(&str, u64)],
    ) -> Result<(), PrepareError> {
        let own = [
            ("map of a sample", self.bytes() / u64::from(self.batch)),
            ("points", 16 * u64::from(self.cloud)),
        ];
        let of = format!("technique `{technique}` (lights[{index}])");
        limits::check_storage(limits, &of, &[&own, others].concat())
    }

    /// Bytes of the maps of a batch.
    pub(crate) fn bytes(&self) -> u64 {
        (4 * u64::from(self.side).pow(2) * u64::from(self.batch)).max(16)
    }
}

/// What all imperfect shadow maps need.
pub(crate) struct Programs {
    fill: Arc<Fill>,
    colors: ComputeProgram,
    splat: ComputeProgram,
    pull_push: ComputeProgram,
}

/// A light's samples, and the maps of a batch of them.
pub(crate) struct Buffers {
    pub(crate) batches: Blocks<BatchUniform>,
    pub(crate) samples: wgpu::Buffer,
    /// Intensity of each sample along the normal [W/sr].
    pub(crate) colors: wgpu::Buffer,
    pub(crate) maps: wgpu::Buffer,
}

impl cache::Programs for Programs {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let batch = layout::uniform::<BatchUniform>(0);
        let read = |binding| layout::storage(binding, true);
        let write = |binding| layout::storage(binding, false);
        let program = |label, wgsl, entry_point, own: &[_]| {
            ComputeProgram::new(device, shared, label, &[IMPERFECT, wgsl], entry_point, own)
        };
        let own = [batch, read(1), write(2)];
        let colors = program("sample light", COLORS, "imperfect_color", &own);
        let own = [batch, read(1), read(2), write(3)];
        let splat = program("splat points", SPLAT, "imperfect_splat", &own).for_all_lights();
        let own = [batch, write(1)];
        let pull_push = program("pull-push", PULL_PUSH, "pull_push", &own).for_all_lights();
        Self {
            fill: shared.programs(device),
            colors,
            splat,
            pull_push,
        }
    }
}

impl Programs {
    /// The samples of a light: their buffers, and the pass that colours them.
    pub(crate) fn sample(
        &self,
        scope: &mut LightScope<'_>,
        area: &AreaLight,
        maps: &Maps,
    ) -> (Buffers, Pass) {
        let count = area.positions.len() as u32;
        let buffers = Buffers {
            batches: scope.blocks("batches", area.batches(maps)),
            samples: scope.upload("samples", &area.samples(scope.rays.eye, maps)),
            colors: scope.storage("colors of the samples", 16 * u64::from(count)),
            maps: scope.storage("imperfect maps", maps.bytes()),
        };
        let resources = [
            buffers.batches.binding(0),
            buffers.samples.as_entire_binding(),
            buffers.colors.as_entire_binding(),
        ];
        let groups = [count.div_ceil(THREADS), 1, 1];
        let pass = scope.compute(&self.colors, "sample light", &resources, groups);
        (buffers, pass)
    }

    /// The maps of a batch: its points, and their holes filled.
    pub(crate) fn draw(
        &self,
        scope: &mut LightScope<'_>,
        buffers: &Buffers,
        index: u32,
        cloud: &wgpu::Buffer,
    ) -> [Pass; 2] {
        let batch = buffers.batches.values[index as usize];
        let empty = self
            .fill
            .dispatch(scope, "no surface", &buffers.maps, NOTHING);
        let resources = [
            buffers.batches.binding(index),
            buffers.samples.as_entire_binding(),
            cloud.as_entire_binding(),
            buffers.maps.as_entire_binding(),
        ];
        let groups = [batch.points.div_ceil(POINTS), batch.count, 1];
        let splat = scope.dispatch(&self.splat, &resources, groups);
        let resources = [
            buffers.batches.binding(index),
            buffers.maps.as_entire_binding(),
        ];
        let blocks = batch.side.div_ceil(BLOCK);
        let groups = [blocks, blocks, batch.count];
        [
            Pass::compute(scope.pass_name("splat points"), vec![empty, splat]),
            scope.compute(&self.pull_push, "pull-push", &resources, groups),
        ]
    }
}
