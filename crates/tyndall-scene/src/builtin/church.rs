//! A church: a nave between two aisles, closed but for its windows. The nave runs along Z, the choir is at -Z.

use std::f32::consts::PI;

use glam::{Affine3A, Vec2, Vec3, vec2, vec3};

use super::{
    builder::SceneBuilder,
    glass,
    triangles::{Bay, Opening, Triangles},
};
use crate::scene::{Blocking, Scene};

/// Length of a bay along the nave \[m], and number of bays.
const BAY: f32 = 4.0;
const BAYS: u32 = 9;
/// Half the nave's length \[m].
const HALF_LENGTH: f32 = 0.5 * BAY * BAYS as f32;
/// Distance of the arcades and of the outer walls from the middle \[m].
const ARCADE: f32 = 4.0;
const OUTER_WALL: f32 = 8.0;
/// Heights \[m]: the arches' springing, the arcades' upper edge, the vault's springing, the ends' walls.
const SPRINGING: f32 = 3.6;
const ARCADE_TOP: f32 = 6.4;
const VAULT: f32 = 10.4;
const GABLE: f32 = VAULT + ARCADE + 0.2;
/// Heights where the aisles' roofs meet the outer walls and the arcades \[m].
const AISLE_ROOF: [f32; 2] = [4.6, 6.3];
const WALL_THICKNESS: f32 = 0.6;
/// Distance of an arc's centre beyond the arch's middle, in half widths.
const POINTEDNESS: f32 = 0.4;
/// Light that clean coloured glass lets pass.
const GLASS_TRANSMISSION: f32 = 0.9;
/// Number of different textures on the lancets.
const LANCET_TEXTURES: usize = 4;
/// Straight pieces of the vault's half circle.
const VAULT_PIECES: u32 = 32;

/// Glass in a window.
#[derive(Clone, Copy, PartialEq)]
enum Glass {
    None,
    Lancet(usize),
    Rose,
}

pub(super) fn make() -> Scene {
    let mut builder = SceneBuilder::default();
    let stone = builder.plain([0.56, 0.51, 0.43]);
    let plaster = builder.plain([0.66, 0.63, 0.57]);
    let wood = builder.plain([0.22, 0.12, 0.06]);
    let tiles = builder.texture(glass::tiles());
    let tiles = builder.textured(tiles, Blocking::Opaque);
    let mut parts = vec![
        (stone, masonry()),
        (plaster, ceilings()),
        (wood, pews()),
        (tiles, floor()),
    ];
    for (kind, texture) in glasses() {
        let texture = builder.texture(texture);
        let transmission = GLASS_TRANSMISSION;
        let material = builder.textured(texture, Blocking::Transmissive { transmission });
        parts.push((material, panes(kind)));
    }
    let church = builder.mesh(parts);
    builder.instance("church", church, Affine3A::IDENTITY);
    builder.camera(
        vec3(1.5, 1.9, 16.4),
        vec3(0.1, 4.3, -4.0),
        62.0,
        [0.05, 37.0],
    );
    builder.sun(vec3(-0.07, -0.36, 0.93), [10.0, 9.3, 8.2]);
    builder.finish()
}

/// Every kind of glass, with its texture.
fn glasses() -> impl Iterator<Item = (Glass, crate::scene::Texture)> {
    (0..LANCET_TEXTURES)
        .map(|i| (Glass::Lancet(i), glass::lancet(11 + i as u64)))
        .chain([(Glass::Rose, glass::rose(3))])
}

/// Every window and the wall round it.
fn windows() -> Vec<(Bay, Glass)> {
    let mut windows = choir_windows();
    windows.push((
        end_wall(
            HALF_LENGTH,
            [[-OUTER_WALL, 0.0], [OUTER_WALL, GABLE]],
            Opening::round([0.0, 9.6], 1.6),
        ),
        Glass::Rose,
    ));
    for side in [-1.0, 1.0] {
        for bay in 0..BAYS {
            let lancet = Glass::Lancet((bay as usize + usize::from(side > 0.0)) % LANCET_TEXTURES);
            let glazed = if bay % 3 == 1 { Glass::None } else { lancet };
            windows.push((
                side_wall(bay, side * ARCADE, [ARCADE_TOP, VAULT], 0.75, [7.2, 8.9]),
                glazed,
            ));
            windows.push((
                side_wall(
                    bay,
                    side * OUTER_WALL,
                    [0.0, AISLE_ROOF[0]],
                    0.7,
                    [1.5, 3.0],
                ),
                lancet,
            ));
        }
    }
    windows
}

