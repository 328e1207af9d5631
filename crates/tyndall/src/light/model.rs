//! A light in f64: how much of it reaches a point, and from where, if nothing blocks it.

use glam::DVec3;

use super::{
    cone, hammersley::hammersley, radius::light_radius, source::LightSource,
    texture::TextureMapping,
};
use crate::{
    frame::{Camera, Emitter, Light},
    inputs::LightTexture,
    physics::{medium::Optics, reals},
};

/// An f64 view of a [`Light`] of one kind each: a rectangle is taken apart by [`LightModel::samples`].
#[derive(Clone, Debug)]
pub struct LightModel<'a> {
    shape: Shape,
    color: DVec3,
    radius: f64,
    texture: Option<(TextureMapping, &'a LightTexture)>,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Parallel {
        direction: DVec3,
    },
    Point {
        position: DVec3,
    },
    Spot {
        position: DVec3,
        axis: DVec3,
        cos_inner: f64,
        cos_outer: f64,
    },
    /// One sample of a rectangle: shines with a cosine about `normal`.
    Patch {
        position: DVec3,
        normal: DVec3,
    },
}

/// Light that arrives at a point.
#[derive(Clone, Copy, Debug)]
pub struct Incident {
    /// The mean direction in which it travels: of unit length, or shorter near the light
    /// ([`light_radius`](super::light_radius)).
    pub direction: DVec3,
    /// Irradiance on a surface that faces it [W/m^2].
    pub irradiance: DVec3,
}

impl<'a> LightModel<'a> {
    /// The light as `camera` sees it, as point sources: itself, or a rectangle's samples (Hammersley points).
    pub fn samples(light: &Light, camera: &Camera, texture: Option<&'a LightTexture>) -> Vec<Self> {
        let radius = light_radius(&light.emitter, camera);
        let mapping = light
            .texture
            .and_then(|placement| TextureMapping::new(&light.emitter, &placement))
            .zip(texture);
        let one = |shape, color| {
            vec![Self {
                shape,
                color: reals(color),
                radius,
                texture: mapping,
            }]
        };
        let unit = |direction| reals(direction).normalize_or_zero();
        match light.emitter {
            Emitter::Directional {
                direction,
                illuminance,
            } => one(
                Shape::Parallel {
                    direction: unit(direction),
                },
                illuminance,
            ),
            Emitter::Point {
                position,
                intensity,
                ..
            } => one(
                Shape::Point {
                    position: reals(position),
                },
                intensity,
            ),
            Emitter::Spot {
                position,
                direction,
                intensity,
                inner,
                outer,
                ..
            } => {
                let [cos_inner, cos_outer] = fade(inner, outer);
                one(
                    Shape::Spot {
                        position: reals(position),
                        axis: unit(direction),
                        cos_inner,
                        cos_outer,
                    },
                    intensity,
                )
            }
            Emitter::Rect {
                center,
                edge_x,
                edge_y,
                radiance,
                samples,
            } => {
                let (edge_x, edge_y) = (reals(edge_x), reals(edge_y));
                let normal = edge_x.cross(edge_y);
                let share = normal.length() / f64::from(samples);
                (0..samples)
                    .map(|i| {
                        let [u, v] = hammersley(i, samples);
                        let position = reals(center) + (u - 0.5) * edge_x + (v - 0.5) * edge_y;
                        let tint = mapping.map_or(DVec3::ONE, |(_, t)| t.sample([u, v]));
                        Self {
                            shape: Shape::Patch {
                                position,
                                normal: normal.normalize_or_zero(),
                            },
                            color: reals(radiance) * tint * share,
                            radius,
                            texture: None,
                        }
                    })
                    .collect()
            }
        }
    }

    /// The light's place, or the direction of the sun's light.
    pub fn source(&self) -> LightSource {
        match self.shape {
            Shape::Parallel { direction } => LightSource::Direction(direction.to_array()),
            Shape::Point { position }
            | Shape::Spot { position, .. }
            | Shape::Patch { position, .. } => LightSource::Position(position.to_array()),
        }
    }

    /// Its position; `None` for a directional light.
    pub fn position(&self) -> Option<DVec3> {
        match self.source() {
            LightSource::Direction(_) => None,
            LightSource::Position(p) => Some(p.into()),
        }
    }

    /// The direction in which a spot shines, and the angle of its cone \[rad]; `None` for other lights.
    pub(crate) fn cone(&self) -> Option<(DVec3, f64)> {
        match self.shape {
            Shape::Spot {
                axis, cos_outer, ..
            } => Some((axis, cos_outer.acos())),
            _ => None,
        }
    }

    /// True of a sample of a rectangle.
    pub(crate) fn is_of_area(&self) -> bool {
        matches!(self.shape, Shape::Patch { .. })
    }

    /// True where the light is the same along a view ray but for distance and angle:
    /// section 1's closed forms hold for it.
    pub fn is_plain(&self) -> bool {
        self.texture.is_none() && matches!(self.shape, Shape::Parallel { .. } | Shape::Point { .. })
    }

    /// The radius by which it is softened \[m]: see [`light_radius`](super::light_radius); 0 of the sun.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Illuminance [W/m^2] or intensity [W/sr] before cone, texture and distance.
    pub(crate) fn strength(&self) -> DVec3 {
        self.color
    }

