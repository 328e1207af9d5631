//! What a view remembers of the frames it prepared, light by light.

use std::collections::HashMap;

use super::ReuseMask;
use crate::{
    effect::LightInputs,
    gpu::uniforms::{FrameUniform, LightUniform, LightVariant},
    occluder::{Occluder, OccluderMesh},
    techniques::Technique,
};

/// The lights' histories.
#[derive(Default)]
pub(crate) struct History {
    lights: HashMap<usize, LightHistory>,
    generations: u32,
}

#[derive(Default)]
struct LightHistory {
    signature: Option<Signature>,
    generation: u32,
    /// Occluders of the frame recorded last.
    recorded: Vec<Placed>,
    /// Occluders of the frame prepared last.
    prepared: Vec<Placed>,
}

/// An occluder that outlives its frame.
#[derive(Clone)]
pub(crate) struct Placed {
    mesh: OccluderMesh,
    world_from_mesh: [[f32; 4]; 4],
}

impl Placed {
    fn of(occluder: &Occluder<'_>) -> Self {
        Self {
            mesh: occluder.mesh.clone(),
            world_from_mesh: occluder.world_from_mesh,
        }
    }

    pub(crate) fn as_occluder(&self) -> Occluder<'_> {
        Occluder {
            mesh: &self.mesh,
            world_from_mesh: self.world_from_mesh,
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        self.mesh.corners == other.mesh.corners && self.world_from_mesh == other.world_from_mesh
    }
}

/// All that a light's picture depends on besides depth buffer and shadow map.
#[derive(Clone, PartialEq)]
pub(crate) struct Signature {
    frame: Vec<u8>,
    light: Vec<u8>,
    variant: LightVariant,
    technique: Technique,
    mask: ReuseMask,
    map: Option<wgpu::Extent3d>,
    texture: Option<wgpu::TextureView>,
    /// The revision of the maps of a light through glass.
    glass: Option<Option<u64>>,
}

impl Signature {
    pub(crate) fn new(
        frame: &FrameUniform,
        light: &LightUniform,
        variant: LightVariant,
        technique: &Technique,
        mask: ReuseMask,
        inputs: &LightInputs<'_>,
    ) -> Self {
        Self {
            frame: bytemuck::bytes_of(frame).to_vec(),
            light: bytemuck::bytes_of(light).to_vec(),
            variant,
            technique: technique.clone(),
            mask,
            map: inputs.shadow_map.map(|map| map.texture().size()),
            texture: inputs.texture.cloned(),
            glass: inputs.glass.map(|_| inputs.shadow_revision),
        }
    }

    /// Whether a picture of the same signature may be kept: glass without a revision may change at any time.
    fn is_certain(&self) -> bool {
        self.glass != Some(None)
    }
}

impl History {
    /// Begins a frame; `before_ran` says whether the one prepared before was recorded.
    pub(crate) fn begin(&mut self, lights: usize, before_ran: bool) {
        self.lights.retain(|index, _| *index < lights);
        if before_ran {
            for light in self.lights.values_mut() {
                light.recorded = std::mem::take(&mut light.prepared);
            }
        }
    }

    /// A number that differs from that of every frame with another signature; never 0.
    pub(crate) fn generation(&mut self, light: usize, signature: Signature) -> u32 {
        let history = self.lights.entry(light).or_default();
        let is_same = history.signature.as_ref() == Some(&signature);
        if !is_same || !signature.is_certain() {
            self.generations = self.generations.wrapping_add(1).max(1);
            history.generation = self.generations;
            history.signature = Some(signature);
        }
        history.generation
    }

    /// The occluders that moved, came or went since the frame recorded last, where they were and where they are.
    pub(crate) fn moved(&mut self, light: usize, occluders: &[Occluder<'_>]) -> Vec<Placed> {
        let history = self.lights.entry(light).or_default();
        history.prepared = occluders.iter().map(Placed::of).collect();
        let (before, now) = (&history.recorded, &history.prepared);
        if before.len() != now.len() {
            return before.iter().chain(now).cloned().collect();
        }
        let pairs = before.iter().zip(now);
        pairs
            .filter(|(before, now)| !before.is_same(now))
            .flat_map(|(before, now)| [before.clone(), now.clone()])
            .collect()
    }
}