/// Three lancets, the middle one clear, below a rose.
fn choir_windows() -> Vec<(Bay, Glass)> {
    const SILL: f32 = 6.5;
    let lancets = [
        ([-OUTER_WALL, -1.15], -2.3),
        ([-1.15, 1.15], 0.0),
        ([1.15, OUTER_WALL], 2.3),
    ];
    let lancets = lancets
        .into_iter()
        .enumerate()
        .map(|(i, ([left, right], middle))| {
            let opening = Opening::arched(middle, 0.75, [1.9, 4.7], POINTEDNESS);
            let wall = end_wall(-HALF_LENGTH, [[left, 0.0], [right, SILL]], opening);
            (
                wall,
                if i == 1 {
                    Glass::None
                } else {
                    Glass::Lancet(i)
                },
            )
        });
    let rose = end_wall(
        -HALF_LENGTH,
        [[-OUTER_WALL, SILL], [OUTER_WALL, GABLE]],
        Opening::round([0.0, 9.7], 2.6),
    );
    lancets.chain([(rose, Glass::Rose)]).collect()
}

fn end_wall(z: f32, rectangle: [[f32; 2]; 2], opening: Opening) -> Bay {
    Bay {
        origin: z * Vec3::Z,
        across: Vec3::X,
        rectangle,
        opening,
        thickness: WALL_THICKNESS,
    }
}

/// A piece of wall along the nave, one bay long, with an arched opening from `sill` to `springing` and above.
fn side_wall(bay: u32, x: f32, [bottom, top]: [f32; 2], half_width: f32, opening: [f32; 2]) -> Bay {
    let start = bay_start(bay);
    Bay {
        origin: x * Vec3::X,
        across: Vec3::Z,
        rectangle: [[start, bottom], [start + BAY, top]],
        opening: Opening::arched(start + 0.5 * BAY, half_width, opening, POINTEDNESS),
        thickness: WALL_THICKNESS,
    }
}

fn bay_start(bay: u32) -> f32 {
    BAY * bay as f32 - HALF_LENGTH
}

fn masonry() -> Triangles {
    let mut masonry = Triangles::default();
    for (wall, _) in windows() {
        masonry.bay(&wall);
    }
    for side in [-1.0, 1.0] {
        for bay in 0..BAYS {
            let heights = [SPRINGING, ARCADE_TOP];
            masonry.bay(&side_wall(bay, side * ARCADE, heights, 1.6, [SPRINGING; 2]));
        }
        for bay in 0..=BAYS {
            column(&mut masonry, vec3(side * ARCADE, 0.0, bay_start(bay)));
            respond(&mut masonry, side, bay_start(bay));
        }
    }
    for bay in 1..BAYS {
        rib(&mut masonry, bay_start(bay));
    }
    for (half_width, top, front) in [(3.4, 0.18, -13.0), (3.0, 0.36, -14.0)] {
        masonry.cuboid(
            vec3(-half_width, 0.0, -HALF_LENGTH),
            vec3(half_width, top, front),
        );
    }
    masonry.cuboid(vec3(-1.3, 0.36, -16.6), vec3(1.3, 1.36, -15.6));
    masonry
}

/// A round column with base and capital, as high as the arches' springing.
fn column(masonry: &mut Triangles, foot: Vec3) {
    const SIDES: u32 = 32;
    const ABACUS: Vec3 = vec3(0.46, 0.10, 0.40);
    /// Height and radius of the mouldings \[m].
    const PROFILE: [(f32, f32); 12] = [
        (0.00, 0.50),
        (0.18, 0.50),
        (0.22, 0.46),
        (0.30, 0.44),
        (0.36, 0.36),
        (0.42, 0.34),
        (2.95, 0.30),
        (2.97, 0.35),
        (3.02, 0.35),
        (3.05, 0.30),
        (3.25, 0.36),
        (3.40, 0.46),
    ];
    let rings = PROFILE.map(|(height, radius)| (foot + height * Vec3::Y, radius));
    masonry.tube(&rings, SIDES);
    let middle = foot + (SPRINGING - ABACUS.y) * Vec3::Y;
    masonry.cuboid(middle - ABACUS, middle + ABACUS);
}

