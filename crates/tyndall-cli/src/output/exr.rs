//! Linear pictures for programs.

use std::io::{Cursor, Error, Result};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer as ExrLayer, LayerAttributes,
    WritableImage,
};

use crate::{layer::Layer, picture::Picture};

/// One layer as plain R, G, B; several as channels `layer.R` ..., which viewers group by the name before the dot.
pub(super) fn encode(layers: &[(Layer, Picture)]) -> Result<Vec<u8>> {
    let Some((_, first)) = layers.first() else {
        return Err(Error::other("an EXR needs a layer"));
    };
    let [width, height] = first.size.map(|side| side as usize);
    let channels = layers
        .iter()
        .flat_map(|(layer, picture)| {
            let prefix = match layers {
                [_] => String::new(),
                _ => format!("{}.", layer.name()),
            };
            ["R", "G", "B"]
                .into_iter()
                .enumerate()
                .map(move |(channel, name)| {
                    channel_of(picture, channel, &format!("{prefix}{name}"))
                })
        })
        .collect();
    let layer = ExrLayer::new(
        (width, height),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    );
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(Error::other)?;
    Ok(bytes.into_inner())
}

fn channel_of(picture: &Picture, channel: usize, name: &str) -> AnyChannel<FlatSamples> {
    let samples = picture.pixels.iter().map(|pixel| pixel[channel]).collect();
    AnyChannel::new(name, FlatSamples::F32(samples))
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels, ReadLayers, read};

    use super::*;

    fn picture(first: f32) -> Picture {
        Picture {
            size: [2, 2],
            pixels: (0..4)
                .map(|i| [first + i as f32, 1e-30 * i as f32, 1e30])
                .collect(),
        }
    }

    fn decode(bytes: &[u8]) -> Vec<(String, Vec<f32>)> {
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap();
        assert_eq!(image.layer_data.size, exr::prelude::Vec2(2, 2));
        let channels = &image.layer_data.channel_data.list;
        channels
            .iter()
            .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
            .collect()
    }

    #[test]
    fn one_layer_is_plain_rgb() {
        let channels = decode(&encode(&[(Layer::Inscatter, picture(0.5))]).unwrap());
        let names: Vec<_> = channels.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["B", "G", "R"]);
        assert_eq!(channels[2].1, [0.5, 1.5, 2.5, 3.5]);
    }

    #[test]
    fn several_layers_have_names_and_keep_every_bit() {
        let layers = [(Layer::Final, picture(1.0)), (Layer::Depth, picture(7.0))];
        let channels = decode(&encode(&layers).unwrap());
        let names: Vec<_> = channels.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            [
                "depth.B", "depth.G", "depth.R", "final.B", "final.G", "final.R"
            ]
        );
        assert_eq!(channels[2].1, [7.0, 8.0, 9.0, 10.0]);
        assert_eq!(channels[4].1, [0.0, 1e-30, 2e-30, 3e-30]);
    }
}
