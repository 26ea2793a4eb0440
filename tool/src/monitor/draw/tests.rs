//! Pictures of real cycles of the simulated hand, in terminals of several sizes.

use super::*;
use crate::jog::panel::JogPanel;
use crate::monitor::snapshot;
use crate::monitor::state::Tracker;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Color;
use std::time::{Duration, Instant};
use sun2xp::telemetry::{Ended, Message, Reader};
use sun2xp::{Configuration, Fingers, Hand};

/// Sizes of terminals.
const SIZES: [(u16, u16); 6] = [(80, 24), (120, 40), (200, 60), (60, 50), (60, 20), (30, 12)];

/// Longest time until the state has what a test waits for.
const LIMIT: Duration = Duration::from_secs(20);

/// A simulated hand and the view of its telemetry.
struct Attached {
    hand: Option<Hand>,
    reader: Reader,
    view: View,
}

impl Attached {
    fn open(name: &str, limp: bool) -> Self {
        let mut configuration = Configuration::default();
        configuration.telemetry.name = name.into();
        let hand = match limp {
            true => Hand::open_limp(configuration, None, Fingers::ALL),
            false => Hand::open(configuration),
        };
        let hand = hand.expect("the simulated hand opens");
        let reader = Reader::attach(Some(name)).expect("the hand is open");
        let mut view = View::new(String::new());
        view.tracker = Some(Tracker::new(reader.description()));
        view.link = Link::Live;
        Self { hand: Some(hand), reader, view }
    }

    fn hand(&self) -> &Hand {
        self.hand.as_ref().expect("open")
    }

    /// Reads until the state has what the test waits for, or until the hand ends.
    fn until(&mut self, what: &str, holds: impl Fn(&HandState) -> bool) {
        let begun = Instant::now();
        loop {
            let mut messages: Vec<Message> = Vec::new();
            let received = self.reader.read(Duration::from_millis(200), &mut messages);
            let tracker = self.view.tracker.as_mut().expect("attached");
            tracker.apply(&messages, received.as_ref().map(|received| received.lost).unwrap_or_default());
            self.view.now = sun2xp::realtime::now();
            if let Err(end) = received {
                assert_eq!(end, Ended::Closed);
                self.view.link = Link::Ended(end.to_string());
                return;
            }
            if holds(&tracker.state) {
                return;
            }
            assert!(begun.elapsed() < LIMIT, "not within {LIMIT:?}: {what}");
        }
    }
}

fn picture(view: &View, (width, height): (u16, u16)) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a terminal");
    let drawn = terminal.draw(|frame| draw(frame, view, &Palette::coloured())).expect("drawn");
    snapshot::text(drawn.buffer)
}

/// Asserts that every word of a text is in the picture, in its order.
fn assert_complete(picture: &str, text: &str) {
    let mut rest = picture;
    for word in text.split_whitespace() {
        let place = rest.find(word).unwrap_or_else(|| panic!("{word:?} of {text:?} is cut off in\n{picture}"));
        rest = &rest[place + word.len()..];
    }
}

fn assert_contains(picture: &str, parts: &[&str]) {
    for part in parts {
        assert!(picture.contains(part), "{part:?} is not in\n{picture}");
    }
}

