//! Random commands, paths, reflexes and pushes never lead beyond a configured limit.
//!
//! SUN2XP_CYCLES sets the number of cycles.

use crate::motion::{configuration, joints, plan, send_if_possible};
use crate::rig::Bench;
use nalgebra::{Matrix3, Matrix6, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::motion::PathExtent;
use sun2xp::control::{AdmissibleDamping, spatial};
use sun2xp::finger::events::EventKind;
use sun2xp::finger::{Adjustable, Condition, FaultKind, Reaction, Reflex, Replaced, Stage, Validity};
use sun2xp::hand::PathPose;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{Contact, FingerNumber};

/// Number of cycles of an ordinary run.
const CYCLES: usize = 200_000;

struct Random(Pcg64);

impl Random {
    /// A number from 0 to 1.
    fn part(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4_294_967_296.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.part() * count as f64) as usize
    }

    fn pose(&mut self) -> Vector3<f64> {
        Vector3::new(self.between(-0.8, 0.8), self.between(-0.3, 1.4), self.between(0.3, 1.8))
    }

    fn condition(&mut self) -> Condition {
        let kinds = EventKind::ALL;
        match self.below(7) {
            0 | 1 => Condition::Event(kinds[self.below(kinds.len())]),
            2 => Condition::ForceAbove(self.between(0.0, 2.0)),
            3 => Condition::TensionAbove(self.between(2.0, 30.0)),
            4 => Condition::JointAbove { joint: self.below(3), angle: self.between(-0.5, 1.5) },
            5 => Condition::JointBelow { joint: self.below(3), angle: self.between(-0.5, 1.5) },
            _ => Condition::PlannerSilent(self.between(0.0, 0.3)),
        }
    }

    fn reflex(&mut self) -> Reflex {
        let reaction = match self.below(5) {
            0 => Reaction::Hold,
            1 => Reaction::Soften(Matrix3::identity() * self.between(0.0, 5.0)),
            2 => Reaction::Retract(self.pose()),
            3 => Reaction::Grip { direction: self.pose(), by: self.between(0.0, 3.0), most: self.between(0.0, 6.0) },
            _ => Reaction::Damp(self.between(0.0, 3.0)),
        };
        Reflex {
            condition: self.condition(),
            reaction,
            priority: self.below(256) as u8,
            refractory: self.between(0.0, 0.2),
            inhibition: if self.below(3) == 0 { self.between(0.0, 0.1) } else { 0.0 },
        }
    }
}

/// Sends a set point or a path, installs or removes a reflex, pushes the finger, or does nothing. Returns whether it
/// has sent a path.
fn disturb(bench: &mut Bench, random: &mut Random, rules: &mut Vec<u32>) -> bool {
    match random.below(8) {
        0 => {
            let joints = random.pose();
            let _ = bench.mailbox.send(|set_point| set_point.joints = joints);
        }
        1 => {
            let kx = spatial(&(Matrix3::identity() * random.between(0.0, 5.0)));
            let _ = bench.mailbox.try_send::<()>((Replaced::Stiffness, Validity::default()), |set_point| {
                // The hand would refuse some of these Kx with a damping ratio other than 1.
                (set_point.stiffness, set_point.damping) = (kx, 1.0);
                Ok(())
            });
        }
        2 | 3 => {
            let force = Vector3::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(-2.0, 2.0));
            let force = if random.below(2) == 0 { force } else { Vector3::zeros() };
            bench.with_finger(|finger| finger.plant().set_external_force(force));
        }
        4 => rules.extend(bench.reflexes.install(random.reflex())),
        5 if !rules.is_empty() => {
            let rule = rules.swap_remove(random.below(rules.len()));
            assert!(bench.reflexes.remove(rule));
        }
        6 => {
            let step = random.between(0.3, 0.6);
            let poses: Vec<_> =
                (1..=1 + random.below(4)).map(|index| joints(step * index as f64, random.pose().into())).collect();
            return send_if_possible(bench, &poses);
        }
        _ => {}
    }
    false
}

fn check(bench: &Bench, finger: &ConfiguredFinger, cycle: usize) {
    let report = bench.report();
    let (low, high) = finger.joint_limits();
    let set_point = &report.set_point;
    for joint in 0..3 {
        // The checks of a path permit the rounding of its polynomials.
        let inside = (low[joint] - 1e-3..=high[joint] + 1e-3).contains(&set_point.joints[joint]);
        assert!(inside, "cycle {cycle}: set point {:?}", set_point.joints);
    }
    let contact = Contact::general(&set_point.stiffness, &Matrix6::identity()).expect("a spring");
    let largest = contact.largest_eigenvalue(finger.links().0[2]);
    assert!(largest <= finger.stiffness_bound(1000.0) * (1.0 + 1e-9), "cycle {cycle}: {largest} N/cm");
    let (least, most) = AdmissibleDamping::new(finger, 1000.0).range(largest);
    let damping = set_point.damping;
    assert!((least..=most).contains(&damping), "cycle {cycle}: damping {damping} with {largest} N/cm");
    for motor in 0..4 {
        let torque = report.cycle.motor_torques[motor];
        assert!(torque.abs() <= finger.motor.torque_limit[motor] + 1e-9, "cycle {cycle}: {torque} N cm");
        let tension = report.cycle.desired_tensions[motor];
        assert!(tension <= finger.tendon.maximum + 1e-9, "cycle {cycle}: {tension} N commanded");
    }
}

