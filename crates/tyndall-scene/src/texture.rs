//! Textures with mip levels, sampled as a GPU samples sRGB ones: decoded first, filtered then.

use std::sync::LazyLock;

use glam::{DVec2, DVec4};

use crate::scene::{Texture, Wrap};

/// A [`Texture`] with its mip chain, each level half as wide and high as the one before (rounded down, at least 1).
///
/// A level averages 2 x 2 texels of the level before in linear light and is stored sRGB-encoded again, so that a GPU
/// can take the very same levels.
#[derive(Clone, Debug)]
pub struct MipTexture {
    levels: Vec<MipLevel>,
    wrap: [Wrap; 2],
}

/// One level of a [`MipTexture`].
#[derive(Clone, Debug, PartialEq)]
pub struct MipLevel {
    /// Width and height \[texels].
    pub size: [u32; 2],
    /// sRGB-encoded RGB and linear alpha, row by row from the top left.
    pub texels: Vec<[u8; 4]>,
}

/// The sRGB transfer function (IEC 61966-2-1) from encoded to linear, in [0, 1].
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// The sRGB transfer function (IEC 61966-2-1) from linear to encoded, in [0, 1].
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

static LINEAR_FROM_BYTE: LazyLock<[f64; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| linear_from_srgb(i as f64 / 255.0)));

impl MipLevel {
    /// Linear RGBA of a texel.
    fn texel(&self, x: usize, y: usize) -> DVec4 {
        let [r, g, b, a] = self.texels[y * self.size[0] as usize + x];
        let table = &*LINEAR_FROM_BYTE;
        DVec4::new(
            table[usize::from(r)],
            table[usize::from(g)],
            table[usize::from(b)],
            f64::from(a) / 255.0,
        )
    }

    fn half(&self) -> Self {
        let size = self.size.map(|n| (n / 2).max(1));
        let last = self.size.map(|n| n as usize - 1);
        let texel = |i: usize| {
            let (x, y) = (2 * (i % size[0] as usize), 2 * (i / size[0] as usize));
            let (x1, y1) = ((x + 1).min(last[0]), (y + 1).min(last[1]));
            let sum = self.texel(x, y) + self.texel(x1, y) + self.texel(x, y1) + self.texel(x1, y1);
            let mean = 0.25 * sum;
            let byte = |v: f64| (255.0 * v).round() as u8;
            [
                byte(srgb_from_linear(mean.x)),
                byte(srgb_from_linear(mean.y)),
                byte(srgb_from_linear(mean.z)),
                byte(mean.w),
            ]
        };
        Self {
            texels: (0..size[0] as usize * size[1] as usize)
                .map(texel)
                .collect(),
            size,
        }
    }
}

impl MipTexture {
    /// Makes the levels down to 1 x 1.
    pub fn new(texture: &Texture) -> Self {
        let base = MipLevel {
            size: texture.size,
            texels: texture.texels.clone(),
        };
        let levels = std::iter::successors(Some(base), |level| {
            (level.size != [1, 1]).then(|| level.half())
        });
        Self {
            levels: levels.collect(),
            wrap: texture.wrap,
        }
    }

    /// The levels, largest first.
    pub fn levels(&self) -> &[MipLevel] {
        &self.levels
    }

    /// Linear RGBA at `uv`, bilinear between the texel centres of one level (clamped to the levels there are).
    pub fn bilinear(&self, uv: DVec2, level: usize) -> DVec4 {
        let level = &self.levels[level.min(self.levels.len() - 1)];
        let [(x0, x1, fx), (y0, y1, fy)] =
            [0, 1].map(|axis| neighbours(uv[axis], level.size[axis], self.wrap[axis]));
        let top = level.texel(x0, y0).lerp(level.texel(x1, y0), fx);
        let bottom = level.texel(x0, y1).lerp(level.texel(x1, y1), fx);
        top.lerp(bottom, fy)
    }

    /// Linear RGBA at `uv`, blended between the two levels round `lod` (0: the largest).
    pub fn trilinear(&self, uv: DVec2, lod: f64) -> DVec4 {
        let lod = lod.clamp(0.0, (self.levels.len() - 1) as f64);
        let fine = self.bilinear(uv, lod as usize);
        if lod.fract() == 0.0 {
            return fine;
        }
        fine.lerp(self.bilinear(uv, lod as usize + 1), lod.fract())
    }

