//! Lists good messages of every type, some of them with edge values. Each line has the payload of a message and the
//! values of its fields.

use crate::examples::{
    ONE, THREE, TWO, answer, event, faulted, finger_status, full_part, part, path, record, request, state, status,
    target,
};
use crate::json::{hex, list, number, numbers, object, option, text};
use sun2xp_remote_protocol::{
    Action, Answer, ClientName, Code, Event, FaultText, Finger, FingerStatus, MOST_POSES, Part, Place, Record, Request,
    Stage, State, Status, Target,
};

type Pairs = Vec<(&'static str, String)>;

fn line(kind: &str, name: &str, payload: &[u8], fields: Pairs) -> String {
    let mut pairs = vec![("type", text(kind)), ("name", text(name)), ("payload", hex(payload))];
    pairs.extend(fields);
    object(&pairs)
}

fn target_line(name: &str, target: &Target) -> String {
    let fields = vec![
        ("validity_ms", target.validity_ms.to_string()),
        ("epoch", target.epoch.to_string()),
        ("sequence", target.sequence.to_string()),
        ("sent", target.sent.to_string()),
        ("seen", target.seen.to_string()),
        ("parts", list(target.parts.iter().map(part_fields))),
    ];
    line("Target", name, &target.encode().expect("a good Target"), fields)
}

fn part_fields(part: &Part) -> String {
    let (joints, tip, poses) = match &part.place {
        Place::Kept => (None, None, None),
        Place::Joints(joints) => (Some(joints), None, None),
        Place::Tip(tip) => (None, Some(tip), None),
        Place::Path(poses) => (None, None, Some(poses)),
    };
    let pose = |pose: &sun2xp_remote_protocol::PathPose| {
        object(&[("time", number(pose.time)), ("joints", numbers(&pose.joints))])
    };
    object(&[
        ("finger", part.finger.to_string()),
        ("command", part.command.to_string()),
        ("joints", option(joints, |joints| numbers(joints))),
        ("tip", option(tip, |tip| numbers(tip))),
        ("path", option(poses, |poses| list(poses.iter().map(pose)))),
        ("stiffness", option(part.stiffness, |rows| list(rows.iter().map(|row| numbers(row))))),
        ("damping", option(part.damping, number)),
    ])
}

fn state_line(name: &str, state: &State) -> String {
    let fields = vec![
        ("missing", state.missing.to_string()),
        ("number", state.number.to_string()),
        ("time", state.time.to_string()),
        ("owner", state.owner.to_string()),
        ("records", list(state.records.iter().map(record_fields))),
    ];
    line("State", name, &state.encode().expect("a good State"), fields)
}

fn record_fields(record: &Record) -> String {
    let (stage, fault) = record.stage.numbers();
    object(&[
        ("finger", record.finger.to_string()),
        ("stage", stage.to_string()),
        ("fault", fault.to_string()),
        ("command", record.command.to_string()),
        ("cycle", record.cycle.to_string()),
        ("begin", record.begin.to_string()),
        ("touching", record.touching.to_string()),
        ("caught", record.caught.to_string()),
        ("arrived", record.arrived.to_string()),
        ("settled", record.settled.to_string()),
        ("joints", numbers(&record.joints)),
        ("set_point", option(record.set_point, |angles| numbers(&angles))),
        ("tip", numbers(&record.tip)),
        ("force", numbers(&record.force)),
        ("tensions", numbers(&record.tensions)),
    ])
}

fn event_line(name: &str, event: &Event) -> String {
    let fields = vec![
        ("finger", event.finger.to_string()),
        ("part", event.part.to_string()),
        ("kind", event.kind.to_string()),
        ("number", event.number.to_string()),
        ("cycle", event.cycle.to_string()),
        ("begin", event.begin.to_string()),
        ("values", numbers(&event.values)),
    ];
    line("Event", name, &event.encode().expect("a good Event"), fields)
}

fn status_line(name: &str, status: &Status) -> String {
    let counts = &status.counts;
    let fields = vec![
        ("catch_ms", status.catch_ms.to_string()),
        ("end_ms", status.end_ms.to_string()),
        ("clients", status.clients.to_string()),
        ("time", status.time.to_string()),
        ("rate", number(status.rate)),
        ("lead_force", number(status.lead_force)),
        ("soft_stiffness", number(status.soft_stiffness)),
        ("taken", counts.taken.to_string()),
        ("malformed", counts.malformed.to_string()),
        ("old_epoch", counts.old_epoch.to_string()),
        ("replayed", counts.replayed.to_string()),
        ("late", counts.late.to_string()),
        ("refused", counts.refused.to_string()),
        ("caught", counts.caught.to_string()),
        ("ended", counts.ended.to_string()),
        ("fingers", list(status.fingers.iter().map(|finger| option(finger.as_ref(), finger_fields)))),
        ("owner", text(status.owner.as_ref().map_or("", ClientName::as_str))),
    ];
    line("Status", name, &status.encode().expect("a good Status"), fields)
}

fn finger_fields(finger: &FingerStatus) -> String {
    let (stage, fault) = finger.stage.numbers();
    object(&[
        ("stage", stage.to_string()),
        ("fault", fault.to_string()),
        ("warnings", finger.warnings.to_string()),
        ("cycles", finger.cycles.to_string()),
        ("skipped_periods", finger.skipped_periods.to_string()),
        ("lost_replies", finger.lost_replies.to_string()),
        ("corrupt_replies", finger.corrupt_replies.to_string()),
        ("low", numbers(&finger.low)),
        ("high", numbers(&finger.high)),
        ("stiffness_bound", number(finger.stiffness_bound)),
        ("calibration", number(finger.calibration)),
        ("fault_text", text(finger.fault_text.as_str())),
    ])
}

fn request_line(name: &str, request: &Request) -> String {
    let fields = vec![
        ("action", text(request.action.name())),
        ("finger", request.finger.map_or(0, Finger::number).to_string()),
        ("take_over", request.take_over.to_string()),
        ("recover", request.recover.to_string()),
        ("epoch", request.epoch.to_string()),
    ];
    line("Request", name, &request.encode().expect("a good Request"), fields)
}

fn answer_line(name: &str, answer: &Answer) -> String {
    let fields = vec![
        ("code", (answer.code as u16).to_string()),
        ("catch_ms", answer.catch_ms.to_string()),
        ("epoch", answer.epoch.to_string()),
        ("time", answer.time.to_string()),
        ("number", answer.number.to_string()),
        ("text", text(&answer.text)),
    ];
    line("Answer", name, &answer.encode().expect("a good Answer"), fields)
}

pub fn listed() -> Vec<String> {
    [targets(), states(), events(), statuses(), requests(), answers()].concat()
}

fn targets() -> Vec<String> {
    let highest = Target { validity_ms: 60_000, epoch: u64::MAX, sequence: u64::MAX, ..target(vec![]) };
    let three = vec![part(ONE, Place::Joints([0.0, 0.5, 0.8])), full_part(), part(THREE, path(2))];
    vec![
        target_line("the owner lives", &target(vec![])),
        target_line("highest numbers", &Target { sent: u64::MAX, seen: u64::MAX, ..highest }),
        target_line(
            "a validity of 1 ms, nothing changes",
            &Target { validity_ms: 1, ..target(vec![part(ONE, Place::Kept)]) },
        ),
        target_line("joint angles", &target(vec![part(TWO, Place::Joints([-0.1, 0.5, 0.8]))])),
        target_line("position of the tip", &target(vec![part(THREE, Place::Tip([1.5, -0.25, 6.75]))])),
        target_line("joint angles, Kx and damping", &target(vec![full_part()])),
        target_line("Kx alone", &target(vec![Part { place: Place::Kept, damping: None, ..full_part() }])),
        target_line("damping alone", &target(vec![Part { place: Place::Kept, stiffness: None, ..full_part() }])),
        target_line("a path of one pose", &target(vec![part(ONE, path(1))])),
        target_line("the longest path", &target(vec![part(ONE, path(MOST_POSES))])),
        target_line("three fingers", &target(three)),
        target_line("the highest command number", &target(vec![Part { command: u32::MAX, ..full_part() }])),
    ]
}

fn states() -> Vec<String> {
    let faulted = Record { stage: Stage::Faulted(10), set_point: None, command: 0, ..record(ONE, 1) };
    let touching = Record { touching: true, caught: true, ..record(TWO, 8) };
    let settled = Record { arrived: true, settled: true, ..record(TWO, 9) };
    vec![
        state_line("no cycle, no owner", &State { owner: 0, number: 0, missing: u32::MAX, ..state(vec![]) }),
        state_line("a finger that has stopped", &state(vec![faulted])),
        state_line("two cycles of two fingers", &state(vec![record(ONE, 7), touching, record(ONE, 8), settled])),
    ]
}

fn events() -> Vec<String> {
    let values = [f64::NAN, -1.5, 1e300, 5e-324];
    vec![
        event_line("settled", &event()),
        event_line("every field", &Event { finger: THREE, part: 255, kind: u16::MAX, values, ..event() }),
    ]
}

fn statuses() -> Vec<String> {
    let text = FaultText::beginning_of(&"é".repeat(40));
    let longest = FingerStatus { fault_text: text, calibration: 1.0, ..faulted() };
    let two = Status { fingers: [Some(finger_status()), None, Some(faulted())], owner: None, ..status() };
    vec![
        status_line("three fingers and an owner", &status()),
        status_line("without finger 2, without an owner, finger 3 has stopped", &two),
        status_line("the longest text of a fault", &Status { fingers: [None, Some(longest), None], ..status() }),
    ]
}

fn requests() -> Vec<String> {
    let mut lines: Vec<String> =
        Action::ALL.iter().map(|&action| request_line(action.name(), &request(action))).collect();
    let acquire = Request { take_over: true, recover: true, epoch: 0, ..request(Action::Acquire) };
    lines.push(request_line("acquire, take over and recover", &acquire));
    lines.push(request_line("stop finger 3", &Request { finger: Some(THREE), ..request(Action::Stop) }));
    lines
}

fn answers() -> Vec<String> {
    let mut lines: Vec<String> =
        Code::ALL.iter().map(|&code| answer_line(&format!("{code:?}"), &answer(code))).collect();
    lines.push(answer_line("acquired", &Answer { number: 2, ..answer(Code::Done) }));
    lines.push(answer_line("Target 7 is refused", &Answer { number: 7, ..answer(Code::Argument) }));
    lines
}
