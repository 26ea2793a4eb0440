//! The injected faults: the expected name of each, and when it becomes detectable.

use crate::rig::{Bench, MICROSECOND, MILLISECOND, Truth};
use nalgebra::{Vector3, Vector4};
use std::f64::consts::TAU;
use sun2xp::finger::FaultKind;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::simulated::{Defect, LineFault};

/// A fault or a warning to provoke.
pub struct Case {
    pub what: &'static str,
    /// The expected fault or warning.
    pub expected: FaultKind,
    /// Provokes the fault. Returns the affected part if the test checks that the fault names it.
    pub inject: fn(&mut Bench) -> Injected,
    /// Shortest time for which the finger moves before the injection, ms.
    pub after: u64,
    /// Longest permitted time after the fault becomes detectable, ms: until the motors reach their end state, or, for a
    /// warning, until the warning is named.
    pub within: f64,
    /// Changes to the default configuration.
    pub configure: fn(&mut Configuration),
    /// When the fault becomes detectable. `None` means at once.
    pub detectable: Option<Detectable>,
}

/// The affected part, if the test checks that the fault names it, and the speed of a drift, N/s.
#[derive(Clone, Copy, Default)]
pub struct Injected {
    pub part: Option<u8>,
    pub drift: Vector4<f64>,
}

/// A fault is detectable from the beginning of the first stretch of `lasts_ms` during which `holds` returns true. The
/// first argument of `holds` is the finger's true state.
#[derive(Clone, Copy)]
pub struct Detectable {
    pub holds: fn(&Truth, &Injected, &ConfiguredFinger) -> bool,
    pub lasts_ms: f64,
}

fn inject(bench: &mut Bench, defect: Defect) -> Injected {
    assert!(bench.with_finger(|finger| finger.inject(&defect)));
    Injected::default()
}

fn at(part: u8) -> Injected {
    Injected { part: Some(part), ..Default::default() }
}

/// Disturbs frames from the board, each with this probability, for the given time.
pub fn line(bench: &mut Bench, fault: LineFault, probability: f64, milliseconds: u64) -> Injected {
    let until = bench.now() + milliseconds * MILLISECOND;
    let seed = bench.random(0.0, 1e9) as u64;
    bench.with_cable(|cable| cable.inject(fault, probability, until, seed));
    Injected::default()
}

fn push(bench: &mut Bench, force: [f64; 3]) -> Injected {
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::from(force)));
    Injected::default()
}

fn case(what: &'static str, expected: FaultKind, inject: fn(&mut Bench) -> Injected) -> Case {
    Case { what, expected, inject, after: 300, within: 20.0, configure: |_| {}, detectable: None }
}

impl Case {
    fn with(self, configure: fn(&mut Configuration)) -> Self {
        Self { configure, ..self }
    }

    /// Lets the monitors learn, before the injection, how the finger differs from its configuration. `within` becomes
    /// the longest time until the motors reach their end state, ms.
    fn after_learning(self, within: f64) -> Self {
        Self { after: 3000, within, ..self }
    }

    /// The fault becomes detectable when a stretch of `lasts_ms` begins during which `holds` returns true.
    fn detectable_while(self, lasts_ms: f64, holds: fn(&Truth, &Injected, &ConfiguredFinger) -> bool) -> Self {
        Self { detectable: Some(Detectable { holds, lasts_ms }), ..self }
    }
}

/// Faults of the finger itself.
pub fn of_the_finger() -> Vec<Case> {
    // The order determines the seed of each case.
    of_the_tendons().into_iter().chain(of_the_motors()).chain(of_the_board()).collect()
}

