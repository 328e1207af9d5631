// Which pixels of this frame are kept at all, before any is looked at.

@group(2) @binding(1) var<storage, read_write> decide_state: ReuseState;
@group(2) @binding(2) var<storage, read_write> decide_dispatches: array<u32>;

// Masks that cover more than this share of the picture cost more than they save.
const DECIDE_TOO_MUCH: f32 = 0.7;
// Frames until such a mask is asked for again.
const DECIDE_REST: u32 = 30u;
// The same of a moving camera, which may have made a cut and go on slowly.
const DECIDE_TOO_MUCH_LOST: f32 = 0.9;
const DECIDE_REST_LOST: u32 = 4u;
// Where the sizes of the dispatch and the draw stand that take over another camera's picture.
const DECIDE_REPROJECT: u32 = 48u;
const DECIDE_RESTORE: u32 = 51u;

@compute @workgroup_size(1)
fn decide() {
    let pixels = reuse.pixels.x * reuse.pixels.y;
    let stale = atomicLoad(&decide_state.stale);
    let covered = select(stale, pixels, reuse.reach == REUSE_PICTURE && stale > 0u);
    let share = f32(covered) / f32(pixels);
    if decide_state.mode == REUSE_MASKED && share > DECIDE_TOO_MUCH {
        decide_state.rest = DECIDE_REST;
    }
    if decide_state.mode == REUSE_REPROJECT && share > DECIDE_TOO_MUCH_LOST {
        decide_state.rest = DECIDE_REST_LOST;
    }
    let is_new = decide_state.generation != reuse.generation;
    let is_kin = reuse.kin != 0u && decide_state.kin == reuse.kin;
    var mode = select(REUSE_MASKED, REUSE_REPROJECT, is_new);
    if (is_new && !is_kin) || decide_state.kept >= reuse.frames {
        mode = REUSE_REMEMBER;
    }
    if decide_state.rest > 0u {
        decide_state.rest -= 1u;
        mode = select(REUSE_OFF, REUSE_REMEMBER, decide_state.rest == 0u);
    }
    decide_state.kept = select(0u, decide_state.kept + 1u, mode >= REUSE_MASKED);
    decide_state.generation = reuse.generation;
    decide_state.kin = reuse.kin;
    decide_state.turn += 1u;
    decide_state.mode = mode;
    atomicStore(&decide_state.stale, select(pixels, 0u, mode >= REUSE_MASKED));
    for (var i = 0u; i < reuse.levels + 1u; i++) {
        let groups = select(reuse.dispatches[i].xyz, vec3u(0u), mode == REUSE_OFF);
        decide_dispatches[3u * i] = groups.x;
        decide_dispatches[3u * i + 1u] = groups.y;
        decide_dispatches[3u * i + 2u] = groups.z;
    }
    let groups = select(vec3u(0u), vec3u((reuse.pixels + 7u) / 8u, 1u), mode == REUSE_REPROJECT);
    decide_dispatches[DECIDE_REPROJECT] = groups.x;
    decide_dispatches[DECIDE_REPROJECT + 1u] = groups.y;
    decide_dispatches[DECIDE_REPROJECT + 2u] = groups.z;
    decide_dispatches[DECIDE_RESTORE] = select(0u, 3u, mode == REUSE_REPROJECT);
    decide_dispatches[DECIDE_RESTORE + 1u] = 1u;
}
