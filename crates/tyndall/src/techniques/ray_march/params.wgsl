// How many steps, and where.

const RAY_MARCH_EQUIANGULAR: u32 = 1u;

struct RayMarchParams {
    steps: u32,
    spacing: u32,
}