fn of_the_tendons() -> Vec<Case> {
    use FaultKind::*;
    vec![
        case("cut tendon", BrokenTendon, |bench| {
            let tendon = bench.part();
            inject(bench, Defect::CutTendon(tendon));
            at(tendon)
        }),
        case("slack tendon (its clamp slips above 1 N)", SlackTendon, |bench| {
            let tendon = bench.part();
            inject(bench, Defect::SlippingTendon { tendon, grip: 1.0 });
            at(tendon)
        }),
        case("gauge keeps its last count", GaugeStuck, |bench| {
            let gauge = bench.part();
            inject(bench, Defect::DeadGauge { gauge, count: None });
            at(gauge)
        })
        // With the noise of the simulated gauges, 0.03 N rms, one count in five equals the previous one. A working
        // gauge repeats one count for 16.5 ms only once in 10^11 samples.
        .detectable_while(0.0, |truth, _, _| truth.time > 0.0165),
        case("gauge reads zero", GaugeStuck, |bench| {
            let gauge = bench.part();
            inject(bench, Defect::DeadGauge { gauge, count: Some(0) });
            at(gauge)
        }),
        case("gauge reads full scale", GaugeOutOfRange, |bench| {
            let gauge = bench.part();
            inject(bench, Defect::DeadGauge { gauge, count: Some(4095) });
            at(gauge)
        }),
        case("drifting gauge (20 N/s)", GaugeDisagrees, drift).after_learning(3000.0).detectable_while(10.0, disagrees),
        case("drifting gauge (20 N/s), smaller tolerances", GaugeDisagrees, drift)
            .with(|configuration| {
                let finger = &mut configuration.fingers[0];
                finger.tendon.stiffness_tolerance = 0.03;
                let monitors = &mut finger.monitors;
                (monitors.friction_tolerance, monitors.moment_arm_tolerance) = (0.0, 0.01);
                monitors.gauge_tolerance = 0.01;
            })
            .after_learning(600.0)
            .detectable_while(10.0, disagrees),
    ]
}

fn of_the_motors() -> Vec<Case> {
    use FaultKind::*;
    vec![
        case("encoder jump (150 counts)", EncoderJump, |bench| {
            let (encoder, way) = (bench.part(), bench.random(-1.0, 1.0).signum());
            inject(bench, Defect::EncoderJump { encoder, counts: 150 * way as i32 });
            at(encoder)
        }),
        case("jammed motor", StalledMotor, |bench| {
            let motor = bench.part();
            inject(bench, Defect::JammedMotor(motor));
            at(motor)
        })
        .detectable_while(12.0, shows_stall),
        case("hot motor, reported by its driver", DriverFault, |bench| inject(bench, Defect::HotMotor(1))),
        case("hot motor, by I^2 t", OverheatedMotor, |bench| push(bench, [0.0, 0.0, -1.6]))
            .with(with_small_motors)
            .detectable_while(0.0, |truth, _, finger| truth.hot_for.max() > finger.motor.thermal_time),
        case("impact (40 N)", OverTension, |bench| push(bench, [0.0, 40.0, 0.0]))
            .detectable_while(4.0, |truth, _, finger| truth.tensions.max() > 1.3 * finger.tendon.maximum),
        case("impossible pose", ImpossiblePose, turn_encoders_unseen),
    ]
}

fn of_the_board() -> Vec<Case> {
    use FaultKind::*;
    vec![
        case("zero lost", ZeroLost, |bench| inject(bench, Defect::ZeroLost)),
        case("emergency stop, input", EmergencyStopInput, |bench| inject(bench, Defect::EmergencyStop)),
        case("motor supply", SupplyFault, |bench| inject(bench, Defect::Supply)),
        case("sensor fault, reported by the board", SensorFault, |bench| inject(bench, Defect::Sensor)),
        case("board reset", BoardReset, |bench| inject(bench, Defect::Reset)),
    ]
}

/// Faults of the line between finger and servo. They are detectable at once, whatever the rate of the servo is.
pub fn of_the_line() -> Vec<Case> {
    use FaultKind::*;
    vec![
        case("replies dropped", LostReplies, |bench| line(bench, LineFault::Drop, 1.0, 1000)),
        case("replies corrupted", DamagedReplies, |bench| line(bench, LineFault::Corrupt, 1.0, 1000)),
        case("replies delayed by 3 ms", LostReplies, |bench| line(bench, LineFault::Delay(3 * MILLISECOND), 1.0, 1000)),
        case("line stalled for 100 ms", LostReplies, |bench| line(bench, LineFault::Stall, 1.0, 100)),
        case("unplug, replug", PortVanished, |bench| {
            bench.with_cable(|cable| cable.set_plugged(false));
            Injected::default()
        }),
        case("host silent for 30 ms", Watchdog, |bench| {
            bench.pause(30 * MILLISECOND);
            Injected::default()
        }),
    ]
}