#[test]
fn nothing_random_leads_beyond_a_limit() {
    let cycles = std::env::var("SUN2XP_CYCLES").map_or(CYCLES, |cycles| cycles.parse().expect("a number of cycles"));
    let mut random = Random(Pcg64::seed_from_u64(13));
    let finger = configuration().fingers[0].clone();
    let mut bench = Bench::new();
    bench.opens();
    let (mut rules, mut fired, mut paths) = (Vec::new(), 0, 0);
    for cycle in 0..cycles {
        if random.below(150) == 0 {
            paths += usize::from(disturb(&mut bench, &mut random, &mut rules));
        }
        bench.cycles(1);
        assert_eq!(bench.fault(), None, "cycle {cycle}");
        check(&bench, &finger, cycle);
        while let Some(event) = bench.events.take() {
            fired += usize::from(event.kind == EventKind::ReflexFired);
        }
    }
    assert_eq!(bench.stage(), Stage::Running);
    println!("{cycles} cycles, {fired} reactions, {paths} paths");
    assert!(fired > cycles / 500 && paths > cycles / 20_000, "{fired} reactions, {paths} paths");
}

/// Torque limit of the motors whose board has a coarse torque unit, N cm. It is 100.6 units.
const COARSE_LIMIT: f64 = 2.0125;

/// The coarse torque unit, N cm: almost 1 % of the limit. The library accepts no unit above 1 % of the limit.
const COARSE_UNIT: f64 = 0.02;

/// The motor torque limit of the board is 30 000 torque units, far above that of the servo. The board therefore
/// executes every Command as it is on the wire.
#[test]
fn no_torque_on_the_wire_exceeds_the_computed_torque_if_the_unit_of_the_board_is_coarse() {
    let mut bench = Bench::believing(
        |configuration| configuration.fingers[0].motor.torque_limit = [30_000.0 * COARSE_UNIT; 4],
        |configuration| configuration.fingers[0].motor.torque_limit = [COARSE_LIMIT; 4],
    );
    bench.opens();
    let mut random = Random(Pcg64::seed_from_u64(52));
    let (mut smaller, mut at_limit) = (0, 0);
    for cycle in 0..20_000 {
        if cycle % 200 == 0 {
            let joints = random.pose();
            bench.mailbox.send(|set_point| set_point.joints = joints).expect("not faulted");
            let force = Vector3::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(-2.0, 2.0));
            bench.with_finger(|finger| finger.plant().set_external_force(force));
        }
        let computed = bench.report().cycle.motor_torques;
        bench.cycles(1);
        assert_eq!(bench.fault(), None, "cycle {cycle}");
        for (&sent, &computed) in bench.executed().iter().zip(&computed) {
            // The product of count and unit is rounded, by far less than a torque unit.
            let rounded_off = (computed - sent) * computed.signum();
            let in_unit = -1e-9..COARSE_UNIT + 1e-9;
            assert!(in_unit.contains(&rounded_off), "cycle {cycle}: {computed} N cm computed, {sent} N cm sent");
            // Rounding to the nearest count would make this torque larger.
            smaller += usize::from(rounded_off > 0.5 * COARSE_UNIT);
            at_limit += usize::from(computed.abs() > COARSE_LIMIT - 1e-9);
        }
    }
    assert!(smaller > 10_000 && at_limit > 10, "{smaller} of 80 000 torques, {at_limit} at the limit");
}

/// Lowers the bound of Kx of the running finger to `bound`, N/cm. Returns the new configuration of the finger.
fn lower_bound(bench: &Bench, bound: f64) -> ConfiguredFinger {
    let mut lowered = configuration();
    lowered.fingers[0].stiffness.bound = Some(bound);
    let mut adjustable = Adjustable::new(&lowered, FingerNumber::ONE).expect("usable");
    adjustable.number = 1;
    bench.mailbox.adjust(adjustable).expect("not faulted");
    lowered.fingers[0].clone()
}

#[test]
fn the_initial_stiffness_is_within_a_bound_that_was_lowered() {
    let mut bench = Bench::new();
    let finger = lower_bound(&bench, 1.0);
    bench.mailbox.stop();
    bench.faults(FaultKind::FingerStopCall);
    bench.repair();
    bench.opens();
    check(&bench, &finger, 0);
}

#[test]
fn a_path_does_not_stiffen_the_finger_beyond_a_bound_that_was_lowered() {
    let mut bench = Bench::new();
    let report = bench.report();
    let kx = |kx: f64| Some((Matrix3::identity() * kx).into());
    let [stiff, soft] = [(0.5, 5.0), (1.0, 1.0)];
    let poses = [stiff, soft].map(|(time, largest)| PathPose {
        stiffness: kx(largest),
        ..joints(time, (report.set_point.joints.add_scalar(0.1 * time)).into())
    });
    let plan = plan(&report.reference, &poses);
    let end = |set_point: &mut sun2xp::control::SetPoint| {
        (set_point.joints, set_point.stiffness) = (plan.end(), spatial(&Matrix3::identity()));
        Ok::<_, ()>(PathExtent::default())
    };
    let begins = (report.springs, report.reference.period, Validity::default());
    assert!(matches!(bench.mailbox.send_path(begins, &plan.table(), end), Ok(Ok(Some(_)))));
    bench.cycles(450);
    assert!(bench.report().set_point.stiffness[(0, 0)] > 4.0);
    let finger = lower_bound(&bench, 2.0);
    for cycle in 0..800 {
        bench.cycles(1);
        check(&bench, &finger, cycle);
    }
    assert_eq!(bench.report().set_point.joints, plan.end());
    assert_eq!(bench.report().set_point.stiffness, spatial(&Matrix3::identity()));
}
