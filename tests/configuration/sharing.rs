//! Fingers on one port: each refusal names the key to change, and says how to change it.

use crate::reading::{read, usable};
use sun2xp::model::FingerNumber;

fn refusal(text: &str) -> String {
    match read(text) {
        Ok(_) => panic!("accepted: {text}"),
        Err((line, reason)) => {
            assert!(line.is_some(), "{reason}");
            reason
        }
    }
}

#[test]
fn the_refusals_lead_to_three_fingers_on_one_port() {
    let mut text = "[finger]\nport = '/dev/ttyUSB0'\n".to_owned();
    for remedy in ["thread = 1", "baud = 1500000"] {
        let reason = refusal(&text);
        assert!(reason.contains(&format!("et {remedy} ")), "{remedy}: {reason}");
        text += remedy;
        text += "\n";
    }
    let hand = usable(&text);
    let expected = |finger: FingerNumber| (1, finger.get() as u8);
    assert!(
        FingerNumber::ALL.into_iter().all(|finger| (hand.thread(finger), hand.address(finger)) == expected(finger))
    );
}

#[test]
fn a_lower_rate_is_the_other_remedy() {
    let fingers = "[finger]\nport = '/dev/ttyUSB0'\nthread = 2\n";
    let reason = refusal(fingers);
    let (_, rate) = reason.split_once("set hand.rate = ").unwrap_or_else(|| panic!("{reason}"));
    let rate: f64 = rate.split(' ').next().unwrap_or_default().parse().expect("a number");
    assert_eq!(usable(&format!("[hand]\nrate = {rate}\n{fingers}")).hand.rate, rate);
}

#[test]
fn a_key_that_differs_between_fingers_of_a_port_is_named() {
    let shared = "[finger]\nport = 'p'\nthread = 1\nbaud = 2000000\n";
    for (own, remedy) in [
        ("[finger.2]\nbaud = 3000000\n", "give all fingers of the port the same baud"),
        ("[finger.3]\naddress = 1\n", "leave `address` out"),
        ("[finger.2]\nthread = 2\n", "set thread = 1 for every finger of the port"),
        ("[finger.2]\ncore = 1\n", "give all fingers of the thread the same core and priority"),
        ("[finger.3]\npriority = 10\n", "give all fingers of the thread the same core and priority"),
    ] {
        let reason = refusal(&format!("{shared}{own}"));
        assert!(reason.contains(remedy), "{own}: {reason}");
    }
}
