//! Takes values of a configuration, or of the `Numbers` of state feedback, from a TOML text.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::error::Error;
use toml_edit::{DocumentMut, TableLike};

/// Returns a copy of `whole` in which every key that is in `text` has its value from `text`.
pub fn overlaid<Whole: Serialize + DeserializeOwned>(whole: &Whole, text: &str) -> Result<Whole, Box<dyn Error>> {
    let above: DocumentMut = text.parse()?;
    let mut document = toml_edit::ser::to_document(whole)?;
    overlay(document.as_table_mut(), above.as_table());
    Ok(toml_edit::de::from_document(document)?)
}

fn overlay(below: &mut dyn TableLike, above: &dyn TableLike) {
    for (key, item) in above.iter() {
        match (below.get_mut(key).and_then(|item| item.as_table_like_mut()), item.as_table_like()) {
            (Some(below), Some(above)) => overlay(below, above),
            _ => {
                below.insert(key, item.clone());
            }
        }
    }
}
