//! A link to a simulated board, in memory and on simulated time.

use nalgebra::Vector4;
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand, EndState};
use sun2xp::simulated::*;

pub const MS: u64 = 1_000_000;

pub fn finger() -> ConfiguredFinger {
    ConfiguredFinger::default()
}

pub fn board(addresses: &[u8]) -> SimulatedBoard {
    let mut hand = Configuration::default();
    hand.fingers.iter_mut().zip(addresses).for_each(|(finger, &address)| finger.address = address);
    SimulatedBoard::new(&hand, &FingerNumber::ALL[..addresses.len()]).unwrap()
}

pub fn link(addresses: &[u8]) -> Link<SimulatedCable> {
    Link::new(SimulatedCable::new(board(addresses)))
}

pub fn terms(end_state: EndState) -> Terms {
    let hand = ConfiguredHand { end_state, hold_time_ms: 50, hold_torque_limit: 0.5, ..Default::default() };
    Terms::new(&hand, &finger())
}

pub fn in_time(link: &mut Link<SimulatedCable>, milliseconds: u64) -> u64 {
    link.transport().now() + milliseconds * MS
}

/// Runs one cycle of the finger at address 1, at 1 kHz, and returns its reply.
pub fn cycle(link: &mut Link<SimulatedCable>, sequence: u8, command: Command) -> Reply {
    link.send(&[OutgoingCommand { address: 1, sequence, command }]).unwrap();
    let deadline = in_time(link, 1);
    let received = link.receive(deadline).unwrap().expect("a reply");
    assert_eq!((received.address, received.sequence), (1, sequence));
    link.transport().advance_to(deadline);
    received.reply
}

pub fn pull(count: i16) -> Command {
    Command { toggle: false, enable: true, torques: [count; 4] }
}

/// Returns the torques of the motors at address 1, N cm.
pub fn torques(link: &mut Link<SimulatedCable>) -> Vector4<f64> {
    link.transport().board().finger(1).unwrap().motor_torques()
}

/// Checks that every torque is `expected`, to within one torque unit, 1.6e-4 N cm.
pub fn assert_all(torques: Vector4<f64>, expected: f64) {
    assert!((torques.add_scalar(-expected)).amax() < 1.6e-4, "{torques} is not {expected} N cm");
}

pub fn read(wire: &[u8]) -> Message {
    Message::read(&Decoder::default().next(&mut &wire[..]).expect("whole")).expect("known")
}
