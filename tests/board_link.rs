//! The link and the simulated board, in memory and on simulated time.

use nalgebra::Vector4;
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand, EndState};
use sun2xp::simulated::*;

const MS: u64 = 1_000_000;

fn finger() -> ConfiguredFinger {
    ConfiguredFinger::default()
}

fn board(addresses: &[u8]) -> SimulatedBoard {
    let mut hand = Configuration::default();
    hand.fingers.iter_mut().zip(addresses).for_each(|(finger, &address)| finger.address = address);
    SimulatedBoard::new(&hand, &[0, 1, 2][..addresses.len()]).unwrap()
}

fn link(addresses: &[u8]) -> Link<SimulatedCable> {
    Link::new(SimulatedCable::new(board(addresses)))
}

fn terms(end_state: EndState) -> Terms {
    let hand = ConfiguredHand { end_state, hold_time_ms: 50, hold_torque_limit: 0.5, ..Default::default() };
    Terms::new(&hand, &finger())
}

fn in_time(link: &mut Link<SimulatedCable>, milliseconds: u64) -> u64 {
    link.transport().now() + milliseconds * MS
}

/// One cycle of one finger at 1 kHz.
fn cycle(link: &mut Link<SimulatedCable>, sequence: u8, command: Command) -> Reply {
    link.send(&[OutgoingCommand { address: 1, sequence, command }]).unwrap();
    let deadline = in_time(link, 1);
    let received = link.receive(deadline).unwrap().expect("a reply");
    assert_eq!((received.address, received.sequence), (1, sequence));
    link.transport().advance_to(deadline);
    received.reply
}

fn pull(count: i16) -> Command {
    Command { toggle: false, enable: true, torques: [count; 4] }
}

/// What the motors are told, N cm.
fn torques(link: &mut Link<SimulatedCable>) -> Vector4<f64> {
    link.transport().board().finger(1).unwrap().motor_torques()
}

/// Within a torque unit, 1.6e-4 N cm.
fn assert_all(torques: Vector4<f64>, expected: f64) {
    assert!((torques.add_scalar(-expected)).amax() < 1.6e-4, "{torques} is not {expected} N cm");
}

#[test]
fn handshake_agrees_on_terms_and_tells_whole_counts() {
    let mut hand = Configuration::default();
    hand.fingers[2].encoder.zero = [1_000_000, -5, 0, 70_000];
    let board = SimulatedBoard::new(&hand, &[2]).unwrap();
    let mut link = Link::new(SimulatedCable::new(board));
    let deadline = in_time(&mut link, 500);
    let (identity, configured) = link.shake_hands(3, &terms(EndState::Hold), deadline).unwrap();
    assert_eq!((identity.version, identity.addresses, identity.gauge_bits), (1, 1 << 3, 12));
    assert_eq!(identity.counts_per_revolution, 2000);
    assert!(configured.encoders[0].abs_diff(1_000_000) < 20_000 && configured.encoders[3].abs_diff(70_000) < 20_000);
    assert_eq!(configured.terms.watchdog_ms, 18);
    // The limits of the configuration, in whole units of the board and not above them.
    for limit in configured.terms.torque_limits {
        let limit = identity.torque(limit as i16);
        assert!(limit <= 4.75 && limit > 4.75 - identity.torque(1));
    }
    assert_eq!(configured.terms.torque_constants, [23_400; 4]);
    assert_eq!(configured.status, Status::CONFIGURED | Status::ZERO_VALID);
    assert_eq!(link.counters(), LinkCounters { bytes: 45 + 66, frames: 2, ..Default::default() });
}

