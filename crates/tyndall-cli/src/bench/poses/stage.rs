//! Scenes with each kind of light, with coloured glass and with lights that shine through pictures.

use crate::{
    bench::{
        report::Bench,
        subject::{self, Subject},
    },
    failure::Failure,
    load::{LoadedShot, ShotFrame},
    progress::Progress,
};

/// A scene, its light, and what that shines through.
pub(super) struct Stage {
    pub(super) name: &'static str,
    scene: Subject,
    /// The light in place of the scene's own, as `--set` takes it.
    light: Option<&'static str>,
    /// Whether it shines through a picture.
    picture: bool,
}

const fn stage(name: &'static str, scene: Subject, light: Option<&'static str>) -> Stage {
    Stage {
        name,
        scene,
        light,
        picture: false,
    }
}

const fn through_a_picture(stage: Stage) -> Stage {
    Stage {
        picture: true,
        ..stage
    }
}

/// Outside, before the rose window of the choir.
const LAMP_BEFORE_GLASS: &str = r#"light=[{ type = "point", position = [1.0, 12.0, -25.0], intensity = [10.0, 9.0, 8.0], shadow_map = 256 }]"#;
const SPOT_BEFORE_GLASS: &str = r#"light=[{ type = "spot", position = [-1.0, 11.0, -26.0], direction = [0.1, -0.2, 1.0], intensity = [10.0, 9.0, 8.0], inner = 0.3, outer = 0.4, shadow_map = 512 }]"#;
const SPOT_BEFORE_BLIND: &str = r#"light=[{ type = "spot", position = [1.5, 3.4, -6.0], direction = [-0.4, -0.5, 1.0], intensity = [10.0, 9.0, 8.0], inner = 0.3, outer = 0.45, shadow_map = 512 }]"#;
/// Too wide for a single map.
const WIDE_SPOT: &str = r#"light=[{ type = "spot", position = [1.6, 2.6, 1.2], direction = [-0.5, -0.8, -0.3], intensity = [10.0, 9.0, 8.0], inner = 1.0, outer = 1.4, shadow_map = 256 }]"#;
const LAMP: &str = r#"light=[{ type = "point", position = [1.4, 2.2, 1.0], intensity = [10.0, 9.0, 8.0], shadow_map = 256 }]"#;
const PANEL: &str = r#"light=[{ type = "rect", center = [0.3, 2.6, -0.4], edge_x = [1.2, 0.0, 0.0], edge_y = [0.0, 0.2, 0.8], radiance = [12.0, 11.0, 9.0], vpls = 16, shadow_map = 128 }]"#;
const PANEL_OVER_SPONGE: &str = r#"light=[{ type = "rect", center = [-0.9, 3.4, -0.7], edge_x = [1.6, 0.0, 0.0], edge_y = [0.0, 0.4, 1.2], radiance = [12.0, 11.0, 9.0], vpls = 16, shadow_map = 128 }]"#;

/// All of them.
pub(super) const STAGES: [Stage; 13] = [
    stage("church", subject::CHURCH, None),
    stage("forest", subject::TREES, None),
    stage("terrain", subject::MOUNTAINS, None),
    stage("box before a wall", subject::BOX_WALL, None),
    stage("church, lamp", subject::CHURCH, Some(LAMP_BEFORE_GLASS)),
    stage("church, spot", subject::CHURCH, Some(SPOT_BEFORE_GLASS)),
    stage("sponge, wide spot", subject::YEAH_RIGHT, Some(WIDE_SPOT)),
    stage("room, panel", subject::BLIND, Some(PANEL)),
    through_a_picture(stage("church, picture", subject::CHURCH, None)),
    through_a_picture(stage(
        "room, spot, picture",
        subject::BLIND,
        Some(SPOT_BEFORE_BLIND),
    )),
    through_a_picture(stage(
        "sponge, lamp, picture",
        subject::YEAH_RIGHT,
        Some(LAMP),
    )),
    through_a_picture(stage("room, picture", subject::BLIND, None)),
    through_a_picture(stage(
        "sponge, panel, picture",
        subject::YEAH_RIGHT,
        Some(PANEL_OVER_SPONGE),
    )),
];

/// Texels a side of a sun's shadow map.
const MAP: u32 = 512;

impl Stage {
    /// Loads it with maps round the whole scene; `None` where its file is not among the assets.
    pub(super) fn load(
        &self,
        size: [u32; 2],
        bench: &Bench,
        progress: &mut Progress,
    ) -> Result<Option<ShotFrame>, Failure> {
        let assets = bench.assets.as_deref();
        if self.scene.is_stood_in_for(assets) {
            return Ok(None);
        }
        let light: Vec<&str> = self.light.into_iter().collect();
        let (shot, _) = self.scene.shot_with(&light, assets, size, MAP)?;
        let mut shot_frame = LoadedShot::at_rest(&shot, progress)?.frame(0)?;
        if self.picture {
            shot_frame = subject::with_texture(&shot_frame, subject::coloured_rings());
        }
        Ok(Some(shot_frame.with_whole_maps()))
    }
}
