//! WGSL: plain files of one topic each, joined by the lists below. No preprocessor.

/// Phase functions.
pub(crate) const PHASE: &str = include_str!("../physics/phase.wgsl");
/// Extinction.
pub(crate) const TRANSMITTANCE: &str = include_str!("../physics/transmittance.wgsl");
/// Airlight of point lights; needs `CHOICE` and a texture `airlight_table`.
pub(crate) const AIRLIGHT: &str = include_str!("../physics/airlight.wgsl");
/// Media; needs `FRAME`.
pub(crate) const MEDIUM: &str = include_str!("../physics/medium.wgsl");
/// View rays; needs `FRAME`.
pub(crate) const CAMERA: &str = include_str!("../camera/camera.wgsl");
/// Bind group 0.
pub(crate) const FRAME: &str = include_str!("frame.wgsl");
/// Uniforms that decide branches; needs `FRAME`.
pub(crate) const CHOICE: &str = include_str!("choice.wgsl");
/// The same in shaders that tests run without a depth buffer.
#[cfg(test)]
pub(crate) const CHOICE_ALONE: &str = "fn frame_choice(value: u32) -> u32 { return value; }";
/// Spot cones.
pub(crate) const CONE: &str = include_str!("../light/cone.wgsl");
/// Bind group 1: lights.
pub(crate) const LIGHT: &str = include_str!("../light/light.wgsl");
/// Lit stretches of view rays; needs `AIRLIGHT` and its texture.
pub(crate) const STRETCH: &str = include_str!("../light/stretch.wgsl");
/// Bind group 1: shadow maps.
pub(crate) const SHADOW: &str = include_str!("../shadow/shadow.wgsl");
/// Steps along view rays; needs frame and light.
pub(crate) const MARCH: &str = include_str!("../shadow/march.wgsl");

/// Epipolar lines on the picture; needs `CHOICE`.
pub(crate) const SCREEN: &str = include_str!("../passes/epipolar/screen.wgsl");
/// Slices in their shadow map; needs `SCREEN`, frame and light.
pub(crate) const TRACE: &str = include_str!("../passes/epipolar/trace.wgsl");

/// What a pass needs that reads the camera, the medium and the depth buffer.
pub(crate) const FRAME_MODULES: &[&str] = &[PHASE, TRANSMITTANCE, MEDIUM, CAMERA, FRAME, CHOICE];
/// What a pass needs besides that reads a light and its shadow map.
pub(crate) const LIGHT_MODULES: &[&str] = &[CONE, LIGHT, SHADOW];

/// The text of a shader made of these modules.
pub(crate) fn join(modules: &[&[&str]]) -> String {
    modules.concat().join("\n")
}

/// A shader made of these modules.
pub(crate) fn create(
    device: &wgpu::Device,
    label: &str,
    modules: &[&[&str]],
) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(join(modules).into()),
    })
}
