//! Tests the physics of the object that all simulated fingers touch, against results that do not depend on its code.

#[path = "common/energy.rs"]
mod energy;

use energy::{assert_gains_no_energy, steps};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredObject, FINGERS, ObjectShape};
use sun2xp::plant::{FreeObject, PLANT_STEP_SECONDS, TipMotion};
use sun2xp::simulated::SimulatedBoard;

const NOBODY: [Option<TipMotion>; FINGERS] = [None; FINGERS];

const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, 9.81);

/// Time by which a step advances the board, ns.
const STEP: u64 = 100_000;

fn brick() -> ConfiguredObject {
    ConfiguredObject { shape: ObjectShape::Box { size: [2.0, 4.0, 6.0] }, ..Default::default() }
}

fn still(position: Vector3<f64>) -> Option<TipMotion> {
    Some(TipMotion { position, velocity: Vector3::zeros() })
}

#[test]
fn an_untouched_object_falls() {
    let mut object = FreeObject::new(&ConfiguredObject::default(), GRAVITY);
    let start = object.position();
    for _ in 0..5000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
    }
    let fallen = object.position() - start;
    assert!((fallen - GRAVITY * 0.125).amax() < 1e-3, "{fallen}");
    assert!((object.velocity() - GRAVITY * 0.5).amax() < 1e-9);
}

#[test]
fn a_tumbling_box_keeps_its_energy() {
    let mut object = FreeObject::new(&brick(), Vector3::zeros());
    // A rotation about an axis close to that of the middle moment of inertia is unstable, so the box tumbles.
    object.put(Vector3::zeros(), Vector3::zeros(), Vector3::new(0.1, 8.0, 0.1));
    let energy = object.kinetic_energy();
    let mut slowest: f64 = 8.0;
    for _ in 0..50_000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
        slowest = slowest.min((object.rotation().inverse() * object.angular_velocity()).y);
        assert!((object.kinetic_energy() / energy - 1.0).abs() < 0.01);
    }
    assert!(slowest < -7.0, "the box does not tumble: {slowest} rad/s");
}

/// Gravity in the frame of a table that leans by this angle. The normal of the table is -z.
fn on_a_slope(degrees: f64) -> Vector3<f64> {
    let (sine, cosine) = f64::to_radians(degrees).sin_cos();
    Vector3::new(sine, 0.0, cosine) * 9.81
}

#[test]
fn a_box_on_a_table_rests_where_its_corners_carry_its_weight() {
    let configured = ConfiguredObject { table: Some(13.0), position: [0.0, 0.0, 9.9], ..brick() };
    let mut object = FreeObject::new(&configured, GRAVITY);
    for _ in 0..20_000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
    }
    // Four corners of 5000 N/m carry 0.981 N.
    let expected = 0.10 + 0.981 / 20_000.0;
    assert!((object.position().z - expected).abs() < 1e-6, "{} m", object.position().z);
    let before = object.position();
    for _ in 0..600_000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
    }
    assert!(
        (object.position() - before).norm() < 1e-9,
        "creeps by {} m in a minute",
        (object.position() - before).norm()
    );
}

/// Returns the displacement of a flat box between 0.1 and 0.2 s, m. The box lies on three fingertips as on a table.
/// Gravity leans by this angle against the normal of the plane of the tips.
fn displacement_on_three_tips(degrees: f64) -> Vector3<f64> {
    let plate = ObjectShape::Box { size: [8.0, 8.0, 1.0] };
    let configured = ConfiguredObject { shape: plate, position: [0.0; 3], ..Default::default() };
    let mut object = FreeObject::new(&configured, on_a_slope(degrees));
    let tips = [[2.0, 2.0], [2.0, -2.0], [-3.0, 0.0]];
    let tips = tips.map(|[x, y]| still(Vector3::new(x, y, 0.5) * 0.01));
    for _ in 0..1000 {
        object.step(&tips, PLANT_STEP_SECONDS);
    }
    let before = object.position();
    for _ in 0..1000 {
        object.step(&tips, PLANT_STEP_SECONDS);
    }
    object.position() - before
}

#[test]
fn friction_holds_below_its_angle_and_yields_above() {
    // The friction of 0.6 holds up to 31 degrees.
    let held = displacement_on_three_tips(29.0);
    assert!(held.norm() < 1e-7, "{held}");
    // Above this angle, the box slides with the acceleration g (sin - 0.6 cos), here 0.6 m/s^2. Between 0.1 and 0.2 s
    // it slides by 9.1 mm.
    let slid = displacement_on_three_tips(34.0);
    let acceleration = 9.81 * (34f64.to_radians().sin() - 0.6 * 34f64.to_radians().cos());
    let expected = acceleration * 0.015;
    assert!((slid.x / expected - 1.0).abs() < 0.05, "{slid} instead of {expected}");
}

