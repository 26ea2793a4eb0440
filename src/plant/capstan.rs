//! A tendon that rubs in its conduit and on its pulleys.
//!
//! The tendon has three sections without mass: from the motor to the conduit, from the conduit past the gauge to the
//! pulleys, and from there to the joint. The friction of the conduit acts between the first two sections. The friction
//! of the pulleys acts between the last two. Neighbouring sections meet at a point of contact. Both points obey the
//! capstan equation: a point sticks while the tensions on its two sides have a ratio of at most 1 + mu, and otherwise
//! slides until they have this ratio.
//!
//! The tendon has no mass, so the points slide without delay. The friction therefore has no chatter at rest, and its
//! computation is stable for any step. With a regularised friction force (a steep function of the speed), the points
//! would creep at rest.

use super::elasticity::Elasticity;

/// Shares of the compliance of a tendon in its three sections. Most of a tendon lies in its conduit, so half of the
/// compliance is on the motor's side of the conduit friction. The sections in the finger are short.
const SHARES: [f64; 3] = [0.5, 0.3, 0.2];

/// Largest number of sweeps over the two points. With usual friction, each sweep reduces the error to a third
/// or less.
const SWEEPS: usize = 40;
/// Sum of the motions of both points in one sweep, m, below which the sweeps end.
const NEGLIGIBLE: f64 = 1e-13;

/// The friction of one tendon: for each point of contact, the largest ratio of the tensions on its two sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Capstans {
    /// 1 + mu of the conduit, between motor and gauge.
    conduit: f64,
    /// 1 + mu of the pulleys, between gauge and joint.
    pulleys: f64,
}

/// The positions of the two points of contact, m, positive toward the motor. The origin is the position of the joint's
/// end of the tendon at theta = 0.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Contacts {
    conduit: f64,
    pulleys: f64,
}

/// The tensions of a tendon, N.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionTensions {
    pub motor: f64,
    pub gauge: f64,
    pub joint: f64,
}

impl Capstans {
    /// Returns None for a tendon without friction, which needs no state.
    pub fn new(conduit: f64, pulleys: f64) -> Option<Self> {
        (conduit > 0.0 || pulleys > 0.0).then_some(Self { conduit: 1.0 + conduit, pulleys: 1.0 + pulleys })
    }

    /// Returns the contacts of a tendon whose three sections have the same tension. `motor` and `joint` are the
    /// positions of its ends, m.
    pub fn relaxed(motor: f64, joint: f64) -> Contacts {
        let stretch = motor - joint;
        Contacts { conduit: motor - SHARES[0] * stretch, pulleys: joint + SHARES[2] * stretch }
    }

    /// Lets the contacts slide as far as the ends of the tendon force them. `motor` and `joint` are the positions of
    /// the ends, m.
    pub fn slide(&self, contacts: &mut Contacts, elasticity: &Elasticity, motor: f64, joint: f64) {
        for _ in 0..SWEEPS {
            let before = *contacts;
            contacts.conduit =
                slid(before.conduit, [(motor, SHARES[0]), (before.pulleys, SHARES[1])], self.conduit, elasticity);
            contacts.pulleys =
                slid(before.pulleys, [(contacts.conduit, SHARES[1]), (joint, SHARES[2])], self.pulleys, elasticity);
            let moved = (contacts.conduit - before.conduit).abs() + (contacts.pulleys - before.pulleys).abs();
            if moved < NEGLIGIBLE {
                break;
            }
        }
    }
}

impl Contacts {
    /// Returns the tensions, N, for the positions of the tendon's ends, m.
    pub fn tensions(&self, elasticity: &Elasticity, motor: f64, joint: f64) -> SectionTensions {
        let [motor, gauge, joint] = self.stretches(motor, joint).map(|stretch| elasticity.tension(stretch));
        SectionTensions { motor, gauge, joint }
    }

    /// Returns the elastic energy, J.
    pub fn energy(&self, elasticity: &Elasticity, motor: f64, joint: f64) -> f64 {
        let stretches = self.stretches(motor, joint);
        stretches.iter().zip(SHARES).map(|(&stretch, share)| share * elasticity.energy(stretch)).sum()
    }

    /// Returns the stretches of the sections, each divided by the section's share of the compliance, m.
    fn stretches(&self, motor: f64, joint: f64) -> [f64; 3] {
        [
            (motor - self.conduit) / SHARES[0],
            (self.conduit - self.pulleys) / SHARES[1],
            (self.pulleys - joint) / SHARES[2],
        ]
    }
}

