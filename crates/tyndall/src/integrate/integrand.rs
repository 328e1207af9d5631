//! The integrand of single scattering.

use glam::DVec3;

use crate::{camera::Ray, light::LightModel, physics::medium::Optics};

/// Chen 2011, eq. 1, without visibility: `exp(-sigma_t s) sigma_s rho(theta) L_in(s)` [W/(m^3 sr)].
pub(crate) fn integrand(ray: &Ray, s: f64, model: &LightModel<'_>, optics: &Optics) -> DVec3 {
    let incident = model.incident(ray.at(s), optics);
    let cos_theta = -incident.direction.dot(ray.direction);
    optics.transmittance(s) * optics.scattering(cos_theta) * incident.irradiance
}
