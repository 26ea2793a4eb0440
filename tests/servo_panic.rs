//! A servo that panics must not leave the last torque on the motors, and its thread must not end the process.

#[allow(dead_code)]
#[path = "common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::{Hooks, ServedFinger, World};
use sun2xp::board::protocol::Status;
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::{Fault, FaultKind, Stage};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Clock;
use sun2xp::simulated::SimulatedCable;

const PERIOD: u64 = 1_000_000;

/// The time from which reads fail, ns.
const DEFECTIVE: u64 = 300 * PERIOD;

/// A driver with a defect, and the number of its remaining panics.
struct Defect {
    panics: u32,
}

impl Hooks for Defect {
    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if cable.now() >= DEFECTIVE && self.panics > 0 {
            self.panics -= 1;
            panic!("the defect of this test");
        }
        cable.read_until(buffer, deadline)
    }
}

#[test]
fn a_panic_in_a_cycle_stops_the_board_and_faults_the_finger() {
    // One panic, or a panic in every read, also while the board is being stopped.
    for panics in [1, u32::MAX] {
        let configuration = Configuration::default();
        let world = World::new(&configuration, Defect { panics });
        let mut finger = ServedFinger::new(&world, &configuration);
        while Clock::now(&world) + 2 * PERIOD < DEFECTIVE {
            finger.servo.cycle();
        }
        let pulling = world.place().cable.board().fingers()[0].motor_torques();
        assert!(pulling.amax() > 0.1, "the motors must pull: {pulling}");

        // The call returns. A panic that escaped it would fail this test.
        finger.servo.run();
        assert!(world.place().hooks.panics < panics, "no panic");
        let stage = finger.mailbox.report().stage;
        assert!(matches!(stage, Stage::Faulted(Fault { kind: FaultKind::ServoPanic, .. })), "{stage:?}");
        assert!(finger.mailbox.send(|_| {}).is_err(), "calls are refused");
        assert!(
            finger.repair_end.released.is_abandoned() && finger.repair_end.released.pop().is_none(),
            "the thread that repairs ports must not receive the link"
        );
        let mut place = world.place();
        let finger = &mut place.cable.board().fingers()[0];
        let status = finger.status();
        assert!(status.has(Status::ENDED) && !status.has(Status::WATCHDOG_TRIPPED), "{status:?}");
        assert_eq!(finger.motor_torques().amax(), 0.0);
    }
}
