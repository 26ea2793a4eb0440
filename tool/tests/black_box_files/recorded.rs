//! Recordings for the tests.

use std::sync::OnceLock;
use std::time::{Duration, Instant};
use sun2xp::control::Activity;
use sun2xp::finger::{Fading, Recording};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, Scheme};
use sun2xp::nalgebra::Vector4;

/// Recordings of one finger of a hand.
pub struct Recorded {
    /// Begins while slack is taken up. Contains a set point, a stiffness and an adjustment.
    pub opening: Recording,
    /// Begins while the finger is a spring.
    pub running: Recording,
}

/// Recordings of the default controller.
pub fn recorded() -> &'static Recorded {
    static RECORDED: OnceLock<Recorded> = OnceLock::new();
    RECORDED.get_or_init(|| record(Scheme::StateFeedback))
}

/// Recordings of a simulated finger with this controller.
pub fn record(scheme: Scheme) -> Recorded {
    let mut configuration = Configuration::default();
    configuration.hand.rate = 750.0;
    configuration.hand.end_state = sun2xp::model::configuration::EndState::Hold;
    configuration.fingers[0].controller.scheme = Some(scheme);
    let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"));
    let until = |end: u64| {
        let begun = Instant::now();
        while hand.report(1).expect("a report").losses.cycles < end {
            assert!(begun.elapsed() < Duration::from_secs(30), "the servo does not run");
            std::thread::sleep(Duration::from_millis(2));
        }
    };
    hand.send_position(1, [0.1, 0.5, 1.1]).expect("sent");
    until(1500);
    hand.adjust(1, "tendon.minimum = 6").expect("adjusted");
    hand.send_stiffness(1, [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.5]]).expect("sent");
    until(1620);
    let opening = hand.recording(1).expect("a recording");
    until(3000);
    let running = hand.recording(1).expect("a recording");
    Recorded { opening, running }
}

/// The first cycles of a recording, changed so that they contain every activity, a lost reply, skipped periods, fading,
/// a restart, and the change to the last controller of the recording. Their replay shows no difference.
pub fn varied(recording: &Recording) -> Recording {
    let mut varied = recording.clone();
    let (first, last) = (varied.origin.controllers[0].number, varied.origin.controllers.last().expect("one").number);
    let pulls = Vector4::new(6.0, 7.0, 8.0, 9.0);
    let activities = [
        Activity::TakeUpSlack,
        Activity::Tighten(pulls * 0.1),
        Activity::Tense(pulls),
        Activity::Pull(pulls),
        Activity::Turn(pulls * 0.05),
        Activity::Release { ramp: 0.2 },
    ];
    // On a busy machine the servo sometimes waits for the simulated finger. Nothing is computed in such a cycle. The
    // last cycle may be such a cycle.
    let computed = recording.cycles.iter().rev().find_map(|cycle| cycle.control);
    let followed = computed.expect("a spring").input.activity;
    varied.cycles.retain(|cycle| cycle.control.is_some());
    varied.cycles.truncate(activities.len() + 6);
    for (index, cycle) in varied.cycles.iter_mut().enumerate() {
        cycle.cycle = index as u64 + 1;
        let feedback = cycle.feedback;
        let control = cycle.control.as_mut().expect("computed");
        (control.controller, control.previous) = (first, first);
        control.input.activity = activities.get(index).copied().unwrap_or(followed);
        match index {
            7 => (cycle.feedback, control.input.skipped) = (None, 2),
            8 => control.input.fading = Some(Fading { left: 0.4, rest: 0.5 }),
            9 => control.input.anew_from = feedback,
            10 => (control.controller, control.previous) = (last, first),
            11 => (control.controller, control.previous) = (last, last),
            _ => {}
        }
    }
    // The changed cycles get the commands that a replay computes.
    while let Some(first) = varied.replay().expect("replayable").first {
        varied.cycles[first.index].control = Some(first.replayed);
    }
    varied
}
