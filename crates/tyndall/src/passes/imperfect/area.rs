//! A rectangular light taken as samples, and how their maps are made.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::{
    error::PrepareError, frame::Emitter, gpu::limits, inputs::LightInputs,
    light::hammersley::hammersley, physics::reals, shader::block,
};

/// From a sample's map to the next one's turn about the normal, in turns.
const GOLDEN: f64 = 0.618_033_988_749_895;

block! {
    /// The shaders' `ImperfectBatch`.
    pub(crate) struct BatchUniform = "ImperfectBatch" in "tyndall::passes::imperfect::imperfect", checked by imperfect_batch_is_laid_out_as_in_wgsl {
        pub(crate) first: u32,
        pub(crate) count: u32,
        pub(crate) total: u32,
        pub(crate) side: u32,
        pub(crate) points: u32,
        pub(crate) cloud: u32,
        pub(crate) spread: f32,
        pub(crate) share: f32,
    }
}

block! {
    /// The shaders' `ImperfectSample`.
    pub(crate) struct SampleUniform = "ImperfectSample" in "tyndall::passes::imperfect::imperfect", checked by imperfect_sample_is_laid_out_as_in_wgsl {
        pub(crate) position: [f32; 3],
        pub(crate) first_point: u32,
        pub(crate) world: [f32; 3],
        pad_world: u32,
        pub(crate) tangent: [f32; 3],
        pad_tangent: u32,
    }
}

/// A rectangle taken as samples, and what their maps are made of.
#[derive(Clone, Debug, Default)]
pub(crate) struct AreaLight {
    /// World-space positions \[m].
    pub(crate) positions: Vec<DVec3>,
    /// Unit direction in which it shines.
    pub(crate) normal: DVec3,
    /// The light's area over the number of samples [m^2].
    share: f64,
}

/// Sizes of the maps of a light.
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
    /// `None` where the light is no rectangle. Samples are Hammersley's points, as the reference's.
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
            let [u, v] = hammersley(i, samples);
            reals(center) + (u - 0.5) * edge_x + (v - 0.5) * edge_y
        };
        let normal = edge_x.cross(edge_y);
        Some(Self {
            positions: (0..samples).map(position).collect(),
            normal: normal.normalize_or_zero(),
            share: normal.length() / f64::from(samples),
        })
    }

    /// The samples for shaders, relative to this eye.
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
    /// Maps of `points` points each, or as many as texels if that is 0; as many at once as the device binds, up to
    /// `at_once`, if each takes `bytes` besides its map.
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
