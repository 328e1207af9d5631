// A medium: extinction, and scattering by angle, summed over its components.

const MEDIUM_MAX_COMPONENTS: u32 = 4u;

const MEDIUM_PHASE_ISOTROPIC: u32 = 0u;
const MEDIUM_PHASE_RAYLEIGH: u32 = 1u;
const MEDIUM_PHASE_HG: u32 = 2u;

// How many components sums are unrolled for; those that a medium does not have scatter nothing.
override MEDIUM_COMPONENTS: u32 = MEDIUM_MAX_COMPONENTS;

struct MediumComponent {
    sigma_s: vec3f, // [1/m]
    phase: u32,
    g: f32,
}

struct Medium {
    sigma_t: vec3f, // sigma_s + sigma_a summed over the components [1/m]
    count: u32,
    components: array<MediumComponent, MEDIUM_MAX_COMPONENTS>,
}

fn medium_phase(component: MediumComponent, cos_theta: f32) -> f32 {
    switch component.phase {
        case MEDIUM_PHASE_RAYLEIGH: { return phase_rayleigh(cos_theta); }
        case MEDIUM_PHASE_HG: { return phase_hg(component.g, cos_theta); }
        default: { return phase_isotropic(); }
    }
}

// sigma_s rho(theta), summed over the components [1/(m sr)].
fn medium_scattering(cos_theta: f32) -> vec3f {
    var sum = vec3f(0.0);
    let count = frame_choice(frame.medium.count);
    for (var i = 0u; i < count; i++) {
        let component = frame.medium.components[i];
        sum += component.sigma_s * medium_phase(component, cos_theta);
    }
    return sum;
}

// The same, unrolled, for inner loops: of a component at a known place drivers know that all threads read the same.
fn medium_scattering_unrolled(cos_theta: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < MEDIUM_COMPONENTS; i++) {
        var component = frame.medium.components[i];
        component.phase = frame_choice(component.phase);
        sum += component.sigma_s * medium_phase(component, cos_theta);
    }
    return sum;
}
