//! The picture comparer: pictures and their linear values, embedded.

use base64::{Engine, engine::general_purpose::STANDARD};
use half::f16;
use serde_json::{Value, json};

use super::template::Html;
use crate::{
    compare::{
        error::FileError,
        error_map::{self, ErrorMap},
        png::{developed, png},
        report::Comparison,
    },
    picture::Picture,
};

/// Characters of embedded data that a page may have.
const BUDGET: usize = 18_000_000;

/// Everything that the script compares.
pub(super) struct Viewer {
    /// Width and height \[pixels].
    size: [u32; 2],
    /// The reference's mean, in which all values are measured [W/(m^2 sr)].
    unit: f64,
    /// The reference, then the rows.
    entries: Vec<Entry>,
    /// Names of what doesn't fit.
    left_out: Vec<String>,
}

/// A technique's pictures and values, or the reference's.
struct Entry {
    name: String,
    /// Data URIs.
    pictures: Vec<Shown>,
    /// Half floats, little-endian, in base64: R, G, B a pixel. The reference's are b / mean(b), a technique's are
    /// (a - b) / mean(b), so that a small error keeps its digits.
    values: String,
}

/// A picture to look at.
struct Shown {
    kind: &'static str,
    uri: String,
}

impl Viewer {
    /// Embeds pictures and values; where that is too much only pictures, as many as fit.
    pub(super) fn new(comparison: &Comparison) -> Result<Self, FileError> {
        Self::within(comparison, BUDGET)
    }

    fn within(comparison: &Comparison, budget: usize) -> Result<Self, FileError> {
        let Comparison {
            report,
            reference,
            pictures,
        } = comparison;
        let unit = unit(reference);
        let mut entries = vec![Entry {
            name: "reference".to_owned(),
            pictures: vec![in_scatter(reference, report.exposure)?],
            values: half_floats(reference.pixels.as_flattened(), |_, b| b / unit),
        }];
        for (row, picture) in report.rows.iter().zip(pictures) {
            let truth = reference.pixels.as_flattened();
            entries.push(Entry {
                name: row.setting.label(),
                pictures: shown(picture, reference, report.exposure)?,
                values: half_floats(picture.pixels.as_flattened(), |index, a| {
                    (a - f64::from(truth[index])) / unit
                }),
            });
        }
        if entries.iter().map(Entry::characters).sum::<usize>() > budget {
            entries.iter_mut().for_each(|entry| entry.values.clear());
        }
        let mut left = budget;
        let (entries, left_out): (Vec<Entry>, Vec<Entry>) =
            entries.into_iter().partition(|entry| {
                let fits = entry.characters() <= left;
                left -= if fits { entry.characters() } else { 0 };
                fits
            });
        Ok(Self {
            size: reference.size,
            unit,
            entries,
            left_out: left_out.into_iter().map(|entry| entry.name).collect(),
        })
    }

    /// Says in words which pictures and values aren't embedded.
    pub(super) fn notes(&self) -> impl Iterator<Item = String> {
        let pictures = self.left_out.iter().map(|name| {
            format!(
                "{name}: its pictures are in the files beside this page, which would grow too large"
            )
        });
        let is_bare = self.entries.iter().any(|entry| entry.values.is_empty());
        let values = is_bare.then(|| {
            "Linear values are in the .exr files beside this page, which would grow too large"
                .to_owned()
        });
        values.into_iter().chain(pictures)
    }

    /// The script's data.
    pub(super) fn data(&self) -> Html {
        let entries: Vec<Value> = self.entries.iter().map(Entry::to_json).collect();
        let data = json!({ "size": self.size, "unit": self.unit, "entries": entries });
        // `<` could end the element that this stands in.
        Html::trusted(&data.to_string().replace('<', "\\u003c"))
    }
}

