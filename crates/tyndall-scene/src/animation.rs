//! Keyframes of nodes' places, as glTF 2.0 has them (section 3.11 and appendix C).

use glam::{DAffine3, DVec3, Quat, Vec3};

/// The movement of one node relative to its parent. A property without a curve stays as it is at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeAnimation {
    /// Index into [`Scene::nodes`](crate::scene::Scene::nodes).
    pub node: usize,
    /// The node's place at rest.
    pub rest: Placement,
    /// Translation over time \[m].
    pub translation: Option<Curve<Vec3>>,
    /// Rotation over time, unit quaternions.
    pub rotation: Option<Curve<Quat>>,
    /// Scale over time.
    pub scale: Option<Curve<Vec3>>,
}

/// A place as translation, rotation and scale, applied from right to left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Translation \[m].
    pub translation: DVec3,
    /// Rotation, a unit quaternion.
    pub rotation: Quat,
    /// Scale along the node's own axes.
    pub scale: Vec3,
}

/// Values at times: the first key's before it, the last key's after it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<T> {
    /// Times of the keys, rising \[s]; at least one.
    pub times: Vec<f32>,
    /// One value a key; of cubic curves three: in-tangent, value, out-tangent.
    pub values: Vec<T>,
    /// Interpolation between keys.
    pub interpolation: Interpolation,
}

/// Interpolation between two keys of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The first key's value.
    Step,
    /// Linear; rotations turn along the shortest arc.
    Linear,
    /// A Hermite spline with the keys' tangents.
    Cubic,
}

/// A value that curves interpolate.
pub trait Animated: Copy {
    /// The value at `t` in [0, 1] between `a` and `b`.
    fn between(a: Self, b: Self, t: f32) -> Self;
    /// The sum of values times weights, made valid again.
    fn weighted(terms: [(Self, f32); 4]) -> Self;
}

impl Animated for Vec3 {
    fn between(a: Self, b: Self, t: f32) -> Self {
        a.lerp(b, t)
    }

    fn weighted(terms: [(Self, f32); 4]) -> Self {
        terms.iter().map(|(value, weight)| *value * *weight).sum()
    }
}

impl Animated for Quat {
    fn between(a: Self, b: Self, t: f32) -> Self {
        a.slerp(b, t)
    }

    fn weighted(terms: [(Self, f32); 4]) -> Self {
        let sum = terms.iter().fold(glam::Vec4::ZERO, |sum, (value, weight)| {
            sum + glam::Vec4::from(*value) * *weight
        });
        sum.try_normalize().map_or(terms[0].0, Self::from_vec4)
    }
}

impl<T: Animated> Curve<T> {
    /// The value at a time \[s]; `None` of a curve without keys.
    pub fn at(&self, seconds: f32) -> Option<T> {
        let after = self.times.partition_point(|time| *time <= seconds);
        let last = self.times.len().checked_sub(1)?;
        if after == 0 || after > last {
            return self.key(if after == 0 { 0 } else { last });
        }
        let before = after - 1;
        let span = self.times[after] - self.times[before];
        let t = (seconds - self.times[before]) / span;
        let (a, b) = (self.key(before)?, self.key(after)?);
        match self.interpolation {
            Interpolation::Step => Some(a),
            Interpolation::Linear => Some(T::between(a, b, t)),
            Interpolation::Cubic => {
                let (out, into) = (
                    self.values.get(3 * before + 2)?,
                    self.values.get(3 * after)?,
                );
                let (t2, t3) = (t * t, t * t * t);
                Some(T::weighted([
                    (a, 2.0 * t3 - 3.0 * t2 + 1.0),
                    (*out, span * (t3 - 2.0 * t2 + t)),
                    (b, -2.0 * t3 + 3.0 * t2),
                    (*into, span * (t3 - t2)),
                ]))
            }
        }
    }

    fn key(&self, index: usize) -> Option<T> {
        let at = match self.interpolation {
            Interpolation::Step | Interpolation::Linear => index,
            Interpolation::Cubic => 3 * index + 1,
        };
        self.values.get(at).copied()
    }
}

