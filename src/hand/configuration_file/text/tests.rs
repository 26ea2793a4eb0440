use super::*;
use crate::model::configuration::Surface;

fn refusal(text: &str) -> (Option<usize>, String) {
    let wrong = parse(text).expect_err("refused");
    (wrong.line(text), wrong.to_string())
}

#[test]
fn an_empty_file_is_the_default_hand() {
    assert_eq!(parse("").expect("usable").0, Configuration::default());
}

#[test]
fn a_finger_overrides_what_all_fingers_share() {
    let text = "[finger]\nport = 'simulated'\nbaud = 2000000\n[finger.tendon]\nminimum = 4\nmaximum = 50\n\
                [finger.2]\nport = '/dev/ttyUSB1'\n[finger.2.tendon]\nminimum = 6\n";
    let (hand, _) = parse(text).expect("usable");
    assert_eq!(hand.fingers.each_ref().map(|f| f.baud), [2_000_000; 3]);
    assert_eq!(hand.fingers.each_ref().map(|f| f.tendon.minimum), [4.0, 6.0, 4.0]);
    assert_eq!(hand.fingers.each_ref().map(|f| f.tendon.maximum), [50.0; 3]);
    assert_eq!(hand.fingers[1].port, "/dev/ttyUSB1");
    assert_eq!(hand.fingers[0].port, "simulated");
}

#[test]
fn a_surface_of_a_finger_replaces_a_surface_of_another_kind() {
    let ball = "ball = { centre = [0, 1, 9], radius = 2, stiffness = 30 }";
    let wall = "wall = { point = [0, 1, 9], normal = [0, -1, 0], stiffness = 30 }";
    let text = format!(
        "[finger.simulation]\nsurface = {{ {ball} }}\n[finger.2.simulation]\nsurface = {{ {wall} }}\n\
         [finger.3.simulation.surface]\nball = {{ radius = 3 }}\n"
    );
    let (hand, _) = parse(&text).unwrap_or_else(|wrong| panic!("{wrong}"));
    let surfaces = hand.fingers.map(|finger| finger.simulation.surface);
    let [Some(Surface::Ball { .. }), Some(Surface::Wall { .. }), Some(third)] = surfaces else {
        panic!("{surfaces:?}");
    };
    // The ball of finger 3 has its other values from the ball that is configured for all fingers.
    assert_eq!(third, Surface::Ball { centre: [0.0, 1.0, 9.0], radius: 3.0, stiffness: 30.0 });
}

#[test]
fn unknown_keys_are_named_with_their_line() {
    for (text, line, word) in [
        ("[hand]\nrate = 1000\nrat = 5\n", 3, "rat"),
        ("[finger]\n[finger.gauge]\nzeros = [0, 0, 0, 0]\n", 3, "zeros"),
        ("[finger.3]\n\nbord = 1\n", 3, "bord"),
        ("[fingers]\n", 1, "fingers"),
        ("[finger.4]\n", 1, "4"),
    ] {
        let (found, reason) = refusal(text);
        assert_eq!(found, Some(line), "{text:?}: {reason}");
        assert!(reason.contains(word), "{text:?}: {reason}");
    }
}

#[test]
fn a_finger_without_a_port_is_not_simulated_beside_real_ones() {
    let text = "[finger.2]\nport = '/dev/a'\n[finger.3]\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n";
    let (line, reason) = refusal(text);
    assert_eq!(line, Some(2), "{reason}");
    assert!(reason.starts_with("finger.1.port: is missing") && reason.contains("hand.fingers = [2, 3]"), "{reason}");
    let (_, reason) = refusal("[finger.3]\nport = '/dev/a'\n");
    assert!(reason.starts_with("finger.1.port: is missing") && reason.contains("hand.fingers = [3]"), "{reason}");
    for beside in ["[finger.1]\nport = 'simulated'\n", "[hand]\nfingers = [2, 3]\n"] {
        let (hand, _) = parse(&format!("{text}{beside}")).expect("usable");
        assert!(hand.fingers[2].board.is_some() && !hand.fingers[2].simulated(), "{beside}");
    }
}

#[test]
fn a_port_of_a_finger_replaces_the_board_of_all_and_the_reverse() {
    let board = "board = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n";
    let (hand, _) = parse(&format!("[finger]\nport = 'simulated'\n[finger.1]\n{board}")).expect("usable");
    assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::simulated), [false, true, true]);
    let of_all = format!("[finger]\nthread = 1\nbaud = 2000000\n{board}");
    let (hand, _) = parse(&format!("{of_all}[finger.2]\nport = 'simulated'\n")).expect("usable");
    assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::simulated), [false, true, false]);
    let (line, reason) = refusal(&format!("[finger.1]\nport = '/dev/a'\n{board}"));
    assert!(line == Some(3) && reason.contains("remove one of them"), "{reason}");
}

#[test]
fn a_hand_has_the_listed_fingers() {
    let (hand, _) = parse("[hand]\nfingers = [3, 1]\n[finger.2]\nport = '/dev/later'\n").expect("usable");
    assert_eq!(hand.hand.fingers.numbers().collect::<Vec<_>>(), [1, 3]);
    for (list, word) in [
        ("[]", "list the numbers of its fingers, for example [2]"),
        ("[4]", "no finger 4: fingers are 1, 2 and 3"),
        ("[2, 2]", "a finger is listed twice: list each finger once, for example [1, 3]"),
        ("2", "must be"),
    ] {
        let (line, reason) = refusal(&format!("[hand]\nfingers = {list}\n"));
        assert!(line == Some(2) && reason.contains(word), "{list}: {reason}");
    }
}

