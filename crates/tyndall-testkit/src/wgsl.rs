//! Runs a WGSL function over a list of inputs, so that a test can compare it with its Rust twin.

use crate::device::{ReadBackError, TestDevice};
use crate::shader::{Shader, ShaderError};
use wgpu::util::DeviceExt;

/// The harness keeps its own buffers in the last bind group, so that the modules may bind what they like in the others.
const HARNESS_GROUP: u32 = 3;
const WORKGROUP_SIZE: usize = 64;
const MAX_WORKGROUPS: u32 = 65_535;

/// The most inputs of one call.
pub const MAX_INPUTS: usize = WORKGROUP_SIZE * MAX_WORKGROUPS as usize;

/// Why a function could not be run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// The modules, or the expression, are no valid WGSL.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// There is nothing to compare, and nothing must not pass for equal; or it is too much for one dispatch.
    #[error("expected 1 to {MAX_INPUTS} inputs, found {0}")]
    Count(usize),
    /// The results cannot be read back.
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
}

/// Evaluates a WGSL expression once for each of `inputs`.
///
/// `modules` are joined in order. The expression sees its input as `x`, an `array<f32, N>`, and is what stands in the
/// parentheses of `vec4f(...)`: a scalar (all four results are it), a `vec4f`, or parts that make up four components.
///
/// ```
/// use tyndall_testkit::{device::device_or_skip, wgsl};
/// let Some(gpu) = device_or_skip("wgsl::evaluate's example") else { return };
/// let square = "fn square(a: f32) -> f32 { return a * a; }";
/// let squares = wgsl::evaluate(gpu, &[square], "square(x[0]), vec3f(x[1])", &[[3.0, 0.5]]).unwrap();
/// assert_eq!(squares, [[9.0, 0.5, 0.5, 0.5]]);
/// ```
///
/// # Errors
/// Where the WGSL is not valid, or there are no inputs or too many.
pub fn evaluate<const N: usize>(
    gpu: &TestDevice,
    modules: &[&str],
    expression: &str,
    inputs: &[[f32; N]],
) -> Result<Vec<[f32; 4]>, EvaluateError> {
    evaluate_with(gpu, modules, &[], expression, inputs)
}

/// As [`evaluate`], for functions that read textures or buffers: `bindings` are those of group 0 that the expression uses.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_with<const N: usize>(
    gpu: &TestDevice,
    modules: &[&str],
    bindings: &[wgpu::BindGroupEntry<'_>],
    expression: &str,
    inputs: &[[f32; N]],
) -> Result<Vec<[f32; 4]>, EvaluateError> {
    let groups = workgroups(inputs.len())?;
    let harness = harness(N, expression);
    let modules: Vec<&str> = modules.iter().copied().chain([harness.as_str()]).collect();
    Shader::new(&modules)?;

    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("wgsl harness"),
        source: wgpu::ShaderSource::Wgsl(modules.join("\n").into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("wgsl harness"),
        layout: None,
        module: &module,
        entry_point: Some("testkit_main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("wgsl harness inputs"),
        contents: bytemuck::cast_slice(inputs.as_flattened()),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let output = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("wgsl harness outputs"),
        size: (inputs.len() * size_of::<[f32; 4]>()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let bind = |group, entries: &[wgpu::BindGroupEntry<'_>]| {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("wgsl harness"),
            layout: &pipeline.get_bind_group_layout(group),
            entries,
        })
    };
    let buffers = bind(
        HARNESS_GROUP,
        &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: input.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: output.as_entire_binding(),
            },
        ],
    );
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        if !bindings.is_empty() {
            pass.set_bind_group(0, &bind(0, bindings), &[]);
        }
        pass.set_bind_group(HARNESS_GROUP, &buffers, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
    }
    gpu.queue.submit([encoder.finish()]);
    Ok(gpu.read_buffer(&output)?)
}

/// Runs a compute shader once. `bound` are a bind group's index and its buffers, at bindings 0, 1 and so on.
///
/// # Errors
/// Where the WGSL is not valid.
pub fn dispatch(
    gpu: &TestDevice,
    modules: &[&str],
    entry_point: &str,
    constants: &[(&str, f64)],
    (group, buffers): (u32, &[&wgpu::Buffer]),
    [x, y, z]: [u32; 3],
) -> Result<(), EvaluateError> {
    Shader::new(modules)?;
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(entry_point),
        source: wgpu::ShaderSource::Wgsl(modules.join("\n").into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: None,
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants,
            ..Default::default()
        },
        cache: None,
    });
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(entry_point),
        layout: &pipeline.get_bind_group_layout(group),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(group, &bind_group, &[]);
        pass.dispatch_workgroups(x, y, z);
    }
    gpu.queue.submit([encoder.finish()]);
    Ok(())
}