#[test]
fn a_cycle_echoes_sequence_and_measures_before_the_command_acts() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    let first = cycle(&mut link, 254, pull(3000));
    assert!(first.status.has(Status::ENABLED) && !first.status.has(Status::TORQUE_CLIPPED));
    let tension = 0.5 * (f64::from(first.gauges[0]) + f64::from(first.gauges[3])) * 100.0 / 4095.0;
    assert!((4.0..12.0).contains(&tension), "the homing pretension, {tension} N");
    let mut last = first;
    for sequence in [255, 0, 1] {
        last = cycle(&mut link, sequence, pull(3000));
    }
    // The board's clock, on the grid of the physics.
    assert!((2900..=3100).contains(&last.sampled_at.wrapping_sub(first.sampled_at)));
    assert_eq!(link.counters().damaged + link.counters().foreign + link.counters().unsent, 0);
}

#[test]
fn torque_is_clipped_to_the_terms() {
    let mut link = link(&[1]);
    let mut low = terms(EndState::Release);
    low.torque_limits = Vector4::repeat(0.5);
    link.shake_hands(1, &low, 500 * MS).unwrap();
    let reply = cycle(&mut link, 0, Command { torques: [i16::MAX, i16::MIN, i16::MAX, i16::MAX], ..pull(0) });
    assert!(reply.status.has(Status::TORQUE_CLIPPED));
    assert_all(torques(&mut link).component_mul(&Vector4::new(1.0, -1.0, 1.0, 1.0)), 0.5);
    let reply = cycle(&mut link, 1, pull(3000));
    assert!(!reply.status.has(Status::TORQUE_CLIPPED));
}

#[test]
fn silence_trips_the_watchdog_after_its_time_and_only_a_configure_leads_back() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    for sequence in 0..100 {
        cycle(&mut link, sequence, pull(3000));
    }
    // 17 more ms, 18 since the last command.
    let almost = in_time(&mut link, 17);
    link.transport().advance_to(almost);
    assert!(link.transport().board().finger(1).unwrap().enabled());
    link.transport().advance_to(almost + MS);
    assert!(!link.transport().board().finger(1).unwrap().enabled());

    let reply = cycle(&mut link, 100, pull(3000));
    assert!(reply.status.has(Status::WATCHDOG_TRIPPED) && reply.status.has(Status::ENDED));
    assert!(!reply.status.has(Status::ENABLED) && !reply.status.has(Status::HOLDING));
    assert_all(torques(&mut link), 0.0);

    let deadline = in_time(&mut link, 100);
    link.shake_hands(1, &terms(EndState::Release), deadline).unwrap();
    assert_all(torques(&mut link), 0.0);
    let reply = cycle(&mut link, 0, pull(3000));
    assert!(reply.status.has(Status::ENABLED) && !reply.status.has(Status::WATCHDOG_TRIPPED));
}

#[test]
fn hold_is_bounded_in_torque_and_time() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Hold), 500 * MS).unwrap();
    // 1.58, 0.32, 0 and -1.58 N cm; the terms allow 0.5 in hold.
    let command = Command { torques: [10_000, 2000, 0, -10_000], ..pull(0) };
    cycle(&mut link, 0, command);
    let before = torques(&mut link);
    let stopped_at = link.transport().now();
    assert!(link.stop(1, stopped_at + 5 * MS).unwrap());
    link.transport().advance_to(stopped_at + 48 * MS);
    let held = torques(&mut link);
    assert_all(Vector4::new(held[0], 0.5, 0.5, -held[3]), 0.5);
    assert_eq!((held[1], held[2]), (before[1], before[2]));
    let reply = cycle(&mut link, 1, command);
    assert!(reply.status.has(Status::HOLDING) && reply.status.has(Status::ENDED));
    link.transport().advance_to(stopped_at + 51 * MS);
    assert_all(torques(&mut link), 0.0);
    let reply = cycle(&mut link, 2, command);
    assert!(!reply.status.has(Status::HOLDING) && reply.status.has(Status::ENDED));
    assert_all(torques(&mut link), 0.0);
}

#[test]
fn a_stop_during_a_hold_does_not_prolong_it() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Hold), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(1000));
    let stopped_at = link.transport().now();
    for milliseconds in [0, 20, 40] {
        link.transport().advance_to(stopped_at + milliseconds * MS);
        let deadline = in_time(&mut link, 1);
        assert!(link.stop(1, deadline).unwrap());
    }
    link.transport().advance_to(stopped_at + 51 * MS);
    assert_all(torques(&mut link), 0.0);
}

