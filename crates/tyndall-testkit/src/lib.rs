//! What tyndall's tests and measurements share: [error metrics](metrics), [pictures](picture),
//! a [GPU device](device), a [harness for WGSL functions](wgsl), [checks of shaders and their layouts](shader),
//! [seeded samples](samples), [what rasterisers round](snapping), the [truth shots](truth) and a [count of skipped tests](skip).

pub mod device;
pub mod metrics;
pub mod picture;
pub mod samples;
pub mod shader;
pub mod skip;
pub mod snapping;
pub mod truth;
pub mod wgsl;
