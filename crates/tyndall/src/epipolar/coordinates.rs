//! The axis of one eye and one light, and the coordinates of rays about it.

use std::f64::consts::PI;

use glam::DVec3;

use crate::light::LightSource;

/// The axis of one eye and one light, and the coordinates about it.
#[derive(Clone, Copy, Debug)]
pub struct EpipolarFrame {
    eye: DVec3,
    axis: DVec3,
    /// Directions of alpha = 0 and alpha = pi/2.
    across: [DVec3; 2],
    /// Distance of a local light from the eye \[m]; `None`: the sun.
    distance: Option<f64>,
}

impl EpipolarFrame {
    /// `None` where the eye is at the light: there is no axis.
    pub fn new(eye: DVec3, light: LightSource) -> Option<Self> {
        let (axis, distance) = match light {
            LightSource::Direction(direction) => (-DVec3::from(direction), None),
            LightSource::Position(position) => {
                let to_light = DVec3::from(position) - eye;
                (to_light.try_normalize()?, Some(to_light.length()))
            }
        };
        let (u, v) = axis.any_orthonormal_pair();
        Some(Self {
            eye,
            axis,
            across: [u, v],
            distance,
        })
    }

    /// The axis: towards the light, unit length.
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// Distance of a local light from the eye \[m]; `None`: the sun.
    pub fn distance(&self) -> Option<f64> {
        self.distance
    }

    /// alpha in [0, 2 pi) and beta in [0, pi] of a view ray of unit direction.
    pub fn view_ray(&self, direction: DVec3) -> (f64, f64) {
        let [x, y] = self.across.map(|u| u.dot(direction));
        let alpha = y.atan2(x).rem_euclid(2.0 * PI);
        (alpha, x.hypot(y).atan2(direction.dot(self.axis)))
    }

    /// The unit direction of a view ray.
    pub fn view_direction(&self, alpha: f64, beta: f64) -> DVec3 {
        beta.cos() * self.axis + beta.sin() * self.outward(alpha)
    }

    /// gamma of the point at distance `s` \[m] of a view ray.
    pub fn gamma(&self, beta: f64, s: f64) -> f64 {
        let across = s * beta.sin();
        match self.distance {
            None => across,
            Some(distance) => across.atan2(distance - s * beta.cos()),
        }
    }

    /// Distance \[m] along a view ray where the light ray `gamma` crosses it; infinite where they do not meet.
    pub fn crossing(&self, beta: f64, gamma: f64) -> f64 {
        match self.distance {
            None => gamma / beta.sin(),
            Some(_) if beta + gamma >= PI => f64::INFINITY,
            Some(distance) => distance * gamma.sin() / (beta + gamma).sin(),
        }
    }

    /// The light ray of a slice: a point on it, and the direction in which it travels. For the sun, the point beside the
    /// eye.
    pub fn light_ray(&self, alpha: f64, gamma: f64) -> (DVec3, DVec3) {
        let outward = self.outward(alpha);
        match self.distance {
            None => (self.eye + gamma * outward, -self.axis),
            Some(distance) => (
                self.eye + distance * self.axis,
                gamma.sin() * outward - gamma.cos() * self.axis,
            ),
        }
    }

    /// S of a light ray that ends at distance `end` \[m] from its point (infinite: never): the point of a view ray on
    /// this light ray is lit iff beta < S.
    pub fn shadow_angle(&self, gamma: f64, end: f64) -> f64 {
        match self.distance {
            None => gamma.atan2(-end),
            Some(_) if end == f64::INFINITY => PI - gamma,
            Some(distance) => (end * gamma.sin()).atan2(distance - end * gamma.cos()),
        }
    }

    fn outward(&self, alpha: f64) -> DVec3 {
        alpha.cos() * self.across[0] + alpha.sin() * self.across[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::samples::in_box;

    fn light(x: &[f32], local: bool) -> LightSource {
        let v = DVec3::new(x[0].into(), x[1].into(), x[2].into());
        if local {
            LightSource::Position((8.0 * v).to_array())
        } else {
            LightSource::Direction((v + 1e-3).normalize().to_array())
        }
    }

    /// Coordinates there and back, and the definition of S, against points and vectors in space.
    #[test]
    fn coordinates_are_those_of_points_in_space() {
        let mut lit = [0; 2];
        for (i, x) in in_box(3, 4000, [const { -1.0..=1.0 }; 8])
            .iter()
            .enumerate()
        {
            let local = i % 2 == 0;
            let eye = DVec3::new(0.3, -0.2, 0.9);
            let source = light(&x[..3], local);
            let Some(frame) = EpipolarFrame::new(eye, source) else {
                continue;
            };
            let direction = DVec3::new(x[3].into(), x[4].into(), x[5].into());
            let Some(direction) = direction.try_normalize() else {
                continue;
            };
            let (alpha, beta) = frame.view_ray(direction);
            assert!((frame.view_direction(alpha, beta) - direction).length() < 1e-12);
            if beta.sin() < 1e-6 {
                continue;
            }
            let s = 0.01 + 6.0 * f64::from(x[6] + 1.0);
            let gamma = frame.gamma(beta, s);
            // The light ray gamma passes through the point, and meets the view ray at s.
            let (origin, travel) = frame.light_ray(alpha, gamma);
            let point = eye + s * direction;
            let along = (point - origin).dot(travel);
            assert!((origin + along * travel - point).length() < 1e-9);
            assert!((frame.crossing(beta, gamma) / s - 1.0).abs() < 1e-6);
            // Light that ends before the point leaves it dark, light that ends behind it does not.
            let end = if local {
                along * (1.0 + f64::from(x[7]))
            } else {
                along + 3.0 * f64::from(x[7])
            };
            if (end - along).abs() > 1e-6 {
                let is_lit = beta < frame.shadow_angle(gamma, end);
                assert_eq!(is_lit, end > along, "{x:?}");
                lit[usize::from(is_lit)] += 1;
            }
            assert!(beta < frame.shadow_angle(gamma, f64::INFINITY));
        }
        assert!(lit.iter().all(|n| *n > 1000), "{lit:?}");
    }

    #[test]
    fn an_eye_at_the_light_has_no_axis() {
        assert!(EpipolarFrame::new(DVec3::ONE, LightSource::Position([1.0; 3])).is_none());
    }
}
