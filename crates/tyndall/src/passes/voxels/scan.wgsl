// The OR of each voxel and all before it in its slice, of the slices of any number of grids in one dispatch.
//
// A thread takes a part of the rows of a word: where parts are several, first the OR of its rows, then, with those of the
// parts before it, each row's.

struct VoxelScan {
    side: u32,
    columns: u32, // words of a row of every slice of all grids
}

@group(2) @binding(0) var<uniform> voxel_scan: VoxelScan;
@group(2) @binding(1) var<storage, read_write> voxels: array<u32>;

// Threads that share the rows of a word, 1 to 64; a power of two.
override VOXEL_SCAN_PARTS: u32 = 1u;

var<workgroup> voxel_scan_parts: array<u32, 64>;

@compute @workgroup_size(64)
fn voxel_scan_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let a_group = 64u / VOXEL_SCAN_PARTS;
    let column = group.x * a_group + thread % a_group;
    let part = thread / a_group;
    let words = voxel_scan.side / 32u;
    let rows = select(0u, voxel_scan.side / VOXEL_SCAN_PARTS, column < voxel_scan.columns);
    let first = (column / words * voxel_scan.side + part * rows) * words + column % words;
    var before = 0u;
    if VOXEL_SCAN_PARTS > 1u {
        var all = 0u;
        for (var i = 0u; i < rows; i++) {
            all |= voxels[first + i * words];
        }
        voxel_scan_parts[thread] = all;
        workgroupBarrier();
        for (var i = 0u; i < part; i++) {
            before |= voxel_scan_parts[a_group * i + thread % a_group];
        }
    }
    for (var i = 0u; i < rows; i++) {
        before |= voxels[first + i * words];
        voxels[first + i * words] = before;
    }
}
