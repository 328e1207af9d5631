//! Any bytes as a picture that a light shines through.

use tyndall_cli::light_texture::load;

use crate::{folder::with_file, outcome::Outcome};

/// The first bytes of an EXR.
const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// Loads an EXR, or a PNG or JPEG, which are told apart by content.
pub fn run(bytes: &[u8]) -> Outcome {
    let name = if bytes.starts_with(EXR) {
        "picture.exr"
    } else {
        "picture.png"
    };
    with_file(name, bytes, |file| match load(file) {
        Err(_) => Outcome::Refused,
        Ok(texture) => {
            let [width, height] = texture.size.map(|side| side as usize);
            assert_eq!(texture.texels.len(), width * height);
            assert!(texture.texels.as_flattened().iter().all(|x| x.is_finite()));
            Outcome::Computed
        }
    })
}
