//! Payloads that a receiver must drop, with the reason that the codec gives.

use crate::examples::{
    ONE, TWO, answer, decode_and_encode, event, faulted, finger_status, full_part, part, path, record, request, state,
    status, target,
};
use crate::json::{hex, object, text};
use sun2xp_remote_protocol::{Action, Code, Place, Status};

/// The offsets at which the parts of a Target, the records of a State and the records of a Status begin.
const PART: usize = 40;
const RECORD: usize = 32;
const FINGER: usize = 112;

fn line(kind: &str, name: &str, payload: &[u8]) -> String {
    let Err(reason) = decode_and_encode(kind, payload) else { panic!("{kind}, {name}: it is not malformed") };
    let reason = reason.to_string();
    object(&[("type", text(kind)), ("name", text(name)), ("payload", hex(payload)), ("reason", text(&reason))])
}

/// Returns one line for each change. A change has the name of the line, an offset, and the bytes that replace those of
/// the message at this offset.
fn changed(kind: &str, payload: &[u8], changes: &[(&str, usize, &[u8])]) -> Vec<String> {
    let change = |&(name, at, bytes): &(&str, usize, &[u8])| {
        let mut payload = payload.to_vec();
        payload[at..at + bytes.len()].copy_from_slice(bytes);
        line(kind, name, &payload)
    };
    changes.iter().map(change).collect()
}

/// Returns one line for each variant of this message with a wrong type, version or length.
fn framed(kind: &str, payload: &[u8]) -> Vec<String> {
    let mut lines = vec![
        line(kind, "nothing", &[]),
        line(kind, "the type alone", &payload[..1]),
        line(kind, "type and version alone", &payload[..2]),
        line(kind, "a byte is missing", &payload[..payload.len() - 1]),
        line(kind, "a byte too many", &[payload, &[0]].concat()),
    ];
    lines.extend(changed(
        kind,
        payload,
        &[("type 0", 0, &[0]), ("type 7", 0, &[7]), ("version 0", 1, &[0]), ("version 2", 1, &[2])],
    ));
    lines
}

pub fn listed() -> Vec<String> {
    [targets(), parts(), paths(), states(), events(), statuses(), finger_statuses(), requests(), answers()].concat()
}

const NAN: [u8; 8] = f64::NAN.to_le_bytes();
const INFINITY: [u8; 8] = f64::INFINITY.to_le_bytes();
const ONE_HALF: [u8; 8] = 0.5f64.to_le_bytes();
const NEGATIVE: [u8; 8] = (-0.5f64).to_le_bytes();
const ZERO: [u8; 8] = [0; 8];

fn targets() -> Vec<String> {
    let two = target(vec![part(ONE, Place::Joints([0.0, 0.5, 0.8])), full_part()]).encode().expect("good");
    let mut lines = framed("Target", &two);
    lines.extend(changed(
        "Target",
        &two,
        &[
            ("four parts", 2, &[4]),
            ("fewer parts than bytes", 2, &[1]),
            ("more parts than bytes", 2, &[3]),
            ("a validity of 0", 4, &[0; 4]),
            ("a validity of 60001 ms", 4, &60_001u32.to_le_bytes()),
            ("twice the same finger", PART, &[2]),
            ("fingers that do not rise", PART, &[3]),
        ],
    ));
    lines
}

fn parts() -> Vec<String> {
    let full = target(vec![full_part()]).encode().expect("good");
    let kept = target(vec![part(ONE, Place::Kept)]).encode().expect("good");
    let mut lines = changed(
        "Target",
        &full,
        &[
            ("finger 0", PART, &[0]),
            ("finger 4", PART, &[4]),
            ("place 4", PART + 1, &[4]),
            ("bit 2", PART + 2, &[7]),
            ("a number of poses without their bytes", PART + 3, &[1]),
            ("command number 0", PART + 4, &[0; 4]),
            ("a joint angle is NaN", PART + 16, &NAN),
            ("Kx is infinite", PART + 96, &INFINITY),
            ("the damping is NaN", PART + 104, &NAN),
            ("Kx is not zero, but its bit is 0", PART + 2, &[2]),
            ("the damping is not zero, but its bit is 0", PART + 2, &[1]),
            ("joint angles are not zero, but the place is none", PART + 1, &[0]),
        ],
    );
    lines.extend(changed("Target", &kept, &[("Kx is NaN, but its bit is 0", PART + 32, &NAN)]));
    lines.push(line("Target", "poses without a path", &{
        let mut payload = full.clone();
        payload[PART + 3] = 1;
        payload.extend([0; 32]);
        payload
    }));
    lines
}

fn paths() -> Vec<String> {
    let two = target(vec![part(ONE, path(2))]).encode().expect("good");
    let mut lines = changed(
        "Target",
        &two,
        &[
            ("a path with joint angles beside it", PART + 8, &ONE_HALF),
            ("the first time is 0", PART + 112, &ZERO),
            ("the first time is negative", PART + 112, &NEGATIVE),
            ("times that do not rise", PART + 112, &ONE_HALF),
            ("a time is NaN", PART + 144, &NAN),
            ("a joint angle of a pose is infinite", PART + 168, &INFINITY),
        ],
    );
    let mut none = two[..PART + 112].to_vec();
    none[PART + 3] = 0;
    lines.push(line("Target", "a path without poses", &none));
    let mut many = target(vec![part(ONE, path(32))]).encode().expect("good");
    many[PART + 3] = 33;
    many.extend([0; 32]);
    lines.push(line("Target", "a path of 33 poses", &many));
    lines
}

