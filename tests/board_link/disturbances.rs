//! The link copes with truncated, late and foreign frames, and with an endless stream of bytes that are no frames.

use crate::other_end::OtherEnd;
use crate::rig::{MS, board, pull, terms};
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::configuration::EndState;
use sun2xp::simulated::*;

#[test]
fn a_truncated_frame_costs_only_its_own_cycle() {
    /// Accepts only 5 bytes of the second Command.
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
    // The writes are Hello, Configure and four Commands. The second Command is cut short.
    assert_eq!(answered, [0, 2, 3]);
    assert_eq!(link.counters().unsent, 1);
}

#[test]
fn a_late_refusal_of_a_handshake_frame_is_no_fault() {
    let refusal = |request| {
        let frame = Frame::Refused(Refused { request, reason: Reason::Running, detail: 0 });
        WireFrame::new(&Message { address: 1, sequence: 3, frame }).as_bytes().to_vec()
    };
    for (request, fault) in [(Kind::Configure as u8, false), (Kind::Command as u8, true)] {
        let mut link = Link::new(OtherEnd::new(|_| Vec::new(), refusal(request)));
        assert_eq!(link.receive(MS).is_err(), fault);
        assert_eq!(link.counters().foreign, u64::from(!fault));
    }
}

/// The link relays a Stop to finger 2. Four frames that answer other requests, such as a Stop to finger 1, arrive
/// before the answer to the relayed Stop.
#[test]
fn only_the_answer_to_a_relayed_request_is_passed_on() {
    let wire = |address, sequence, frame| WireFrame::new(&Message { address, sequence, frame }).as_bytes().to_vec();
    let stopped = |address, sequence| wire(address, sequence, Frame::Stopped(Stopped::default()));
    let other = Refused { request: Kind::Configure as u8, reason: Reason::Running, detail: 0 };
    let foreign = [stopped(1, 4), stopped(2, 8), stopped(1, 9), wire(2, 9, Frame::Refused(other))].concat();
    let answers = [foreign, stopped(2, 9), stopped(2, 9)].concat();
    let mut link = Link::new(OtherEnd::new(move |_| answers.clone(), Vec::new()));
    link.relay(&wire(2, 9, Frame::Stop(Stop)));
    link.send(&[]).unwrap();
    let arrival = link.next_arrival(&mut Allowance::for_replies(MS)).unwrap();
    let expected = Message { address: 2, sequence: 9, frame: Frame::Stopped(Stopped::default()) };
    assert_eq!(arrival, Some(Arrival::Relayed(expected)));
    assert!(!link.awaits_relayed());
    assert_eq!(link.next_arrival(&mut Allowance::for_replies(MS)).unwrap(), None);
    // The four frames before the answer count as foreign, and so does the repetition of the answer.
    assert_eq!(link.counters().foreign, 5);
}

#[test]
fn endless_rubbish_delays_no_call() {
    /// Always has bytes to read. Each read takes 10 us.
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
