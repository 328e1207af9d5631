//! The textures that lights shine through.

use std::{
    ffi::OsStr,
    path::{Path, PathBuf},
    sync::Arc,
};

use image::ImageReader;
use tyndall::cpu::LightTexture;
use tyndall_scene::texture::linear_from_srgb;

use crate::{output::Pattern, shot::FrameRange};

/// The most texels a side.
const MAX_SIDE: usize = 8192;

/// Why a texture could not be read.
#[derive(Debug, thiserror::Error)]
pub enum TextureError {
    /// It is missing, broken or of a kind we don't read.
    #[error("cannot read {}: {cause}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// Why.
        cause: String,
    },
    /// It is too large.
    #[error("cannot take {}: expected at most {MAX_SIDE} texels a side, found {} x {}", file.display(), size[0], size[1])]
    Size {
        /// The file.
        file: PathBuf,
        /// Its size \[texels].
        size: [usize; 2],
    },
    /// It is to be another texture in each frame, and there is none.
    #[error("cannot read {}: expected pictures of frames, such as {}, found none", file.display(), first.display())]
    NoFrames {
        /// The files' pattern.
        file: PathBuf,
        /// The texture of frame 0.
        first: PathBuf,
    },
    /// It is to be another texture in each frame, and one is missing.
    #[error("cannot read {}: expected a picture of each of the frames {frames}, {} is missing", file.display(), missing.display())]
    MissingFrame {
        /// The files' pattern.
        file: PathBuf,
        /// From the first that is there to the last.
        frames: FrameRange,
        /// The first that is not.
        missing: PathBuf,
    },
    /// It holds a value that is no light.
    #[error("cannot take {}: expected finite values >= 0, found {value} in column {}, row {}", file.display(), texel[0], texel[1])]
    Value {
        /// The file.
        file: PathBuf,
        /// The first such value.
        value: f32,
        /// Its column and row.
        texel: [usize; 2],
    },
}

/// The textures of a light: one for good, or one a frame.
#[derive(Debug)]
pub(crate) enum Textures {
    /// One for all frames.
    Still(Arc<LightTexture>),
    /// A file a frame, over and over again.
    Frames(Pattern, FrameRange),
}

impl Textures {
    /// Reads a texture. Where its name has a place for a frame's number (`####` or `%04d`) and no file is called so to the
    /// letter, finds which frames there are.
    ///
    /// # Errors
    /// As for [`load`], and where there is no texture of any frame or a frame is missing among the others.
    pub(crate) fn open(file: &Path) -> Result<Self, TextureError> {
        match Pattern::of(file) {
            Ok(pattern) if !file.exists() => {
                let frames = frames(file, &pattern)?;
                Ok(Self::Frames(pattern, frames))
            }
            _ => Ok(Self::Still(Arc::new(load(file)?))),
        }
    }

    /// The texture of a frame. Before the first one that there is and after the last they start over.
    ///
    /// # Errors
    /// As for [`load`].
    pub(crate) fn at(&self, frame: u32) -> Result<Arc<LightTexture>, TextureError> {
        match self {
            Self::Still(texture) => Ok(Arc::clone(texture)),
            Self::Frames(pattern, FrameRange { first, last }) => {
                let count = i64::from(*last) - i64::from(*first) + 1;
                let from_first = (i64::from(frame) - i64::from(*first)).rem_euclid(count);
                load(&pattern.file(first + from_first as u32)).map(Arc::new)
            }
        }
    }
}

/// The frames whose textures are there, all of them.
fn frames(file: &Path, pattern: &Pattern) -> Result<FrameRange, TextureError> {
    let mut numbers = pattern
        .numbers()
        .map_err(|cause| unreadable(file, &cause))?;
    numbers.sort_unstable();
    let (Some(&first), Some(&last)) = (numbers.first(), numbers.last()) else {
        return Err(TextureError::NoFrames {
            file: file.to_owned(),
            first: pattern.file(0),
        });
    };
    let frames = FrameRange { first, last };
    match frames.frames().zip(&numbers).find(|(a, b)| a != *b) {
        None => Ok(frames),
        Some((missing, _)) => Err(TextureError::MissingFrame {
            file: file.to_owned(),
            frames,
            missing: pattern.file(missing),
        }),
    }
}

/// Reads a PNG or JPEG, which is taken as sRGB, or an EXR, which is taken as it is.
///
/// # Errors
/// [`TextureError`] where the file is missing or broken, too large, or holds negative or non-finite values.
pub fn load(file: &Path) -> Result<LightTexture, TextureError> {
    let ending = file.extension().unwrap_or(OsStr::new(""));
    let texture = if ending.eq_ignore_ascii_case("exr") {
        load_exr(file)?
    } else {
        load_srgb(file)?
    };
    let wrong = |x: &f32| !(x.is_finite() && *x >= 0.0);
    match texture.texels.as_flattened().iter().position(wrong) {
        None => Ok(texture),
        Some(index) => {
            let width = texture.size[0] as usize;
            Err(TextureError::Value {
                file: file.to_owned(),
                value: texture.texels.as_flattened()[index],
                texel: [index / 3 % width, index / 3 / width],
            })
        }
    }
}

fn load_srgb(file: &Path) -> Result<LightTexture, TextureError> {
    let open = || ImageReader::open(file)?.with_guessed_format();
    let reader = || open().map_err(|cause| unreadable(file, &cause));
    let size = reader()?
        .into_dimensions()
        .map_err(|cause| unreadable(file, &cause))?;
    check_size(file, [size.0 as usize, size.1 as usize])?;
    let picture = reader()?
        .decode()
        .map_err(|cause| unreadable(file, &cause))?
        .into_rgb32f();
    Ok(LightTexture {
        size: [picture.width(), picture.height()],
        texels: picture
            .pixels()
            .map(|pixel| pixel.0.map(|x| linear_from_srgb(x.into()) as f32))
            .collect(),
    })
}

