//! Valid frames of every type, with edge values.

use super::example_board::IDENTITY;
use super::json::{hex, list, object, text};
use super::stuffing::stuffed;
use sun2xp::board::protocol::*;
use sun2xp::model::configuration::EndState;

/// Header, sequence number, body and checksum, encoded for the line.
pub fn sealed(content: &[u8]) -> Vec<u8> {
    stuffed(&with_check(content))
}

pub fn with_check(content: &[u8]) -> Vec<u8> {
    [content, &check(content).to_le_bytes()].concat()
}

fn terms(end_state: EndState) -> Configure {
    Configure {
        version: 1,
        watchdog_ms: 20,
        end_state,
        hold_time_ms: 2000,
        hold_torque_limit: 5000,
        torque_limits: [23750, 1, 256, 0],
        torque_constants: [23400, 0, 1, u32::MAX],
    }
}

type Named = (&'static str, u8, u8, Frame);

const ALL_ONES: Configure = Configure {
    version: 255,
    watchdog_ms: u16::MAX,
    end_state: EndState::Hold,
    hold_time_ms: u16::MAX,
    hold_torque_limit: u16::MAX,
    torque_limits: [u16::MAX; 4],
    torque_constants: [u32::MAX; 4],
};

/// Names, addresses, sequence numbers and frames.
fn messages() -> Vec<Named> {
    [requests(), answers()].concat()
}

fn requests() -> Vec<Named> {
    let command = |toggle, enable, torques| Frame::Command(Command { toggle, enable, torques });
    vec![
        ("versions 1 to 1", 1, 1, Frame::Hello(Hello { lowest_version: 1, highest_version: 1 })),
        ("to any finger", 0, 255, Frame::Hello(Hello { lowest_version: 0, highest_version: 255 })),
        ("hold, limits and constants that differ", 1, 2, Frame::Configure(terms(EndState::Hold))),
        ("release, the highest address", 15, 0, Frame::Configure(terms(EndState::Release))),
        ("all ones but the end state", 15, 255, Frame::Configure(ALL_ONES)),
        ("toggle and enable", 1, 7, command(true, true, [1188, 594, 0, -1])),
        ("neither", 1, 8, command(false, false, [0; 4])),
        ("the ends of the range", 2, 0, command(false, true, [i16::MAX, i16::MIN, 256, -256])),
        ("no zero in the frame", 15, 255, command(true, false, [-1, 257, -257, 514])),
        ("without a body", 1, 3, Frame::Stop(Stop)),
        ("all bytes zero but the check", 1, 0, Frame::Stop(Stop)),
        ("nothing received yet", 1, 4, Frame::TactileRequest(TactileRequest { received: 0 })),
        ("event 255 received", 1, 5, Frame::TactileRequest(TactileRequest { received: 255 })),
    ]
}

/// The largest value of each field.
const MOST: Identity = Identity {
    version: 255,
    addresses: 0xFFFE,
    board_kind: u16::MAX,
    unique_number: [255; 12],
    firmware: FirmwareVersion([255; 3]),
    counts_per_revolution: u32::MAX,
    gauge_bits: 16,
    torque_unit: u32::MAX,
    torque_limit: 32767,
    shortest_watchdog_ms: 20,
    capabilities: Capabilities(u32::MAX),
};

fn answers() -> Vec<Named> {
    let configured =
        |terms, encoders, gauges, status| Frame::Configured(Configured { terms, encoders, gauges, status });
    let reply = |status, encoders, gauges, sampled_at| {
        Frame::Reply(Reply { status: Status(status), encoders, gauges, sampled_at })
    };
    let refused = |request, reason, detail| Frame::Refused(Refused { request, reason, detail });
    vec![
        ("a board with three fingers", 1, 1, Frame::Identity(IDENTITY)),
        ("the largest numbers", 15, 255, Frame::Identity(MOST)),
        (
            "configured and zero valid",
            1,
            2,
            configured(
                terms(EndState::Hold),
                [100_000, -1, 0, 65536],
                [410, 205, 205, 410],
                Status::CONFIGURED | Status::ZERO_VALID,
            ),
        ),
        (
            "the ends of the range",
            1,
            3,
            configured(ALL_ONES, [i32::MIN, i32::MAX, -2, 1], [0, 65535, 1, 256], Status(0xFFFF)),
        ),
        ("in motion", 1, 7, reply(0x23, [0x86A0, 0xFFFF, 0, 0], [410, 205, 205, 410], 12345)),
        ("all zeros", 1, 0, reply(0, [0; 4], [0; 4], 0)),
        ("all ones", 15, 255, reply(0xFFFF, [0xFFFF; 4], [0xFFFF; 4], 0xFFFF)),
        ("tripped and ended, a damaged frame before", 2, 9, reply(0x082D, [1, 2, 3, 4], [5, 6, 7, 8], 0x8000)),
        ("ended and holding", 1, 3, Frame::Stopped(Stopped { status: Status(0x0039) })),
        ("no common version", 1, 1, refused(0x1, Reason::Version, 0x0302)),
        ("a torque limit of motor 4", 1, 2, refused(0x2, Reason::Value, 16)),
        ("not configured", 1, 9, refused(0x3, Reason::NotConfigured, 0)),
        ("running", 1, 10, refused(0x2, Reason::Running, 0)),
        ("emergency stop", 1, 11, refused(0x2, Reason::Fault, 0x40)),
        ("unknown frame with 3 bytes", 1, 12, refused(0x7, Reason::UnknownFrame, 3)),
        ("nothing waits", 1, 4, Frame::TactileEvent(TactileEvent::default())),
        (
            "contact of element 300",
            1,
            5,
            Frame::TactileEvent(TactileEvent {
                waiting: 2,
                number: 255,
                change: TactileChange::Made,
                element: 300,
                count: 4095,
                noticed_at: 4_000_000_000,
                lost: 255,
            }),
        ),
    ]
}

fn number(value: impl ToString) -> String {
    value.to_string()
}

fn terms_fields(terms: &Configure) -> Vec<(&'static str, String)> {
    vec![
        ("version", number(terms.version)),
        ("watchdog_ms", number(terms.watchdog_ms)),
        ("end_state", number(terms.end_state as u8)),
        ("hold_time_ms", number(terms.hold_time_ms)),
        ("hold_torque_limit", number(terms.hold_torque_limit)),
        ("torque_limits", list(&terms.torque_limits)),
        ("torque_constants", list(&terms.torque_constants)),
    ]
}

/// Field names as in the tables of docs/board-protocol.md.
fn fields(frame: &Frame) -> Vec<(&'static str, String)> {
    match frame {
        Frame::Hello(hello) => {
            vec![("lowest_version", number(hello.lowest_version)), ("highest_version", number(hello.highest_version))]
        }
        Frame::Configure(terms) => terms_fields(terms),
        Frame::Command(command) => vec![
            ("toggle", number(u8::from(command.toggle))),
            ("enable", number(u8::from(command.enable))),
            ("torques", list(&command.torques)),
        ],
        Frame::Stop(_) => vec![],
        Frame::TactileRequest(request) => vec![("received", number(request.received))],
        Frame::Identity(identity) => vec![
            ("version", number(identity.version)),
            ("addresses", number(identity.addresses)),
            ("board_kind", number(identity.board_kind)),
            ("unique_number", list(&identity.unique_number)),
            ("firmware_version", list(&identity.firmware.0)),
            ("counts_per_revolution", number(identity.counts_per_revolution)),
            ("gauge_bits", number(identity.gauge_bits)),
            ("torque_unit", number(identity.torque_unit)),
            ("torque_limit", number(identity.torque_limit)),
            ("shortest_watchdog_ms", number(identity.shortest_watchdog_ms)),
            ("capabilities", number(identity.capabilities.0)),
        ],
        Frame::Configured(configured) => {
            let mut fields = terms_fields(&configured.terms);
            fields.push(("encoders", list(&configured.encoders)));
            fields.push(("gauges", list(&configured.gauges)));
            fields.push(("status", number(configured.status.0)));
            fields
        }
        Frame::Reply(reply) => vec![
            ("status", number(reply.status.0)),
            ("encoders", list(&reply.encoders)),
            ("gauges", list(&reply.gauges)),
            ("sampled_at", number(reply.sampled_at)),
        ],
        Frame::Stopped(stopped) => vec![("status", number(stopped.status.0))],
        Frame::Refused(refused) => vec![
            ("request", number(refused.request)),
            ("reason", number(refused.reason.number())),
            ("detail", number(refused.detail)),
        ],
        Frame::TactileEvent(event) => vec![
            ("waiting", number(event.waiting)),
            ("number", number(event.number)),
            ("change", number(event.change.number())),
            ("element", number(event.element)),
            ("count", number(event.count)),
            ("noticed_at", number(event.noticed_at)),
            ("lost", number(event.lost)),
        ],
    }
}

pub fn good() -> Vec<String> {
    let line = |(name, address, sequence, frame): (&str, u8, u8, Frame)| {
        let wire = WireFrame::new(&Message { address, sequence, frame });
        let mut pairs = vec![
            ("type", text(&format!("{:?}", frame.kind()))),
            ("name", text(name)),
            ("wire", hex(wire.as_bytes())),
            ("address", number(address)),
            ("sequence", number(sequence)),
        ];
        pairs.extend(fields(&frame));
        object(&pairs)
    };
    messages().into_iter().map(line).collect()
}

pub fn all_found(decoder: &mut Decoder, mut bytes: &[u8]) -> Vec<Message> {
    let mut found = Vec::new();
    while let Some(packet) = decoder.next(&mut bytes) {
        found.extend(Message::read(&packet));
    }
    found
}

#[test]
fn every_type_is_there() {
    for kind in Kind::ALL {
        assert!(messages().iter().any(|(.., frame)| frame.kind() == kind), "{kind:?}");
    }
}

#[test]
fn good_frames_are_read_back() {
    for (name, address, sequence, frame) in messages() {
        let message = Message { address, sequence, frame };
        let mut decoder = Decoder::default();
        assert_eq!(all_found(&mut decoder, WireFrame::new(&message).as_bytes()), [message], "{name}");
    }
}