#[test]
fn a_hold_of_no_torque_is_a_hold_and_a_refused_configure_does_not_end_it() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Hold), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(0));
    let deadline = in_time(&mut link, 1);
    assert!(link.stop(1, deadline).unwrap());
    let holding = |link: &mut Link<SimulatedCable>| link.transport().board().finger(1).unwrap().status();
    assert!(holding(&mut link).has(Status::HOLDING));
    let bad = Configure { version: 1, watchdog_ms: 0, ..Default::default() };
    let frame = WireFrame::new(&Message { address: 1, sequence: 9, frame: Frame::Configure(bad) });
    link.transport().write(frame.as_bytes()).unwrap();
    assert!(holding(&mut link).has(Status::HOLDING));
    let deadline = in_time(&mut link, 10);
    link.shake_hands(1, &terms(EndState::Hold), deadline).unwrap();
    assert!(!holding(&mut link).has(Status::HOLDING));
}

#[test]
fn a_command_without_enable_takes_the_torque_off_and_needs_no_new_configure() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Hold), 500 * MS).unwrap();
    assert!(cycle(&mut link, 0, pull(3000)).status.has(Status::ENABLED));
    let off = cycle(&mut link, 1, Command { enable: false, ..pull(3000) });
    assert_eq!(off.status, Status::CONFIGURED | Status::ZERO_VALID);
    assert!(cycle(&mut link, 2, pull(3000)).status.has(Status::ENABLED));
}

#[test]
fn emergency_stop_overrules_hold_and_latches() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Hold), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(3000));
    link.transport().board().finger(1).unwrap().set_faults(Status::EMERGENCY_STOP);
    let reply = cycle(&mut link, 1, pull(3000));
    assert!(reply.status.has(Status::EMERGENCY_STOP) && !reply.status.has(Status::HOLDING | Status::ENABLED));

    let deadline = in_time(&mut link, 200);
    let refusal = link.shake_hands(1, &terms(EndState::Hold), deadline).unwrap_err();
    assert!(matches!(refusal, LinkError::Refused { refused: Refused { reason: Reason::Fault, .. }, .. }));
    assert!(refusal.to_string().contains("emergency stop"));

    link.transport().board().finger(1).unwrap().set_faults(Status::default());
    assert!(cycle(&mut link, 2, pull(3000)).status.has(Status::EMERGENCY_STOP), "latched");
    let deadline = in_time(&mut link, 200);
    link.shake_hands(1, &terms(EndState::Hold), deadline).unwrap();
    assert!(!cycle(&mut link, 3, pull(3000)).status.has(Status::EMERGENCY_STOP));
}

#[test]
fn a_reset_board_refuses_commands() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(3000));
    link.transport().board().finger(1).unwrap().reset();
    link.send(&[OutgoingCommand { address: 1, sequence: 1, command: pull(3000) }]).unwrap();
    let deadline = in_time(&mut link, 1);
    let refusal = link.receive(deadline).unwrap_err();
    assert!(matches!(
        refusal,
        LinkError::Refused { address: 1, refused: Refused { reason: Reason::NotConfigured, request: 3, .. } }
    ));
}

#[test]
fn three_fingers_on_one_port_answer_in_the_order_of_their_commands() {
    let mut link = link(&[2, 3, 1]);
    for address in 1..=3 {
        let deadline = in_time(&mut link, 500);
        let (identity, _) = link.shake_hands(address, &terms(EndState::Release), deadline).unwrap();
        assert_eq!(identity.addresses, 0b1110);
    }
    let commands = [1, 2, 3].map(|address| OutgoingCommand { address, sequence: 40 + address, command: pull(1000) });
    link.send(&commands).unwrap();
    for address in 1..=3 {
        let deadline = in_time(&mut link, 1);
        let received = link.receive(deadline).unwrap().expect("a reply");
        assert_eq!((received.address, received.sequence), (address, 40 + address));
    }
    let deadline = in_time(&mut link, 1);
    assert_eq!(link.receive(deadline).unwrap(), None);
    assert_eq!(link.transport().now(), deadline);
}