#[test]
fn a_pushed_ball_rolls_and_comes_to_rest() {
    let configured = ConfiguredObject { table: Some(12.0), ..Default::default() };
    let mut object = FreeObject::new(&configured, GRAVITY);
    object.put(object.position(), Vector3::new(0.1, 0.0, 0.0), Vector3::zeros());
    for _ in 0..3000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
    }
    // The table is at +z. Rolling begins after 5 ms, at 5/7 of the sliding speed. The resistance then slows the ball by
    // 0.07 m/s^2: 0.2 mm times 0.981 N, divided by 7/5 of 0.1 kg times 2 cm.
    let (speed, spin) = (object.velocity().x, object.angular_velocity().y);
    assert!((speed - (0.0714 - 0.07 * 0.295)).abs() < 0.001, "{speed} m/s");
    assert!((spin + speed / 0.02).abs() < 0.02, "{spin} rad/s at {speed} m/s");
    for _ in 0..30_000 {
        object.step(&NOBODY, PLANT_STEP_SECONDS);
    }
    assert!(object.velocity().norm() < 1e-9 && object.angular_velocity().norm() < 1e-9, "{}", object.velocity());
}

/// The total energy and the kinetic energy of a board's fingers and object, J.
fn energies(board: &mut SimulatedBoard, hand: &Configuration) -> (f64, f64) {
    let (mut whole, mut kinetic) = (0.0, 0.0);
    let mut tips = NOBODY;
    for (number, finger) in FingerNumber::ALL.into_iter().zip(board.fingers()) {
        whole += finger.plant().energy();
        kinetic += finger.plant().kinetic_energy();
        let tip = hand.finger_to_palm(number).transform_point(&Point3::from(finger.plant().tip()));
        tips[number.index()] = still(tip.coords * 0.01);
    }
    let object = board.scene().expect("an object").object();
    (whole + object.energy(&tips), kinetic + object.kinetic_energy())
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        ..Default::default()
    })]

    /// An object is thrown between braked fingers that get no commands, and in some cases onto a table.
    #[test]
    fn fingers_and_object_never_create_energy(
        joints in prop::array::uniform3((-15.0..15.0f64, -28.0..10.0f64, 60.0..100.0f64)),
        place in prop::array::uniform3(-1.5..1.5f64),
        velocity in prop::array::uniform3(-0.5..0.5f64),
        spin in prop::array::uniform3(-10.0..10.0f64),
        mass in 0.01..1.0f64, friction in 0.0..1.5f64, boxed: bool, table: bool, steps in steps(),
    ) {
        let mut hand = Configuration::default();
        hand.hand.gravity = GRAVITY.into();
        let shape = match boxed {
            true => ObjectShape::Box { size: [3.0, 3.5, 4.0] },
            false => ObjectShape::Ball { radius: 2.0 },
        };
        let table = table.then_some(12.5);
        hand.hand.simulated_object = Some(ConfiguredObject { shape, mass, friction, table, ..Default::default() });
        for (finger, start) in hand.fingers.iter_mut().zip(joints) {
            finger.simulation.start_degrees = [start.0, start.1, start.2];
        }
        let mut board = SimulatedBoard::new(&hand, &FingerNumber::ALL).expect("a board");
        let middle = Vector3::new(0.0, 0.0, 0.10) + Vector3::from(place) * 0.01;
        board.scene().expect("an object").object().put(middle, velocity.into(), spin.into());
        board.advance(0);
        let start = energies(&mut board, &hand);
        let mut time = 0;
        let step = || {
            time += STEP;
            board.advance(time);
            energies(&mut board, &hand)
        };
        // The fastest contact oscillates at 2000 rad/s. With steps of 0.1 ms, its energy error is at most 0.1 of the
        // swinging energy (see `assert_gains_no_energy`).
        assert_gains_no_energy(start, step, 0.1, steps);
    }

    /// Without gravity and without a table, the object loses exactly the momentum that it gives to the fingers.
    #[test]
    fn action_equals_reaction(
        place in prop::array::uniform3(-0.015..0.015f64), velocity in prop::array::uniform3(-0.3..0.3f64),
        spin in prop::array::uniform3(-10.0..10.0f64), boxed: bool,
    ) {
        let shape = if boxed { brick().shape } else { ObjectShape::Ball { radius: 2.0 } };
        let configured = ConfiguredObject { shape, mass: 0.2, position: [0.0; 3], ..Default::default() };
        let mut object = FreeObject::new(&configured, Vector3::zeros());
        object.put(Vector3::zeros(), velocity.into(), spin.into());
        let tips = [still(place.into()), still(Vector3::new(0.0, 0.019, 0.0)), None];
        let mut given = Vector3::zeros();
        for _ in 0..500 {
            let on_tips = object.step(&tips, PLANT_STEP_SECONDS);
            given += on_tips.iter().sum::<Vector3<f64>>() * PLANT_STEP_SECONDS;
            prop_assert_eq!(object.forces().map(|force| -force), on_tips);
        }
        let kept = object.velocity() * 0.2;
        prop_assert!((Vector3::from(velocity) * 0.2 - kept - given).amax() < 1e-9);
    }
}
