//! Linear RGB pictures in f64, and how they are read from EXR files.

use exr::image::{AnyChannel, FlatSamples, Layer};
use exr::prelude::{AnyChannels, FlatImage, read_all_flat_layers_from_file};
use std::path::{Path, PathBuf};

/// A linear RGB picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    size: [usize; 2],
    pixels: Vec<[f64; 3]>,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureReadError {
    /// The pixels don't fill the size, or the size is zero.
    #[error("a picture of {} x {} must have {} pixels and more than 0, found {found}", size[0], size[1], size[0] * size[1])]
    Size {
        /// Width and height \[pixels].
        size: [usize; 2],
        /// Number of pixels given.
        found: usize,
    },
    /// The file cannot be read as EXR.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: exr::error::Error,
    },
    /// The file lacks a colour channel.
    #[error("{}: expected channel {channel}, plain or of a layer `inscatter` or `final`, found {found}", path.display())]
    Channel {
        /// The file.
        path: PathBuf,
        /// R, G or B.
        channel: &'static str,
        /// The channels there are, joined by commas.
        found: String,
    },
}

impl Picture {
    /// A picture of `size` (width, height), row by row from the top left.
    ///
    /// # Errors
    /// Where there are no pixels, or more or fewer than width * height.
    pub fn new(size: [usize; 2], pixels: Vec<[f64; 3]>) -> Result<Self, PictureReadError> {
        if pixels.is_empty() || size[0].checked_mul(size[1]) != Some(pixels.len()) {
            return Err(PictureReadError::Size {
                size,
                found: pixels.len(),
            });
        }
        Ok(Self { size, pixels })
    }

    /// Reads R, G and B of an EXR file: the plain channels, else those of its layer `inscatter`, else `final`.
    /// A layer is either a part of the file or a prefix of the channels' names.
    ///
    /// # Errors
    /// Where the file cannot be read or has no such channels.
    pub fn read_exr(path: &Path) -> Result<Self, PictureReadError> {
        let image =
            read_all_flat_layers_from_file(path).map_err(|source| PictureReadError::File {
                path: path.to_owned(),
                source,
            })?;
        let mut planes = Vec::with_capacity(3);
        let mut size = [0, 0];
        for name in ["R", "G", "B"] {
            let (layer, channel) =
                find_channel(&image, name).ok_or_else(|| PictureReadError::Channel {
                    path: path.to_owned(),
                    channel: name,
                    found: names(&image).join(", "),
                })?;
            size = [layer.size.width(), layer.size.height()];
            planes.push(values(&channel.sample_data));
        }
        let pixels = (0..planes[0].len())
            .map(|i| std::array::from_fn(|c| planes[c].get(i).copied().unwrap_or(f64::NAN)))
            .collect();
        Self::new(size, pixels)
    }

    /// Width and height \[pixels].
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Linear RGB, row by row from the top left.
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.pixels
    }
}

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

fn channels(image: &FlatImage) -> impl Iterator<Item = (&FlatLayer, &AnyChannel<FlatSamples>)> {
    image
        .layer_data
        .iter()
        .flat_map(|layer| layer.channel_data.list.iter().map(move |c| (layer, c)))
}

/// `layer.channel`, or the bare channel of an unnamed layer.
fn full_name(layer: &FlatLayer, channel: &AnyChannel<FlatSamples>) -> String {
    match &layer.attributes.layer_name {
        Some(name) if !name.as_slice().is_empty() => format!("{name}.{}", channel.name),
        _ => channel.name.to_string(),
    }
}

fn names(image: &FlatImage) -> Vec<String> {
    channels(image).map(|(l, c)| full_name(l, c)).collect()
}

fn find_channel<'a>(
    image: &'a FlatImage,
    name: &str,
) -> Option<(&'a FlatLayer, &'a AnyChannel<FlatSamples>)> {
    ["", "inscatter.", "final."].iter().find_map(|layer| {
        let wanted = format!("{layer}{name}");
        channels(image).find(|(l, c)| full_name(l, c) == wanted)
    })
}

fn values(samples: &FlatSamples) -> Vec<f64> {
    samples.values_as_f32().map(f64::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{
        AnyChannels, Encoding, Image, Layer, LayerAttributes, Text, WritableImage, f16,
    };

    /// Writes a 2 x 1 picture whose channels are named `channels` and hold 10 i, 10 i + 1.
    fn write(path: &Path, layer: Option<&str>, channels: &[&str]) {
        let list = channels
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let base = 10.0 * i as f32;
                AnyChannel::new(*name, FlatSamples::F32(vec![base, base + 1.0]))
            })
            .collect();
        let attributes = LayerAttributes {
            layer_name: layer.map(Text::new_or_panic),
            ..LayerAttributes::default()
        };
        let layer = Layer::new(
            (2, 1),
            attributes,
            Encoding::default(),
            AnyChannels::sort(list),
        );
        Image::from_layer(layer).write().to_file(path).unwrap();
    }

    #[test]
    fn plain_and_layered_channels_are_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("picture.exr");
        // (layer, channels, red of the first pixel, blue of the second)
        let cases: &[(Option<&str>, &[&str], f64, f64)] = &[
            (None, &["R", "G", "B"], 0.0, 21.0),
            (
                None,
                &["inscatter.R", "inscatter.G", "inscatter.B"],
                0.0,
                21.0,
            ),
            (
                None,
                &["final.R", "final.G", "final.B", "depth.Z"],
                0.0,
                21.0,
            ),
            (Some("inscatter"), &["R", "G", "B"], 0.0, 21.0),
            (
                None,
                &[
                    "final.R",
                    "final.G",
                    "final.B",
                    "inscatter.R",
                    "inscatter.G",
                    "inscatter.B",
                ],
                30.0,
                51.0,
            ),
        ];
        for (layer, channels, red, blue) in cases {
            write(&path, *layer, channels);
            let picture = Picture::read_exr(&path).unwrap();
            assert_eq!(picture.size(), [2, 1]);
            assert_eq!(picture.pixels()[0][0], *red, "{channels:?}");
            assert_eq!(picture.pixels()[1][2], *blue, "{channels:?}");
        }
    }

    #[test]
    fn half_precision_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("half.exr");
        let plane = |name| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(0.5)]));
        let channels = AnyChannels::sort(["R", "G", "B"].into_iter().map(plane).collect());
        Image::from_channels((1, 1), channels)
            .write()
            .to_file(&path)
            .unwrap();
        assert_eq!(Picture::read_exr(&path).unwrap().pixels(), [[0.5; 3]]);
    }

    #[test]
    fn a_file_without_colours_is_refused_by_name() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("depth.exr");
        write(&path, None, &["R", "depth.Z"]);
        let message = Picture::read_exr(&path).unwrap_err().to_string();
        assert!(message.contains("channel G"), "{message}");
        assert!(message.contains("depth.Z"), "{message}");
    }

    #[test]
    fn what_is_not_an_exr_is_refused_by_name() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("text.exr");
        std::fs::write(&path, "no picture").unwrap();
        let message = Picture::read_exr(&path).unwrap_err().to_string();
        assert!(message.contains("text.exr"), "{message}");
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        for (size, count) in [([2, 2], 3), ([0, 0], 0), ([0, 5], 0), ([usize::MAX, 2], 2)] {
            assert!(
                Picture::new(size, vec![[0.0; 3]; count]).is_err(),
                "{size:?}"
            );
        }
    }
}
