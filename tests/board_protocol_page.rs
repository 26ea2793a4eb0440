//! Others build boards from docs/board-protocol.md: its numbers and hex examples must agree with the codec.

#[path = "board_vectors/example_board.rs"]
mod example_board;

use example_board::IDENTITY;
use std::collections::BTreeMap;
use sun2xp::board::capacity;
use sun2xp::board::protocol::*;
use sun2xp::model::configuration::EndState;

const PAGE: &str = include_str!("../docs/board-protocol.md");

/// The examples as the page describes them in prose.
fn described() -> Vec<Message> {
    let message = |sequence, frame| Message { address: 1, sequence, frame };
    let terms = Configure {
        version: 1,
        watchdog_ms: 20,
        end_state: EndState::Hold,
        hold_time_ms: 2000,
        hold_torque_limit: 5000,
        torque_limits: [23750; 4],
        torque_constants: [23400; 4],
    };
    let encoders = [100_000, -1, 0, 65536];
    let gauges = [410, 205, 205, 410];
    vec![
        message(1, Frame::Hello(Hello { lowest_version: 1, highest_version: 1 })),
        message(1, Frame::Identity(IDENTITY)),
        message(2, Frame::Configure(terms)),
        message(
            2,
            Frame::Configured(Configured { terms, encoders, gauges, status: Status::CONFIGURED | Status::ZERO_VALID }),
        ),
        message(3, Frame::Stop(Stop)),
        message(5, Frame::TactileRequest(TactileRequest { received: 254 })),
        message(
            5,
            Frame::TactileEvent(TactileEvent {
                waiting: 2,
                number: 255,
                change: TactileChange::Made,
                element: 300,
                count: 4095,
                noticed_at: 4_000_000_000,
                lost: 0,
            }),
        ),
        message(3, Frame::Stopped(Stopped { status: Status::CONFIGURED | Status::ENDED | Status::ZERO_VALID })),
        message(9, Frame::Refused(Refused { request: 0x3, reason: Reason::NotConfigured, detail: 0 })),
        message(7, Frame::Command(Command { toggle: true, enable: true, torques: [1188, 594, 0, -1] })),
        message(
            7,
            Frame::Reply(Reply {
                status: Status::CONFIGURED | Status::ENABLED | Status::ZERO_VALID,
                encoders: encoders.map(|count| count as u16),
                gauges,
                sampled_at: 12345,
            }),
        ),
    ]
}

fn in_hex(bytes: &[u8]) -> String {
    let pairs: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    pairs.chunks(16).map(|line| line.join(" ")).collect::<Vec<_>>().join("\n")
}

/// Name and content of every block of hex.
fn blocks() -> BTreeMap<&'static str, &'static str> {
    PAGE.split("```hex ")
        .skip(1)
        .map(|block| {
            let block = block.split("```").next().unwrap();
            let (name, hex) = block.split_once('\n').unwrap();
            (name, hex.trim())
        })
        .collect()
}

/// The cells of each row of the table whose heading begins with `head`.
fn table(head: &str) -> Vec<Vec<&'static str>> {
    PAGE.lines()
        .skip_while(|line| !line.starts_with(head))
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect()
}

#[test]
fn hex_is_what_the_codec_sends() {
    let mut blocks = blocks();
    for message in described() {
        let name = format!("{:?}", message.frame.kind());
        let sent = in_hex(WireFrame::new(&message).as_bytes());
        assert_eq!(blocks.remove(name.as_str()), Some(sent.as_str()), "example {name} should be\n{sent}");
    }
    assert!(blocks.is_empty(), "examples that nothing describes: {blocks:?}");
}

#[test]
fn hex_is_what_the_codec_accepts() {
    let blocks = blocks();
    for message in described() {
        let hex = blocks[format!("{:?}", message.frame.kind()).as_str()];
        let bytes: Vec<u8> = hex.split_whitespace().map(|pair| u8::from_str_radix(pair, 16).unwrap()).collect();
        let mut decoder = Decoder::default();
        let mut rest = &bytes[..];
        let read = decoder.next(&mut rest).map(|packet| Message::read(&packet));
        assert_eq!(read, Some(Ok(message)));
        assert!(rest.is_empty());
    }
}

#[test]
fn lengths_of_the_types() {
    let rows = table("| type | name |");
    assert_eq!(rows.len(), Kind::ALL.len());
    for (row, kind) in rows.iter().zip(Kind::ALL) {
        let wire = kind.wire_length();
        let expected = [
            format!("{:#X}", kind as u8).replace('X', "x"),
            format!("{kind:?}"),
            row[2].into(),
            (wire - WIRE_OVERHEAD).to_string(),
            wire.to_string(),
        ];
        assert_eq!(row[..], expected.each_ref().map(String::as_str));
        assert_eq!(row[2], if (kind as u8) < 8 { "host" } else { "board" });
        assert!(wire <= MAX_WIRE);
    }
}

#[test]
fn a_cycle_is_45_bytes() {
    assert_eq!(Kind::Command.wire_length() + Kind::Reply.wire_length(), 45);
    assert!(PAGE.contains("a Command and a Reply: 45 bytes"));
}

#[test]
fn check_value() {
    assert!(PAGE.contains("0xCBF43926"));
    assert_eq!(check(b"123456789"), 0xCBF43926);
}

#[test]
fn times_at_the_usual_rates() {
    let rows = table("| baud | Command |");
    assert!(rows.len() >= 6);
    for row in rows {
        let baud: u32 = row[0].parse().unwrap();
        // The rate is far too high, so the result is an error. Its fields contain all numbers of the row.
        let [one, three] = [1, 3].map(|fingers| capacity(baud, fingers, 1e5).unwrap_err());
        let expected = [
            baud.to_string(),
            format!("{:.0}", one.command_us),
            format!("{:.0}", one.replies_us),
            format!("{:.0}", one.needed_us),
            format!("{:.0}", one.fastest_rate),
            format!("{:.0}", three.needed_us),
            format!("{:.0}", three.fastest_rate),
        ];
        assert_eq!(row[..], expected.each_ref().map(String::as_str));
    }
}

#[test]
fn status_bits() {
    let named = [
        ("configured", Status::CONFIGURED),
        ("enabled", Status::ENABLED),
        ("watchdog tripped", Status::WATCHDOG_TRIPPED),
        ("ended", Status::ENDED),
        ("holding", Status::HOLDING),
        ("zero valid", Status::ZERO_VALID),
        ("emergency stop", Status::EMERGENCY_STOP),
        ("supply fault", Status::SUPPLY_FAULT),
        ("driver fault", Status::DRIVER_FAULT),
        ("sensor fault", Status::SENSOR_FAULT),
        ("torque clipped", Status::TORQUE_CLIPPED),
        ("damaged input", Status::DAMAGED_INPUT),
    ];
    let mut rows = table("| bit | name |");
    assert_eq!(rows.pop().expect("the reserved bits")[0], format!("{}-15", named.len()));
    assert_eq!(rows.len(), named.len());
    for (row, (name, bit)) in rows.iter().zip(named) {
        assert_eq!(row[1], name);
        assert_eq!(Status(1 << row[0].parse::<u16>().unwrap()), bit);
    }
}