#[test]
fn duplicates_are_answered_and_damage_is_not_but_shows() {
    let mut board = board(&[1]);
    let mut answers = Vec::new();
    let mut tell = |board: &mut SimulatedBoard, bytes: &[u8]| {
        answers.clear();
        board.receive(0, bytes, &mut |answer| answers.push(answer.to_vec()));
        answers.iter().map(|answer| read(answer)).collect::<Vec<_>>()
    };
    let wire = |sequence, frame| WireFrame::new(&Message { address: 1, sequence, frame }).as_bytes().to_vec();
    let configure = Configure { version: 1, watchdog_ms: 20, torque_limits: [100; 4], ..Default::default() };
    assert_eq!(tell(&mut board, &wire(1, Frame::Configure(configure))).len(), 1);
    let command = wire(7, Frame::Command(pull(50)));
    assert_eq!(tell(&mut board, &[command.clone(), command.clone()].concat()).len(), 2);
    let mut damaged = command.clone();
    damaged[5] ^= 0x10;
    assert!(tell(&mut board, &damaged).is_empty());
    let status = |messages: &[Message]| match messages {
        [Message { frame: Frame::Reply(reply), .. }] => reply.status,
        other => panic!("not one reply: {other:?}"),
    };
    assert!(status(&tell(&mut board, &command)).has(Status::DAMAGED_INPUT));
    assert!(!status(&tell(&mut board, &command)).has(Status::DAMAGED_INPUT));
    // Half a frame, then a delimiter and a whole one.
    assert_eq!(tell(&mut board, &[&command[..9], &[0], &command[..]].concat()).len(), 1);
    // An answer's type, another finger's address, Hello apart from address 0.
    assert!(tell(&mut board, &wire(1, Frame::Stopped(Stopped::default()))).is_empty());
    let to = |address, frame| WireFrame::new(&Message { address, sequence: 1, frame }).as_bytes().to_vec();
    assert!(tell(&mut board, &to(2, Frame::Stop(Stop))).is_empty());
    assert!(tell(&mut board, &to(0, Frame::Stop(Stop))).is_empty());
}

#[test]
fn a_board_refuses_what_it_cannot_carry_out() {
    let good = Configure { version: 1, watchdog_ms: 20, torque_limits: [100; 4], ..Default::default() };
    let refusal = |terms: Configure| {
        let mut board = board(&[1]);
        let mut answer = None;
        let message = Message { address: 1, sequence: 5, frame: Frame::Configure(terms) };
        board.receive(0, WireFrame::new(&message).as_bytes(), &mut |bytes| answer = Some(read(bytes)));
        match answer.expect("an answer").frame {
            Frame::Refused(refused) => Some((refused.reason, refused.detail)),
            _ => None,
        }
    };
    assert_eq!(refusal(good), None);
    assert_eq!(refusal(Configure { version: 2, ..good }), Some((Reason::Value, 2)));
    assert_eq!(refusal(Configure { watchdog_ms: 1, ..good }), Some((Reason::Value, 3)));
    assert_eq!(refusal(Configure { torque_limits: [0, 0, 40_000, 0], ..good }), Some((Reason::Value, 14)));
}

