//! A frame as plain data: the same [`Frame`] drives the GPU and the CPU.
//!
//! World space is right-handed; lengths are metres, angles radians, colours linear RGB. So that squares and products stay finite in f32,
//! lengths are 1e12 m at most (1e-9 m at least where they must not be 0), coefficients 1e9 1/m, strengths of lights 1e18.
//!
//! Its origin is the caller's to choose, and single precision holds what is near it: in a large world, subtract a point near the
//! eye from all positions (and put it into the matrices of shadow maps) in double precision, before they become a frame. Keep
//! the point while it is near, for what temporal reuse keeps is relative to it: turn reuse off for the frame that moves it.

pub use crate::phase::Phase;
use crate::phase::droplets::droplets;

/// One view of one moment: everything a technique needs besides textures (depth, shadow maps).
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The camera that sees it.
    pub camera: Camera,
    /// The lights, in the order of the inputs that belong to them. Their in-scattered light adds up.
    pub lights: Vec<Light>,
    /// The medium that fills all space.
    pub medium: Medium,
}

/// A camera: eye, orientation, projection and the convention of its depth buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World-space position of the eye (orthographic: of the plane that depth is measured from) \[m]; within 8192 far planes of
    /// the origin, see the module's head.
    pub eye: [f32; 3],
    /// World-space viewing direction; need not be of unit length, must not be zero.
    pub forward: [f32; 3],
    /// World-space direction that is up in the image; need not be normal to `forward`, must not be parallel to it.
    pub up: [f32; 3],
    /// The projection.
    pub projection: Projection,
    /// The convention of the depth buffer.
    pub depth_range: DepthRange,
}

/// The convention by which a depth buffer stores view depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthRange {
    /// 0 at the near plane, 1 at the far plane.
    Standard,
    /// 1 at the near plane, 0 at the far plane ("reversed z").
    Reversed,
    /// near / view depth: 1 at the near plane, 0 at infinity. Perspective only. Rays end at view depth `far` at the
    /// latest: there is no medium beyond.
    ReversedInfinite,
}

impl DepthRange {
    /// True where nearer surfaces have larger values.
    pub fn is_reversed(self) -> bool {
        self != Self::Standard
    }

    /// The depth buffer's value where nothing was drawn.
    pub fn far_value(self) -> f32 {
        if self.is_reversed() { 0.0 } else { 1.0 }
    }
}

/// The projection of view space onto the image. Depth runs along the viewing direction.
///
/// A point of the image at normalised device coordinates (x, y) in [-1, 1], y up, lies at
/// `center + half_extent * (x, y)` on the plane at view depth 1 (perspective) or at any depth (orthographic).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays pass through the eye.
    Perspective {
        /// Tangents of half the horizontal and vertical field of view (> 0).
        half_extent: [f32; 2],
        /// Tangents of the image's centre off the viewing direction; zero but for jitter and stereo.
        center: [f32; 2],
        /// View depth of the near plane \[m] (> 0).
        near: f32,
        /// View depth where rays that hit nothing end \[m] (> near, finite).
        far: f32,
    },
    /// All rays are parallel to the viewing direction and start at view depth 0.
    Orthographic {
        /// Half the image's width and height \[m] (> 0).
        half_extent: [f32; 2],
        /// The image's centre off the viewing axis \[m].
        center: [f32; 2],
        /// View depth of the near plane \[m].
        near: f32,
        /// View depth where rays that hit nothing end \[m] (> near, finite).
        far: f32,
    },
}

impl Camera {
    /// A symmetric perspective camera with reversed depth.
    /// `yfov` is the whole vertical field of view \[rad], `aspect` is width / height, `near` and `far` are view depths \[m].
    pub fn perspective(
        eye: [f32; 3],
        target: [f32; 3],
        up: [f32; 3],
        yfov: f32,
        aspect: f32,
        near: f32,
        far: f32,
    ) -> Self {
        let tangent = (0.5 * yfov).tan();
        Self {
            eye,
            forward: std::array::from_fn(|i| target[i] - eye[i]),
            up,
            projection: Projection::Perspective {
                half_extent: [tangent * aspect, tangent],
                center: [0.0; 2],
                near,
                far,
            },
            depth_range: DepthRange::Reversed,
        }
    }

