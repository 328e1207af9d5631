//! `[camera]`: where the picture is taken from.

use glam::{DVec3, Vec3};
use tyndall::frame::{Camera, Projection};

use super::{
    error::{Location, Problem, ShotError},
    reader::{Field, Section},
};

/// A shot's keys about its camera; the rest comes from [`CameraBase`].
#[derive(Clone, Debug, PartialEq)]
pub struct CameraSpec {
    /// Source of everything that is left out.
    pub base: CameraBase,
    /// Position of the eye \[m].
    pub eye: Option<DVec3>,
    /// Point that the camera looks at \[m].
    pub target: Option<DVec3>,
    /// World-space direction that is up in the picture.
    pub up: Option<[f32; 3]>,
    /// Vertical field of view \[rad].
    pub yfov: Option<f32>,
    /// View depth of the near plane \[m].
    pub near: Option<f32>,
    /// View depth of the far plane \[m].
    pub far: Option<f32>,
    /// The place where the shot speaks of it.
    pub location: Location,
}

/// A camera before the shot's keys change it.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraBase {
    /// Nothing: the shot says where its eye and target are.
    Shot,
    /// The scene's camera of this name.
    Named(String),
    /// The scene's first camera, or one that frames the scene.
    Scene,
}

/// A scene's offers to a shot that leaves something of its camera out.
pub(crate) struct SceneCameras<'a> {
    /// Cameras by the names of their nodes.
    pub(crate) named: &'a [(String, Camera)],
    /// The scene's first camera, or one that frames the scene.
    pub(crate) framed: Option<Camera>,
    /// The point of the shot's and the scene's space that the cameras are relative to \[m].
    pub(crate) origin: DVec3,
    /// Distance from a point to the farthest corner of the scene \[m].
    pub(crate) farthest: &'a dyn Fn([f32; 3]) -> f32,
}

const DEFAULT_YFOV_DEG: f32 = 50.0;
/// Default near plane as a fraction of the far plane: a reversed depth buffer of 32-bit floats loses nothing by it.
const NEAR_OF_FAR: f32 = 1e-4;
/// Sine of the smallest angle between the view and the up direction.
const LEAST_UP_SINE: f32 = 1e-3;

const KEYS: [&str; 7] = ["name", "eye", "target", "up", "yfov_deg", "near", "far"];

impl CameraSpec {
    /// The scene's camera as it is.
    pub(super) fn of_scene(location: Location) -> Self {
        Self {
            base: CameraBase::Scene,
            eye: None,
            target: None,
            up: None,
            yfov: None,
            near: None,
            far: None,
            location,
        }
    }

    /// Reads `[camera]`. `in_file` is false where only the command line speaks of a camera: the scene's is changed.
    pub(super) fn read(field: &Field<'_>, in_file: bool) -> Result<Self, ShotError> {
        let section = field.section()?;
        section.only(&KEYS)?;
        let base = match (section.get("name"), in_file) {
            (Some(name), _) => CameraBase::Named(name.text("a camera's name")?.to_owned()),
            (None, true) => CameraBase::Shot,
            (None, false) => CameraBase::Scene,
        };
        let required = base == CameraBase::Shot;
        let spec = Self {
            base,
            eye: point(&section, "eye", required)?,
            target: point(&section, "target", required)?,
            up: section
                .get("up")
                .map(|field| field.direction())
                .transpose()?,
            yfov: yfov(&section)?,
            near: depth(&section, "near")?,
            far: depth(&section, "far")?,
            location: field.location(),
        };
        spec.check_target(&section)?;
        spec.check_depths(&section)?;
        Ok(spec)
    }

    fn check_target(&self, section: &Section<'_>) -> Result<(), ShotError> {
        let (Some(eye), Some(target)) = (self.eye, self.target) else {
            return Ok(());
        };
        let view = (target - eye).as_vec3();
        if view.try_normalize().is_none() {
            let target = section.require("target", "")?;
            return Err(target.unexpected("a point apart from camera.eye"));
        }
        match section.get("up") {
            Some(up) if !is_upright(view, self.up.unwrap_or_default()) => {
                Err(up.unexpected("a direction that is not parallel to the view"))
            }
            _ => Ok(()),
        }
    }

    fn check_depths(&self, section: &Section<'_>) -> Result<(), ShotError> {
        match (self.near, self.far) {
            (Some(near), Some(far)) if near >= far => {
                let field = section.require("near", "")?;
                Err(field.unexpected(format!("a number below camera.far = {far}")))
            }
            _ => Ok(()),
        }
    }

    /// The camera of a picture of this aspect ratio (width / height).
    pub(crate) fn resolve(
        &self,
        scene: &SceneCameras<'_>,
        aspect: f32,
    ) -> Result<Camera, ShotError> {
        let mut camera = match &self.base {
            CameraBase::Shot => self.look_at(scene, aspect),
            CameraBase::Scene => scene.framed.unwrap_or_else(|| self.look_at(scene, aspect)),
            CameraBase::Named(name) => find(scene.named, name).map_err(|p| self.error(p))?,
        };
        self.change_pose(&mut camera, scene.origin);
        self.change_projection(&mut camera.projection, aspect)?;
        self.check(&camera)?;
        Ok(camera)
    }

