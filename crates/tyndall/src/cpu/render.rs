//! The image of a frame, pixel by pixel on all cores.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use glam::DVec3;

use crate::{
    camera::Ray,
    error::PrepareError,
    frame::Frame,
    integrate::{CpuInputs, CpuScene, RayIntegrator},
    techniques::{Backends, Technique, TechniqueChoice},
    validate,
};

/// In-scattered light of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct InScatter {
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// Row by row from the top left: radiance [W/(m^2 sr)] per channel and, last, the mean transmittance to the surface.
    pub pixels: Vec<[f32; 4]>,
}

/// Called as work goes on with the number of pixels done and their total; from any thread.
pub type Progress<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// Computes the in-scattered light of a frame on all cores.
///
/// # Errors
/// [`PrepareError`] where the frame or an input is out of range, missing or of the wrong size,
/// or where a light's technique cannot do it on the CPU.
pub fn render(
    frame: &Frame,
    inputs: &CpuInputs<'_>,
    techniques: &TechniqueChoice,
    progress: Progress<'_>,
) -> Result<InScatter, PrepareError> {
    validate::frame(frame)?;
    let resolved = techniques.resolve(frame, Backends::Cpu)?;
    validate::cpu_inputs(frame, inputs)?;
    let scene = CpuScene::new(frame, inputs, &[]);
    let groups: Vec<(Technique, CpuScene<'_>)> = by_technique(resolved)
        .into_iter()
        .map(|(technique, lights)| (technique, CpuScene::new(frame, inputs, &lights)))
        .collect();
    let integrators = groups
        .iter()
        .map(|(technique, scene)| technique.cpu()?.integrator(scene))
        .collect::<Result<Vec<Box<dyn RayIntegrator + '_>>, _>>()?;
    let in_scatter = |pixel, ray: &Ray| -> DVec3 {
        let each = integrators.iter().map(|i| i.in_scatter(pixel, ray));
        each.sum()
    };
    let width = inputs.size[0];
    let total = u64::from(width) * u64::from(inputs.size[1]);
    let done = AtomicU64::new(0);
    let mut pixels = vec![[0.0; 4]; inputs.depth.len()];
    let rows = pixels.par_chunks_mut(width as usize);
    rows.enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            let ray = scene.ray(x as u32, y as u32);
            let light = in_scatter(y * width as usize + x, &ray);
            let transmittance = scene.optics.transmittance(ray.length).element_sum() / 3.0;
            *pixel = light.extend(transmittance).as_vec4().to_array();
        }
        let width = u64::from(width);
        progress(done.fetch_add(width, Ordering::Relaxed) + width, total);
    });
    Ok(InScatter {
        size: inputs.size,
        pixels,
    })
}

/// Each technique with the indices of its lights, so that lights of one technique share its work.
fn by_technique(techniques: Vec<Technique>) -> Vec<(Technique, Vec<usize>)> {
    let mut groups: Vec<(Technique, Vec<usize>)> = Vec::new();
    for (index, technique) in techniques.into_iter().enumerate() {
        match groups.iter_mut().find(|(of, _)| *of == technique) {
            Some((_, lights)) => lights.push(index),
            None => groups.push((technique, vec![index])),
        }
    }
    groups
}