/// A thin shaft on the wall that carries a rib.
fn respond(masonry: &mut Triangles, side: f32, z: f32) {
    let x = side * (ARCADE - 0.5 * WALL_THICKNESS);
    let rings = [(SPRINGING, 0.14), (VAULT - 0.3, 0.14), (VAULT, 0.24)];
    masonry.tube(&rings.map(|(y, radius)| (vec3(x, y, z), radius)), 16);
}

/// An arch under the vault.
fn rib(masonry: &mut Triangles, z: f32) {
    const HALF_SIZE: f32 = 0.17;
    let radius = ARCADE - 0.4;
    for i in 0..VAULT_PIECES {
        let step = PI / VAULT_PIECES as f32;
        let outward = on_vault((i as f32 + 0.5) * step);
        let along = outward.cross(Vec3::Z);
        let half_length = (radius + HALF_SIZE) * (0.5 * step).tan();
        masonry.block(
            vec3(0.0, VAULT, z) + radius * outward,
            [
                HALF_SIZE * outward,
                HALF_SIZE * Vec3::Z,
                -half_length * along,
            ],
        );
    }
}

/// From +X over +Y to -X.
fn on_vault(angle: f32) -> Vec3 {
    vec3(angle.cos(), angle.sin(), 0.0)
}

fn ceilings() -> Triangles {
    let mut ceilings = Triangles::default();
    ceilings.surface([2, VAULT_PIECES + 1], |column, row| {
        let z = HALF_LENGTH * (2.0 * column as f32 - 1.0);
        let angle = PI * row as f32 / VAULT_PIECES as f32;
        vec3(0.0, VAULT, z) + ARCADE * on_vault(angle)
    });
    for side in [-1.0, 1.0] {
        let corner = |x: f32, y: f32, end: f32| vec3(side * x, y, side * end * HALF_LENGTH);
        ceilings.plain_quad([
            corner(OUTER_WALL, AISLE_ROOF[0], -1.0),
            corner(ARCADE, AISLE_ROOF[1], -1.0),
            corner(ARCADE, AISLE_ROOF[1], 1.0),
            corner(OUTER_WALL, AISLE_ROOF[0], 1.0),
        ]);
    }
    ceilings
}

fn floor() -> Triangles {
    /// Side of a square of two by two tiles \[m].
    const TILES: f32 = 1.4;
    let (x, z) = (OUTER_WALL + WALL_THICKNESS, HALF_LENGTH + WALL_THICKNESS);
    let corners = [vec2(-x, z), vec2(x, z), vec2(x, -z), vec2(-x, -z)];
    let mut floor = Triangles::default();
    floor.quad(
        corners.map(|corner| vec3(corner.x, 0.0, corner.y)),
        corners.map(|corner: Vec2| corner / TILES),
    );
    floor
}

fn pews() -> Triangles {
    const ROWS: u32 = 17;
    const SPACING: f32 = 1.25;
    let mut pews = Triangles::default();
    for side in [-1.0, 1.0] {
        for row in 0..ROWS {
            let z = SPACING * row as f32 - 10.0;
            let mut plank = |x: [f32; 2], y: [f32; 2], dz: [f32; 2]| {
                let (a, b) = (side * x[0], side * x[1]);
                pews.cuboid(
                    vec3(a.min(b), y[0], z + dz[0]),
                    vec3(a.max(b), y[1], z + dz[1]),
                );
            };
            plank([0.9, 3.1], [0.42, 0.47], [-0.4, 0.0]);
            plank([0.9, 3.1], [0.30, 0.92], [0.0, 0.05]);
            plank([0.85, 0.9], [0.0, 0.98], [-0.42, 0.07]);
            plank([3.1, 3.15], [0.0, 0.98], [-0.42, 0.07]);
        }
    }
    pews
}

/// The glass of one kind in all windows that have it.
fn panes(kind: Glass) -> Triangles {
    let mut panes = Triangles::default();
    for (wall, _) in windows().iter().filter(|(_, glass)| *glass == kind) {
        panes.pane(wall);
    }
    panes
}
