//! Hardware whose shortest watchdog time is longer than the configured time.

use super::plant_io::PlantIo;
use sun2xp::Hand;
use sun2xp::hand::Fingers;
use sun2xp::io::FingerIo;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Mutex, Severity, offer_messages_to};

/// The messages of all hands of this process.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn note(_: Severity, text: &str) -> bool {
    MESSAGES.lock().push(text.into());
    // The message is printed too.
    false
}

/// Opens finger 2 with hardware that has this shortest watchdog time, ms. Returns the time that the hardware gets, and
/// the notices about it. The servo waits for this hardware (`in_step`), so the library never reports that the watchdog
/// time has passed, and a pause of the machine does not fail the test.
fn opened(shortest_watchdog_ms: u16) -> (u16, Vec<String>) {
    offer_messages_to(note);
    let mut configuration = Configuration::default();
    configuration.hand.fingers = Fingers::only(2).expect("finger 2");
    let mut hardware = PlantIo::new(&configuration, FingerNumber::TWO, true);
    hardware.properties.shortest_watchdog_ms = shortest_watchdog_ms;
    let switches = hardware.switches.clone();
    MESSAGES.lock().clear();
    let hand = Hand::open_with_io(configuration, [None, Some(Box::new(hardware) as Box<dyn FingerIo>), None]);
    hand.expect("open").close();
    let notices = MESSAGES.lock().iter().filter(|text| text.contains("shortest watchdog time")).cloned().collect();
    (switches.lock().terms.expect("terms").watchdog_ms, notices)
}

#[test]
fn hardware_that_needs_a_longer_watchdog_time_gets_it_and_is_announced() {
    assert_eq!(opened(18), (18, Vec::new()), "the configured time");
    let (agreed, notices) = opened(20);
    assert!(agreed == 20 && notices.len() == 1, "{agreed} ms: {notices:?}");
    for part in ["the board of finger 2 is 20 ms", "hand.watchdog_ms is 18", "continue for 20 ms"] {
        assert!(notices[0].contains(part), "{part:?} is not in: {}", notices[0]);
    }
}
