//! The adapter `IoBoard`, which acts as the board, on a link without threads.

use super::plant_io::{PlantIo, Switches, starts_and_stops};
use sun2xp::board::protocol::{Command, Configured, Identity, Status};
use sun2xp::board::{IoBoard, Link, LinkError, OutgoingCommand, PortError, Received, Terms};
use sun2xp::io::{FingerIo, IoFaults};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, EndState};
use sun2xp::realtime::now;

struct Rig {
    link: Link<IoBoard>,
    switches: Switches,
    sequence: u8,
}

impl Rig {
    fn new(configuration: &Configuration) -> Self {
        let io = PlantIo::new(configuration, FingerNumber::TWO, false);
        let switches = io.switches.clone();
        let properties = io.properties();
        let board = IoBoard::new(configuration, FingerNumber::TWO, Box::new(io), properties);
        let board = board.expect("a positive tension unit");
        Self { link: Link::new(board), switches, sequence: 0 }
    }

    fn shake_hands(&mut self, configuration: &Configuration) -> Result<(Identity, Configured), LinkError> {
        let terms = Terms::new(&configuration.hand, &configuration.fingers[1]);
        self.link.shake_hands(2, &terms, now() + 200_000_000)
    }

    fn ready() -> Self {
        let configuration = Configuration::default();
        let mut rig = Self::new(&configuration);
        rig.shake_hands(&configuration).expect("the hardware starts");
        rig
    }

    fn exchange(&mut self, torques: [i16; 4]) -> Option<Received> {
        self.sequence = self.sequence.wrapping_add(1);
        let command = Command { toggle: false, enable: true, torques };
        self.link.send(&[OutgoingCommand { address: 2, sequence: self.sequence, command }]).expect("sent");
        self.link.receive(now() + 1_000_000).expect("no refusal")
    }

    fn status(&mut self) -> Status {
        self.exchange([0; 4]).expect("a reply").reply.status
    }
}

#[test]
fn the_terms_reach_the_hardware_in_physical_units() {
    let mut configuration = Configuration::default();
    configuration.hand.end_state = EndState::Release;
    let mut rig = Rig::new(&configuration);
    let (identity, configured) = rig.shake_hands(&configuration).expect("the hardware starts");
    let terms = rig.switches.lock().terms.expect("terms");
    let motor = &configuration.fingers[1].motor;
    assert_eq!(terms.watchdog_ms, configuration.hand.watchdog_ms);
    assert_eq!((terms.rate, terms.end_state, terms.finger), (1000.0, EndState::Release, FingerNumber::TWO));
    for motor_number in 0..4 {
        let (limit, constant) = (motor.torque_limit[motor_number], motor.torque_constant[motor_number]);
        assert!((0.9999..=1.0).contains(&(terms.torque_limits[motor_number] / limit)), "{}", terms.torque_limits);
        assert!((terms.torque_constants[motor_number] - constant).abs() < 1e-4, "{}", terms.torque_constants);
    }
    assert_eq!(identity.gauge_bits, 16);
    let pretension = configured.gauges.map(|count| (f64::from(count) - 8192.0) * 0.005);
    assert!(pretension.iter().all(|tension| (4.0..60.0).contains(tension)), "{pretension:?}");
}

#[test]
fn torques_are_those_of_the_command_within_the_limits() {
    let configuration = Configuration::default();
    let mut rig = Rig::new(&configuration);
    let (identity, _) = rig.shake_hands(&configuration).expect("the hardware starts");
    let reply = rig.exchange([100, -200, i16::MAX, 0]).expect("a reply").reply;
    let torques = rig.switches.lock().last.expect("a command").torques;
    let limit = configuration.fingers[1].motor.torque_limit[2];
    assert_eq!((torques[0], torques[1], torques[3]), (identity.torque(100), identity.torque(-200), 0.0));
    assert!((0.9999..=1.0).contains(&(torques[2] / limit)), "{torques}");
    assert!(reply.status.has(Status::TORQUE_CLIPPED) && !rig.status().has(Status::TORQUE_CLIPPED));
}

#[test]
fn an_exchange_that_fails_is_a_lost_reply_without_a_wait() {
    let mut rig = Rig::ready();
    assert!(rig.exchange([0; 4]).is_some());
    rig.switches.lock().exchange_fails = Some(libc::ETIMEDOUT);
    let before = now();
    rig.sequence += 1;
    let command = Command { enable: true, ..Command::default() };
    rig.link.send(&[OutgoingCommand { address: 2, sequence: rig.sequence, command }]).expect("sent");
    assert_eq!(rig.link.receive(before + 2_000_000_000).expect("no refusal"), None);
    assert!(now() - before < 1_000_000_000, "the failure is known before the deadline");
    rig.switches.lock().exchange_fails = None;
    assert_eq!(rig.exchange([0; 4]).map(|received| received.sequence), Some(rig.sequence));
}

