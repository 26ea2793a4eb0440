//! The named hands of `simulation.hand`: each opens and moves with the default configuration.

use crate::rig::Bench;
use nalgebra::Vector3;
use sun2xp::finger::Stage;
use sun2xp::model::configuration::NamedHand;

/// Largest motion of a joint while its tendons are tightened, rad.
const OPENING: f64 = 0.03;

/// Largest error of a joint at rest, rad. Errors of the gauges displace the joints of an uncalibrated finger.
const DISPLACED: f64 = 0.06;

fn open(hand: NamedHand) -> Bench {
    let mut bench = Bench::believing(|is| is.fingers[0].simulation = hand.simulation(), |_| {});
    let start = Vector3::from(hand.simulation().start_degrees.map(f64::to_radians));
    bench.until("a spring", |bench| {
        let moved = (bench.with_finger(|finger| finger.plant().joints()) - start).amax();
        assert!(moved < OPENING, "{}: {moved} rad", hand.name());
        bench.stage() != Stage::Opening
    });
    assert_eq!(bench.stage(), Stage::Running, "{}", hand.name());
    bench
}

#[test]
fn every_named_hand_opens_where_it_is_and_moves_without_a_fault() {
    for hand in NamedHand::ALL {
        let mut bench = open(hand);
        for target in [[0.2, 0.6, 1.1], [-0.3, 1.0, 1.5], [0.5, 0.2, 0.9], [0.2, 0.5, 1.0]].map(Vector3::from) {
            bench.mailbox.send(|set_point| set_point.joints = target).expect("not faulted");
            bench.cycles(2000);
            assert_eq!(bench.stage(), Stage::Running, "{} at {target}", hand.name());
            let off = (bench.with_finger(|finger| finger.plant().joints()) - target).amax();
            assert!(off < DISPLACED, "{}: {off} rad at {target}", hand.name());
        }
    }
}
