//! Linear pictures.

/// Linear RGB, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height \[pixels].
    pub size: [u32; 2],
    /// One a pixel.
    pub pixels: Vec<[f32; 3]>,
}

/// Rec. 709 luminance.
pub(super) fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