#[test]
fn a_running_hand_is_shown_in_every_size() {
    let mut attached = Attached::open("draw-running", false);
    attached.hand().send_position(1, [0.2, 0.5, 1.0]).expect("sent");
    attached.until("all fingers have cycles and timing, and one has settled", |hand| {
        hand.events.iter().any(|event| event.text.starts_with("settled"))
            && hand.fingers.iter().all(|finger| finger.sample.is_some() && finger.wake_up.count > 0)
    });
    let view = &mut attached.view;
    let small = picture(view, (80, 24));
    let parts = ["finger 1 running", "finger 3 running", "J2 ├", "T4 │", "tip ", "F  ", "Kx   3.00  3.00  3.00"];
    assert_contains(&small, &parts);
    assert_contains(&small, &["simulated", "live", "events", "arrived", "rate", "99.9 %", "overruns", "q quit"]);
    // The set point of joint 0 is 0.2 rad, which is 11.5 degrees. The joint has come within about 0.1 degrees of it.
    assert!(small.contains("11.4°") || small.contains("11.5°"), "{small}");
    let large = picture(view, (200, 60));
    assert_contains(&large, &["set point", "tip force", "N/cm", "torques", "stiffness 100 %", "wake-ups of", "200us"]);
    for size in SIZES {
        let picture = picture(view, size);
        assert_contains(&picture, &["J0 ├", "T1 │", "running"]);
        assert_eq!(picture.lines().count(), usize::from(size.1));
    }
    view.select(2);
    for size in SIZES {
        assert_contains(&picture(view, size), &["finger 2 in detail", "J0 ├", "T1 │"]);
    }
    assert_contains(&picture(view, (80, 24)), &["Kx in the frame of finger 2", "set point", "motors", "events"]);
    // Where there is room, the fingers stay above the detail.
    assert_contains(&picture(view, (120, 40)), &["finger 1 running", "finger 2 in detail", "timing"]);
    (view.selected, view.help) = (None, true);
    assert_contains(&picture(view, (80, 24)), &["freeze the picture", "below 0.8 t_min"]);
}

#[test]
fn without_colours_the_picture_has_the_same_characters() {
    let mut attached = Attached::open("draw-plain", false);
    attached.until("cycles", |hand| hand.fingers.iter().all(|finger| finger.sample.is_some()));
    attached.hand().stop(1).expect("there");
    attached.until("finger 1 is faulted", HandState::faulted);
    let mut terminal = Terminal::new(TestBackend::new(120, 40)).expect("a terminal");
    let plain = terminal.draw(|frame| draw(frame, &attached.view, &Palette::plain())).expect("drawn").buffer.clone();
    assert!(plain.content.iter().all(|cell| cell.fg == Color::Reset && cell.bg == Color::Reset));
    assert_eq!(snapshot::text(&plain), picture(&attached.view, (120, 40)));
}

#[test]
fn a_fault_is_shown_with_its_whole_remedy() {
    let mut attached = Attached::open("draw-faulted", false);
    // A new reader gets at least the events from its first cycle on.
    attached.until("cycles", |hand| hand.fingers.iter().all(|finger| finger.sample.is_some()));
    attached.hand().stop(2).expect("there");
    attached.until("finger 2 is faulted", |hand| hand.faulted() && hand.events.iter().any(|event| event.fault));
    let fault = attached.hand().fault(2).expect("there").stopped.expect("stopped");
    for size in &SIZES[..5] {
        let picture = picture(&attached.view, *size);
        assert_contains(&picture, &["FAULTED", &format!("finger 2, fault {}", fault.kind.number())]);
        assert_complete(&picture, &fault.to_string());
    }
    // All fingers with the same fault share its text.
    for finger in [1, 3] {
        attached.hand().stop(finger).expect("there");
    }
    attached.until("all are faulted", |hand| hand.fingers.iter().all(|finger| finger.fault.is_some()));
    let picture_of_all = picture(&attached.view, (80, 24));
    assert_contains(&picture_of_all, &["fingers 1, 2, 3, fault"]);
    assert_complete(&picture_of_all, &fault.to_string());

    // A text that does not fit into the terminal can be scrolled.
    let tracker = attached.view.tracker.as_mut().expect("attached");
    for (finger, word) in tracker.state.fingers.iter_mut().zip(["one", "two", "three"]) {
        let fault = finger.fault.as_mut().expect("faulted");
        fault.text = format!("{word}begin {} {word}end", fault.text.repeat(3));
    }
    let mut seen = String::new();
    for scroll in 0..60 {
        attached.view.scroll = scroll;
        seen += &picture(&attached.view, (80, 24));
    }
    assert_contains(&seen, &["onebegin", "oneend", "twobegin", "twoend", "threebegin", "threeend", "lines above"]);
    assert_contains(&seen, &["up and down keys"]);
    // The arrow keys of jog move the hand.
    attached.view.jog = Some(JogPanel::new(true));
    let with_jog = picture(&attached.view, (80, 24));
    assert!(with_jog.contains("keys { and }") && !with_jog.contains("up and down keys"), "{with_jog}");
}

