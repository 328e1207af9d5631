// Where anything is drawn.

@fragment
fn touched() -> @location(0) vec4f {
    return vec4f(1.0);
}
