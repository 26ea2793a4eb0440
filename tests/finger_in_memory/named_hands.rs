//! The named hands of `simulation.hand`: each opens with the default configuration.

use crate::rig::Bench;
use nalgebra::Vector3;
use sun2xp::finger::Stage;
use sun2xp::model::configuration::NamedHand;

/// Largest motion of a joint while its tendons are tightened, rad.
const OPENING: f64 = 0.03;

#[test]
fn every_named_hand_opens_where_it_is() {
    for hand in NamedHand::ALL {
        let mut bench = Bench::believing(|is| is.fingers[0].simulation = hand.simulation(), |_| {});
        let start = Vector3::from(hand.simulation().start_degrees.map(f64::to_radians));
        bench.until("a spring", |bench| {
            let moved = (bench.with_finger(|finger| finger.plant().joints()) - start).amax();
            assert!(moved < OPENING, "{}: {moved} rad", hand.name());
            bench.stage() != Stage::Opening
        });
        assert_eq!(bench.stage(), Stage::Running, "{}", hand.name());
    }
}