fn workgroups(inputs: usize) -> Result<u32, EvaluateError> {
    match u32::try_from(inputs.div_ceil(WORKGROUP_SIZE)) {
        Ok(count @ 1..=MAX_WORKGROUPS) => Ok(count),
        _ => Err(EvaluateError::Count(inputs)),
    }
}

fn harness(dimensions: usize, expression: &str) -> String {
    format!(
        "
@group({HARNESS_GROUP}) @binding(0) var<storage, read> testkit_inputs: array<array<f32, {dimensions}>>;
@group({HARNESS_GROUP}) @binding(1) var<storage, read_write> testkit_outputs: array<vec4f>;

@compute @workgroup_size({WORKGROUP_SIZE})
fn testkit_main(@builtin(global_invocation_id) id: vec3u) {{
    if id.x >= arrayLength(&testkit_outputs) {{
        return;
    }}
    let x = testkit_inputs[id.x];
    testkit_outputs[id.x] = vec4f({expression});
}}
"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::device_or_skip;
    use crate::metrics::worst;
    use crate::samples::in_box;

    const LENGTH: &str = "fn hypotenuse(a: f32, b: f32) -> f32 { return sqrt(a * a + b * b); }";

    #[test]
    fn a_function_agrees_with_its_twin_and_not_with_another() {
        let Some(gpu) = device_or_skip("wgsl::evaluate") else {
            return;
        };
        // More than one workgroup, and not a whole number of them.
        let inputs = in_box(1, 1001, [0.0..=2.0, 0.0..=3.0]);
        let found = evaluate(gpu, &[LENGTH], "hypotenuse(x[0], x[1])", &inputs).unwrap();
        let error = |twin: fn(f64, f64) -> f64| {
            let expected: Vec<_> = inputs
                .iter()
                .map(|p| [twin(p[0].into(), p[1].into()); 4])
                .collect();
            worst(&found, &expected, 1e-3).unwrap().error
        };
        // 9.6e-8 on llvmpipe (Mesa 22.3.6), November 2026.
        assert!(error(f64::hypot) < 1e-6);
        assert!(error(|a, b| f64::hypot(a, 1.001 * b)) > 1e-4);
    }

    #[test]
    fn every_input_has_its_own_result() {
        let Some(gpu) = device_or_skip("wgsl::evaluate, order") else {
            return;
        };
        let inputs: Vec<[f32; 1]> = (0..200_u16).map(|i| [f32::from(i)]).collect();
        let found = evaluate(gpu, &[], "x[0], -x[0], 1.0, 2.0", &inputs).unwrap();
        let expected: Vec<_> = inputs.iter().map(|&[i]| [i, -i, 1.0, 2.0]).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_function_may_read_a_buffer() {
        let Some(gpu) = device_or_skip("wgsl::evaluate_with") else {
            return;
        };
        let table = "@group(0) @binding(2) var<storage, read> table: array<f32>;";
        let buffer = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::cast_slice(&[5.0_f32, 7.0]),
                usage: wgpu::BufferUsages::STORAGE,
            });
        let binding = wgpu::BindGroupEntry {
            binding: 2,
            resource: buffer.as_entire_binding(),
        };
        let found = evaluate_with(
            gpu,
            &[table],
            &[binding],
            "table[u32(x[0])]",
            &[[1.0], [0.0]],
        );
        assert_eq!(found.unwrap(), [[7.0; 4], [5.0; 4]]);
    }

    #[test]
    fn what_cannot_run_is_refused() {
        let Some(gpu) = device_or_skip("wgsl::evaluate, errors") else {
            return;
        };
        let misspelt = evaluate(gpu, &[LENGTH], "hypotenuze(x[0], x[1])", &[[1.0, 2.0]]);
        assert!(matches!(
            misspelt,
            Err(EvaluateError::Shader(ShaderError::Parse(_)))
        ));
        let nothing: &[[f32; 1]] = &[];
        assert!(matches!(
            evaluate(gpu, &[], "x[0]", nothing),
            Err(EvaluateError::Count(0))
        ));
        assert!(matches!(workgroups(MAX_INPUTS), Ok(MAX_WORKGROUPS)));
        assert!(matches!(
            workgroups(MAX_INPUTS + 1),
            Err(EvaluateError::Count(_))
        ));
    }
}
