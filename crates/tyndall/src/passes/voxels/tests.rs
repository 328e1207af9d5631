//! The shaders against their twins.

use tyndall_testkit::{device::device_or_skip, samples::in_box, wgsl};
use wgpu::util::DeviceExt;

use crate::shader::tests::{harness, in_one_group};

use super::{
    scan::{scan_columns, scan_groups},
    twin::{self, Grid},
};

/// Words whose bits are set with a chance that differs from word to word.
fn words(seed: u64, count: usize) -> Vec<u32> {
    let draws = in_box(seed, 33 * count, [0.0..=1.0]);
    let word =
        |x: &[[f32; 1]]| (0..32).fold(0, |w, i| w | u32::from(x[i][0] < 0.2 * x[32][0]) << i);
    draws.chunks_exact(33).take(count).map(word).collect()
}

#[test]
fn scan_is_the_or_of_all_before() {
    let Some(gpu) = device_or_skip("scan.wgsl") else {
        return;
    };
    let scan = harness(
        "import tyndall::passes::voxels::scan::voxel_scan_rows;",
        &[],
        &[],
    );
    let sizes = [(64_usize, 3), (128, 2), (160, 1), (256, 1)];
    for ((side, grids), parts) in sizes.iter().flat_map(|size| [(*size, 1), (*size, 16)]) {
        let given = words(side as u64, grids * side.pow(3) / 32);
        let buffer = |contents: &[u8], usage| {
            let usage = usage | wgpu::BufferUsages::COPY_SRC;
            let init = wgpu::util::BufferInitDescriptor {
                label: None,
                contents,
                usage,
            };
            gpu.device.create_buffer_init(&init)
        };
        let columns = scan_columns(side as u32, grids as u32);
        let uniform = buffer(
            bytemuck::bytes_of(&[side as u32, columns, 0, 0]),
            wgpu::BufferUsages::UNIFORM,
        );
        let voxels = buffer(bytemuck::cast_slice(&given), wgpu::BufferUsages::STORAGE);
        wgsl::dispatch(
            gpu,
            &[&scan],
            "voxel_scan_rows",
            &[("VOXEL_SCAN_PARTS", parts.into())],
            (2, &[&uniform, &voxels]),
            scan_groups(columns, parts),
        )
        .expect("the shader runs");
        let found: Vec<u32> = gpu.read_buffer(&voxels).expect("readable");
        let found = Grid::all_from_words(side, &found);
        let mut expected = Grid::all_from_words(side, &given);
        let mut changed = 0;
        for (expected, found) in expected.iter_mut().zip(&found) {
            let before = expected.is_dark.clone();
            expected.scan();
            changed += before
                .iter()
                .zip(&expected.is_dark)
                .filter(|(a, b)| a != b)
                .count();
            assert!(expected.is_dark == found.is_dark, "{side} {parts}");
        }
        assert!(changed > side * side, "the scan has something to do");
    }
}

#[test]
fn queries_are_those_of_single_bits() {
    let Some(gpu) = device_or_skip("voxels.wgsl") else {
        return;
    };
    let side = 96_usize;
    let given = words(5, side.pow(3) / 32);
    let grid = &Grid::all_from_words(side, &given)[0];
    let init = wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&given),
        usage: wgpu::BufferUsages::STORAGE,
    };
    let voxels = gpu.device.create_buffer_init(&init);
    let binding = [wgpu::BindGroupEntry {
        binding: 21,
        resource: voxels.as_entire_binding(),
    }];
    let modules = "
import tyndall::passes::voxels::voxels::{voxel_dark, voxel_end, voxel_row};
import tyndall::techniques::voxelized::runs::{voxel_next, vsv_voxels};
";
    let modules = in_one_group(&harness(modules, &[], &[]));
    let most = side as f32;
    let ranges = [
        0.0..=most - 0.001,
        0.0..=most - 0.001,
        0.0..=most,
        -9.0..=1.2 * most,
    ];
    let inputs = in_box(9, 20_000, ranges);
    let expression = "
        f32(voxel_next(96u, voxel_row(96u, u32(x[0]), u32(x[1])), u32(x[2]), 0u)),
        f32(voxel_next(96u, voxel_row(96u, u32(x[0]), u32(x[1])), u32(x[2]), 0xffffffffu)),
        voxel_dark(vsv_voxels[voxel_row(96u, u32(x[0]), u32(x[1]))], x[2] / 3.0),
        f32(voxel_end(96u, x[3]))";
    let found =
        wgsl::evaluate_with(gpu, &[&modules], &binding, expression, &inputs).expect("it runs");
    for (x, found) in inputs.iter().zip(found) {
        let [slice, row, column] = [x[0], x[1], x[2]].map(|x| x as usize);
        let row = grid.row(slice, row);
        let place = f64::from(x[2] / 3.0);
        let exact = [
            twin::next(row, column, true) as f32,
            twin::next(row, column, false) as f32,
            twin::dark(&row[..32], place) as f32,
            twin::end(side, x[3].into()) as f32,
        ];
        assert_eq!(exact[..2], found[..2], "{x:?}");
        // Measured on lavapipe: 2e-6, rounding of the place.
        assert!(
            (exact[2] - found[2]).abs() < 1e-5,
            "{x:?} {exact:?} {found:?}"
        );
        assert_eq!(exact[3], found[3], "{x:?}");
    }
}
