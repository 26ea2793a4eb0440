//! The states of the board as its host sees them: ready, enabled, holding, ended.

use crate::rig::{MS, assert_all, cycle, in_time, link, pull, terms, torques};
use nalgebra::Vector4;
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::configuration::EndState;
use sun2xp::simulated::*;

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
    // The board's clock advances with the steps of its physics, 100 us each, so the three periods of 1 ms may measure
    // one step more or less.
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
    // The last command was sent 1 ms ago. After 17 ms more, it is 18 ms old.
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
    // The torques are 1.58, 0.32, 0 and -1.58 N cm. The terms permit 0.5 N cm during a hold.
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
    let status = |link: &mut Link<SimulatedCable>| link.transport().board().finger(1).unwrap().status();
    assert!(status(&mut link).has(Status::HOLDING));
    let bad = Configure { version: 1, watchdog_ms: 0, ..Default::default() };
    let frame = WireFrame::new(&Message { address: 1, sequence: 9, frame: Frame::Configure(bad) });
    link.transport().write(frame.as_bytes()).unwrap();
    assert!(status(&mut link).has(Status::HOLDING));
    let deadline = in_time(&mut link, 10);
    link.shake_hands(1, &terms(EndState::Hold), deadline).unwrap();
    assert!(!status(&mut link).has(Status::HOLDING));
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