impl From<Placement> for DAffine3 {
    fn from(place: Placement) -> Self {
        Self::from_scale_rotation_translation(
            place.scale.as_dvec3(),
            place.rotation.as_dquat().normalize(),
            place.translation,
        )
    }
}

impl NodeAnimation {
    /// The node's place at a time \[s], relative to its parent.
    pub fn at(&self, seconds: f32) -> Placement {
        fn value<T: Animated>(curve: &Option<Curve<T>>, seconds: f32, rest: T) -> T {
            let curve = curve.as_ref();
            curve.and_then(|curve| curve.at(seconds)).unwrap_or(rest)
        }
        let rotation = value(&self.rotation, seconds, self.rest.rotation);
        let translation = self.translation.as_ref();
        Placement {
            translation: translation
                .and_then(|curve| curve.at(seconds))
                .map_or(self.rest.translation, |moved| moved.as_dvec3()),
            // A file's rotations may be zeros.
            rotation: glam::Vec4::from(rotation)
                .try_normalize()
                .map_or(self.rest.rotation, Quat::from_vec4),
            scale: value(&self.scale, seconds, self.rest.scale),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(interpolation: Interpolation, values: &[f32]) -> Curve<Vec3> {
        Curve {
            times: vec![1.0, 2.0, 4.0],
            values: values.iter().map(|x| Vec3::splat(*x)).collect(),
            interpolation,
        }
    }

    #[test]
    fn curves_pass_their_keys_and_stay_at_their_ends() {
        let plain = [5.0, 7.0, 3.0];
        let spline = [0.0, 5.0, 0.0, 0.0, 7.0, 0.0, 0.0, 3.0, 0.0];
        for (curve, at_one_and_a_half) in [
            (curve(Interpolation::Step, &plain), 5.0),
            (curve(Interpolation::Linear, &plain), 6.0),
            (curve(Interpolation::Cubic, &spline), 6.0),
        ] {
            for (seconds, expected) in [
                (-1.0, 5.0),
                (1.0, 5.0),
                (1.5, at_one_and_a_half),
                (2.0, 7.0),
                (4.0, 3.0),
                (9.0, 3.0),
            ] {
                let found = curve.at(seconds).unwrap();
                assert_eq!(found, Vec3::splat(expected), "{curve:?} at {seconds}");
            }
        }
        assert_eq!(curve(Interpolation::Linear, &[]).at(1.5), None);
    }

    #[test]
    fn tangents_are_slopes() {
        // x^3 - x on 0..2: a cubic is its own Hermite spline.
        let value = |x: f32| x * x * x - x;
        let slope = |x: f32| 3.0 * x * x - 1.0;
        let keys = [0.0, 2.0];
        let curve = Curve {
            times: keys.to_vec(),
            values: keys
                .iter()
                .flat_map(|x| [slope(*x), value(*x), slope(*x)].map(Vec3::splat))
                .collect(),
            interpolation: Interpolation::Cubic,
        };
        for x in [0.25, 1.0, 1.75] {
            let error = curve.at(x).unwrap().x - value(x);
            assert!(error.abs() < 1e-6, "{x}: {error}");
        }
    }

    #[test]
    fn rotations_turn_along_the_short_arc_and_stay_unit() {
        let turn = Quat::from_rotation_y;
        let linear = Curve {
            times: vec![0.0, 1.0],
            values: vec![turn(0.2), -turn(0.8)],
            interpolation: Interpolation::Linear,
        };
        assert!(linear.at(0.5).unwrap().abs_diff_eq(turn(0.5), 1e-6));
        let cubic = Curve {
            times: vec![0.0, 1.0],
            values: vec![
                Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
                turn(0.0),
                Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
                Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
                turn(1.0),
                Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
            ],
            interpolation: Interpolation::Cubic,
        };
        let middle = cubic.at(0.5).unwrap();
        assert!(middle.is_normalized() && middle.abs_diff_eq(turn(0.5), 1e-6));
    }
}
