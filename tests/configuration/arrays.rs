//! An array must have exactly the number of entries that its key requires. An extra entry would be lost silently, and a
//! missing one would become a default.

use crate::reading::{keys, read, with_optional_keys};
use toml_edit::{Array, Value};

/// Every array in a value, the value itself included. Each is given by its path of indices, from the outside in.
fn arrays(value: &Value, place: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    let Value::Array(array) = value else { return };
    found.push(place.clone());
    for (index, entry) in array.iter().enumerate() {
        place.push(index);
        arrays(entry, place, found);
        place.pop();
    }
}

/// The value with one of its arrays changed.
fn with_array(value: &Value, place: &[usize], change: fn(&mut Array)) -> Value {
    let mut changed = value.clone();
    let array = place.iter().fold(&mut changed, |value, &index| {
        value.as_array_mut().and_then(|array| array.get_mut(index)).expect("an entry")
    });
    change(array.as_array_mut().expect("an array"));
    changed
}

fn longer(array: &mut Array) {
    let last = array.iter().last().cloned().expect("an entry");
    array.push(last);
}

fn shorter(array: &mut Array) {
    array.remove(array.len() - 1);
}

#[test]
fn every_array_has_exactly_the_number_of_entries_that_its_key_requires() {
    let mut tried = 0;
    for key in keys(&with_optional_keys()) {
        let value: Value = key.value.parse().expect("a value");
        // The lengths of these lists are not fixed: the fingers of a hand, and the ports to search.
        if matches!(&*key.name, "fingers" | "search_ports") {
            continue;
        }
        // The length of a list of tables is not fixed. The arrays in its tables are tested below.
        if value.as_array().is_some_and(|array| array.get(0).is_some_and(Value::is_inline_table)) {
            continue;
        }
        let mut places = Vec::new();
        arrays(&value, &mut Vec::new(), &mut places);
        for place in places {
            let changes: [fn(&mut Array); 3] = [longer, shorter, Array::clear];
            for change in changes {
                let written = with_array(&value, &place, change).to_string();
                let text = format!("[{}]\n\n{} = {written}\n", key.table, key.name);
                let (line, reason) = read(&text).expect_err(&text);
                assert_eq!(line, Some(3), "{text}: {reason}");
                assert!(reason.contains(&key.name) && reason.contains("entries, and must have"), "{text}: {reason}");
                tried += 1;
            }
        }
    }
    assert!(tried > 120, "only {tried} arrays tried");
}

#[test]
fn arrays_inside_inline_tables_have_exactly_the_number_of_entries_that_their_keys_require() {
    for wrong in ["point = [4, 0, 0, 0]", "normal = [-1, 0]"] {
        let right = ["point = [4, 0, 0]", "normal = [-1, 0, 0]"]
            .map(|right| if right[..4] == wrong[..4] { wrong } else { right })
            .join(", ");
        let text = format!("[finger.3.simulation]\nsurface = {{ wall = {{ {right}, stiffness = 5 }} }}\n");
        let (line, reason) = read(&text).expect_err(&text);
        assert_eq!(line, Some(2), "{reason}");
        assert!(reason.contains("finger.3.simulation.surface.wall."), "{reason}");
        assert!(reason.contains("entries, and must have 3"), "{reason}");
    }
}

#[test]
fn errors_inside_a_list_of_tables_are_refused() {
    let good = "{ position = [0, 0, 0], normal = [0, 0, 1] }";
    for (wrong, needed) in [
        ("{ position = [0, 0], normal = [0, 0, 1] }", "entries, and must have 3"),
        ("{ position = [0, 0, 0], normal = [0, 0, 1, 0] }", "entries, and must have 3"),
        ("{ position = [0, 0, 0], normal = [0, 0, 0] }", "a normal of length 0"),
        ("{ position = [0, 0, 0], normal = [0, 0, 1], newton_per_count = 0 }", "outside"),
        ("{ position = [0, 0, 0] }", "normal"),
    ] {
        let text = format!("[finger.touch]\nelements = [{good}, {wrong}]\n");
        let (line, reason) = read(&text).expect_err(&text);
        assert_eq!(line, Some(2), "{reason}");
        assert!(reason.contains("touch.elements") && reason.contains(needed), "{reason}");
    }
    let many = format!("[finger.touch]\nelements = [{}]\n", [good; 65].join(", "));
    let (_, reason) = read(&many).expect_err("65 elements");
    assert!(reason.contains("at most 64"), "{reason}");
}

#[test]
fn the_row_that_is_wrong_is_named_with_its_line() {
    let text = "[finger.2.geometry]\nr = [\n  [-1.09, 0.62, 0.62, -1.09],\n  [1.09, 0.62, -0.62, -1.09, 0, 0],\n  \
                [0, 0.62, -0.62, 0],\n]\n";
    let (line, reason) = read(text).expect_err("six tendons");
    assert_eq!((line, reason.as_str()), (Some(4), "finger.2.geometry.r[1]: has 6 entries, and must have 4"));
}

#[test]
fn an_array_is_no_table() {
    for text in ["[finger]\ntendon = [4.0]\n", "[finger.1]\ntendon = [5.0, 60.0]\n", "[[finger.joints]]\n"] {
        let (line, reason) = read(text).expect_err(text);
        assert_eq!(line, Some(if text.starts_with("[[") { 1 } else { 2 }), "{reason}");
        assert!(reason.contains("must be a table"), "{reason}");
    }
}
