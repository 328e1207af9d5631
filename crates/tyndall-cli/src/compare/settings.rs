//! Settings of a technique that are compared: its own, and those along the parameter that buys quality with time.

use tyndall::techniques::{Technique, Value};

use super::report::Setting;

/// Parameters that buy quality with time, and their values; a technique is varied along the first that it has.
const QUALITY: &[(&str, &[i64])] = &[
    ("steps", &[32, 64, 128, 256, 512, 1024]),
    ("samples", &[128, 256, 512, 1024, 2048]),
    ("resolution", &[64, 128, 256, 512]),
];

/// The value that leaves a count to the technique.
const AUTOMATIC: i64 = 0;

/// A technique to be compared, and what to call it.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The technique and its parameters.
    pub technique: Technique,
    /// Its name and parameters for people.
    pub setting: Setting,
}

/// The technique at its settings, from the coarsest up, its own among them.
pub fn candidates(technique: &Technique) -> Vec<Candidate> {
    let Some((key, values)) = quality(technique) else {
        return vec![candidate(technique.clone(), None)];
    };
    let mut techniques: Vec<Technique> = values
        .iter()
        .filter_map(|value| with(technique, key, *value))
        .collect();
    if !techniques.contains(technique) {
        techniques.push(technique.clone());
    }
    techniques.sort_by_key(|technique| match integer(technique, key) {
        Some(AUTOMATIC) => i64::MAX,
        value => value.unwrap_or(0),
    });
    techniques
        .into_iter()
        .map(|technique| candidate(technique, Some(key)))
        .collect()
}

/// Steps a ray over all lights, of techniques whose parameters fix it.
pub fn steps(technique: &Technique, lights: usize) -> Option<u64> {
    let steps = u64::try_from(integer(technique, "steps")?).ok()?;
    Some(steps * lights as u64)
}

/// A technique's name and parameters for people; `key` is the parameter that tells it from its others.
pub fn candidate(technique: Technique, key: Option<&str>) -> Candidate {
    let parameters: Vec<(String, String)> = technique
        .params()
        .into_iter()
        .map(|param| (param.key.to_owned(), text(&param.value)))
        .collect();
    let varied = parameters.iter().find(|(k, _)| Some(k.as_str()) == key);
    let varied = varied.map(|(key, value)| match integer(&technique, key) {
        Some(AUTOMATIC) => (key.clone(), "auto".to_owned()),
        _ => (key.clone(), value.clone()),
    });
    let setting = Setting {
        technique: technique.info().name.to_owned(),
        varied,
        parameters,
    };
    Candidate { technique, setting }
}

fn quality(technique: &Technique) -> Option<(&'static str, &'static [i64])> {
    QUALITY
        .iter()
        .copied()
        .find(|(key, _)| integer(technique, key).is_some())
}

/// The technique with a parameter changed, where its range has the value.
fn with(technique: &Technique, key: &str, value: i64) -> Option<Technique> {
    let mut technique = technique.clone();
    technique.set(key, &Value::Integer(value)).ok()?;
    Some(technique)
}

fn integer(technique: &Technique, key: &str) -> Option<i64> {
    let mut params = technique.params().into_iter();
    match params.find(|param| param.key == key)?.value {
        Value::Integer(number) => Some(number),
        _ => None,
    }
}

fn text(value: &Value) -> String {
    match value {
        Value::Word(word) => word.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use tyndall::techniques::TABLE;

    use super::*;

    fn march(steps: i64) -> Technique {
        let technique = Technique::from_name("ray-march").unwrap();
        with(&technique, "steps", steps).unwrap()
    }

    #[test]
    fn marching_is_varied_along_its_steps_with_its_own_among_them() {
        for (own, expected) in [
            (512, &[32, 64, 128, 256, 512, 1024][..]),
            (300, &[32, 64, 128, 256, 300, 512, 1024]),
        ] {
            let found: Vec<i64> = candidates(&march(own))
                .iter()
                .filter_map(|candidate| integer(&candidate.technique, "steps"))
                .collect();
            assert_eq!(found, expected);
        }
        let first = &candidates(&march(512))[0].setting;
        assert_eq!(first.label(), "ray-march steps 32");
        assert!(
            first
                .parameters
                .contains(&("spacing".to_owned(), "equal".to_owned()))
        );
    }

    #[test]
    fn what_the_technique_chooses_itself_comes_last_and_is_called_so() {
        let candidates = candidates(&Technique::from_name("min-max").unwrap());
        let last = &candidates.last().unwrap().setting;
        assert_eq!(last.label(), "min-max samples auto");
    }

    #[test]
    fn every_technique_is_compared_and_no_two_share_a_label() {
        for info in TABLE {
            let candidates = candidates(&info.default_technique());
            let mut labels: Vec<String> = candidates.iter().map(|c| c.setting.label()).collect();
            labels.sort();
            labels.dedup();
            assert_eq!(labels.len(), candidates.len());
            assert!(
                candidates
                    .iter()
                    .any(|c| c.technique == info.default_technique())
            );
        }
    }

    #[test]
    fn steps_are_counted_over_lights_where_they_are_fixed() {
        assert_eq!(steps(&march(64), 3), Some(192));
        assert_eq!(steps(&Technique::from_name("reference").unwrap(), 3), None);
    }
}
