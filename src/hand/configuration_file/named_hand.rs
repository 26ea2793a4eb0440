//! The key `simulation.hand`: a name that stands for the values of other keys.

use super::values::to_document;
use super::wrong::Wrong;
use crate::model::configuration::ConfiguredSimulation;
use toml_edit::{Item, Table, value};

/// Adds to the table of a finger the values for which `simulation.hand` stands. Keys that the table contains keep their
/// values. An unknown name adds nothing: the conversion of the table refuses it.
pub(super) fn add_named_values(finger: &mut Table) -> Result<(), Wrong> {
    let Some(simulation) = finger.get_mut("simulation").and_then(Item::as_table_like_mut) else { return Ok(()) };
    let name = simulation.get("hand").and_then(Item::as_str);
    let Some(values) = name.and_then(ConfiguredSimulation::named) else { return Ok(()) };
    let values = to_document(&values)?;
    for (key, value) in values.iter() {
        if !simulation.contains_key(key) {
            simulation.insert(key, value.clone());
        }
    }
    Ok(())
}

/// Sets the name in the table of a finger. If `simulation` is no table, the conversion of the finger refuses it.
pub(super) fn set_name(finger: &mut Table, name: &str) {
    let simulation = finger.entry("simulation").or_insert_with(|| Item::Table(Table::new()));
    if let Some(simulation) = simulation.as_table_like_mut() {
        simulation.insert("hand", value(name));
    }
}
