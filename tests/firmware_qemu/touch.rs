//! The tactile elements of the emulated boards.

use crate::machine::{Emulated, LM3S6965, STM32F405};
use crate::{KEYS, PATIENCE, alone, text, wait_until, with_configured_hand};

#[test]
fn the_tactile_elements_of_the_lm3s6965_reach_the_planner() {
    elements_reach_the_planner(LM3S6965);
}

#[test]
fn the_tactile_elements_of_the_stm32f405_reach_the_planner() {
    elements_reach_the_planner(STM32F405);
}

/// An element of finger 2 is pressed and becomes unreadable. Finger 1 has no configured elements.
fn elements_reach_the_planner(emulated: Emulated) {
    let Some(_alone) = alone() else { return };
    let keys = format!(
        "{KEYS}\n[finger.2.touch]\nelements = [{{ position = [0, 0, 0], normal = [0, 0, 1], zero = 300 }}, \
         {{ position = [0, 0, 0], normal = [1, 0, 0], zero = 500, newton_per_count = 0.002 }}]"
    );
    with_configured_hand(emulated, "touch on the firmware", &keys, |machine, hand| {
        assert!(!hand.touch(2, 1).expect("an element").valid);
        let none = hand.touch(1, 0).expect_err("no element is configured").to_string();
        assert!(none.contains("no tactile element with the number 0, because its configuration lists 0 elements"));
        machine.finger(1).touch[1] = 600;
        let pressed = wait_until(PATIENCE, || hand.touch(2, 1).expect("an element").pressed);
        let reading = hand.touch(2, 1).map_err(text)?;
        if !pressed || (reading.force - 0.2).abs() > 1e-9 {
            return Err(format!("{reading:?}"));
        }
        machine.finger(1).touch[1] = 0xFFFF;
        let unreadable = wait_until(PATIENCE, || !hand.touch(2, 1).expect("an element").valid);
        if unreadable { Ok(()) } else { Err("an element that cannot be read has a reading".into()) }
    });
}