#[test]
fn a_board_refuses_what_it_does_not_understand() {
    let mut board = board(&[1]);
    let mut refusal = |content: &[u8]| {
        let mut answer = None;
        let check = check(content).to_le_bytes();
        let mut wire = [0; MAX_WIRE];
        let length = cobs::encode(&[content, &check].concat(), &mut wire) + 1;
        board.receive(0, &wire[..length], &mut |bytes| answer = Some(read(bytes)));
        match answer {
            Some(Message { address: 1, sequence: 77, frame: Frame::Refused(refused) }) => refused,
            other => panic!("{other:?}"),
        }
    };
    // Versions 2 to 9; a type that is free; a Stop with a body; a third end state.
    assert_eq!(refusal(&[0x11, 77, 2, 9]), Refused { request: 1, reason: Reason::Version, detail: 0x0101 });
    assert_eq!(refusal(&[0x71, 77, 1, 2, 3]), Refused { request: 7, reason: Reason::UnknownFrame, detail: 3 });
    // A Hello to whoever is there, without its second version.
    assert_eq!(refusal(&[0x10, 77, 1]), Refused { request: 1, reason: Reason::UnknownFrame, detail: 1 });
    assert_eq!(refusal(&[0x41, 77, 0]), Refused { request: 4, reason: Reason::UnknownFrame, detail: 1 });
    let mut configure = vec![0x21, 77, 1, 20, 0, 2];
    configure.resize(34, 0);
    assert_eq!(refusal(&configure), Refused { request: 2, reason: Reason::Value, detail: 5 });
}

fn read(wire: &[u8]) -> Message {
    Message::read(&Decoder::default().next(&mut &wire[..]).expect("whole")).expect("known")
}

/// Something else at the other end: answers each write with what a function makes of it.
struct Other<F>(F, Vec<u8>, u64);

impl<F: FnMut(Message) -> Vec<u8>> Transport for Other<F> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut decoder = Decoder::default();
        let mut rest = bytes;
        while let Some(packet) = decoder.next(&mut rest) {
            let message = Message::read(&packet).expect("the link sends known frames");
            self.1.extend((self.0)(message));
        }
        Ok(bytes.len())
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if self.1.is_empty() {
            self.2 = self.2.max(deadline);
        }
        let taken = self.1.len().min(buffer.len());
        buffer[..taken].copy_from_slice(&self.1[..taken]);
        self.1.drain(..taken);
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.1.clear();
        Ok(())
    }

    fn now(&self) -> u64 {
        self.2
    }
}

fn failure(answer: impl FnMut(Message) -> Vec<u8>) -> (LinkError, u64) {
    let mut link = Link::new(Other(answer, Vec::new(), 0));
    let error = link.shake_hands(1, &terms(EndState::Hold), 1000 * MS).unwrap_err();
    (error, link.transport().now())
}

/// A board that is good but for what `change` does to its answers.
fn good_but(change: impl Fn(&mut Message)) -> impl FnMut(Message) -> Vec<u8> {
    let mut good = board(&[1]);
    move |request| {
        let mut wire = Vec::new();
        good.receive(0, WireFrame::new(&request).as_bytes(), &mut |answer| {
            let mut message = read(answer);
            change(&mut message);
            wire.extend(WireFrame::new(&message).as_bytes());
        });
        wire
    }
}

#[test]
fn handshake_names_what_is_wrong() {
    let (error, when) = failure(|_| Vec::new());
    assert!(matches!(error, LinkError::Silent { milliseconds: 1000 }) && when == 1000 * MS, "{error}");
    assert_eq!(error.errno(), libc::ETIMEDOUT);

    let (error, _) = failure(|_| vec![0x55, 0xAA, 0, 0x13, 0]);
    assert!(matches!(error, LinkError::Unintelligible { .. }) && error.to_string().contains("baud"), "{error}");

    let mut elsewhere = board(&[4, 7]);
    let (error, when) = failure(move |request| {
        let mut wire = Vec::new();
        elsewhere.receive(0, WireFrame::new(&request).as_bytes(), &mut |answer| wire.extend(answer));
        wire
    });
    assert!(matches!(error, LinkError::WrongAddress { address: 1, .. }), "{error}");
    assert!(error.to_string().contains("but 4, 7") && when < 1000 * MS, "{error}");

    let (error, when) = failure(good_but(|message| {
        message.frame = Frame::Refused(Refused { request: 1, reason: Reason::Version, detail: 0x0302 });
    }));
    assert!(matches!(error, LinkError::WrongVersion { lowest: 2, highest: 3 }) && when == 0, "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Configured(configured) = &mut message.frame {
            configured.terms.watchdog_ms += 1;
        }
    }));
    assert!(matches!(error, LinkError::OtherTerms { address: 1 }), "{error}");

    let (error, _) = failure(good_but(|message| message.sequence ^= 1));
    assert!(matches!(error, LinkError::Unanswered { request: Kind::Hello, .. }), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.shortest_watchdog_ms = 50;
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::Watchdog { shortest: 50, wanted: 18 })), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.capabilities = Capabilities(0);
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::Hold)), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.torque_limit = 100;
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::TorqueLimit { motor: 1, .. })), "{error}");
}

