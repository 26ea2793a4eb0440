//! Schedules whose expected times were calculated with pencil and paper.

use super::super::fastest::Fastest;
use super::*;
use sun2xp::model::configuration::TouchElement;

const COSTS: Costs = Costs { wake_up: 100.0, write: 10.0, read: 5.0, compute: 15.0 };

/// Each finger is on its own core: 100 + 10 us until the commands are written, 550 us for the exchange, and 20 us
/// after that. The exchange takes 170 us for the 17 bytes of the command, 100 us in the board and 280 us for the 28
/// bytes of the reply.
#[test]
fn three_fingers_on_three_cores() {
    let mut hand = Configuration::default();
    for (core, finger) in hand.fingers.iter_mut().enumerate() {
        finger.core = Some(core);
    }
    let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
    assert_eq!(schedule.len(), 3);
    for (index, thread) in schedule.iter().enumerate() {
        assert_eq!(
            (thread.thread as usize, thread.core, &thread.fingers[..]),
            (index + 1, Some(index), &[FingerNumber::ALL[index]][..])
        );
        assert_eq!((thread.response, thread.violation), (Some((660.0, 680.0)), None));
        assert!((thread.load - 0.03).abs() < 1e-9 && (thread.line - 0.55).abs() < 1e-9);
    }
    // The line is the limit: 550 us are 80 % of a period at 1454.5 Hz.
    assert_eq!(Fastest::of(&hand, &COSTS, &Sensor::default()).rate, Some(1454));
    assert_eq!(off_line_schedule(&hand, 1455.0, &COSTS, &Sensor::default())[0].violation, Some(Violation::Line));
    // Ten more bytes take 100 us more. At 2 megabaud the exchange takes 225 + 100 + 50 us, which is 80 % of a
    // period at 2133 Hz.
    let sensor = Sensor { bytes: 10, compute: 50.0 };
    assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &sensor)[0].response, Some((760.0, 830.0)));
    hand.fingers.iter_mut().for_each(|finger| finger.baud = 2_000_000);
    // 100 + 10 + 375 + 70 = 555: the cycle is done in time up to 1801 Hz.
    assert_eq!(Fastest::of(&hand, &COSTS, &sensor).rate, Some(1801));
    assert_eq!(off_line_schedule(&hand, 1802.0, &COSTS, &sensor)[0].violation, Some(Violation::Cycle));
}

/// On one core, each thread may have to wait until both other threads have computed two cycles each. In a cycle, a
/// thread computes for 10 + 5 + 15 = 30 us. The cycle is done by 680 + 2 * 2 * 30 = 800 us.
#[test]
fn three_fingers_on_one_core() {
    let mut hand = Configuration::default();
    hand.fingers.iter_mut().for_each(|finger| finger.core = Some(1));
    let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
    assert!(schedule.iter().all(|thread| thread.response == Some((780.0, 800.0))), "{schedule:?}");
    // Threads that are not bound to cores may compete for one core.
    hand.fingers.iter_mut().for_each(|finger| finger.core = None);
    assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[2].response, Some((780.0, 800.0)));
}

/// On one thread, the lines are busy in parallel, and the fingers are computed one after the other.
#[test]
fn three_fingers_on_one_thread() {
    let mut hand = Configuration::default();
    hand.fingers.iter_mut().for_each(|finger| finger.thread = 1);
    let [thread] = &off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[..] else { panic!("one thread") };
    assert_eq!(thread.response, Some((680.0, 740.0)));
    // On one port the replies follow each other. The second and the third command are sent while replies arrive, so
    // they add no time. The exchange takes 170 + 100 + 3 * 280 = 1110 us. This is more than 80 % of the period of
    // 1000 us.
    hand.fingers.iter_mut().for_each(|finger| finger.port = "/dev/ttyUSB0".into());
    assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[0].violation, Some(Violation::Line));
    hand.fingers.iter_mut().for_each(|finger| finger.baud = 2_000_000);
    let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
    assert_eq!(schedule[0].response, Some((715.0, 775.0)));
    assert_eq!((&schedule[0].fingers[..], schedule[0].violation), (&FingerNumber::ALL[..], None));
}

/// The answer to a TactileRequest takes 200 us, and reading it 5 us more.
#[test]
fn touch_takes_the_time_that_the_line_has_left() {
    let mut hand = Configuration::default();
    hand.fingers.iter_mut().enumerate().for_each(|(core, finger)| finger.core = Some(core));
    let element = TouchElement { position: [0.0; 3], normal: [0.0, 0.0, 1.0], newton_per_count: 0.001, zero: 0 };
    hand.fingers[1].touch.elements = vec![element];
    let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
    let touched: Vec<usize> =
        schedule.iter().map(|thread| touches(&hand, &thread.fingers, &Sensor::default(), 1000.0)).collect();
    assert_eq!(touched, [0, 1, 0]);
    assert_eq!((schedule[0].response, schedule[1].response), (Some((660.0, 680.0)), Some((860.0, 885.0))));
    assert!((schedule[1].line - 0.75).abs() < 1e-9);
    // At 1100 Hz no time is left, so the servo sends no requests, and touch delays no cycle.
    assert_eq!(touches(&hand, &[FingerNumber::TWO], &Sensor::default(), 1100.0), 0);
    assert_eq!(Fastest::of(&hand, &COSTS, &Sensor::default()).rate, Some(1454));
    // 16 more bytes take 160 us. They leave no time for a request at 1000 Hz. The exchange then takes 710 us, which is
    // 80 % of a period at 1126.8 Hz.
    let sensor = Sensor { bytes: 16, compute: 0.0 };
    assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &sensor)[1].violation, None);
    assert_eq!(Fastest::of(&hand, &COSTS, &sensor).rate, Some(1126));
}

/// Times that are too long for a 64-bit number of nanoseconds must not become short times.
#[test]
fn endless_costs_have_no_schedule() {
    let hand = Configuration::default();
    let endless = Costs::parse("wake_up = 1.0\nwrite = 1.0\nread = 1.0\ncompute = 1e300\n").expect("numbers");
    for (costs, sensor) in [
        (endless, Sensor::default()),
        (COSTS, Sensor { bytes: 0, compute: 1e300 }),
        (COSTS, Sensor { bytes: usize::MAX, compute: 0.0 }),
    ] {
        let schedule = off_line_schedule(&hand, 1000.0, &costs, &sensor);
        assert!(schedule.iter().all(|thread| thread.violation.is_some()), "{schedule:?}");
    }
}

/// A late wake-up is not the board's fault: the reply window begins at the wake-up.
#[test]
fn the_reply_window_begins_at_the_wake_up() {
    let hand = Configuration::default();
    let costs = Costs { wake_up: 300.0, write: 10.0, read: 1.0, compute: 1.0 };
    assert_eq!(off_line_schedule(&hand, 1000.0, &costs, &Sensor::default())[0].violation, None);
    // With each finger on its own core, 310 + 550 us exceed the reply window of 850 us.
    let mut apart = hand.clone();
    apart.fingers.iter_mut().enumerate().for_each(|(core, finger)| finger.core = Some(core));
    let costs = Costs { wake_up: 9.0, write: 310.0, ..costs };
    assert_eq!(off_line_schedule(&apart, 1000.0, &costs, &Sensor::default())[0].violation, Some(Violation::Replies));
}
