//! Measures one servo cycle, from counts to motor torques, with the complete controller of Figure 9, 10 or 11 of the
//! report, or with state feedback. The controller of the report needed 1430 us.

use divan::{Bencher, black_box};
use nalgebra::{Matrix3, Vector3};
use sun2xp::control::{Activity, Controller, Feedback, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::plant::{Plant, Sensors};

fn main() {
    divan::main();
}

#[divan::bench(args = [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11, Scheme::StateFeedback])]
fn follow(bencher: Bencher, scheme: Scheme) {
    cycle(bencher, scheme, 1.0);
}

/// The required joint torque needs tensions beyond their limits, so the controller must compute the fraction of the
/// torque that the limits permit.
#[divan::bench(args = [Scheme::Figure10, Scheme::StateFeedback])]
fn follow_over_limit(bencher: Bencher, scheme: Scheme) {
    cycle(bencher, scheme, 40.0);
}

/// `factor` multiplies the stiffness of the set point.
fn cycle(bencher: Bencher, scheme: Scheme, factor: f64) {
    let mut finger = ConfiguredFinger::default();
    finger.controller.scheme = Some(scheme);
    let controller = Controller::new(&finger, 1000.0).expect("the default finger");
    let mut plant = Plant::new(&finger, Vector3::zeros()).expect("the default finger");
    let mut sensors = Sensors::new(&finger);
    // The finger moves, so that the measured cycles take different branches of the controller.
    plant.release_brake();
    let feedback: [Feedback; 64] = std::array::from_fn(|_| {
        for _ in 0..10 {
            plant.step([0.003; 4]);
        }
        let (motor_counts, gauge_counts) = sensors.read(&plant);
        Feedback { motor_counts, gauge_counts }
    });
    let mut state = controller.start(&feedback[0]);
    let stiffness = Matrix3::new(3.0, 0.2, 0.1, 0.2, 4.0, 0.3, 0.1, 0.3, 2.0) * factor;
    let activity = Activity::Follow(SetPoint::hard_finger(Vector3::new(0.3, 0.6, 1.2), stiffness));
    let mut turn = 0;
    bencher.bench_local(|| {
        turn = (turn + 1) % feedback.len();
        controller.cycle(black_box(&mut state), black_box(Some(&feedback[turn])), black_box(&activity))
    });
}
