// What passes over the samples of a batch read: `batch_entries` and `Buffers::of_batch` of gpu.rs.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> grids: array<Epipolar>;
@group(2) @binding(3) var<storage, read> imperfect_maps: array<u32>;
@group(2) @binding(4) var<storage, read> voxels: array<u32>;
@group(2) @binding(5) var<storage, read> imperfect_colors: array<vec4f>;
@group(2) @binding(6) var<uniform> ivsv: IvsvParams;
