//! Airlight tables on the GPU, made once a set of phase functions.

use std::sync::{Mutex, PoisonError};

use crate::{
    frame::{Medium, Phase},
    physics::airlight::{AirlightTable, TABLE_HEIGHT, TABLE_WIDTH},
};

/// Sets of phase functions that are kept; the oldest goes when another comes.
const KEPT: usize = 8;

/// The tables of the media of late, as textures that `airlight.wesl` reads.
#[derive(Default)]
pub(crate) struct AirlightTextures {
    kept: Mutex<Vec<(Vec<Phase>, wgpu::TextureView)>>,
}

impl AirlightTextures {
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
        let made = upload(device, queue, &tables.iter().collect::<Vec<_>>());
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push((phases, made.clone()));
        made
    }
}

/// The tables as a texture that `airlight.wesl` reads, one layer a phase function.
pub(crate) fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    tables: &[&AirlightTable],
) -> wgpu::TextureView {
    use wgpu::util::DeviceExt;
    let texels: Vec<[f32; 2]> = tables
        .iter()
        .flat_map(|table| table.texels().iter().copied())
        .collect();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("tyndall airlight"),
        size: wgpu::Extent3d {
            width: TABLE_WIDTH as u32,
            height: TABLE_HEIGHT as u32,
            depth_or_array_layers: tables.len() as u32,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rg32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    device
        .create_texture_with_data(queue, &descriptor, order, bytemuck::cast_slice(&texels))
        .create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        })
}
