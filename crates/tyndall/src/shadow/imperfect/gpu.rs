//! The maps of a rectangular light's samples in a storage buffer, batch by batch.

use std::f64::consts::TAU;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::{
    frame::Emitter,
    gpu::{
        layout,
        pass::Dispatch,
        program::ComputeProgram,
        scope::{Blocks, LightScope, Shared},
    },
    light::halton::halton,
    physics::medium::reals,
};

/// Samples and projection.
pub(crate) const IMPERFECT: &str = include_str!("imperfect.wgsl");
/// Look-ups; needs batch, samples and maps.
pub(crate) const LOOKUP: &str = include_str!("lookup.wgsl");
pub(super) const SPLAT: &str = include_str!("splat.wgsl");
pub(super) const PULL_PUSH: &str = include_str!("pull_push.wgsl");

/// Points that a workgroup of `splat.wgsl` takes.
const POINTS_A_WORKGROUP: u32 = 64;
/// Texels a side that a workgroup of `pull_push.wgsl` takes.
const BLOCK: u32 = 16;
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
#[derive(Clone, Debug)]
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
    /// Bytes of the maps of a batch.
    pub(crate) fn bytes(&self) -> u64 {
        (4 * u64::from(self.side).pow(2) * u64::from(self.batch)).max(16)
    }
}

/// What all imperfect shadow maps need.
pub(crate) struct Programs {
    splat: ComputeProgram,
    pull_push: ComputeProgram,
}

impl Programs {
    pub(crate) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let own = [
            layout::uniform::<BatchUniform>(0),
            layout::storage(1, true),
            layout::storage(2, true),
            layout::storage(3, false),
        ];
        let modules = [IMPERFECT, SPLAT];
        let splat = ComputeProgram::new(
            device,
            shared,
            "splat points",
            &modules,
            "imperfect_splat",
            &own,
        );
        let own = [
            layout::uniform::<BatchUniform>(0),
            layout::storage(1, false),
        ];
        let modules = [IMPERFECT, PULL_PUSH];
        Self {
            splat: splat.for_all_lights(),
            pull_push: ComputeProgram::new(
                device,
                shared,
                "pull-push",
                &modules,
                "pull_push",
                &own,
            )
            .for_all_lights(),
        }
    }

    /// The points of a batch, onto maps that hold nothing.
    pub(crate) fn splat(
        &self,
        scope: &LightScope<'_>,
        batch: (&Blocks<BatchUniform>, u32),
        samples: &wgpu::Buffer,
        cloud: &wgpu::Buffer,
        maps: &wgpu::Buffer,
    ) -> Dispatch {
        let (blocks, index) = batch;
        let uniform = blocks.values[index as usize];
        let resources = [
            blocks.binding(index),
            samples.as_entire_binding(),
            cloud.as_entire_binding(),
            maps.as_entire_binding(),
        ];
        let groups = [
            uniform.points.div_ceil(POINTS_A_WORKGROUP),
            uniform.count,
            1,
        ];
        scope.dispatch(&self.splat, &resources, groups)
    }

    /// Fills the holes of a batch's maps.
    pub(crate) fn pull_push(
        &self,
        scope: &LightScope<'_>,
        batch: (&Blocks<BatchUniform>, u32),
        maps: &wgpu::Buffer,
    ) -> Dispatch {
        let (blocks, index) = batch;
        let uniform = blocks.values[index as usize];
        let resources = [blocks.binding(index), maps.as_entire_binding()];
        let blocks = uniform.side.div_ceil(BLOCK);
        scope.dispatch(&self.pull_push, &resources, [blocks, blocks, uniform.count])
    }
}