/// Conditions that only cause a warning.
pub fn warnings() -> Vec<Case> {
    use FaultKind::*;
    vec![
        case("warm motor, by I^2 t", WarmMotor, |bench| push(bench, [0.0, 0.0, -1.6]))
            .with(with_small_motors)
            .detectable_while(0.0, |truth, _, _| truth.heat.max() > 0.8),
        case("joint at its stop", JointAtStop, |bench| push(bench, [-6.0, 0.0, 0.0])).detectable_while(
            0.0,
            |truth, _, finger| {
                let ((low, high), (lower, upper)) = (finger.joint_limits(), finger.stops());
                let (low, high) = (low.lerp(&lower, 0.8), high.lerp(&upper, 0.8));
                // Slack tendons give no information about the joints.
                truth.tensions.min() > 0.5
                    && (0..3).any(|joint| !(low[joint]..=high[joint]).contains(&truth.joints[joint]))
            },
        ),
        case("30 % of the replies dropped", LineNoise, |bench| line(bench, LineFault::Drop, 0.3, 1000))
            .detectable_while(0.0, |truth, _, _| truth.lost > 0.02),
        case("overrun (every eighth cycle 2.2 ms late)", Overrun, |bench| {
            bench.wake_late(2200 * MICROSECOND);
            Injected::default()
        })
        .detectable_while(0.0, |truth, _, _| truth.skipping > 0.02),
    ]
}

/// Motors that a push heats up quickly but that can still hold the finger.
fn with_small_motors(configuration: &mut Configuration) {
    let motor = &mut configuration.fingers[0].motor;
    (motor.continuous_torque, motor.thermal_time) = ([0.85; 4], 0.3);
}

/// Interference that hits the line and the counters together, so the servo cannot see the counters jump.
fn turn_encoders_unseen(bench: &mut Bench) -> Injected {
    line(bench, LineFault::Drop, 1.0, 12);
    let finger = bench.finger();
    let tendons = finger.tendons().expect("tendons");
    let turned = (tendons.r.tr_mul(&Vector3::new(0.0, -3.0, 0.0))).component_div(&tendons.radius);
    let per_turn = finger.encoder.counts_per_revolution.map(f64::from);
    for (index, per_turn) in per_turn.into_iter().enumerate() {
        let counts = (turned[index] * per_turn / TAU) as i32;
        inject(bench, Defect::EncoderJump { encoder: index as u8 + 1, counts });
    }
    Injected::default()
}

fn drift(bench: &mut Bench) -> Injected {
    let (gauge, way) = (bench.part(), bench.random(-1.0, 1.0).signum());
    inject(bench, Defect::DriftingGauge { gauge, speed: 20.0 * way });
    let mut drift = Vector4::zeros();
    drift[usize::from(gauge) - 1] = 20.0 * way;
    // The monitor compares gauges and encoders by one equation (`control/monitors/agreement.rs`), which cannot show
    // which of the four gauges is wrong. The fault names the gauge that differs most from the pull of its motor. This
    // need not be the wrong one, so the part is not checked.
    Injected { part: None, drift }
}

/// Whether the gauge error exceeds what is always tolerated.
fn disagrees(truth: &Truth, injected: &Injected, finger: &ConfiguredFinger) -> bool {
    let null: Vector4<f64> = finger.tendons().expect("tendons").q.column(3).into_owned();
    let per_stiffness = null.component_div(&Vector4::from(finger.tendon.stiffness));
    let shares = per_stiffness / per_stiffness.sum();
    // 0.1 N for the resolution of the encoders and the noise of the gauges.
    shares.dot(&(injected.drift * truth.time)).abs() > finger.monitors.disagreement + 0.1
}

/// Whether pull and tension differ by more than the monitor of stalled motors always tolerates.
fn shows_stall(truth: &Truth, injected: &Injected, finger: &ConfiguredFinger) -> bool {
    let motor = usize::from(injected.part.expect("a motor")) - 1;
    let (pull, tension) = (truth.pulls[motor], truth.tensions[motor]);
    let larger = pull.abs().max(tension);
    let monitors = &finger.monitors;
    let held = monitors.stall_torque[motor] / finger.geometry.motor_radius[motor];
    (pull - tension).abs() > held + monitors.stall_fraction * larger
}
