//! The stiffness with which a path begins.

use crate::motion::{joints, send};
use crate::rig::{Bench, TARGET};
use nalgebra::Matrix3;
use sun2xp::control::{SetPoint, spatial};
use sun2xp::finger::{Replaced, Validity};
use sun2xp::hand::PathPose;

/// Sends Kx with three equal eigenvalues, N/cm, as the hand does.
fn stiffen(bench: &Bench, kx: f64) {
    let change = |set_point: &mut SetPoint| {
        set_point.stiffen_tip(spatial(&(Matrix3::identity() * kx)));
        Ok::<(), ()>(())
    };
    bench.mailbox.try_send((Replaced::Stiffness, Validity::default()), change).expect("not faulted").expect("admitted");
}

/// Sends a path that reaches this Kx, N/cm, after one second.
fn send_path(bench: &Bench, kx: f64) {
    let end = TARGET.add_scalar(0.1).into();
    send(bench, &[PathPose { stiffness: Some((Matrix3::identity() * kx).into()), ..joints(1.0, end) }]);
}

/// Returns the stiffness along x that is in force, N/cm.
fn in_force(bench: &Bench) -> f64 {
    bench.report().set_point.stiffness[(0, 0)]
}

/// Of the set points that are sent in one period, the servo takes only the newest one. Here this is the set point of
/// the path, so the servo never takes the set point with the softer Kx that was sent before. Nevertheless the path must
/// begin with the softer Kx and not with the old one, because the planner may have sent a damping that suits only the
/// softer Kx.
#[test]
fn a_path_begins_with_the_stiffness_that_was_sent_in_the_same_period() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    // The second of two paths begins with the softer Kx too, because it replaces a path that has not begun.
    for paths in [1, 2] {
        stiffen(&bench, 4.0);
        bench.cycles(10);
        assert!((in_force(&bench) - 4.0).abs() < 1e-9);
        stiffen(&bench, 1.0);
        (0..paths).for_each(|_| send_path(&bench, 1.0));
        for cycle in 0..100 {
            bench.cycles(1);
            assert!((in_force(&bench) - 1.0).abs() < 1e-9, "{paths} {cycle}: {}", in_force(&bench));
        }
    }
}

/// The servo never takes the set point with the Kx, because the set point of the path replaces it in the same period.
#[test]
fn a_path_after_a_joint_stiffness_begins_with_the_kx_that_was_sent_just_before() {
    let mut bench = Bench::new();
    let springs = |set_point: &mut SetPoint| {
        set_point.stiffen_joints(Matrix3::identity() * 20.0);
        Ok::<(), ()>(())
    };
    bench
        .mailbox
        .try_send((Replaced::Stiffness, Validity::default()), springs)
        .expect("not faulted")
        .expect("admitted");
    bench.cycles(100);
    assert_eq!(in_force(&bench), 0.0);
    stiffen(&bench, 5.0);
    send_path(&bench, 5.0);
    for cycle in 0..1100 {
        bench.cycles(1);
        let joint_spring = bench.report().set_point.joint_spring;
        assert!((in_force(&bench) - 5.0).abs() < 1e-9 && joint_spring.is_none(), "{cycle}: {}", in_force(&bench));
    }
}

#[test]
fn a_path_that_replaces_another_one_begins_with_the_stiffness_in_force() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    stiffen(&bench, 1.0);
    send_path(&bench, 5.0);
    bench.cycles(500);
    let before = in_force(&bench);
    assert!((before - 3.0).abs() < 0.05, "{before}");
    send_path(&bench, 5.0);
    bench.cycles(1);
    assert!((in_force(&bench) - before).abs() < 0.01, "{before} {}", in_force(&bench));
    bench.cycles(500);
    assert!((in_force(&bench) - 4.0).abs() < 0.05, "{}", in_force(&bench));
}
