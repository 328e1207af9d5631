// What is gathered, and how.

struct IvsvParams {
    size: vec2u, // of the picture that is gathered [pixels]
    pitch: u32, // pixels of the output from one of its pixels to the next
    turns: u32, // 1, or 9: of so many pixels each takes other samples
    weighting: u32,
}