#[test]
fn slack_tendons_are_marked_and_a_closed_hand_stays_on_the_screen() {
    let mut attached = Attached::open("draw-slack", true);
    let slack = |hand: &HandState| {
        let sample = |finger: &crate::monitor::finger_state::FingerState| {
            finger.sample.as_ref().is_some_and(|sample| sample.tensions.iter().all(|&tension| tension < 4.0))
        };
        hand.fingers.iter().all(sample)
    };
    attached.until("the tendons of a limp hand are slack", slack);
    let picture_of_slack = picture(&attached.view, (80, 24));
    assert_contains(&picture_of_slack, &["finger 1 limp", "T1 ‹", "T4 ‹"]);
    attached.hand = None;
    attached.until("the hand ends", |_| false);
    let closed = picture(&attached.view, (80, 24));
    assert_contains(&closed, &["ended", "T4 ‹", "finger 1 closed"]);
    assert_complete(&closed, "the hand was closed, or its program has ended. This view waits for the next hand");
}

#[test]
fn a_frozen_picture_stays_while_the_state_goes_on() {
    let mut attached = Attached::open("draw-frozen", false);
    attached.until("cycles", |hand| hand.fingers.iter().all(|finger| finger.cycle > 0));
    attached.view.toggle_frozen();
    let cycle = attached.view.shown().expect("a state").0.fingers[0].cycle;
    attached.hand().send_position(1, [0.5, 0.5, 1.0]).expect("sent");
    attached.until("more cycles", |hand| hand.fingers[0].cycle > cycle + 500);
    assert_eq!(attached.view.shown().expect("a state").0.fingers[0].cycle, cycle);
    assert_contains(&picture(&attached.view, (80, 24)), &["frozen for 0."]);
    attached.view.toggle_frozen();
    assert!(attached.view.shown().expect("a state").0.fingers[0].cycle > cycle);
    // The snapshot has the same numbers as the screen.
    let folder = tempfile::tempdir().expect("a folder");
    let (hand, _) = attached.view.shown().expect("a state");
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).expect("a terminal");
    let screen = terminal.draw(|frame| draw(frame, &attached.view, &Palette::coloured())).expect("drawn").buffer;
    let [json, text, _] = snapshot::write(folder.path(), hand, screen).expect("written");
    let state: serde_json::Value = serde_json::from_slice(&std::fs::read(json).expect("there")).expect("JSON");
    assert_eq!(state["fingers"][0]["cycle"], hand.fingers[0].cycle);
    assert!(state["fingers"][2]["sample"]["tensions"][3].as_f64().is_some_and(|tension| tension > 4.0), "{state}");
    assert_contains(&std::fs::read_to_string(text).expect("there"), &["finger 3 running", "q quit"]);
    let again = snapshot::write(folder.path(), hand, screen).expect("written");
    assert!(again[0].exists() && std::fs::read_dir(folder.path()).expect("there").count() == 6);
}

#[test]
fn without_a_hand_the_reason_is_shown_and_controls_have_their_lines() {
    let mut view = View::new("no hand of this user is open: start the program that opens it".into());
    for size in SIZES {
        assert_complete(&picture(&view, size), "no hand of this user is open: start the program that opens it");
    }
    view.jog = Some(JogPanel::new(false));
    let refusal = "joint 0 would be at 2.1 rad, outside the limits of finger 1: send an angle within the limits, widen \
                   them in `finger.joints`, or set `hand.out_of_range`";
    view.jog.as_mut().expect("there").result = Some((refusal.into(), true));
    let picture = picture(&view, (80, 24));
    assert_contains(&picture, &["sun2xp jog", "jog finger 1", "[j joints 1°]", "EMERGENCY STOP"]);
    assert_complete(&picture, refusal);
}
