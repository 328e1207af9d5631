//! Shots frame by frame: what moves, what stays, and moves of what isn't there.

use std::path::Path;

use glam::Vec3;
use tyndall::frame::Emitter;

use super::*;
use crate::{
    progress::Progress,
    shot::{FrameRange, Shot},
};

const SHOT: &str = r#"scene = "builtin:slats"
size = [8, 6]
[camera]
eye = [0, 1, 4]
target = [0, 1, 0]
[[light]]
type = "spot"
position = [0, 3, 0]
direction = [0, -1, 0]
intensity = [1, 1, 1]
inner = 0.1
outer = 0.4
[medium]
sigma_s = [0.1, 0.2, 0.3]
sigma_a = [0, 0, 0]
phase = { kind = "isotropic" }
[animation]
fps = 10
[[animation.move]]
node = "camera"
translate = [[0, 0, 0], [2, 0, 0], [2, 2, 0]]
rotate_deg = [[0, 0, 0], [0, 90, 0]]
[[animation.move]]
node = "light.0"
translate = [[0, 0, 0], [0, 0, 4]]
rotate_deg = [[0, 0, 0], [90, 0, 0]]
[[animation.move]]
node = "medium"
density = [1, 3]
"#;

fn loaded(text: &str) -> Result<LoadedShot, String> {
    let shot = Shot::of_text(Path::new("shot.toml"), text, &[]).unwrap();
    let range = FrameRange { first: 0, last: 4 };
    LoadedShot::moving(&shot, range, &mut Progress::default())
        .map_err(|failure| failure.to_string())
}

fn close(a: [f32; 3], b: [f32; 3]) -> bool {
    Vec3::from(a).abs_diff_eq(b.into(), 1e-5)
}

#[test]
fn camera_light_and_medium_move_along_their_keys() {
    let mut loaded = loaded(SHOT).unwrap();
    for (frame, eye, forward, position, density) in [
        (0, [0.0, 1.0, 4.0], [0.0, 0.0, -4.0], [0.0, 3.0, 0.0], 1.0),
        (
            1,
            [1.0, 1.0, 4.0],
            [-1.530_734, 0.0, -3.695_518],
            [0.0, 3.0, 1.0],
            1.5,
        ),
        (
            2,
            [2.0, 1.0, 4.0],
            [-2.828_427, 0.0, -2.828_427],
            [0.0, 3.0, 2.0],
            2.0,
        ),
        (4, [2.0, 3.0, 4.0], [-4.0, 0.0, 0.0], [0.0, 3.0, 4.0], 3.0),
    ] {
        let ShotFrame { frame: found, .. } = loaded.frame(frame).unwrap();
        assert!(close(found.camera.eye, eye), "{frame}: {:?}", found.camera);
        assert!(
            close(found.camera.forward, forward),
            "{frame}: {:?}",
            found.camera
        );
        let Emitter::Spot { position: at, .. } = found.lights[0].emitter else {
            panic!("a spot");
        };
        assert!(close(at, position), "{frame}: {at:?}");
        let sigma_s = found.medium.components[0].sigma_s;
        assert!(
            close(sigma_s, [0.1, 0.2, 0.3].map(|x| x * density)),
            "{frame}"
        );
    }
    // Turned about x by 90 degrees, what pointed down points away from the viewer.
    let Emitter::Spot { direction, .. } = loaded.frame(4).unwrap().frame.lights[0].emitter else {
        panic!("a spot");
    };
    assert!(close(direction, [0.0, 0.0, -1.0]), "{direction:?}");
}

#[test]
fn nodes_move_and_frames_do_not_depend_on_each_other() {
    let name = tyndall_scene::builtin::builtin("slats").unwrap().nodes;
    let node = name.iter().find(|node| node.mesh.is_some()).unwrap();
    let moves = format!(
        "[animation]\nfps = 10\n[[animation.move]]\nnode = \"{}\"\ntranslate = [[0, 0, 0], [0, 8, 0]]\n",
        node.name
    );
    let (before, _) = SHOT.split_once("[animation]").unwrap();
    let text = format!("{before}{moves}");
    let mut forwards = loaded(&text).unwrap();
    let place = |shot_frame: &ShotFrame| {
        let moved = shot_frame.scene.nodes.iter().find(|n| n.name == node.name);
        moved.unwrap().parent_from_local.translation
    };
    let first = forwards.frame(0).unwrap();
    assert_eq!(place(&first), node.parent_from_local.translation);
    let third = forwards.frame(2).unwrap();
    assert_eq!(place(&third).y, node.parent_from_local.translation.y + 4.0);
    assert_eq!(place(&first), node.parent_from_local.translation);
    // Maps stay, rays hit what moved.
    assert_eq!(first.frame.lights, third.frame.lights);
    let top = |shot_frame: &ShotFrame| shot_frame.tracer.geometry().bounds().unwrap().max.y;
    assert!(top(&third) > top(&first) + 1.0);
    assert_eq!(top(&loaded(&text).unwrap().frame(2).unwrap()), top(&third));
}

/// A sun's map follows the camera, and is that of its frame alone.
#[test]
fn a_sun_s_map_follows_the_camera() {
    let (sun, spot) = (
        "type = \"directional\"\ndirection = [1, -1, 0.2]\nilluminance = [1, 1, 1]\n",
        SHOT.find("type = \"spot\"").unwrap()..SHOT.find("[medium]").unwrap(),
    );
    let mut text = SHOT.replace("builtin:slats", "builtin:forest");
    let from = text.find("type = \"spot\"").unwrap();
    text.replace_range(from..from + spot.len(), sun);
    let (head, _) = text.split_once("[animation]").unwrap();
    let text = format!(
        "{head}[animation]\nfps = 10\n[[animation.move]]\nnode = \"camera\"\nrotate_deg = [[0, 0, 0], [0, 170, 0]]\n"
    );
    let lights = |loaded: &mut LoadedShot, frame| loaded.frame(frame).unwrap().frame.lights;
    let mut forwards = loaded(&text).unwrap();
    let film: Vec<_> = (0..5).map(|frame| lights(&mut forwards, frame)).collect();
    assert_ne!(film[0], film[4]);
    for frame in [4, 1, 3] {
        let alone = lights(&mut loaded(&text).unwrap(), frame);
        assert_eq!(alone, film[frame as usize], "{frame}");
    }
    let whole = loaded(&text).unwrap().frame(0).unwrap().with_whole_maps();
    assert_ne!(whole.frame.lights, film[0]);
}

#[test]
fn what_is_not_there_cannot_be_moved() {
    for (from, to, words) in [
        (
            "node = \"light.0\"",
            "node = \"light.7\"",
            "shot.toml:24: animation.move.1.node: no light is called \"light.7\": expected light.0",
        ),
        (
            "node = \"light.0\"",
            "node = \"dragon\"",
            "shot.toml:24: animation.move.1.node: no node is called \"dragon\": expected ",
        ),
    ] {
        let error = loaded(&SHOT.replacen(from, to, 1)).err().unwrap();
        assert!(error.starts_with(words), "{error}");
    }
}
