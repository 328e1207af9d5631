//! The inputs and passes that layers and techniques need.

use tyndall::{
    techniques::{Technique, reference},
    temporal::{Reuse, ReuseMask},
};

use crate::layer::Layer;

/// The inputs that a technique reads besides depth buffer, lights and medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TechniqueInputs {
    /// Shadow maps and the coloured glass before them.
    pub(crate) light_maps: bool,
    /// The scene's triangles, on the GPU.
    pub(crate) occluders: bool,
    /// Points of the scene's surfaces, of rectangular lights on the GPU.
    pub(crate) points: bool,
    /// Whether the technique finds the shadows of rectangular lights on surfaces as well, from their normals.
    pub(crate) surface_shadows: bool,
}

impl TechniqueInputs {
    /// Everything in the command that depends on which technique it is.
    pub(crate) fn of(technique: &Technique) -> Self {
        let is_traced = matches!(
            technique,
            Technique::Reference(reference::Params {
                visibility: reference::Visibility::Traced,
                ..
            })
        );
        let is_area = matches!(technique, Technique::ImperfectVoxelized(_));
        Self {
            light_maps: !is_traced,
            occluders: matches!(technique, Technique::Hybrid(_)),
            points: is_area,
            surface_shadows: is_area,
        }
    }
}

/// Whether a technique, or its reuse of earlier frames, reads the scene's triangles.
pub(crate) fn reads_occluders(technique: &Technique, reuse: Option<&Reuse>) -> bool {
    let mask = reuse.map(|reuse| reuse.mask);
    TechniqueInputs::of(technique).occluders || mask == Some(ReuseMask::Geometry)
}

/// The passes and inputs that layers need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    pub(super) in_scatter: bool,
    pub(super) surface: bool,
    /// Shadows of rectangular lights on surfaces, by the technique.
    pub(super) surface_shadows: bool,
    pub(super) light_maps: bool,
    /// Points of the scene's surfaces, of rectangular lights.
    pub(super) points: bool,
}

impl Needs {
    /// In-scattered light by any technique, and nothing else.
    pub(crate) const IN_SCATTER: Self = Self {
        in_scatter: true,
        surface: false,
        surface_shadows: false,
        light_maps: true,
        points: true,
    };

    pub(super) fn of(layers: &[Layer], technique: &Technique) -> Self {
        let inputs = TechniqueInputs::of(technique);
        let any = |wanted: [Layer; 2]| layers.iter().any(|layer| wanted.contains(layer));
        let surface = any([Layer::Final, Layer::Surface]);
        let surface_shadows = surface && inputs.surface_shadows;
        let in_scatter = surface_shadows || any([Layer::Final, Layer::Inscatter]);
        Self {
            in_scatter,
            surface,
            surface_shadows,
            light_maps: surface || (in_scatter && inputs.light_maps),
            points: in_scatter && inputs.points,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_layers_need_is_computed() {
        let march = Technique::default();
        let voxels = Technique::from_name("ivsv").unwrap();
        let traced = Technique::Reference(reference::Params::default());
        for (layers, technique, [in_scatter, surface, surface_shadows, light_maps, points]) in [
            (&[Layer::Depth][..], &march, [false; 5]),
            (
                &[Layer::Inscatter],
                &march,
                [true, false, false, true, false],
            ),
            (
                &[Layer::Inscatter],
                &traced,
                [true, false, false, false, false],
            ),
            (&[Layer::Final], &traced, [true, true, false, true, false]),
            (
                &[Layer::Surface, Layer::Depth],
                &march,
                [false, true, false, true, false],
            ),
            (
                &[Layer::Inscatter],
                &voxels,
                [true, false, false, true, true],
            ),
            (&[Layer::Surface], &voxels, [true; 5]),
        ] {
            let expected = Needs {
                in_scatter,
                surface,
                surface_shadows,
                light_maps,
                points,
            };
            assert_eq!(Needs::of(layers, technique), expected, "{layers:?}");
        }
    }
}
