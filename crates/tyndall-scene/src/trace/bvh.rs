//! The bounding volume hierarchy (built by `obvhs`) and its two traversals.
//!
//! `obvhs`' own traversals take rays in f32. Ours may not miss a triangle that f64 arithmetic hits: boxes are padded by
//! more than the rounding errors of the f32 box tests, and triangles are left to the caller, who tests them in f64.

use std::{ops::Range, time::Duration};

use glam::{DVec3, Vec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2, node::Bvh2Node},
};

use crate::view::Ray;

/// Padding of the boxes, relative to the largest coordinate: an f32 slab test errs by less than 14 roundings (8e-7).
const PADDING: f32 = 2e-6;

/// A tree over some triangles of a scene.
pub(super) struct Tree {
    bvh: Bvh2,
    /// Largest coordinate of the triangles \[m].
    scale: f32,
    /// Offset of `bvh`'s leaves in the order of all triangles.
    offset: usize,
}

impl Tree {
    /// Builds a tree over the triangles `chosen`. It renumbers the n-th of its leaves' triangles to `order.len() + n`, and
    /// appends their old numbers to `order`.
    pub(super) fn new(triangles: &[[Vec3; 3]], chosen: &[u32], order: &mut Vec<u32>) -> Self {
        let boxes: Vec<Aabb> = chosen
            .iter()
            .map(|&t| Aabb::from_points(&triangles[t as usize].map(Vec3A::from)))
            .collect();
        let scale = boxes.iter().fold(0.0, |scale: f32, b| {
            scale.max(b.min.abs().max(b.max.abs()).max_element())
        });
        // The builder always measures its time.
        let mut build_time = Duration::ZERO;
        let mut bvh = if boxes.is_empty() {
            Bvh2::default()
        } else {
            build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut build_time)
        };
        let padding = Vec3A::splat(PADDING * scale);
        for node in &mut bvh.nodes {
            node.aabb = Aabb::new(node.aabb.min - padding, node.aabb.max + padding);
        }
        let offset = order.len();
        order.extend(bvh.primitive_indices.iter().map(|&i| chosen[i as usize]));
        Self { bvh, scale, offset }
    }

    /// True if there are no triangles.
    pub(super) fn is_empty(&self) -> bool {
        self.bvh.nodes.is_empty()
    }

    /// Largest coordinate of the triangles \[m].
    pub(super) fn scale(&self) -> f64 {
        f64::from(self.scale)
    }

    /// Calls `leaf` with triangles whose boxes the ray meets within `[from, to]`, roughly nearest first. `leaf` returns
    /// a new `to` where it has found something, which makes the search shorter; negative infinity ends it.
    pub(super) fn along(
        &self,
        ray: &Ray,
        [from, to]: [f64; 2],
        mut leaf: impl FnMut(usize) -> Option<f64>,
    ) {
        let Some(mut slabs) = self.enter(ray, [from, to]) else {
            return;
        };
        let nodes = &self.bvh.nodes;
        let mut stack: Vec<(u32, f32)> = Vec::with_capacity(64);
        stack.push((0, 0.0));
        while let Some((index, entry)) = stack.pop() {
            if entry > slabs.limit {
                continue;
            }
            let node = &nodes[index as usize];
            if node.is_leaf() {
                for triangle in self.triangles(node) {
                    if let Some(to) = leaf(triangle) {
                        slabs.shorten(to);
                    }
                }
                continue;
            }
            let children = [node.first_index, node.first_index + 1];
            let [first, second] = children.map(|c| (c, slabs.entry(&nodes[c as usize].aabb)));
            let nearer_last = match (first.1, second.1) {
                (Some(a), Some(b)) if a < b => [second, first],
                _ => [first, second],
            };
            stack.extend(nearer_last.into_iter().filter_map(|(c, t)| Some((c, t?))));
        }
    }

    /// Calls `leaf` with the triangles of all boxes that `enters` (given their middle and half their edges) takes.
    pub(super) fn within(
        &self,
        enters: impl Fn(Vec3A, Vec3A) -> bool,
        mut leaf: impl FnMut(usize),
    ) {
        let nodes = &self.bvh.nodes;
        let mut stack: Vec<u32> = Vec::with_capacity(64);
        stack.extend((!nodes.is_empty()).then_some(0));
        while let Some(index) = stack.pop() {
            let node = &nodes[index as usize];
            let (min, max) = (node.aabb.min, node.aabb.max);
            if !enters(0.5 * (min + max), 0.5 * (max - min)) {
                continue;
            }
            if node.is_leaf() {
                self.triangles(node).for_each(&mut leaf);
            } else {
                stack.extend([node.first_index, node.first_index + 1]);
            }
        }
    }

    /// A leaf's triangles.
    fn triangles(&self, leaf: &Bvh2Node) -> Range<usize> {
        let first = self.offset + leaf.first_index as usize;
        first..first + leaf.prim_count as usize
    }

    /// Starts the ray where it enters the tree: near the boxes, f32 is precise enough for them.
    fn enter(&self, ray: &Ray, [from, to]: [f64; 2]) -> Option<Slabs> {
        let root = self.bvh.nodes.first()?.aabb;
        let (min, max) = (root.min.as_dvec3(), root.max.as_dvec3());
        let inverse = DVec3::from(ray.direction.to_array().map(finite_inverse));
        let (a, b) = ((min - ray.origin) * inverse, (max - ray.origin) * inverse);
        let enter = a.min(b).max_element().max(from);
        let leave = a.max(b).min_element().min(to);
        (enter <= leave).then(|| {
            let mut slabs = Slabs {
                origin: ray.at(enter).as_vec3a(),
                inverse: inverse.as_vec3a(),
                start: enter,
                slack: PADDING * self.scale,
                limit: 0.0,
            };
            slabs.shorten(to);
            slabs
        })
    }
}

/// The inverse, kept finite for a direction without extent along an axis: zero times infinity would be NaN.
fn finite_inverse(x: f64) -> f64 {
    const LARGEST: f64 = 1e30;
    (1.0 / x).clamp(-LARGEST, LARGEST)
}

/// A ray prepared for box tests.
struct Slabs {
    origin: Vec3A,
    inverse: Vec3A,
    /// The ray's distance at `origin` \[m].
    start: f64,
    slack: f32,
    /// Distance from `origin` up to which boxes count \[m].
    limit: f32,
}

impl Slabs {
    fn shorten(&mut self, to: f64) {
        self.limit = (to - self.start) as f32 * (1.0 + PADDING) + self.slack;
    }

    /// Distance at which the ray enters the box; `None` where it misses.
    fn entry(&self, aabb: &Aabb) -> Option<f32> {
        let a = (aabb.min - self.origin) * self.inverse;
        let b = (aabb.max - self.origin) * self.inverse;
        let enter = a.min(b).max_element().max(0.0);
        let leave = a.max(b).min_element().min(self.limit);
        (enter <= leave).then_some(enter)
    }
}
