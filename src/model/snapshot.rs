//! Serialises large types with code that is compiled only once for each type. Serde itself compiles the code of a type
//! again for each format: TOML, JSON and the format of telemetry. So a value is first copied to a snapshot, and only
//! the snapshot is written in each format.

mod copying;
mod value;

pub use copying::snapshot;
use serde::ser::Error;
use serde::{Serialize, Serializer};

/// Serialises a field through a snapshot of its value. The attribute `serialize_with` of a field names this function.
///
/// # Errors
/// Returns the error of the format.
pub fn serialize<T: Serialize, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    snapshot(value).map_err(S::Error::custom)?.serialize(serializer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::{Configuration, Surface};

    #[test]
    fn a_snapshot_is_written_as_the_value_itself() {
        let mut configuration = Configuration::default();
        let finger = &mut configuration.fingers[1];
        finger.core = Some(3);
        finger.base = Some([0.1, -0.2, 3.0]);
        finger.simulation.surface = Some(Surface::Ball { centre: [0.0, 1.0, 9.0], radius: 2.0, stiffness: 30.0 });
        let copy = snapshot(&configuration).expect("supported");

        let json = serde_json::to_string(&configuration).expect("JSON");
        assert_eq!(serde_json::to_string(&copy).expect("JSON"), json);
        let bytes = postcard::to_stdvec(&configuration).expect("encoded");
        assert_eq!(postcard::to_stdvec(&copy).expect("encoded"), bytes);
        let toml = toml_edit::ser::to_string(&configuration).expect("TOML");
        assert_eq!(toml_edit::ser::to_string(&copy).expect("TOML"), toml);
    }

    #[test]
    fn a_map_is_refused() {
        let map = std::collections::BTreeMap::from([("key", 1)]);
        assert!(snapshot(&map).expect_err("refused").to_string().contains("map"));
    }
}
