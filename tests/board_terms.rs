//! Terms that a board receives in its own units. Rounding must never exceed a limit.

use nalgebra::Vector4;
use proptest::prelude::*;
use sun2xp::board::protocol::{Capabilities, Configure, FirmwareVersion, Identity, VERSION};
use sun2xp::board::{LinkError, Terms, TermsError};
use sun2xp::model::configuration::{ConfiguredFinger, ConfiguredHand, EndState};

/// A board with this torque unit, nN m, and the largest torque that a Command can carry.
fn board(torque_unit: u32) -> Identity {
    Identity {
        version: VERSION,
        addresses: 2,
        board_kind: 0x8000,
        unique_number: [1; 12],
        firmware: FirmwareVersion([1, 0, 0]),
        counts_per_revolution: 2000,
        gauge_bits: 12,
        torque_unit,
        torque_limit: 32_767,
        shortest_watchdog_ms: 2,
        capabilities: Capabilities::HOLD,
    }
}

fn terms(torque_limit: f64, hold_torque_limit: f64, torque_constant: f64) -> Terms {
    let hand = ConfiguredHand { end_state: EndState::Hold, hold_torque_limit, ..Default::default() };
    Terms {
        torque_limits: Vector4::repeat(torque_limit),
        torque_constants: Vector4::repeat(torque_constant),
        ..Terms::new(&hand, &ConfiguredFinger::default())
    }
}

/// Converts a count to N cm, independently of the library. The product of count and unit is a whole number of nN m. The
/// result is the torque that the board will give.
fn newton_centimetres(count: i64, unit: u32) -> f64 {
    (count * i64::from(unit)) as f64 / 1e7
}

#[test]
fn a_torque_unit_of_nearly_twice_the_limit_is_refused() {
    // The limit is 0.54 units. It would round to one unit, which is 1.85 times the limit.
    let unit = (4.75e7f64 / 0.54) as u32;
    let error = terms(4.75, 1.0, 2.34).configure(&board(unit)).expect_err("too coarse");
    assert!(matches!(error, TermsError::CoarseUnit { motor: 1, .. }), "{error}");
    let text = LinkError::from(error).to_string();
    for part in ["8.796 N cm", "1 % of the torque limit", "motor 1", "4.750 N cm", "firmware"] {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
}

#[test]
fn the_coarsest_unit_that_is_taken_is_a_hundredth_of_the_smallest_limit() {
    let mut terms = terms(4.75, 1.0, 2.34);
    terms.torque_limits[2] = 2.0;
    assert!(terms.configure(&board(200_000)).is_ok());
    let error = terms.configure(&board(200_001)).expect_err("too coarse");
    assert!(matches!(error, TermsError::CoarseUnit { motor: 3, .. }), "{error}");
}

/// A limit of a whole number of units is not rounded at all.
#[test]
fn whole_numbers_of_units_are_kept() {
    let sent = terms(4.75, 0.5, 2.34).configure(&board(2000)).expect("good terms");
    assert_eq!((sent.torque_limits, sent.hold_torque_limit, sent.torque_constants), ([23_750; 4], 2500, [23_400; 4]));
    for count in -32_767..=32_767 {
        for unit in [1, 3, 158, 1584, 2000, 475_000] {
            assert_eq!(board(unit).torque_count(newton_centimetres(count.into(), unit)), count, "{unit} nN m");
        }
    }
}

#[test]
fn a_limit_beyond_the_boards_is_refused() {
    let weak = Identity { torque_limit: 23_749, ..board(2000) };
    let error = terms(4.75, 1.0, 2.34).configure(&weak).expect_err("too strong");
    assert!(matches!(error, TermsError::TorqueLimit { motor: 1, .. }), "{error}");
    // Far beyond the range, where counts saturate.
    let error = terms(5000.0, 1.0, 2.34).configure(&board(2000)).expect_err("too strong");
    assert!(matches!(error, TermsError::TorqueLimit { motor: 1, .. }), "{error}");
    // Less than one unit beyond the range: the board receives the largest torque that it can give.
    let sent = terms(4.7501, 1.0, 2.34).configure(&Identity { torque_limit: 23_750, ..board(2000) });
    assert_eq!(sent.expect("good terms").torque_limits, [23_750; 4]);
}

/// docs/board-protocol.md allows a shortest watchdog time of up to 20 ms. A board that needs more than the configured
/// time gets its shortest time, and every other board gets the configured time. A board whose shortest time is more
/// than 20 ms is refused, unless the configured time is at least as long.
#[test]
fn a_board_gets_the_shortest_watchdog_that_it_can_keep() {
    let terms = terms(4.75, 1.0, 2.34);
    assert_eq!(terms.watchdog_ms, 18);
    for (shortest_watchdog_ms, agreed) in [(2, 18), (18, 18), (19, 19), (20, 20)] {
        let board = Identity { shortest_watchdog_ms, ..board(2000) };
        assert_eq!(terms.configure(&board).expect("good terms").watchdog_ms, agreed);
    }
    let slow = Identity { shortest_watchdog_ms: 21, ..board(2000) };
    let error = terms.configure(&slow).expect_err("above 20 ms");
    assert!(matches!(error, TermsError::Watchdog { shortest: 21, wanted: 18 }), "{error}");
    assert!(error.to_string().contains("raise hand.watchdog_ms to 21"), "{error}");
    let patient = Terms { watchdog_ms: 21, ..terms };
    assert_eq!(patient.configure(&slow).expect("good terms").watchdog_ms, 21);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn no_torque_is_larger_for_being_rounded(torque in -6000.0..6000.0f64, unit in 1u32..100_000_000) {
        let count = i64::from(board(unit).torque_count(torque));
        let sent = newton_centimetres(count, unit);
        prop_assert!(sent.abs() <= torque.abs() && sent * torque >= 0.0, "{torque} N cm became {sent}");
        let saturated = count.abs() == 32_767;
        let next = newton_centimetres(count.abs() + 1, unit);
        prop_assert!(saturated || torque.abs() < next, "{torque} N cm became {sent}, though {next} is not too much");
    }

    #[test]
    fn no_limit_is_exceeded(
        limit in 0.001..6000.0f64, hold in 0.0..1000.0f64, constant in 0.001..10_000.0f64, parts in 100.0..30_000.0f64,
    ) {
        // A unit of at least 1 nN m, rounded down. The limit is `parts` units or more, unless the unit is 1 nN m.
        let unit = ((limit * 1e7 / parts) as u32).max(1);
        match terms(limit, hold, constant).configure(&board(unit)) {
            Ok(configure) => {
                let Configure { torque_limits, hold_torque_limit, torque_constants, .. } = configure;
                let (sent, constant_sent) = (torque_limits[0], torque_constants[0]);
                let sent = newton_centimetres(sent.into(), unit);
                prop_assert!(sent <= limit && sent >= 0.99 * limit, "{limit} N cm became {sent}");
                prop_assert!(newton_centimetres(hold_torque_limit.into(), unit) <= hold);
                // The board divides by the constant to get a current, so a larger constant makes the torque smaller.
                let constant_sent = f64::from(constant_sent) / 1e4;
                prop_assert!(constant_sent >= constant && constant_sent < constant + 1.001e-4);
            }
            Err(error) => {
                let coarse = f64::from(unit) > 0.01 * limit * 1e7;
                prop_assert!(coarse && matches!(error, TermsError::CoarseUnit { .. }), "{error}");
            }
        }
    }
}
