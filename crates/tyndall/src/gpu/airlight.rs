//! Airlight tables on the GPU, made once a set of phase functions.

use std::sync::{Mutex, PoisonError};

use crate::{
    frame::{Medium, Phase},
    physics::airlight::{AirlightTable, picture},
};

/// Sets of phase functions that are kept; the oldest goes when another comes.
const KEPT: usize = 8;

/// The tables of the media of late, as textures that `airlight.wgsl` reads.
#[derive(Default)]
pub(crate) struct AirlightPictures {
    kept: Mutex<Vec<(Vec<Phase>, wgpu::TextureView)>>,
}

impl AirlightPictures {
    /// One layer a component of the medium, in order; a vacuum has one that nothing reads.
    pub(crate) fn of(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        medium: &Medium,
    ) -> wgpu::TextureView {
        let phases: Vec<Phase> = medium.components.iter().map(|c| c.phase).collect();
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = kept.iter().find(|(of, _)| *of == phases) {
            return found.clone();
        }
        let tables: Vec<AirlightTable> = if phases.is_empty() {
            vec![AirlightTable::new(Phase::Isotropic)]
        } else {
            phases
                .iter()
                .map(|phase| AirlightTable::new(*phase))
                .collect()
        };
        let made = picture(device, queue, &tables.iter().collect::<Vec<_>>());
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push((phases, made.clone()));
        made
    }
}