    /// The level of detail at which neighbouring pixels, whose `uv` differ by `dx` and `dy`, are about a texel apart.
    pub fn lod(&self, dx: DVec2, dy: DVec2) -> f64 {
        let size = DVec2::from(self.levels[0].size.map(f64::from));
        let texels = (dx * size).length().max((dy * size).length());
        // The smallest level is right for a texture seen from infinitely far; NaN (0 * infinity) gives the largest.
        texels.max(1.0).log2()
    }
}

/// The two texels between which a coordinate lies, and how far it is towards the second.
fn neighbours(coordinate: f64, size: u32, wrap: Wrap) -> (usize, usize, f64) {
    let x = coordinate * f64::from(size) - 0.5;
    let low = x.floor();
    let texel = |i: i64| wrapped(i, i64::from(size), wrap) as usize;
    // Casts saturate: texture coordinates beyond any texel index stay in range.
    let low_index = (low as i64).clamp(-(1 << 52), 1 << 52);
    (texel(low_index), texel(low_index + 1), x - low)
}

fn wrapped(i: i64, size: i64, wrap: Wrap) -> i64 {
    match wrap {
        Wrap::Repeat => i.rem_euclid(size),
        Wrap::MirroredRepeat => {
            let j = i.rem_euclid(2 * size);
            j.min(2 * size - 1 - j)
        }
        Wrap::ClampToEdge => i.clamp(0, size - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(size: [u32; 2], wrap: Wrap, texel: impl Fn(u32, u32) -> [u8; 4]) -> MipTexture {
        let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        MipTexture::new(&Texture {
            size,
            texels: texels.map(|(x, y)| texel(x, y)).collect(),
            wrap: [wrap; 2],
        })
    }

    #[test]
    fn transfer_functions_are_inverse() {
        for i in 0..=255 {
            let encoded = f64::from(i) / 255.0;
            // 3e-8: the standard's rounded constants leave a step of this size at the knee.
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 3e-8);
        }
        // Mid grey, a known value of the standard.
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-6);
    }

    #[test]
    fn wraps_like_the_texture_again() {
        for (wrap, expected) in [
            (Wrap::Repeat, [1, 2, 0, 1, 2, 0, 1, 2, 0]),
            (Wrap::MirroredRepeat, [1, 0, 0, 1, 2, 2, 1, 0, 0]),
            (Wrap::ClampToEdge, [0, 0, 0, 1, 2, 2, 2, 2, 2]),
        ] {
            let found: Vec<i64> = (-2..7).map(|i| wrapped(i, 3, wrap)).collect();
            assert_eq!(found, expected, "{wrap:?}");
        }
    }

    #[test]
    fn is_bilinear_in_linear_light_between_texel_centres() {
        let t = texture([2, 1], Wrap::ClampToEdge, |x, _| {
            [x as u8 * 255, 0, 0, x as u8 * 255]
        });
        for (u, expected) in [(0.0, 0.0), (0.25, 0.0), (0.5, 0.5), (0.6, 0.7), (0.9, 1.0)] {
            let found = t.bilinear(DVec2::new(u, 0.5), 0);
            assert!((found.x - expected).abs() < 1e-12 && (found.w - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn levels_halve_and_keep_the_mean() {
        let t = texture([8, 4], Wrap::Repeat, |x, y| {
            [if (x + y) % 2 == 0 { 255 } else { 0 }; 4]
        });
        let sizes: Vec<_> = t.levels().iter().map(|l| l.size).collect();
        assert_eq!(sizes, [[8, 4], [4, 2], [2, 1], [1, 1]]);
        // Half the light, to the precision of 8 bits.
        for level in 1..4 {
            let found = t.bilinear(DVec2::splat(0.3), level);
            assert!((found.x - 0.5).abs() < 0.004 && (found.w - 0.5).abs() < 0.004);
        }
        assert_eq!(t.lod(DVec2::new(0.5, 0.0), DVec2::new(0.0, 0.25)), 2.0);
        let blend = t.trilinear(DVec2::splat(0.0625), 0.25).w;
        let (fine, coarse) = (t.bilinear(DVec2::splat(0.0625), 0).w, 128.0 / 255.0);
        assert!((blend - (0.75 * fine + 0.25 * coarse)).abs() < 1e-12);
    }

    #[test]
    fn no_coordinate_is_out_of_range() {
        for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            let t = texture([3, 5], wrap, |x, y| [x as u8, y as u8, 0, 255]);
            for u in [-1e300, -7.3, 0.0, 1.0, 1e18, f64::INFINITY, f64::NAN] {
                t.trilinear(DVec2::new(u, -u), u);
            }
        }
    }
}
