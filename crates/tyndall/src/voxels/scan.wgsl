// The OR of each voxel and all before it in its slice, of the slices of any number of grids in one dispatch.
//
// A workgroup takes four words of the rows of a slice, a thread a sixteenth of the rows of a word: first the OR of its
// rows, then, with those of the threads before it, each row's.

struct VoxelScan {
    side: u32,
}

@group(2) @binding(0) var<uniform> voxel_scan: VoxelScan;
@group(2) @binding(1) var<storage, read_write> voxels: array<u32>;

const VOXEL_SCAN_PARTS: u32 = 16u;

var<workgroup> voxel_scan_parts: array<u32, 64>;

@compute @workgroup_size(64)
fn voxel_scan_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let side = voxel_scan.side;
    let words = side / 32u;
    let word = 4u * group.z + (thread & 3u);
    let part = thread >> 2u;
    let rows = select(0u, side / VOXEL_SCAN_PARTS, word < words);
    let first = ((group.y * side + group.x) * side + part * (side / VOXEL_SCAN_PARTS)) * words + word;
    var all = 0u;
    for (var i = 0u; i < rows; i++) {
        all |= voxels[first + i * words];
    }
    voxel_scan_parts[thread] = all;
    workgroupBarrier();
    var before = 0u;
    for (var i = 0u; i < part; i++) {
        before |= voxel_scan_parts[4u * i + (thread & 3u)];
    }
    for (var i = 0u; i < rows; i++) {
        before |= voxels[first + i * words];
        voxels[first + i * words] = before;
    }
}