#[test]
fn the_remedy_for_a_wrong_board_is_complete() {
    let (line, reason) = refusal("[finger.1]\nboard = '00 00'\n");
    assert!(line == Some(2) && reason.ends_with("as `sun2xp boards` prints it"), "{reason}");
}

#[test]
fn wrong_types_are_named_with_their_line() {
    for (text, line) in [
        ("[hand]\n\nrate = 'fast'\n", 3),
        ("[finger.tendon]\nstiffness = [1, 2, 3]\n", 2),
        ("hand = 3\n", 1),
        ("[finger]\n2 = 7\n", 2),
        ("[hand]\nrate = \n", 2),
    ] {
        let (found, reason) = refusal(text);
        assert_eq!(found, Some(line), "{text:?}: {reason}");
    }
}

#[test]
fn impossible_values_are_named_with_line_and_reason() {
    let printed =
        "[finger.geometry]\nr = [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, 1.09], [0, 0.62, -0.62, 0]]\n";
    let with_ones = &format!("{printed}ghost_row = [1, 1, 1, 1]\n");
    for (text, line, words) in [
        (printed, Some(2), "positive"),
        (with_ones, Some(2), "singular"),
        ("[finger.geometry]\nr = [[1, 1, 1, 1], [1, 0, 0, 0], [2, 1, 1, 1]]\n", Some(2), "singular"),
        ("[finger.1.geometry]\nghost_row = [-1, -1, -1, -1]\n", Some(2), "positive"),
        ("[finger.geometry]\nr = [[1, 1, 1, 1], [1, 0, 0, 0], [0, 1, 0, 0]]\n", Some(2), "positive"),
        ("[finger.3.tendon]\nmaximum = 8\n", Some(2), "for its pretension"),
        // The refused key, tendon.maximum, is not in the file, so the error gives the line of its table. Another
        // key of that table makes the default value of tendon.maximum unusable.
        ("[finger.tendon]\n\nminimum = 40\n", Some(1), "for its pretension"),
        ("[hand]\nrate = 500\n\n[finger.3.tendon]\nminimum = 40\n", Some(4), "for its pretension"),
        ("[hand]\nrate = nan\n", Some(2), "outside"),
        ("[hand]\nwatchdog_ms = 3\nrate = 500\n", Some(2), "two periods"),
        ("[finger.2.joints]\nminimum_degrees = [0, 0, -5]\n", Some(2), "singular"),
        ("[finger]\nport = '/dev/ttyUSB0'\naddress = 1\n", Some(1), "thread"),
    ] {
        let (found, reason) = refusal(text);
        assert_eq!(found, line, "{text:?}: {reason}");
        assert!(reason.contains(words), "{text:?}: {reason}");
    }
}

#[test]
fn values_with_which_no_controller_can_be_constructed_are_refused_with_the_key_to_correct() {
    for (text, line, beginning, words) in [
        ("[finger.tendon]\nmaximum = 10\n", 2, "finger.1.tendon.maximum: is too low", "lower tendon.minimum"),
        ("[hand]\nrate = 1000\n[finger.3.tendon]\nmaximum = 10\n", 4, "finger.3.tendon.maximum: is too low", "Raise"),
        (
            "[finger.2.friction]\njoint_coulomb = [20, 20, 20]\n",
            2,
            "finger.2.friction.joint_coulomb: because of this value, the key motor.continuous_torque is refused. \
             Correct this value first. The refusal is: motor.continuous_torque: is too low",
            "lower tendon.minimum",
        ),
        (
            "[finger.motor]\nviscous_friction = [1, 1, 1, 1]\n",
            2,
            "finger.1.motor.viscous_friction: 1 N m s/rad",
            "must be at most",
        ),
    ] {
        let (found, reason) = refusal(text);
        assert_eq!(found, Some(line), "{text:?}: {reason}");
        assert!(reason.starts_with(beginning) && reason.contains(words), "{text:?}: {reason}");
    }
    // No controller is constructed for a finger that the hand does not have.
    assert!(parse("[hand]\nfingers = [1]\n[finger.2.tendon]\nmaximum = 10\n").is_ok());
}

#[test]
fn a_simulated_finger_that_a_step_cannot_integrate_is_refused_with_its_line() {
    for (text, key) in [
        ("[finger.2.simulation]\njoint_viscous_friction = [0.5, 0.5, 0.5]\n", "joint_viscous_friction"),
        ("[finger.2.simulation]\nmasses = [1e-6, 1e-6, 1e-6, 1e-6]\n", "masses"),
        ("[finger.2.simulation]\nmotor_viscous_friction = [1, 1, 1, 1]\n", "motor_viscous_friction"),
    ] {
        let (line, reason) = refusal(text);
        assert_eq!(line, Some(2), "{text:?}: {reason}");
        assert!(reason.starts_with(&format!("finger.2.simulation.{key}: ")), "{text:?}: {reason}");
    }
}
