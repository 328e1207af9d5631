//! Vectors as the shaders' blocks hold them.

use glam::DVec3;

pub(super) fn floats(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}
