//! The scene made ready for rays, and their hits.

use glam::{DVec2, DVec3};

use super::{bvh::Tree, surface::Surface, triangle::TriangleRay};
use crate::{geometry::Geometry, scene::Scene, texture::MipTexture, view::Ray};

/// A scene made ready for rays. It owns all it needs; building it takes about a microsecond a triangle.
pub struct Tracer {
    pub(super) geometry: Geometry,
    /// Triangles that light and view rays can end on.
    pub(super) blockers: Tree,
    /// Triangles that change the rays' colour.
    pub(super) glass: Tree,
    surfaces: Vec<Surface>,
    pub(super) textures: Vec<MipTexture>,
}

/// A point of a surface that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray \[m].
    pub distance: f64,
    /// Index into the arrays of [`Tracer::geometry`].
    pub triangle: usize,
    /// Weights of the triangle's corners; they add up to 1.
    pub weights: DVec3,
}

/// Glass or a blended surface that a ray passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassHit {
    /// Distance along the ray \[m].
    pub distance: f64,
    /// Factor on the light, linear RGB.
    pub tint: DVec3,
}

impl Tracer {
    /// Flattens the scene and builds its tree.
    pub fn new(scene: &Scene) -> Self {
        let geometry = Geometry::new(scene);
        let textures: Vec<MipTexture> = scene.textures.iter().map(MipTexture::new).collect();
        let surfaces: Vec<Surface> = scene
            .materials
            .iter()
            .map(|material| Surface::new(material, &textures))
            .collect();
        let surface = |triangle: &u32| &surfaces[geometry.materials[*triangle as usize] as usize];
        let count = geometry.len() as u32;
        let (blockers, others): (Vec<u32>, Vec<u32>) =
            (0..count).partition(|t| surface(t).can_block());
        let (glass, clear): (Vec<u32>, Vec<u32>) =
            others.iter().partition(|t| surface(t).is_tinted_glass());
        let mut order = Vec::with_capacity(geometry.len());
        let blockers = Tree::new(&geometry.positions, &blockers, &mut order);
        let glass = Tree::new(&geometry.positions, &glass, &mut order);
        order.extend(clear);
        Self {
            geometry: geometry.reordered(&order),
            blockers,
            glass,
            surfaces,
            textures,
        }
    }

    /// The scene's triangles, in the order that hits refer to.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The first opaque surface at a distance within `range` \[m]. Surfaces with holes (MASK) count where the alpha of
    /// their texture's largest level, sampled bilinearly, is at least the cutoff; glass and blended surfaces don't.
    /// Surfaces have two sides. No ray slips through between triangles that share their corners' coordinates.
    pub fn closest(&self, ray: &Ray, range: [f64; 2]) -> Option<Hit> {
        let prepared = TriangleRay::new(ray);
        let [from, mut to] = range;
        let mut closest = None;
        self.blockers.along(ray, range, |triangle| {
            let hit = self.meet(&prepared, triangle)?;
            if !(from..=to).contains(&hit.distance) || !self.blocks(&hit) {
                return None;
            }
            to = hit.distance;
            closest = Some(hit);
            Some(to)
        });
        closest
    }

    /// True if any opaque surface is at a distance within `range` \[m]; see [`Tracer::closest`].
    pub fn blocked(&self, ray: &Ray, range: [f64; 2]) -> bool {
        let prepared = TriangleRay::new(ray);
        let [from, to] = range;
        let mut blocked = false;
        self.blockers.along(ray, range, |triangle| {
            let hit = self.meet(&prepared, triangle)?;
            blocked |= (from..=to).contains(&hit.distance) && self.blocks(&hit);
            blocked.then_some(f64::NEG_INFINITY)
        });
        blocked
    }

    /// Appends the glass and blended surfaces at distances within `range` \[m], in any order; clear glass is left out.
    pub fn glass(&self, ray: &Ray, range: [f64; 2], hits: &mut Vec<GlassHit>) {
        let prepared = TriangleRay::new(ray);
        let [from, to] = range;
        self.glass.along(ray, range, |triangle| {
            let hit = self.meet(&prepared, triangle)?;
            let tint = self.tint(&hit);
            if (from..=to).contains(&hit.distance) && tint != DVec3::ONE {
                hits.push(GlassHit {
                    distance: hit.distance,
                    tint,
                });
            }
            None
        });
    }

    /// True if glass or a blended surface changes the colour of light somewhere.
    pub fn has_tinted_glass(&self) -> bool {
        !self.glass.is_empty()
    }

    /// The largest coordinate of any surface that changes light \[m].
    pub(super) fn scale(&self) -> f64 {
        self.blockers.scale().max(self.glass.scale())
    }

    /// The surface that a triangle is made of.
    pub(super) fn surface(&self, triangle: usize) -> &Surface {
        &self.surfaces[self.geometry.materials[triangle] as usize]
    }

    fn meet(&self, ray: &TriangleRay, triangle: usize) -> Option<Hit> {
        let crossing = ray.meet(&self.geometry.positions[triangle])?;
        Some(Hit {
            distance: crossing.distance,
            triangle,
            weights: crossing.weights,
        })
    }

    /// True if the surface is opaque: not in a hole.
    pub(super) fn blocks(&self, hit: &Hit) -> bool {
        self.tint(hit) == DVec3::ZERO
    }

    /// Factor on light at a hit: zero where it is blocked.
    fn tint(&self, hit: &Hit) -> DVec3 {
        let surface = self.surface(hit.triangle);
        surface
            .uniform
            .unwrap_or_else(|| surface.tint_at(&self.textures, self.uv(hit.triangle, hit.weights)))
    }

    /// Texture coordinates of a point of a triangle.
    pub(super) fn uv(&self, triangle: usize, weights: DVec3) -> DVec2 {
        let [a, b, c] = self.geometry.uvs[triangle].map(|uv| uv.as_dvec2());
        weights.x * a + weights.y * b + weights.z * c
    }
}