impl Entry {
    fn to_json(&self) -> Value {
        let shown = |shown: &Shown| json!({ "kind": shown.kind, "uri": shown.uri });
        let pictures: Vec<Value> = self.pictures.iter().map(shown).collect();
        json!({ "name": self.name, "pictures": pictures, "values": self.values })
    }

    fn characters(&self) -> usize {
        let pictures = self.pictures.iter().map(|shown| shown.uri.len());
        pictures.sum::<usize>() + self.values.len()
    }
}

/// A technique's picture and its errors.
fn shown(picture: &Picture, reference: &Picture, ev: f32) -> Result<Vec<Shown>, FileError> {
    let errors = error_map::relative_errors(picture, reference);
    let mut shown = vec![in_scatter(picture, ev)?];
    for map in ErrorMap::ALL {
        let bytes = png(&map.colors(&errors), picture.size)?;
        shown.push(Shown::new(map.title(), &bytes));
    }
    Ok(shown)
}

fn in_scatter(picture: &Picture, ev: f32) -> Result<Shown, FileError> {
    let bytes = developed(picture, ev)?;
    Ok(Shown::new("In-scatter", &bytes))
}

impl Shown {
    fn new(kind: &'static str, png: &[u8]) -> Self {
        Self {
            kind,
            uri: format!("data:image/png;base64,{}", STANDARD.encode(png)),
        }
    }
}

/// The mean, but for a black picture.
fn unit(reference: &Picture) -> f64 {
    let mean = error_map::mean(reference);
    if mean.is_finite() && mean > 0.0 {
        mean
    } else {
        1.0
    }
}

fn half_floats(values: &[f32], map: impl Fn(usize, f64) -> f64) -> String {
    let bytes: Vec<u8> = values
        .iter()
        .enumerate()
        .flat_map(|(index, value)| f16::from_f64(map(index, f64::from(*value))).to_le_bytes())
        .collect();
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture;

    #[test]
    fn small_errors_keep_their_digits() {
        let mut comparison = fixture::comparison();
        let unit = unit(&comparison.reference);
        let picture = &mut comparison.pictures[0];
        *picture = comparison.reference.clone();
        picture.pixels[7][1] += 1e-4;
        let difference = f64::from(picture.pixels[7][1] - comparison.reference.pixels[7][1]);
        let viewer = Viewer::new(&comparison).unwrap();
        let bytes = STANDARD.decode(&viewer.entries[1].values).unwrap();
        let values = bytes.as_chunks::<2>().0;
        let found = f16::from_le_bytes(values[3 * 7 + 1]).to_f64() * unit;
        assert!(
            (found / difference - 1.0).abs() < 1e-3,
            "{found} {difference}"
        );
        assert_eq!(values.iter().filter(|v| **v != [0; 2]).count(), 1);
    }

    #[test]
    fn pages_stay_within_their_budget_and_say_what_is_missing() {
        let comparison = fixture::comparison();
        let whole = Viewer::new(&comparison).unwrap();
        assert_eq!((whole.entries.len(), whole.notes().count()), (4, 0));
        let all: usize = whole.entries.iter().map(Entry::characters).sum();
        let bare = Viewer::within(&comparison, all - 1).unwrap();
        assert_eq!((bare.entries.len(), bare.notes().count()), (4, 1));
        let pictures: usize = bare.entries.iter().map(Entry::characters).sum();
        let fewer = Viewer::within(&comparison, pictures - 1).unwrap();
        assert_eq!((fewer.entries.len(), fewer.notes().count()), (3, 2));
        assert!(fewer.notes().any(|note| note.contains("ray-march steps")));
    }

    #[test]
    fn data_cannot_end_its_element() {
        let mut comparison = fixture::comparison();
        comparison.report.rows[0].setting.technique = "</script>".to_owned();
        let data = Viewer::new(&comparison).unwrap().data().to_string();
        assert!(!data.contains('<'));
        let json: serde_json::Value = serde_json::from_str(&data).unwrap();
        assert_eq!(json["entries"][1]["name"], "</script> steps 64");
    }
}