    /// The same camera with the centres of the pixels of a picture of `size` moved by so many pixels, to the right and up, as
    /// temporal antialiasing does.
    #[must_use]
    pub fn jittered(&self, size: [u32; 2], pixels: [f64; 2]) -> Self {
        let mut jittered = *self;
        let (Projection::Perspective {
            half_extent,
            center,
            ..
        }
        | Projection::Orthographic {
            half_extent,
            center,
            ..
        }) = &mut jittered.projection;
        for axis in 0..2 {
            let pixel = 2.0 * f64::from(half_extent[axis]) / f64::from(size[axis]);
            center[axis] += (pixel * pixels[axis]) as f32;
        }
        jittered
    }
}

/// A light, the map that holds its shadows, and the texture it shines through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The emitter and its strength.
    pub emitter: Emitter,
    /// The projection of the light's shadow map; `None`: nothing blocks this light, unless visibility is traced.
    pub shadow: Option<ShadowProjection>,
    /// The placement of the light's texture; `None`: white light.
    pub texture: Option<TexturePlacement>,
}

/// An emitter and its strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Emitter {
    /// The sun: parallel light that reaches every unblocked point with its full illuminance (Chen 2011, section 3.1).
    Directional {
        /// The direction in which the light travels; need not be of unit length.
        direction: [f32; 3],
        /// Irradiance on a surface that faces the light [W/m^2].
        illuminance: [f32; 3],
    },
    /// A point that shines evenly to all sides.
    Point {
        /// World-space position \[m].
        position: [f32; 3],
        /// Radiant intensity [W/sr].
        intensity: [f32; 3],
        /// Radius by which the lamp is softened \[m] (>= 0): at distance d its light is as that of a point at hypot(d, radius), so
        /// that it stays finite at its very place. 0 is a point, taken as a millionth of its distance from the eye or a thousandth
        /// of the near plane's, whichever is more; see [`light_radius`](crate::light::light_radius).
        radius: f32,
    },
    /// A point that shines into a cone, with `KHR_lights_punctual`'s smooth edge.
    Spot {
        /// World-space position \[m].
        position: [f32; 3],
        /// The cone's axis, the direction in which the light travels; need not be of unit length.
        direction: [f32; 3],
        /// Radiant intensity on the axis [W/sr].
        intensity: [f32; 3],
        /// Angle from the axis where the light begins to fade \[rad] (0 <= inner <= outer).
        inner: f32,
        /// Angle from the axis where the light ends \[rad] (<= pi/2; below it with a texture).
        outer: f32,
        /// Radius by which the lamp is softened \[m] (>= 0), as a point's.
        radius: f32,
    },
    /// A rectangle that shines to one side, along cross(edge_x, edge_y), with a cosine. Each of its samples stands for a patch of it
    /// and is softened by as much ([`patch_radius`](crate::light::patch_radius)).
    Rect {
        /// World-space middle of the rectangle \[m].
        center: [f32; 3],
        /// World-space edge from the texture's left to its right \[m].
        edge_x: [f32; 3],
        /// World-space edge from the texture's top to its bottom \[m].
        edge_y: [f32; 3],
        /// Radiance of the bright side [W/(m^2 sr)].
        radiance: [f32; 3],
        /// Number of point samples that stand for it (1 ..= 1024).
        samples: u32,
    },
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// Parallel light.
    Directional,
    /// A point.
    Point,
    /// A point with a cone.
    Spot,
    /// A rectangle.
    Rect,
}

impl LightKind {
    /// The kind of an emitter.
    pub fn of(emitter: &Emitter) -> Self {
        match emitter {
            Emitter::Directional { .. } => Self::Directional,
            Emitter::Point { .. } => Self::Point,
            Emitter::Spot { .. } => Self::Spot,
            Emitter::Rect { .. } => Self::Rect,
        }
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Directional => "directional",
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Rect => "rect",
        }
    }
}

