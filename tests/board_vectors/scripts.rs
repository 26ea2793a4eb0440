//! The conversations: sequences of requests and answers from power-up.

use super::frames::sealed;
use super::steps::*;
use sun2xp::board::protocol::*;

/// A name, and the steps from power-up.
pub type Conversation = (&'static str, Vec<Step>);

/// All conversations, in the order of protocol/vectors.json.
pub fn conversations() -> Vec<Conversation> {
    [orderly_use(), watchdog(), holds(), refusals(), damage(), faults()].concat()
}

const COMMAND_FRAME: Frame = Frame::Command(Command { toggle: false, enable: true, torques: [1; 4] });

/// The board accepts these terms.
fn configured(terms: Configure) -> Step {
    configure(terms, Answer::Configured(READY))
}

/// From power-up to motion and back.
fn orderly_use() -> Vec<Conversation> {
    vec![
        (
            "idle: says who it is, refuses commands",
            vec![
                NO_TORQUE,
                hello(1, 1, Answer::Identity),
                hello(0, 255, Answer::Identity),
                hello(2, 3, refused(1, 0x0101)),
                sent(COMMAND_FRAME, refused(3, 0)),
                stop(Status::default()),
                sent(COMMAND_FRAME, refused(3, 0)),
                NO_TORQUE,
            ],
        ),
        (
            "configured, enabled, disabled",
            vec![
                configured(TERMS),
                NO_TORQUE,
                disabled([100; 4], READY),
                NO_TORQUE,
                configured(TERMS),
                command([100, -200, 0, 9000], ENABLED),
                Step::Torques([100, -200, 0, 9000]),
                hello(1, 1, Answer::Identity),
                Step::Torques([100, -200, 0, 9000]),
                configure(TERMS, refused(4, 0)),
                Step::Torques([100, -200, 0, 9000]),
                disabled([100; 4], READY),
                NO_TORQUE,
                configured(TERMS),
            ],
        ),
        (
            "torques are clipped only in a command that the board obeys",
            vec![
                configured(TERMS),
                command([10_001, -10_001, i16::MAX, i16::MIN], ENABLED | Status::TORQUE_CLIPPED),
                Step::Torques([10_000, -10_000, 10_000, -9_000]),
                command([10_000, -10_000, 1, 9_000], ENABLED),
                Step::Torques([10_000, -10_000, 1, 9_000]),
                disabled([i16::MAX; 4], READY),
                stop(ENDED),
                command([i16::MAX; 4], ENDED),
                NO_TORQUE,
            ],
        ),
    ]
}

/// The host falls silent, or sends nothing that restarts the watchdog.
fn watchdog() -> Vec<Conversation> {
    let tripped = ENDED | Status::WATCHDOG_TRIPPED;
    vec![
        (
            "the watchdog releases",
            vec![
                configured(TERMS),
                Step::Wait(100),
                command([100; 4], ENABLED),
                Step::Wait(19),
                command([100; 4], ENABLED),
                Step::Wait(19),
                hello(1, 1, Answer::Identity),
                Step::Wait(3),
                NO_TORQUE,
                command([100; 4], tripped),
                disabled([0; 4], tripped),
                stop(tripped),
                NO_TORQUE,
                configured(TERMS),
                command([100; 4], ENABLED),
            ],
        ),
        (
            "only a command with enable set restarts the watchdog",
            vec![
                configured(TERMS),
                command([100; 4], ENABLED),
                Step::Wait(15),
                raw(&[0x31, 0, 2, 0, 0], 6, 3),
                configure(TERMS, refused(4, 0)),
                Step::Wait(7),
                command([100; 4], tripped),
                NO_TORQUE,
            ],
        ),
    ]
}

/// The end state is a hold.
fn holds() -> Vec<Conversation> {
    let tripped = ENDED | Status::WATCHDOG_TRIPPED;
    vec![
        (
            "a stop holds, for its time and within its limit",
            vec![
                configured(HOLD),
                command([1000, -1000, 100, 0], ENABLED),
                stop(ENDED | Status::HOLDING),
                Step::Torques([500, -500, 100, 0]),
                command([100; 4], ENDED | Status::HOLDING),
                Step::Torques([500, -500, 100, 0]),
                Step::Wait(40),
                stop(ENDED | Status::HOLDING),
                Step::Wait(22),
                NO_TORQUE,
                command([100; 4], ENDED),
                NO_TORQUE,
            ],
        ),
        (
            "the watchdog holds; a configure ends that",
            vec![
                configured(HOLD),
                command([1000, -1000, 100, 0], ENABLED),
                Step::Wait(22),
                Step::Torques([500, -500, 100, 0]),
                command([100; 4], tripped | Status::HOLDING),
                configure(TERMS, Answer::Configured(READY)),
                NO_TORQUE,
            ],
        ),
        (
            "there is nothing to hold before the first torque, and no time in a hold of 0 ms",
            vec![
                configured(HOLD),
                stop(ENDED),
                NO_TORQUE,
                configure(Configure { hold_time_ms: 0, ..HOLD }, Answer::Configured(READY)),
                command([1000; 4], ENABLED),
                stop(ENDED),
                NO_TORQUE,
            ],
        ),
    ]
}

/// The board cannot carry out a request, or does not understand it.
fn refusals() -> Vec<Conversation> {
    // A Configure with an undefined end state, which the codec cannot write.
    let mut end_state_2 = vec![0x21, 9, 1, 20, 0, 2];
    end_state_2.resize(34, 0);
    // A field before the end state is wrong too.
    let (mut version_2, mut watchdog_0) = (end_state_2.clone(), end_state_2.clone());
    (version_2[2], watchdog_0[3]) = (2, 0);
    vec![
        (
            "refused terms leave the earlier terms in force",
            vec![
                configure(Configure { version: 2, ..TERMS }, refused(2, 2)),
                sent(COMMAND_FRAME, refused(3, 0)),
                configured(TERMS),
                configure(Configure { version: 0, ..TERMS }, refused(2, 2)),
                configure(Configure { watchdog_ms: 0, ..TERMS }, refused(2, 3)),
                configure(Configure { watchdog_ms: 0, torque_limits: [u16::MAX; 4], ..TERMS }, refused(2, 3)),
                raw(&end_state_2, 2, 5),
                raw(&version_2, 2, 2),
                raw(&watchdog_0, 2, 3),
                configure(Configure { torque_limits: [1, u16::MAX, 1, u16::MAX], ..HOLD }, refused(2, 12)),
                command([10_000, 0, 0, 9_001], ENABLED | Status::TORQUE_CLIPPED),
                Step::Torques([10_000, 0, 0, 9_000]),
                raw(&end_state_2, 4, 0),
            ],
        ),
        (
            "types and lengths that it does not know",
            vec![
                raw(&[0x71, 1], 6, 0),
                // A request that needs tactile sensors, which the board lacks.
                raw(&[0x61, 1, 0], 6, 1),
                raw(&[0x01, 1, 2], 6, 1),
                raw(&[0x51, 1, 2, 3], 6, 2),
                raw(&[0x41, 1, 2], 6, 1),
                raw(&[0x11, 1, 1], 6, 1),
                raw(&[0x31, 1, 2, 0, 0, 0, 0, 0, 0, 0], 6, 8),
                configured(TERMS),
                command([100; 4], ENABLED),
                raw(&[0x21, 1, 1], 6, 1),
                Step::Torques([100; 4]),
            ],
        ),
    ]
}

/// Frames are damaged on the line.
fn damage() -> Vec<Conversation> {
    vec![(
        "damage is reported in the next reply",
        vec![
            Step::Send(vec![3, 0x31, 7, 0], None),
            configured(TERMS),
            disabled([0; 4], READY | Status::DAMAGED_INPUT),
            disabled([0; 4], READY),
            // A Command in two pieces with a delimiter between them.
            Step::Send(vec![8, 0x31, 7, 3, 0, 0xA4, 4, 0x52, 0], None),
            stop(ENDED),
            command([0; 4], ENDED | Status::DAMAGED_INPUT),
            // Damage and a Command that arrive together.
            after(&[3, 0x31, 7, 0], command([0; 4], ENDED | Status::DAMAGED_INPUT)),
            command([0; 4], ENDED),
            // Undamaged frames that the board ignores: for another finger, an answer, delimiters.
            Step::Send(sealed(&[0x42, 1]), None),
            Step::Send(sealed(&[0xC1, 1, 0, 0]), None),
            Step::Send(vec![0, 0], None),
            command([0; 4], ENDED),
        ],
    )]
}

/// The board detects a fault of its own.
fn faults() -> Vec<Conversation> {
    let stopped = ENDED | Status::EMERGENCY_STOP;
    vec![
        (
            "an emergency stop takes the torque off and is remembered",
            vec![
                configured(HOLD),
                command([100; 4], ENABLED),
                Step::Faults(Status::EMERGENCY_STOP),
                Step::Wait(1),
                NO_TORQUE,
                command([100; 4], stopped),
                configure(HOLD, refused(5, 0x40)),
                configure(Configure { version: 2, ..HOLD }, refused(5, 0x40)),
                Step::Faults(Status::default()),
                Step::Wait(1),
                command([100; 4], stopped),
                stop(stopped),
                NO_TORQUE,
                configured(TERMS),
                command([100; 4], ENABLED),
                Step::Torques([100; 4]),
            ],
        ),
        (
            "a fault ends a hold, and a fault in idle keeps it idle",
            vec![
                Step::Faults(Status::SUPPLY_FAULT),
                Step::Wait(1),
                hello(1, 1, Answer::Identity),
                configure(TERMS, refused(5, 0x80)),
                sent(COMMAND_FRAME, refused(3, 0)),
                stop(Status::SUPPLY_FAULT),
                Step::Faults(Status::default()),
                configured(HOLD),
                command([1000; 4], ENABLED),
                stop(ENDED | Status::HOLDING),
                Step::Faults(Status::DRIVER_FAULT | Status::SENSOR_FAULT),
                Step::Wait(1),
                NO_TORQUE,
                command([0; 4], ENDED | Status::DRIVER_FAULT | Status::SENSOR_FAULT),
            ],
        ),
    ]
}
