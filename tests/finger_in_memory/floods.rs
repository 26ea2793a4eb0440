//! A board that sends valid frames without end: its finger faults in time, is stopped, and recovers after the flood.

use crate::rig::{Bench, MILLISECOND, TARGET};
use sun2xp::board::protocol::{Configured, Frame, Reply, Status, Stopped};
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::{FaultKind, Stage};

fn ended(bench: &Bench) -> bool {
    bench.with_finger(|finger| finger.status().has(Status::ENDED))
}

#[test]
fn a_flood_stops_its_finger_in_the_watchdogs_time() {
    for frame in [Frame::Reply(Reply::default()), Frame::Stopped(Stopped::default())] {
        let mut bench = Bench::new();
        bench.goes(TARGET);
        bench.flood_with(frame);
        let begun = bench.world.now();
        bench.faults(FaultKind::LostReplies);
        bench.cycles(1);
        // The flood may have begun just after a good reply. The finger then faults within the 18 ms of the watchdog.
        // One more cycle of 1 ms has run since the fault.
        let milliseconds = (bench.world.now() - begun) as f64 / MILLISECOND as f64;
        assert!(milliseconds <= 19.0, "{frame:?}: {milliseconds} ms");
        assert!(ended(&bench), "{frame:?}: the board was not stopped");
        bench.end_flood();
        bench.repair();
        bench.opens();
        bench.goes(TARGET);
    }
}

#[test]
fn a_flood_does_not_keep_a_finger_from_being_closed() {
    for frame in [Frame::Reply(Reply::default()), Frame::Configured(Configured::default())] {
        let mut bench = Bench::new();
        bench.mailbox.close();
        bench.flood_with(frame);
        let begun = bench.world.now();
        bench.servo.run();
        assert!(matches!(bench.stage(), Stage::Closed | Stage::Faulted(_)), "{:?}", bench.stage());
        assert!(ended(&bench), "{frame:?}: the board was not stopped");
        // The time of the watchdog, two periods as a margin, and the time that a board may take to confirm that it has
        // stopped.
        let milliseconds = (bench.world.now() - begun) / MILLISECOND;
        assert!(milliseconds <= 18 + 2 + 100, "{frame:?}: {milliseconds} ms");
    }
}

#[test]
fn frames_that_only_a_repair_receives_are_not_counted() {
    let mut bench = Bench::new();
    bench.opens();
    for _ in 0..2 {
        bench.fail_port(PortError::Vanished);
        bench.faults(FaultKind::PortVanished);
        bench.until("at rest", |bench| !bench.repair_end.released.is_empty());
        let before = bench.report().losses;
        bench.answer_with(Frame::Stopped(Stopped::default()));
        bench.repair();
        bench.opens();
        let after = bench.report().losses;
        assert_eq!(after.foreign_frames, before.foreign_frames);
        assert_eq!(after.damaged_frames, before.damaged_frames);
    }
}