fn load_exr(file: &Path) -> Result<LightTexture, TextureError> {
    use exr::prelude::{MetaData, ReadChannels, ReadLayers, Vec2, read};
    let headers = MetaData::read_from_file(file, false)
        .map_err(|cause| unreadable(file, &cause))?
        .headers;
    for header in &headers {
        check_size(file, [header.layer_size.x(), header.layer_size.y()])?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size: Vec2<usize>, _| (size.x(), vec![[0.0_f32; 3]; size.area()]),
            |(width, texels), position, (r, g, b): (f32, f32, f32)| {
                texels[position.y() * *width + position.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(file)
        .map_err(|cause| unreadable(file, &cause))?;
    let size = image.layer_data.size;
    Ok(LightTexture {
        size: [size.x() as u32, size.y() as u32],
        texels: image.layer_data.channel_data.pixels.1,
    })
}

fn check_size(file: &Path, size: [usize; 2]) -> Result<(), TextureError> {
    if size.into_iter().all(|side| (1..=MAX_SIDE).contains(&side)) {
        Ok(())
    } else {
        Err(TextureError::Size {
            file: file.to_owned(),
            size,
        })
    }
}

fn unreadable(file: &Path, cause: &dyn std::fmt::Display) -> TextureError {
    TextureError::Unreadable {
        file: file.to_owned(),
        cause: cause.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use crate::{layer::Layer, output::Format, picture::Picture};

    use super::*;

    fn written(name: &str, pixels: [[f32; 3]; 2]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(name);
        let picture = Picture {
            size: [2, 1],
            pixels: pixels.to_vec(),
        };
        // Transmittance is the layer that a PNG holds as it is.
        let layers = vec![(Layer::Transmittance, picture)];
        let format = Format::of(&file, &[Layer::Transmittance]).unwrap();
        format.write(&file, &layers, 0.0).unwrap();
        (folder, file)
    }

    #[test]
    fn eight_bits_are_linearised_and_floats_are_not() {
        let (_folder, png) = written("a.png", [[0.0, 0.5, 1.0], [1.0; 3]]);
        let texture = load(&png).unwrap();
        assert_eq!(texture.size, [2, 1]);
        assert_eq!([texture.texels[0][0], texture.texels[0][2]], [0.0, 1.0]);
        // Code 187 or 188 of 255: half a code is 0.0025 there.
        assert!((texture.texels[0][1] - 0.5).abs() < 0.005);
        let (_folder, exr) = written("a.exr", [[0.0, 0.5, 1e4], [1e-9; 3]]);
        let texture = load(&exr).unwrap();
        assert_eq!(texture.texels, [[0.0, 0.5, 1e4], [1e-9; 3]]);
    }

    #[test]
    fn pictures_of_frames_start_over() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let write = |name: &str, value: f32| {
            let picture = Picture {
                size: [1, 1],
                pixels: vec![[value; 3]],
            };
            let layers = vec![(Layer::Transmittance, picture)];
            Format::Exr.write(&file(name), &layers, 0.0).unwrap();
        };
        for n in 3..6 {
            write(&format!("v.{n:03}.exr"), n as f32);
        }
        // None of these belongs to the frames.
        write("v.0004.exr", 1.0);
        write("w.009.exr", 1.0);
        for name in ["v.###.exr", "v.%03d.exr"] {
            let pictures = Textures::open(&file(name)).unwrap();
            let found = [0, 1, 3, 4, 5, 6, 12].map(|n| pictures.at(n).unwrap().texels[0][0]);
            assert_eq!(found, [3.0, 4.0, 3.0, 4.0, 5.0, 3.0, 3.0], "{name}");
        }
        write("v.008.exr", 8.0);
        let message = Textures::open(&file("v.###.exr")).unwrap_err().to_string();
        assert!(message.contains("each of the frames 3..8"), "{message}");
        assert!(message.ends_with("v.006.exr is missing"), "{message}");
        let message = Textures::open(&file("u.##.exr")).unwrap_err().to_string();
        assert!(message.ends_with("u.00.exr, found none"), "{message}");
        // A file that is called so to the letter is one texture.
        write("a#b.exr", 7.0);
        let still = Textures::open(&file("a#b.exr")).unwrap();
        assert_eq!(still.at(5).unwrap().texels[0][0], 7.0);
    }

    #[test]
    fn what_is_no_light_is_refused() {
        let (_folder, exr) = written("a.exr", [[0.0; 3], [0.0, -1.0, 0.0]]);
        let message = load(&exr).unwrap_err().to_string();
        assert!(
            message.ends_with("found -1 in column 1, row 0"),
            "{message}"
        );
        let (folder, exr) = written("a.exr", [[0.0; 3], [f32::NAN; 3]]);
        assert!(matches!(load(&exr), Err(TextureError::Value { .. })));
        let missing = load(&folder.path().join("b.png")).unwrap_err();
        assert!(matches!(missing, TextureError::Unreadable { .. }));
    }

    #[test]
    fn truncated_pictures_are_errors() {
        for name in ["a.png", "a.exr"] {
            let (_folder, file) = written(name, [[0.25; 3], [0.5; 3]]);
            let whole = std::fs::read(&file).unwrap();
            for length in 0..whole.len() {
                std::fs::write(&file, &whole[..length]).unwrap();
                // A PNG without its last, empty chunk is still complete.
                let whole_picture = name == "a.png" && length + 12 >= whole.len();
                assert!(load(&file).is_err() || whole_picture, "{name}: {length}");
            }
        }
    }
}
