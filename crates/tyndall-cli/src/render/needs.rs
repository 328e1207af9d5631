//! The inputs and passes that layers and techniques need.

use tyndall::{
    techniques::{Technique, TechniqueInfo, reference},
    temporal::{Reuse, ReuseMask},
};

use crate::layer::Layer;

/// The inputs that techniques read besides depth buffer, lights, their textures and medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TechniqueInputs {
    /// Shadow maps.
    pub(crate) shadow_maps: bool,
    /// Coloured glass.
    pub(crate) glass: bool,
    /// The scene's triangles, on the GPU.
    pub(crate) occluders: bool,
    /// Points of the scene's surfaces about rectangular lights, on the GPU.
    pub(crate) points: bool,
    /// Normals of the surfaces, which are shadowed as well.
    pub(crate) normals: bool,
}

impl TechniqueInputs {
    /// All inputs that any of the techniques reads.
    pub(crate) fn of(techniques: &[Technique]) -> Self {
        let any = |reads: fn(&TechniqueInfo) -> bool| {
            techniques.iter().any(|technique| reads(technique.info()))
        };
        Self {
            shadow_maps: !techniques.iter().all(is_traced),
            glass: any(|info| info.reads.glass),
            occluders: any(|info| info.reads.occluders),
            points: any(|info| info.reads.points),
            normals: any(|info| info.shadows_surfaces),
        }
    }
}

/// Whether a technique takes visibility from the scene itself; surfaces do then, too.
pub(super) fn is_traced(technique: &Technique) -> bool {
    matches!(
        technique,
        Technique::Reference(reference::Params {
            visibility: reference::Visibility::Traced,
            ..
        })
    )
}

/// Whether techniques, or their reuse of earlier frames, read the scene's triangles.
pub(crate) fn reads_occluders(techniques: &[Technique], reuse: Option<&Reuse>) -> bool {
    let mask = reuse.map(|reuse| reuse.mask);
    TechniqueInputs::of(techniques).occluders || mask == Some(ReuseMask::Geometry)
}

/// The passes and inputs that layers need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    pub(super) in_scatter: bool,
    pub(super) surface: bool,
    /// Shadows of rectangular lights on surfaces, by the technique.
    pub(super) surface_shadows: bool,
    pub(super) shadow_maps: bool,
    /// Coloured glass before the shadow maps.
    pub(super) glass: bool,
    /// Points of the scene's surfaces, of rectangular lights.
    pub(super) points: bool,
}

impl Needs {
    /// In-scattered light by any technique, and nothing else.
    pub(crate) const IN_SCATTER: Self = Self {
        in_scatter: true,
        surface: false,
        surface_shadows: false,
        shadow_maps: true,
        glass: true,
        points: true,
    };

    pub(super) fn of(layers: &[Layer], techniques: &[Technique]) -> Self {
        let inputs = TechniqueInputs::of(techniques);
        let any = |wanted: [Layer; 2]| layers.iter().any(|layer| wanted.contains(layer));
        let surface = any([Layer::Final, Layer::Surface]);
        let surface_shadows = surface && inputs.normals;
        let in_scatter = surface_shadows || any([Layer::Final, Layer::Inscatter]);
        Self {
            in_scatter,
            surface,
            surface_shadows,
            shadow_maps: (surface || in_scatter) && inputs.shadow_maps,
            glass: inputs.shadow_maps && (surface || (in_scatter && inputs.glass)),
            points: in_scatter && inputs.points,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_layers_need_is_computed() {
        let named = |name| Technique::from_name(name).unwrap();
        let (march, voxels) = (named("min-max"), named("ivsv"));
        let traced = Technique::Reference(reference::Params::default());
        let none = Needs {
            in_scatter: false,
            surface: false,
            surface_shadows: false,
            shadow_maps: false,
            glass: false,
            points: false,
        };
        let in_scatter = Needs {
            in_scatter: true,
            ..none
        };
        let surface = Needs {
            surface: true,
            shadow_maps: true,
            glass: true,
            ..none
        };
        let marched = Needs {
            shadow_maps: true,
            glass: true,
            ..in_scatter
        };
        for (layers, techniques, expected) in [
            (&[Layer::Depth][..], &[&march][..], none),
            (&[Layer::Inscatter], &[&march], marched),
            (&[Layer::Inscatter], &[&traced], in_scatter),
            (
                &[Layer::Final],
                &[&traced],
                Needs {
                    surface: true,
                    ..in_scatter
                },
            ),
            (&[Layer::Surface, Layer::Depth], &[&march], surface),
            (
                &[Layer::Inscatter],
                &[&voxels],
                Needs {
                    glass: false,
                    points: true,
                    ..marched
                },
            ),
            (
                &[Layer::Inscatter],
                &[&voxels, &march],
                Needs {
                    points: true,
                    ..marched
                },
            ),
            (
                &[Layer::Surface],
                &[&voxels],
                Needs {
                    in_scatter: true,
                    surface_shadows: true,
                    points: true,
                    ..surface
                },
            ),
        ] {
            let techniques: Vec<Technique> = techniques.iter().map(|t| (*t).clone()).collect();
            assert_eq!(Needs::of(layers, &techniques), expected, "{layers:?}");
        }
    }
}