fn states() -> Vec<String> {
    let two = state(vec![record(ONE, 7), record(ONE, 8)]).encode().expect("good");
    let mut lines = framed("State", &two);
    lines.extend(changed(
        "State",
        &two,
        &[
            ("more records than bytes", 2, &[3]),
            ("fewer records than bytes", 2, &[1]),
            ("301 records", 2, &301u16.to_le_bytes()),
            ("finger 0", RECORD, &[0]),
            ("finger 4", RECORD, &[4]),
            ("stage 7", RECORD + 1, &[7]),
            ("faulted without a fault", RECORD + 1, &[6]),
            ("running with a fault", RECORD + 2, &[1]),
            ("bit 4", RECORD + 24, &[16]),
            ("a joint angle is NaN", RECORD + 32, &NAN),
            ("a part of the set point is NaN", RECORD + 64, &NAN),
            ("the position of the tip is infinite", RECORD + 80, &INFINITY),
            ("the force of the tip is NaN", RECORD + 104, &NAN),
            ("a tension is NaN", RECORD + 152, &NAN),
            ("the same cycle twice", RECORD + 8, &[8]),
            ("a later cycle first", RECORD + 8, &[9]),
        ],
    ));
    lines
}

fn events() -> Vec<String> {
    let event = event().encode().expect("good");
    let mut lines = framed("Event", &event);
    lines.extend(changed(
        "Event",
        &event,
        &[("finger 0", 2, &[0]), ("finger 4", 2, &[4]), ("kind 0", 4, &[0, 0]), ("number 0", 8, &ZERO)],
    ));
    lines
}

fn statuses() -> Vec<String> {
    let good = status().encode().expect("good");
    let mut lines = framed("Status", &good);
    lines.extend(changed(
        "Status",
        &good,
        &[
            ("bit 3", 2, &[15]),
            ("a record of a finger that is not there", 2, &[5]),
            ("catch_ms 0", 4, &[0; 4]),
            ("end_ms 0", 8, &[0; 4]),
            ("the rate is 0", 24, &ZERO),
            ("the rate is NaN", 24, &NAN),
            ("lead_force is infinite", 32, &INFINITY),
            ("soft_stiffness is negative", 40, &NEGATIVE),
            ("the owner's name is longer than the message", 640, &[200]),
            ("the owner's name is shorter than the message", 640, &[0]),
            ("the owner's name is not UTF-8", 641, &[0xff]),
            ("the owner's name has a slash", 642, b"/"),
        ],
    ));
    let mut long = status().encode().expect("good");
    long.truncate(640);
    long.push(65);
    long.extend([b'a'; 65]);
    lines.push(line("Status", "the owner's name is too long", &long));
    lines
}

fn finger_statuses() -> Vec<String> {
    let fingers = [Some(finger_status()), None, Some(faulted())];
    let good = Status { fingers, owner: None, ..status() }.encode().expect("good");
    let third = FINGER + 2 * 176;
    changed(
        "Status",
        &good,
        &[
            ("stage 7", FINGER, &[7]),
            ("running with a fault", FINGER + 2, &[3]),
            ("a joint limit is NaN", FINGER + 40, &NAN),
            ("a largest angle below the smallest", FINGER + 64, &(-1.0f64).to_le_bytes()),
            ("the largest eigenvalue is negative", FINGER + 88, &NEGATIVE),
            ("a calibration of more than 1", FINGER + 96, &1.5f64.to_le_bytes()),
            ("the text of a fault without a fault", FINGER + 104, b"\x01a"),
            ("a text of 72 bytes", third + 104, &[72]),
            ("a text that is not UTF-8", third + 105, &[0xff]),
            ("bytes after the text", third + 104, &[5]),
        ],
    )
}

fn requests() -> Vec<String> {
    let (acquire, stop) =
        (request(Action::Acquire).encode().expect("good"), request(Action::Stop).encode().expect("good"));
    let mut identify = request(Action::Identify);
    identify.finger = Some(TWO);
    let identify = identify.encode().expect("good");
    let mut lines = framed("Request", &acquire);
    lines.extend(changed(
        "Request",
        &acquire,
        &[("action 0", 2, &[0]), ("action 7", 2, &[7]), ("acquire of one finger", 3, &[1]), ("bit 2", 4, &[4])],
    ));
    lines.extend(changed(
        "Request",
        &stop,
        &[
            ("finger 4", 3, &[4]),
            ("stop with take over", 4, &[1]),
            ("stop with recover", 4, &[2]),
            ("release of one finger", 2, &[2, 1]),
        ],
    ));
    lines.extend(changed(
        "Request",
        &identify,
        &[("identify without a finger", 3, &[0]), ("calibrate without a finger", 2, &[4, 0])],
    ));
    lines
}

fn answers() -> Vec<String> {
    let good = answer(Code::Owned).encode().expect("good");
    let mut lines = framed("Answer", &good);
    lines.extend(changed(
        "Answer",
        &good,
        &[
            ("code 10", 2, &[10]),
            ("done with a text", 2, &[0]),
            ("catch_ms 0", 4, &[0; 4]),
            ("the text is shorter than the message", 32, &[0, 0]),
            ("the text is longer than the message", 32, &[0xff, 0xff]),
            ("the text is not UTF-8", 34, &[0xc3, 0x28]),
        ],
    ));
    lines
}
