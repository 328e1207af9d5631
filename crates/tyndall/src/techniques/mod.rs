//! The techniques, and the one table of them. Each folder's first page is its manual.

mod choice;
pub mod epipolar_sampling;
pub mod hybrid;
pub mod imperfect_voxelized;
pub mod incremental;
mod info;
pub mod light_volume;
mod method;
pub mod min_max;
mod params;
pub mod ray_march;
pub mod reference;
mod table;
pub mod voxelized;

pub use choice::TechniqueChoice;
#[cfg(feature = "gpu")]
pub(crate) use info::Reach;
pub use info::{Backends, Reads, TechniqueInfo};
#[cfg(feature = "gpu")]
pub(crate) use method::{GpuMethod, LightRequest};
pub use params::{ParamError, ParamInfo, Value};
pub use table::{TABLE, Technique};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_find_their_entry() {
        for entry in TABLE {
            let technique = Technique::from_name(entry.name).expect("in the table");
            assert_eq!(technique.info().name, entry.name);
            assert_eq!(TABLE.iter().filter(|t| t.name == entry.name).count(), 1);
        }
        assert_eq!(Technique::from_name("magic"), None);
    }

    #[test]
    fn every_default_can_be_set_again() {
        for entry in TABLE {
            let mut technique = entry.default_technique();
            for param in technique.params() {
                technique
                    .set(param.key, &param.default)
                    .expect("a default is in range");
            }
            assert_eq!(technique, entry.default_technique());
        }
    }

    #[test]
    fn wrong_parameters_are_refused_with_what_was_expected() {
        let mut technique = Technique::from_name("ray-march").expect("in the table");
        let before = technique.clone();
        let unknown = technique.set("stepz", &Value::Integer(3)).unwrap_err();
        assert_eq!(
            unknown.to_string(),
            "technique `ray-march` has no parameter `stepz`; it has steps, spacing, points"
        );
        for wrong in [
            Value::Integer(0),
            Value::Integer(-4),
            Value::Real(12.5),
            Value::Word("many".into()),
        ] {
            let error = technique.set("steps", &wrong).unwrap_err();
            assert!(
                error.to_string().contains(&format!("found {wrong}")),
                "{error}"
            );
        }
        assert_eq!(technique, before);
    }
}