/// Returns the position of a contact between two sections after it has slid. Each section is given by the position of
/// its far end, m, and its share of the compliance. The section toward the motor comes first. `ratio` is 1 + mu.
fn slid(contact: f64, [upper, lower]: [(f64, f64); 2], ratio: f64, elasticity: &Elasticity) -> f64 {
    let above = elasticity.signed_tension((upper.0 - contact) / upper.1);
    let below = elasticity.signed_tension((contact - lower.0) / lower.1);
    // A slack tendon has no friction. The slack is then divided between the two sections in proportion to their shares
    // of the compliance.
    let ratio = if above <= 0.0 && below <= 0.0 { 1.0 } else { ratio };
    let (gain_above, gain_below) = if above > ratio * below {
        (1.0, ratio)
    } else if below > ratio * above {
        (ratio, 1.0)
    } else {
        return contact;
    };
    // One Newton step for gain_above t_above = gain_below t_below. It is exact for a linear spring.
    let excess = gain_above * above - gain_below * below;
    let slope = gain_above * elasticity.local_stiffness(above) / upper.1
        + gain_below * elasticity.local_stiffness(below) / lower.1;
    contact + excess / slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LINEAR: f64 = 0.0;

    fn spring(hardening: f64) -> Elasticity {
        Elasticity::new(3e4, hardening, 60.0)
    }

    /// Moves the ends along `path` (motor, joint) in small steps. Returns the tensions, the work that the ends did, J,
    /// and the increase of the elastic energy, J.
    fn moved(capstans: &Capstans, hardening: f64, path: &[(f64, f64)]) -> (SectionTensions, f64, f64) {
        let elasticity = spring(hardening);
        let (mut motor, mut joint) = path[0];
        let mut contacts = Capstans::relaxed(motor, joint);
        let begun = contacts.energy(&elasticity, motor, joint);
        let mut work = 0.0;
        for &(to_motor, to_joint) in &path[1..] {
            let steps = 400;
            let by = ((to_motor - motor) / f64::from(steps), (to_joint - joint) / f64::from(steps));
            for _ in 0..steps {
                let before = contacts.tensions(&elasticity, motor, joint);
                (motor, joint) = (motor + by.0, joint + by.1);
                capstans.slide(&mut contacts, &elasticity, motor, joint);
                let after = contacts.tensions(&elasticity, motor, joint);
                work += 0.5 * ((before.motor + after.motor) * by.0 - (before.joint + after.joint) * by.1);
            }
        }
        let stored = contacts.energy(&elasticity, motor, joint) - begun;
        (contacts.tensions(&elasticity, motor, joint), work, stored)
    }

    #[test]
    fn pulling_in_and_letting_out_give_the_ratios_of_the_capstan_equation() {
        let capstans = Capstans::new(0.2, 0.05).expect("there is friction");
        for hardening in [0.0, 0.5] {
            let (pulled, ..) = moved(&capstans, hardening, &[(2e-4, 0.0), (1e-3, 0.0)]);
            assert!((pulled.motor / pulled.gauge - 1.2).abs() < 1e-6, "{pulled:?}");
            assert!((pulled.gauge / pulled.joint - 1.05).abs() < 1e-6, "{pulled:?}");
            let (let_out, ..) = moved(&capstans, hardening, &[(2e-4, 0.0), (1.2e-3, 0.0), (3e-4, 0.0)]);
            assert!((let_out.gauge / let_out.motor - 1.2).abs() < 1e-6, "{let_out:?}");
            assert!((let_out.joint / let_out.gauge - 1.05).abs() < 1e-6, "{let_out:?}");
        }
    }

    #[test]
    fn a_tendon_without_friction_is_one_spring() {
        assert!(Capstans::new(0.0, 0.0).is_none());
        let nearly = Capstans::new(1e-12, 1e-12).expect("there is friction");
        let (tensions, ..) = moved(&nearly, LINEAR, &[(2e-4, 0.0), (9e-4, 1e-4), (5e-4, -1e-4)]);
        for tension in [tensions.motor, tensions.gauge, tensions.joint] {
            assert!((tension - 18.0).abs() < 1e-4, "{tensions:?}");
        }
    }

    #[test]
    fn the_contacts_stick_within_the_friction() {
        let capstans = Capstans::new(0.2, 0.05).expect("there is friction");
        let elasticity = spring(LINEAR);
        let mut contacts = Capstans::relaxed(6e-4, 0.0);
        let before = contacts;
        // All sections have a tension of 18 N. The motor moves its end by 0.3e-4 m. The motor's section has a stiffness
        // of 6e4 N/m, so its tension changes by 1.8 N, which is less than the friction.
        capstans.slide(&mut contacts, &elasticity, 6.3e-4, 0.0);
        assert_eq!((contacts.conduit, contacts.pulleys), (before.conduit, before.pulleys));
        assert_eq!(contacts.tensions(&elasticity, 6.3e-4, 0.0).gauge, contacts.tensions(&elasticity, 6e-4, 0.0).gauge);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        /// No path of the ends stores more energy than the ends put in, and the ratios stay within the friction.
        #[test]
        fn friction_only_takes_energy(
            conduit in 0.0..0.4f64,
            pulleys in 0.001..0.2f64,
            hardening in 0.0..0.8f64,
            corners in prop::collection::vec((-2e-4..2e-3f64, -3e-4..3e-4f64), 2..6),
        ) {
            let capstans = Capstans::new(conduit, pulleys).expect("there is friction");
            let (tensions, work, stored) = moved(&capstans, hardening, &corners);
            // The error of the trapezoidal rule is proportional to the square of the motion in one step. In one step,
            // the motor's end moves by at most 5.5e-6 m, and the joint's end by at most 1.5e-6 m. The bound below uses
            // 6e-6 m and the stiffness of the stiffest section.
            let rounding = 400.0 * 5.0 * 1.5e5 * 2.0 * (6e-6f64).powi(2);
            prop_assert!(stored <= work + rounding, "{stored} {work}");
            prop_assert!(tensions.motor <= (1.0 + conduit) * tensions.gauge + 1e-6);
            prop_assert!(tensions.gauge <= (1.0 + conduit) * tensions.motor + 1e-6);
            prop_assert!(tensions.gauge <= (1.0 + pulleys) * tensions.joint + 1e-6);
            prop_assert!(tensions.joint <= (1.0 + pulleys) * tensions.gauge + 1e-6);
        }
    }
}
