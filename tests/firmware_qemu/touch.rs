//! The tactile elements of the emulated board.

use crate::{KEYS, PATIENCE, alone, text, wait_until, with_configured_hand};

/// An element of finger 2 is pressed, becomes unreadable, and can be read again. Finger 3 has no configured elements.
#[test]
fn its_tactile_elements_reach_the_planner() {
    let Some(_alone) = alone() else { return };
    let keys = format!(
        "{KEYS}\n[finger.2.touch]\nelements = [{{ position = [0, 0, 0], normal = [0, 0, 1], zero = 300 }}, \
         {{ position = [0, 0, 0], normal = [1, 0, 0], zero = 500, newton_per_count = 0.002 }}]"
    );
    with_configured_hand("touch on the firmware", &keys, |machine, hand| {
        assert!(!hand.touch(2, 1).expect("an element").valid);
        hand.touch(3, 0).expect_err("no element is configured");
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