#[test]
fn an_unusable_reading_sets_sensor_fault_and_keeps_the_last_counts() {
    for tension in [f64::NAN, f64::INFINITY, -41.0, 300.0] {
        let mut rig = Rig::ready();
        let before = rig.exchange([0; 4]).expect("a reply").reply.gauges;
        rig.switches.lock().tension = Some((2, tension));
        let reply = rig.exchange([0; 4]).expect("a reply").reply;
        assert!(reply.status.has(Status::SENSOR_FAULT), "{tension} N: {:?}", reply.status);
        assert_eq!(reply.gauges, before, "{tension} N");
    }
    for (moved, readable) in [(32_000, true), (-32_000, true), (40_000, false), (i32::MIN, false)] {
        let mut rig = Rig::ready();
        rig.switches.lock().encoder = [0, 0, 0, moved];
        assert_eq!(rig.status().has(Status::SENSOR_FAULT), !readable, "{moved} counts");
    }
}

#[test]
fn faults_of_the_hardware_are_bits_of_the_status() {
    for (fault, bit) in [
        (IoFaults::WATCHDOG, Status::WATCHDOG_TRIPPED),
        (IoFaults::ENDED, Status::ENDED),
        (IoFaults::EMERGENCY_STOP, Status::EMERGENCY_STOP),
        (IoFaults::SUPPLY, Status::SUPPLY_FAULT),
        (IoFaults::DRIVER, Status::DRIVER_FAULT),
        (IoFaults::SENSOR, Status::SENSOR_FAULT),
    ] {
        let mut rig = Rig::ready();
        assert!(!rig.status().has(bit) && rig.status().has(Status::ZERO_VALID));
        rig.switches.lock().faults = fault;
        assert!(rig.status().has(bit), "{fault:?}");
        // The bit of a fault stays set until the next start, even if the fault was present in only one exchange.
        rig.switches.lock().faults = IoFaults::default();
        assert!(rig.status().has(bit), "{fault:?}");
    }
    let mut rig = Rig::ready();
    rig.switches.lock().faults = IoFaults::ZERO_LOST;
    assert!(!rig.status().has(Status::ZERO_VALID | Status::FAULTS));
}

#[test]
fn a_fault_at_the_start_refuses_the_terms_and_stops_the_hardware() {
    let configuration = Configuration::default();
    let mut rig = Rig::new(&configuration);
    rig.switches.lock().faults = IoFaults::EMERGENCY_STOP;
    let error = rig.shake_hands(&configuration).expect_err("a fault is present");
    assert!(matches!(error, LinkError::Refused { .. }) && error.to_string().contains("0x0040"), "{error}");
    assert_eq!(starts_and_stops(&rig.switches), (1, 1));
}

#[test]
fn after_a_silence_the_watchdog_counts_as_tripped() {
    let mut rig = Rig::ready();
    assert!(!rig.status().has(Status::WATCHDOG_TRIPPED));
    // The default watchdog time is 18 ms.
    std::thread::sleep(std::time::Duration::from_millis(25));
    let exchanges = rig.switches.lock().exchanges;
    assert!(rig.status().has(Status::WATCHDOG_TRIPPED));
    assert_eq!(rig.switches.lock().exchanges, exchanges, "the hardware gets no torque after its watchdog has tripped");
}

#[test]
fn a_stop_is_confirmed_when_the_hardware_has_stopped_and_is_then_not_repeated() {
    let mut rig = Rig::ready();
    rig.status();
    rig.switches.lock().stops_fail = 2;
    let confirmed = [(); 4].map(|()| rig.link.stop(2, 0).expect("the link works"));
    assert_eq!((confirmed, starts_and_stops(&rig.switches).1), ([false, false, true, true], 1));
    assert!(rig.status().has(Status::ENDED));
}

#[test]
fn hardware_that_does_not_start_has_its_errno() {
    let configuration = Configuration::default();
    let mut rig = Rig::new(&configuration);
    rig.switches.lock().start_fails = Some(libc::ENODEV);
    let error = rig.shake_hands(&configuration).expect_err("no hardware");
    assert!(matches!(error, LinkError::Port(PortError::Hardware { doing: "start", .. })), "{error}");
    assert_eq!(error.errno(), libc::ENODEV);
    rig.switches.lock().start_fails = None;
    rig.shake_hands(&configuration).expect("the hardware starts now");
    drop(rig.link);
    assert_eq!(starts_and_stops(&rig.switches), (1, 1), "dropping stops the hardware");
}

#[test]
fn a_stop_that_fails_is_repeated_when_the_board_is_dropped() {
    for (fail, left, stops) in [(2, 0, 1), (5, 2, 0)] {
        let rig = Rig::ready();
        rig.switches.lock().stops_fail = fail;
        drop(rig.link);
        let switches = rig.switches.lock();
        assert_eq!((switches.stops_fail, switches.stops), (left, stops), "{fail} failures");
    }
}
