//! Adjusts parameters while the finger runs. Section 5 of the report calls these parameters adjustable.

use crate::rig::{Loop, SCHEMES, quiet, spring};
use nalgebra::Vector3;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// A change, and whether the commands would jump if the controller were simply replaced.
type Change = (&'static str, fn(&mut ConfiguredFinger), bool);

const CHANGES: &[Change] = &[
    ("t_min", |finger| finger.tendon.minimum = 12.0, true),
    ("t_max", |finger| finger.tendon.maximum = 30.0, false),
    (
        "gains",
        |finger| match finger.controller.scheme {
            Some(Scheme::Figure11) => finger.controller.adaptation_gain = Some(5.0),
            _ => finger.controller.tension_integral = Some(100.0),
        },
        false,
    ),
    ("damper", |finger| finger.controller.motor_damping = Some(300.0), false),
    ("to figure 9", |finger| finger.controller.scheme = Some(Scheme::Figure9), false),
    ("to figure 10", |finger| finger.controller.scheme = Some(Scheme::Figure10), false),
    ("to figure 11", |finger| finger.controller.scheme = Some(Scheme::Figure11), false),
    ("to state feedback", |finger| finger.controller.scheme = Some(Scheme::StateFeedback), false),
    ("links", |finger| finger.geometry.links = [3.556, 5.080, 4.200], false),
    ("tendon stiffness", |finger| finger.tendon.stiffness = [280.0; 4], false),
    ("motor radius", |finger| finger.geometry.motor_radius = [0.0480; 4], true),
    ("much larger motor radius", |finger| finger.geometry.motor_radius = [0.0600; 4], true),
];

/// Returns the largest change of a motor's command in one cycle, N at the tendon, for a finger on which a force acts.
/// The three values are for a cycle at rest, for the first cycle of the adjustment, and for the first cycle after the
/// controller is simply replaced.
fn jumps(scheme: Scheme, change: fn(&mut ConfiguredFinger)) -> [f64; 3] {
    let mut finger = quiet(scheme);
    let activity = spring(Vector3::new(0.2, 0.7, 1.2), 3.0);
    let rested = || {
        let mut servo = Loop::new(&quiet(scheme), 1000.0);
        servo.plant.set_external_force(Vector3::new(0.8, -0.6, 0.5));
        servo.run(2.5, &activity);
        servo.forget();
        servo
    };
    change(&mut finger);
    let (mut at_rest, mut adjusted, mut replaced) = (rested(), rested(), rested());
    adjusted.adjust(&finger);
    replaced.replace(&finger);
    [&mut at_rest, &mut adjusted, &mut replaced].map(|servo| {
        servo.cycle(&activity);
        servo.largest_jump
    })
}

#[test]
fn an_adjustment_does_not_jump() {
    for (scheme, (name, change, would_jump)) in
        SCHEMES.into_iter().flat_map(|scheme| CHANGES.iter().map(move |it| (scheme, it)))
    {
        let [at_rest, adjusted, replaced] = jumps(scheme, *change);
        println!("{scheme:?}, {name}: {adjusted:.3} N, {at_rest:.3} N at rest, {replaced:.2} N without a transition");
        assert!(adjusted < at_rest + 0.5, "{scheme:?}, {name}: {adjusted} N, {at_rest} N at rest");
        if *would_jump {
            assert!(
                replaced > adjusted + 1.0,
                "{scheme:?}, {name}: the jump must be visible: {replaced} N without a transition, {adjusted} N with it"
            );
        }
    }
}

/// The adjustment is complete within 1 s, and the change is smooth.
#[test]
fn an_adjustment_takes_effect() {
    let activity = spring(Vector3::new(0.2, 0.7, 1.2), 3.0);
    let mut servo = Loop::new(&quiet(Scheme::Figure10), 1000.0);
    servo.run(1.5, &activity);
    servo.forget();
    servo.run(0.5, &activity);
    let at_rest = servo.largest_jump;
    let joints = servo.plant.joints();
    let mut finger = quiet(Scheme::Figure10);
    finger.tendon.minimum = 12.0;
    servo.forget();
    servo.adjust(&finger);
    servo.run(1.0, &activity);
    assert!(servo.largest_jump < at_rest + 6.0, "{} N, {at_rest} N at rest", servo.largest_jump);
    servo.forget();
    servo.run(0.2, &activity);
    assert!(servo.least_commanded > 12.0 - 1e-9 && servo.least_true > 11.0, "{}", servo.least_true);
    assert!((servo.plant.joints() - joints).amax() < 0.02);
}

/// A planner that adjusts in every cycle must neither freeze nor delay the torque.
#[test]
fn a_finger_that_is_adjusted_in_every_cycle_moves_and_settles() {
    let target = Vector3::new(0.2, 0.7, 1.2);
    let mut servo = Loop::new(&quiet(Scheme::Figure10), 1000.0);
    let mut finger = quiet(Scheme::Figure10);
    for cycle in 0..2000 {
        finger.tendon.minimum = 5.0 + f64::from(cycle % 5);
        servo.adjust(&finger);
        servo.cycle(&spring(target, 3.0));
    }
    assert!((servo.plant.joints() - target).amax() < 0.03, "{}", servo.plant.joints());
    assert!(servo.report.joint_rates.amax() < 0.3, "{}", servo.report.joint_rates);
}
