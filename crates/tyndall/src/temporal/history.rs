//! A view's memory of the frames it prepared, light by light.

use std::collections::HashMap;

use glam::DVec3;

use super::options::{Reuse, ReuseMask};
use crate::{
    frame::{Camera, Frame, Light, Medium},
    gpu::uniforms::{CameraUniform, LightVariant},
    inputs::LightInputs,
    mesh::{Occluder, OccluderMesh},
    techniques::Technique,
};

/// The lights' histories.
#[derive(Default)]
pub(crate) struct History {
    lights: HashMap<usize, LightHistory>,
    generations: u32,
    /// Viewpoint of the frame recorded last.
    recorded: Option<Viewpoint>,
    /// Viewpoint of the frame prepared last.
    prepared: Option<Viewpoint>,
}

/// The camera and eye that a frame is seen from.
#[derive(Clone, Copy)]
pub(crate) struct Viewpoint {
    pub(crate) camera: CameraUniform,
    /// World-space eye \[m].
    pub(crate) eye: DVec3,
}

/// Numbers of a light's frames that are alike; never 0.
#[derive(Clone, Copy, Default)]
pub(crate) struct Generations {
    /// Another one whenever the signature is.
    pub(crate) exact: u32,
    /// Another one whenever more of it than the camera's place is.
    pub(crate) ignoring_camera: u32,
}

#[derive(Default)]
struct LightHistory {
    signature: Option<Signature>,
    generations: Generations,
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

/// All that a light's image depends on besides depth buffer and shadow map.
#[derive(Clone, PartialEq)]
pub(crate) struct Signature {
    camera: Camera,
    scene: SceneSignature,
}

/// All of it but the camera.
#[derive(Clone, PartialEq)]
struct SceneSignature {
    light: Light,
    medium: Medium,
    variant: LightVariant,
    technique: Technique,
    mask: ReuseMask,
    reproject: Option<f32>,
    map: Option<wgpu::Extent3d>,
    texture: Option<wgpu::TextureView>,
    /// The revision of the maps of a light through glass.
    glass: Option<Option<u64>>,
}

impl Signature {
    pub(crate) fn new(
        (frame, technique): (&Frame, &Technique),
        light: &Light,
        variant: LightVariant,
        reuse: Reuse,
        inputs: &LightInputs<'_>,
    ) -> Self {
        Self {
            camera: frame.camera,
            scene: SceneSignature {
                light: *light,
                medium: frame.medium.clone(),
                variant,
                technique: technique.clone(),
                mask: reuse.mask,
                reproject: reuse.reproject,
                map: inputs.shadow_map.map(|map| map.texture().size()),
                texture: inputs.texture.cloned(),
                glass: inputs.glass.map(|_| inputs.shadow_revision),
            },
        }
    }

    /// True if an image of the same signature may be kept: glass without a revision may change at any time.
    fn is_certain(&self) -> bool {
        self.scene.glass != Some(None)
    }

    /// True if the other differs in the camera's place and lens at most.
    fn differs_by_camera_only(&self, other: &Self) -> bool {
        let kind = |camera: &Camera| {
            (
                std::mem::discriminant(&camera.projection),
                camera.depth_range,
            )
        };
        self.scene == other.scene && kind(&self.camera) == kind(&other.camera)
    }
}

impl History {
    /// Begins a frame; `before_ran` says whether the one prepared before was recorded.
    pub(crate) fn begin(&mut self, lights: usize, before_ran: bool, seen_from: Viewpoint) {
        self.lights.retain(|index, _| *index < lights);
        if before_ran {
            self.recorded = self.prepared;
            for light in self.lights.values_mut() {
                light.recorded = std::mem::take(&mut light.prepared);
            }
        }
        self.prepared = Some(seen_from);
    }

    /// The viewpoint of the frame recorded last; of this one, where it is the first.
    pub(crate) fn before(&self) -> Option<Viewpoint> {
        self.recorded.or(self.prepared)
    }

    /// Numbers that differ from those of every frame with another signature.
    pub(crate) fn generations(&mut self, light: usize, signature: Signature) -> Generations {
        let history = self.lights.entry(light).or_default();
        let known = history.signature.as_ref();
        let known = known.filter(|_| signature.is_certain());
        if known != Some(&signature) {
            self.generations = self.generations.wrapping_add(1).max(1);
            history.generations.exact = self.generations;
            if !known.is_some_and(|known| known.differs_by_camera_only(&signature)) {
                history.generations.ignoring_camera = self.generations;
            }
            history.signature = Some(signature);
        }
        history.generations
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