    fn look_at(&self, scene: &SceneCameras<'_>, aspect: f32) -> Camera {
        let point = |p: Option<DVec3>| relative(p.unwrap_or_default(), scene.origin);
        let eye = point(self.eye);
        let far = self
            .far
            .unwrap_or_else(|| (scene.farthest)(eye).max(2.0 * self.near.unwrap_or(0.5)));
        Camera::perspective(
            eye,
            point(self.target),
            [0.0, 1.0, 0.0],
            DEFAULT_YFOV_DEG.to_radians(),
            aspect,
            NEAR_OF_FAR * far,
            far,
        )
    }

    fn change_pose(&self, camera: &mut Camera, origin: DVec3) {
        if let Some(eye) = self.eye {
            camera.eye = relative(eye, origin);
        }
        if let Some(target) = self.target {
            let target = Vec3::from(relative(target, origin));
            camera.forward = (target - Vec3::from(camera.eye)).into();
        }
        match self.up {
            Some(up) => camera.up = up,
            // Looking straight up or down, north is up.
            None if !is_upright(camera.forward.into(), camera.up) => camera.up = [0.0, 0.0, -1.0],
            None => {}
        }
    }

    fn change_projection(&self, projection: &mut Projection, aspect: f32) -> Result<(), ShotError> {
        match projection {
            Projection::Perspective {
                half_extent,
                near,
                far,
                ..
            } => {
                if let Some(yfov) = self.yfov {
                    half_extent[1] = (0.5 * yfov).tan();
                }
                half_extent[0] = half_extent[1] * aspect;
                *near = self.near.unwrap_or(*near);
                *far = self.far.unwrap_or(*far);
            }
            Projection::Orthographic {
                half_extent,
                near,
                far,
                ..
            } => {
                if let Some(yfov) = self.yfov {
                    return Err(self.error(Problem::Value {
                        expected: "no camera.yfov_deg, because the camera is orthographic".into(),
                        found: yfov.to_degrees().to_string(),
                    }));
                }
                half_extent[0] = half_extent[1] * aspect;
                *near = self.near.unwrap_or(*near);
                *far = self.far.unwrap_or(*far);
            }
        }
        Ok(())
    }

    fn check(&self, camera: &Camera) -> Result<(), ShotError> {
        let (Projection::Perspective { near, far, .. }
        | Projection::Orthographic { near, far, .. }) = camera.projection;
        let problem = if Vec3::from(camera.forward).try_normalize().is_none() {
            ("eye and target apart", format!("both {:?}", camera.eye))
        } else if !is_upright(camera.forward.into(), camera.up) {
            (
                "up not parallel to the view",
                format!("up {:?}, view {:?}", camera.up, camera.forward),
            )
        } else if near >= far {
            ("near below far", format!("near {near}, far {far}"))
        } else {
            return Ok(());
        };
        Err(self.error(Problem::Value {
            expected: problem.0.into(),
            found: problem.1,
        }))
    }

    fn error(&self, problem: Problem) -> ShotError {
        ShotError::new(self.location.clone(), problem)
    }
}

/// A position relative to `origin`, rounded once.
pub(super) fn relative(position: DVec3, origin: DVec3) -> [f32; 3] {
    (position - origin).as_vec3().into()
}

fn is_upright(view: Vec3, up: [f32; 3]) -> bool {
    let sine = view
        .normalize_or_zero()
        .cross(Vec3::from(up).normalize_or_zero())
        .length();
    sine > LEAST_UP_SINE
}

fn find(cameras: &[(String, Camera)], name: &str) -> Result<Camera, Problem> {
    cameras
        .iter()
        .find(|(candidate, _)| candidate == name)
        .map(|(_, camera)| *camera)
        .ok_or_else(|| {
            let names: Vec<&str> = cameras.iter().map(|(name, _)| name.as_str()).collect();
            Problem::unknown_name("camera of the scene", name, &names)
        })
}

fn point(section: &Section<'_>, key: &str, required: bool) -> Result<Option<DVec3>, ShotError> {
    if required || section.get(key).is_some() {
        section.point(key).map(Some)
    } else {
        Ok(None)
    }
}

fn yfov(section: &Section<'_>) -> Result<Option<f32>, ShotError> {
    section
        .get("yfov_deg")
        .map(|field| {
            field.real("an angle above 0 and below 180 degrees", |x| {
                x > 0.0 && x < 180.0
            })
        })
        .transpose()
        .map(|angle| angle.map(f32::to_radians))
}

fn depth(section: &Section<'_>, key: &str) -> Result<Option<f32>, ShotError> {
    section
        .get(key)
        .map(|field| field.real("a number > 0", |x| x > 0.0))
        .transpose()
}
