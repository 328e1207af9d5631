//! Random numbers and noise, equal on every machine.

use glam::{IVec2, Vec2, Vec3, vec2, vec3};
use rand_pcg::{Pcg32, rand_core::Rng as _};

/// Random numbers from a seed.
pub(super) struct Random(Pcg32);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg32::new(seed, 1))
    }

    /// Even in [0, 1).
    pub(super) fn unit(&mut self) -> f32 {
        // 24 bits are what an f32 holds.
        (self.0.next_u32() >> 8) as f32 / (1 << 24) as f32
    }

    /// Even in [low, high).
    pub(super) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Even in 0 .. count.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f32) as usize
    }

    /// Even in the unit ball.
    pub(super) fn in_ball(&mut self) -> Vec3 {
        loop {
            let point = vec3(
                self.between(-1.0, 1.0),
                self.between(-1.0, 1.0),
                self.between(-1.0, 1.0),
            );
            if point.length_squared() <= 1.0 {
                return point;
            }
        }
    }

    /// Even over the unit sphere.
    pub(super) fn direction(&mut self) -> Vec3 {
        loop {
            if let Some(direction) = self.in_ball().try_normalize() {
                return direction;
            }
        }
    }
}

/// Gradient noise in the plane (Perlin 1985, with the interpolant of Perlin 2002), within [-1, 1].
pub(super) fn gradient_noise(point: Vec2, seed: u32) -> f32 {
    let cell = point.floor();
    let within = point - cell;
    let weight = |t: Vec2| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let corner = |x: i32, y: i32| {
        let offset = vec2(x as f32, y as f32);
        gradient(cell.as_ivec2() + IVec2::new(x, y), seed).dot(within - offset)
    };
    let w = weight(within);
    let below = corner(0, 0) + w.x * (corner(1, 0) - corner(0, 0));
    let above = corner(0, 1) + w.x * (corner(1, 1) - corner(0, 1));
    std::f32::consts::SQRT_2 * (below + w.y * (above - below))
}

/// A unit vector that belongs to a lattice point.
fn gradient(cell: IVec2, seed: u32) -> Vec2 {
    let hash = hash(cell.x as u32, hash(cell.y as u32, seed));
    Vec2::from_angle(hash as f32 * (std::f32::consts::TAU / u32::MAX as f32))
}

/// PCG's output permutation as a hash (Jarzynski & Olano 2020).
fn hash(value: u32, seed: u32) -> u32 {
    let state = (value ^ seed.rotate_left(16))
        .wrapping_mul(747_796_405)
        .wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
