// A small number from a uniform that decides which way a shader goes. lavapipe compiles a shader anew, whenever it is bound,
// for the uniforms that all of a branch or a loop hangs on, in tenths of a second; of a texture's size it knows nothing.

fn frame_choice(value: u32) -> u32 {
    return min(value, 0xffffu * textureDimensions(frame_depth).x);
}
