//! A room behind a window blind.

use glam::{Affine3A, Vec3, vec3};

use super::{
    builder::SceneBuilder,
    triangles::{Bay, Opening, Triangles},
};
use crate::scene::Scene;

/// Half the room's width and depth, and its height \[m].
const ROOM: Vec3 = vec3(2.5, 2.8, 3.0);
/// Lower left and upper right corner of the window, across and up \[m].
const WINDOW: [[f32; 2]; 2] = [[-1.2, 0.8], [1.2, 2.4]];
const SLATS: u32 = 26;
/// Half a slat's depth and thickness \[m].
const SLAT: [f32; 2] = [0.03, 0.0015];
/// Tilt of the slats, down towards the room \[rad].
const TILT: f32 = 0.35;

pub(super) fn make() -> Scene {
    let mut builder = SceneBuilder::default();
    let wall = builder.plain([0.62, 0.58, 0.52]);
    let floor = builder.plain([0.30, 0.19, 0.11]);
    let blind = builder.plain([0.75, 0.72, 0.66]);
    let table = builder.plain([0.35, 0.10, 0.07]);
    let room = builder.mesh([
        (wall, walls()),
        (floor, ground()),
        (blind, slats()),
        (table, furniture()),
    ]);
    builder.instance("room", room, Affine3A::IDENTITY);
    builder.camera(
        vec3(2.0, 1.55, 2.2),
        vec3(-0.55, 1.0, -1.0),
        58.0,
        [0.05, 20.0],
    );
    builder.sun(vec3(-0.55, -0.62, 0.75), [10.0, 9.2, 8.0]);
    builder.finish()
}

fn walls() -> Triangles {
    let mut walls = Triangles::default();
    walls.bay(&Bay {
        origin: vec3(0.0, 0.0, -ROOM.z),
        across: Vec3::X,
        rectangle: [[-ROOM.x, 0.0], [ROOM.x, ROOM.y]],
        opening: Opening::rectangle(WINDOW[0], WINDOW[1]),
        thickness: 0.2,
    });
    let (low, high) = (vec3(-ROOM.x, 0.0, -ROOM.z), ROOM);
    let t = 0.2;
    walls.cuboid(vec3(low.x - t, 0.0, low.z), vec3(low.x, high.y, high.z));
    walls.cuboid(vec3(high.x, 0.0, low.z), vec3(high.x + t, high.y, high.z));
    walls.cuboid(
        vec3(low.x - t, 0.0, high.z),
        vec3(high.x + t, high.y, high.z + t),
    );
    walls.cuboid(vec3(low.x - t, high.y, low.z - t), high + Vec3::splat(t));
    walls
}

fn ground() -> Triangles {
    let mut ground = Triangles::default();
    ground.cuboid(
        vec3(-ROOM.x - 0.2, -0.2, -ROOM.z - 0.2),
        vec3(ROOM.x + 0.2, 0.0, ROOM.z + 0.2),
    );
    ground
}

fn slats() -> Triangles {
    let mut slats = Triangles::default();
    let [[left, bottom], [right, top]] = WINDOW;
    let (sin, cos) = TILT.sin_cos();
    let half_edges = [
        0.5 * (right - left - 0.02) * Vec3::X,
        SLAT[1] * vec3(0.0, cos, sin),
        SLAT[0] * vec3(0.0, -sin, cos),
    ];
    let at = |x: f32, y: f32| vec3(x, y, -ROOM.z);
    for i in 0..SLATS {
        let y = bottom + (top - bottom) * (i as f32 + 0.5) / SLATS as f32;
        slats.block(at(0.0, y), half_edges);
    }
    for x in [left + 0.3, 0.0, right - 0.3] {
        slats.tube(&[(at(x, bottom), 0.003), (at(x, top), 0.003)], 6);
    }
    slats
}

fn furniture() -> Triangles {
    let mut table = Triangles::default();
    table.cuboid(vec3(-1.4, 0.70, -1.6), vec3(0.0, 0.75, -0.6));
    for (x, z) in [(-1.35, -1.55), (-0.1, -1.55), (-1.35, -0.7), (-0.1, -0.7)] {
        table.cuboid(vec3(x, 0.0, z), vec3(x + 0.06, 0.70, z + 0.06));
    }
    table.tube(
        &[
            (vec3(-0.7, 0.75, -1.1), 0.07),
            (vec3(-0.7, 0.85, -1.1), 0.12),
            (vec3(-0.7, 0.98, -1.1), 0.09),
            (vec3(-0.7, 1.08, -1.1), 0.04),
            (vec3(-0.7, 1.14, -1.1), 0.055),
        ],
        32,
    );
    table
}