    /// The part of the ray within `[a, b]` that the light can reach at all; empty where first >= second.
    pub fn reach(&self, origin: DVec3, direction: DVec3, [a, b]: [f64; 2]) -> [f64; 2] {
        match self.shape {
            Shape::Parallel { .. } | Shape::Point { .. } => [a, b],
            Shape::Spot {
                position,
                axis,
                cos_outer,
                ..
            } => cone::cone_interval(origin - position, direction, axis, cos_outer, [a, b]),
            Shape::Patch { position, normal } => {
                let height = (origin - position).dot(normal);
                let slope = direction.dot(normal);
                let crossing = -height / slope;
                match slope {
                    s if s > 0.0 => [a.max(crossing), b],
                    s if s < 0.0 => [a, b.min(crossing)],
                    _ if height > 0.0 => [a, b],
                    _ => [a, a],
                }
            }
        }
    }

    /// Appends distances within `(a, b)`, in any order, between which the light along the ray is smooth but for the
    /// small kinks at a texture's texels: the borders of a spot's inner cone and of the texture, and enough points
    /// between that no stretch spans many texels.
    pub(crate) fn breaks(
        &self,
        origin: DVec3,
        direction: DVec3,
        [a, b]: [f64; 2],
        breaks: &mut Vec<f64>,
    ) {
        if let Shape::Spot {
            position,
            axis,
            cos_inner,
            ..
        } = self.shape
        {
            let inner = cone::cone_interval(origin - position, direction, axis, cos_inner, [a, b]);
            breaks.extend(inner.iter().filter(|s| **s > a && **s < b));
        }
        if let Some((mapping, texture)) = &self.texture {
            mapping.breaks(origin, direction, [a, b], texture.size, breaks);
        }
    }

    /// The light that arrives at a point if nothing blocks it.
    pub fn incident(&self, point: DVec3, optics: &Optics) -> Incident {
        let irradiance = self.color * self.picture_at(point);
        let position = match self.shape {
            Shape::Parallel { direction } => {
                return Incident {
                    direction,
                    irradiance,
                };
            }
            Shape::Point { position }
            | Shape::Spot { position, .. }
            | Shape::Patch { position, .. } => position,
        };
        let offset = point - position;
        let distance = offset.length().hypot(self.radius);
        let falloff = self.falloff(offset);
        Incident {
            direction: offset / distance,
            irradiance: irradiance
                * optics.transmittance(distance)
                * (falloff / (distance * distance)),
        }
    }

    /// Transmission of the light ray through a point, on its whole length: texture and cone.
    pub(crate) fn ray_tint(&self, point: DVec3) -> DVec3 {
        let from_light = self.position().map_or(DVec3::ZERO, |p| point - p);
        self.picture_at(point) * self.falloff(from_light)
    }

    fn picture_at(&self, point: DVec3) -> DVec3 {
        self.texture.map_or(DVec3::ONE, |(mapping, texture)| {
            texture.sample(mapping.uv(point))
        })
    }

    /// The cone's transmission for light that gets this far from a local light \[m], or a patch's cosine.
    fn falloff(&self, offset: DVec3) -> f64 {
        match self.shape {
            Shape::Spot {
                axis,
                cos_inner,
                cos_outer,
                ..
            } => spot_falloff(offset.normalize_or_zero().dot(axis), cos_inner, cos_outer),
            Shape::Patch { normal, .. } => patch_cosine(offset, normal, self.radius),
            Shape::Parallel { .. } | Shape::Point { .. } => 1.0,
        }
    }
}

/// Cosines of the angles between which a spot fades, inner and outer. They lie 1e-3 apart at least, as `KHR_lights_punctual` has it:
/// a cone of equal angles has an edge of that width, and one that is narrower all over is nowhere as bright as its intensity.
pub(crate) fn fade(inner: f32, outer: f32) -> [f64; 2] {
    // f32's pi/2 is a little more than pi/2.
    let [inner, outer] = [inner, outer].map(|angle| f64::from(angle).cos().max(0.0));
    [inner.max(outer + 1e-3), outer]
}

/// The smooth edge of a spot's cone, as `KHR_lights_punctual` recommends it, between two cosines 1e-3 apart at least; 1 inside,
/// 0 outside.
pub fn spot_falloff(cos_angle: f64, cos_inner: f64, cos_outer: f64) -> f64 {
    let t = (cos_angle - cos_outer) / (cos_inner - cos_outer).max(1e-3);
    t.clamp(0.0, 1.0).powi(2)
}

/// The cosine at a sample of a rectangle that shines along `normal` (unit), for a point at `offset` from it \[m]; 0 behind it.
/// Lifted close to it, see [`patch_radius`](super::patch_radius).
pub fn patch_cosine(offset: DVec3, normal: DVec3, radius: f64) -> f64 {
    let distance = offset.length().hypot(radius);
    let (height, radius) = (offset.dot(normal) / distance, radius / distance);
    let over = height.hypot(radius);
    let lift = 3.0 * over * over * radius * radius / (over + height.abs());
    if height > 0.0 { height + lift } else { 0.0 }
}
