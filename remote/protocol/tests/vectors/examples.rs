//! The messages from which the vectors are made.

use sun2xp_remote_protocol::{
    Action, Answer, Code, Counts, DecodeError, Event, FaultText, Finger, FingerStatus, Part, PathPose, Place, Record,
    Request, Stage, State, Status, Target,
};

pub const ONE: Finger = Finger::ALL[0];
pub const TWO: Finger = Finger::ALL[1];
pub const THREE: Finger = Finger::ALL[2];

/// Decodes a payload of this type and encodes the result.
pub fn decode_and_encode(kind: &str, payload: &[u8]) -> Result<Vec<u8>, DecodeError> {
    let encoded = match kind {
        "Target" => Target::decode(payload)?.encode(),
        "State" => State::decode(payload)?.encode(),
        "Event" => Event::decode(payload)?.encode(),
        "Status" => Status::decode(payload)?.encode(),
        "Request" => Request::decode(payload)?.encode(),
        "Answer" => Answer::decode(payload)?.encode(),
        other => panic!("no message is called {other}"),
    };
    Ok(encoded.expect("what can be decoded can be encoded"))
}

pub fn target(parts: Vec<Part>) -> Target {
    let (epoch, sequence) = (0x0123_4567_89ab_cdef, 7);
    Target { validity_ms: 100, epoch, sequence, sent: 1_000_000_007, seen: 2_000_000_011, parts }
}

pub fn part(finger: Finger, place: Place) -> Part {
    Part { finger, command: 3, place, stiffness: None, damping: None }
}

/// A part with everything that a part can have.
pub fn full_part() -> Part {
    let stiffness = Some([[2.0, 0.25, -0.5], [0.25, 1.5, 0.125], [-0.5, 0.125, 1.0]]);
    Part { stiffness, damping: Some(0.75), ..part(TWO, Place::Joints([-0.1, 0.5, 0.8])) }
}

pub fn path(poses: usize) -> Place {
    let pose = |index| {
        let index = f64::from(index);
        PathPose { time: 0.25 * (1.0 + index), joints: [0.01 * index, 0.5, 0.75] }
    };
    Place::Path((0..poses as u32).map(pose).collect())
}

pub fn record(finger: Finger, cycle: u64) -> Record {
    Record {
        finger,
        stage: Stage::Running,
        command: 3,
        cycle,
        begin: 5_000_000_000 + 1_000_000 * cycle,
        touching: false,
        caught: false,
        arrived: false,
        settled: false,
        joints: [-0.1, 0.5, 0.8],
        set_point: Some([-0.1, 0.5, 0.8125]),
        tip: [1.5, -0.25, 6.75],
        force: [0.5, 0.0, -0.25],
        tensions: [5.0, 6.0, 7.0, 8.0],
    }
}

pub fn state(records: Vec<Record>) -> State {
    State { missing: 0, number: 41, time: 6_000_000_000, owner: 2, records }
}

pub fn event() -> Event {
    let values = [0.0, 0.5, 0.8, 0.0];
    Event { finger: TWO, part: 0, kind: 12, number: 9, cycle: 4711, begin: 5_000_000_000, values }
}

pub fn finger_status() -> FingerStatus {
    FingerStatus {
        stage: Stage::Running,
        warnings: 1,
        cycles: 100_000,
        skipped_periods: 2,
        lost_replies: 3,
        corrupt_replies: 4,
        low: [-0.5, 0.0, 0.0],
        high: [0.5, 1.5, 1.75],
        stiffness_bound: 12.5,
        calibration: 0.0,
        fault_text: FaultText::default(),
    }
}

pub fn status() -> Status {
    let counts = Counts { taken: 1, malformed: 2, old_epoch: 3, replayed: 4, late: 5, refused: 6, caught: 7, ended: 8 };
    Status {
        catch_ms: 100,
        end_ms: 1000,
        clients: 2,
        time: 6_000_000_000,
        rate: 1000.0,
        lead_force: 10.0,
        soft_stiffness: 1.0,
        counts,
        fingers: [Some(finger_status()), Some(finger_status()), Some(finger_status())],
        owner: Some("planner".parse().expect("a name")),
    }
}

pub fn faulted() -> FingerStatus {
    let fault_text = FaultText::beginning_of("the board does not answer: check the cable");
    FingerStatus { stage: Stage::Faulted(10), fault_text, ..finger_status() }
}

pub fn request(action: Action) -> Request {
    let finger = matches!(action, Action::Calibrate | Action::Identify).then_some(TWO);
    Request { action, finger, take_over: false, recover: false, epoch: 0x0123_4567_89ab_cdef }
}

pub fn answer(code: Code) -> Answer {
    let text = match code {
        Code::Done => "",
        Code::Owned => "planner owns the hand: release it there, or take it over",
        _ => "the cause: the remedy",
    };
    let (epoch, time) = (0x0123_4567_89ab_cdef, 6_000_000_000);
    Answer { code, catch_ms: 100, epoch, time, number: 0, text: text.into() }
}