#[test]
fn handshake_waits_for_a_board_that_is_starting() {
    let mut asked = 0;
    let mut starting = good_but(|_| {});
    let answer = move |request| {
        asked += 1;
        if asked < 5 { Vec::new() } else { starting(request) }
    };
    let mut link = Link::new(Other(answer, Vec::new(), 0));
    assert!(link.shake_hands(1, &terms(EndState::Hold), 1000 * MS).is_ok());
}

#[test]
fn handshake_waits_for_the_watchdog_to_end_a_dead_host() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(3000));
    // A new host at once: refused as running until the watchdog has tripped.
    let began = link.transport().now();
    link.shake_hands(1, &terms(EndState::Release), began + 500 * MS).unwrap();
    assert!(link.transport().now() - began >= 19 * MS);
}

#[test]
fn a_frame_that_did_not_fit_costs_itself_only() {
    /// Takes 5 bytes of the second write.
    struct Narrow(SimulatedCable, u32);
    impl Transport for Narrow {
        fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
            self.1 += 1;
            self.0.write(if self.1 == 4 { &bytes[..5] } else { bytes })
        }
        fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
            self.0.read_until(buffer, deadline)
        }
        fn discard_input(&mut self) -> Result<(), PortError> {
            self.0.discard_input()
        }
        fn now(&self) -> u64 {
            self.0.now()
        }
    }
    let mut link = Link::new(Narrow(SimulatedCable::new(board(&[1])), 0));
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    let mut answered = Vec::new();
    for sequence in 0..4 {
        link.send(&[OutgoingCommand { address: 1, sequence, command: pull(100) }]).unwrap();
        let deadline = link.transport().now() + MS;
        answered.extend(link.receive(deadline).unwrap().map(|received| received.sequence));
    }
    // Writes: Hello, Configure, three whole commands and one cut short, the second.
    assert_eq!(answered, [0, 2, 3]);
    assert_eq!(link.counters().unsent, 1);
}

#[test]
fn a_refused_handshake_frame_that_comes_late_is_no_fault() {
    let refusal = |request| {
        let frame = Frame::Refused(Refused { request, reason: Reason::Running, detail: 0 });
        WireFrame::new(&Message { address: 1, sequence: 3, frame }).as_bytes().to_vec()
    };
    for (request, fault) in [(Kind::Configure as u8, false), (Kind::Command as u8, true)] {
        let mut link = Link::new(Other(|_| Vec::new(), refusal(request), 0));
        assert_eq!(link.receive(MS).is_err(), fault);
        assert_eq!(link.counters().foreign, u64::from(!fault));
    }
}

#[test]
fn endless_rubbish_holds_up_nobody() {
    /// Always has bytes; each read takes 10 us.
    struct Babbler(u64);
    impl Transport for Babbler {
        fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
            Ok(bytes.len())
        }
        fn read_until(&mut self, buffer: &mut [u8], _: u64) -> Result<usize, PortError> {
            self.0 += 10_000;
            buffer.fill(0x5A);
            Ok(buffer.len())
        }
        fn discard_input(&mut self) -> Result<(), PortError> {
            Ok(())
        }
        fn now(&self) -> u64 {
            self.0
        }
    }
    let mut link = Link::new(Babbler(0));
    assert_eq!(link.receive(MS).unwrap(), None);
    assert!(link.transport().now() <= MS + 10_000);
}