impl Light {
    /// Its kind.
    pub fn kind(&self) -> LightKind {
        LightKind::of(&self.emitter)
    }

    /// Faces of its shadow map: 6 for a cube, else 1.
    pub fn faces(&self) -> u32 {
        match self.shadow {
            Some(ShadowProjection::Cube { .. }) => 6,
            _ => 1,
        }
    }
}

/// The projection that a shadow map was rendered with. Its depth is a depth buffer's: clip z / clip w in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadowProjection {
    /// One square or oblong map: a directional light's orthographic or a spot's perspective one, which
    /// gets coarse as the cone widens: beyond some 70 degrees a cube is the better one.
    Single {
        /// World space to the map's clip space, column-major, z in [0, 1], y up.
        clip_from_world: [[f32; 4]; 4],
        /// True where the map holds 1 at its near plane and 0 at its far plane.
        reversed_depth: bool,
    },
    /// Six square faces round a point light or a spot, 90 degrees each, in the order +X, -X, +Y, -Y, +Z, -Z
    /// and with the orientation of WebGPU's and Direct3D's cube textures.
    Cube {
        /// Distance of each face's near plane along its axis \[m] (> 0).
        near: f32,
        /// Distance of each face's far plane along its axis \[m] (> near, finite).
        far: f32,
        /// True where the map holds 1 at its near plane and 0 at its far plane.
        reversed_depth: bool,
    },
}

/// The placement of a light's texture, which is bilinear between texel centres and black outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TexturePlacement {
    /// Directional light: the texture fills this parallelogram, projected along the light.
    Parallelogram {
        /// World-space middle \[m].
        center: [f32; 3],
        /// World-space edge from the texture's left to its right \[m].
        edge_x: [f32; 3],
        /// World-space edge from the texture's top to its bottom \[m].
        edge_y: [f32; 3],
    },
    /// Spot light: the texture fills the square round the cone, tan(outer) to each side of the axis: outer < pi/2.
    Cone {
        /// World-space direction that is up in the texture; must not be parallel to the axis.
        up: [f32; 3],
    },
    /// Point light: the texture is wrapped round the sphere of directions, longitude from left to right
    /// (seen from the light, eastward), latitude from top to bottom.
    Sphere {
        /// World-space direction of the texture's upper edge.
        up: [f32; 3],
        /// World-space direction of the texture's middle; must not be parallel to `up`.
        forward: [f32; 3],
    },
    /// Rectangular light: the texture fills the rectangle.
    Rectangle,
}

/// A homogeneous medium, the sum of its components (air is Rayleigh + Mie).
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// The components of the mixture; none is a vacuum. At most [`Medium::MAX_COMPONENTS`].
    pub components: Vec<MediumComponent>,
}

impl Medium {
    /// The most components a medium may have.
    pub const MAX_COMPONENTS: usize = 4;
}

/// One constituent of a medium, with its own coefficients and phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumComponent {
    /// Scattering coefficient per channel [1/m] (>= 0).
    pub sigma_s: [f32; 3],
    /// Absorption coefficient per channel [1/m] (>= 0).
    pub sigma_a: [f32; 3],
    /// The phase function.
    pub phase: Phase,
}

impl MediumComponent {
    /// Fog or cloud of water droplets of this diameter \[um], 5 to 50: two components that share the coefficients [1/m], a wide
    /// lobe and a narrow forward peak; see [`droplets`] (Jendersie & d'Eon 2023). `None`
    /// where the diameter is out of range.
    pub fn fog_droplets(sigma_s: [f32; 3], sigma_a: [f32; 3], diameter: f32) -> Option<[Self; 2]> {
        let parts = droplets(diameter)?;
        Some(parts.map(|(share, phase)| Self {
            sigma_s: sigma_s.map(|x| (f64::from(x) * share) as f32),
            sigma_a: sigma_a.map(|x| (f64::from(x) * share) as f32),
            phase,
        }))
    }
}
