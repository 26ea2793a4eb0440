//! Which way motors, encoders and gauges count, when nothing is known about it.
//!
//! First every motor is given a short push: command and count agree or disagree, and from then on every motor can be held
//! where it is, whichever way that pulls. Then one motor after the other turns to and fro with the rest held. On one side the
//! tensions grow, on the other they are gone: that is in and out. A free finger shares every pull among all its tendons (its
//! tensions stay along the null vector of R), so all gauges answer to every motor.

use super::average::Average;
use super::findings::{Findings, Signs};
use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::step::{Progress, Sample, Step, Stepped};
use super::wiring::Wiring;
use crate::control::signals::{Activity, Feedback};
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use std::ops::ControlFlow::{Break, Continue};

/// A push counts when its motor has turned so far, cm at the tendon.
const TURNED: f64 = 0.005;
/// Pushes begin at this part of t_min and grow by a factor until the motor turns; N at the tendon.
const FIRST_PUSH: f64 = 0.4;
const GROWTH: f64 = 1.3;
const HARDEST_PUSH: f64 = 2.0;
/// Seconds of a push and of the pause after it.
const PUSH: f64 = 0.1;
/// Seconds at rest before anything is measured.
const REST: f64 = 0.2;

/// Holding a motor: N/cm, N s/cm, largest pull in t_min, corner of the speed in 1/s.
const HOLD: f64 = 150.0;
const DAMPING: f64 = 2.0;
const STRONGEST_HOLD: f64 = 1.2;
const SPEED_CORNER: f64 = 1000.0;
/// A motor that lags so far behind has stalled, cm and part of the way.
const STALLED: (f64, f64) = (0.03, 0.25);

/// The way of a motor to each side, cm: first and longest. It is doubled until one side is tight and the other slack.
const FIRST_WAY: f64 = 0.05;
const LONGEST_WAY: f64 = 1.0;
/// cm/s.
const SPEED: f64 = 0.5;
/// Stops on the way, parts of it.
const PLACES: [f64; 5] = [0.5, 1.0, -0.5, -1.0, 0.0];
/// Seconds at each: settling, then reading.
const SETTLING: f64 = 0.15;
const READING: f64 = 0.1;
/// Change over the outer half of a way, N: from here on it is tight; up to here it is slack.
const TIGHT: f64 = 0.5;
const SLACK: f64 = 0.25;

#[derive(Clone, Debug)]
pub(super) struct SignSearch {
    /// cm at the tendon of one count, without signs.
    cm_per_count: Vector4<f64>,
    newton_per_count: Vector4<f64>,
    /// Counts in the beginning, which every way is measured from.
    start: Option<[i32; 4]>,
    last: Vector4<f64>,
    speed: Vector4<f64>,
    /// Where every motor is held, cm of count.
    target: Vector4<f64>,
    /// +1 where a positive command raises the count.
    agrees: [f64; 4],
    /// +1 where a rising count tightens.
    tightens: [f64; 4],
    /// Of each gauge, once it has answered.
    gauges: [f64; 4],
    motor: usize,
    phase: Phase,
}

// No heap in the servo: the largest phase takes its room.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
enum Phase {
    Rest {
        seconds: f64,
    },
    Push {
        seconds: f64,
        push: f64,
        from: Vector4<f64>,
    },
    Pause {
        seconds: f64,
    },
    Sweep(Sweep),
    /// Every sign is known.
    Wiring(Wiring),
}

/// One motor to and fro.
#[derive(Clone, Copy, Debug)]
struct Sweep {
    centre: f64,
    way: f64,
    place: usize,
    /// At the place, s.
    seconds: f64,
    gauges: Average,
    read: [Vector4<f64>; 4],
    stalled: [bool; 4],
}

impl Sweep {
    fn new(centre: f64, way: f64) -> Self {
        let read = [Vector4::zeros(); 4];
        Self { centre, way, place: 0, seconds: 0.0, gauges: Average::default(), read, stalled: [false; 4] }
    }
}

impl SignSearch {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let cm_per_count = |motor: usize| {
            finger.geometry.motor_radius[motor] * std::f64::consts::TAU
                / f64::from(finger.encoder.counts_per_revolution[motor])
        };
        Self {
            cm_per_count: Vector4::from_fn(|motor, _| cm_per_count(motor)),
            newton_per_count: Vector4::from(finger.gauge.newton_per_count.map(f64::abs)),
            start: None,
            last: Vector4::zeros(),
            speed: Vector4::zeros(),
            target: Vector4::zeros(),
            agrees: [0.0; 4],
            tightens: [0.0; 4],
            gauges: [0.0; 4],
            motor: 0,
            phase: Phase::Rest { seconds: 0.0 },
        }
    }

    pub fn step(&mut self, instruments: &Instruments, sample: &Sample) -> Stepped {
        let way = self.measure(instruments, sample.feedback);
        let motor = self.motor;
        let minimum = instruments.minimum;
        let sweeping = matches!(self.phase, Phase::Sweep(_) | Phase::Wiring(_));
        let part = motor as f64 * if sweeping { 0.22 } else { 0.03 } + if sweeping { 0.12 } else { 0.0 };
        let mut torques = Vector4::zeros();
        match &mut self.phase {
            Phase::Rest { seconds } => {
                *seconds += instruments.period;
                if *seconds > REST {
                    self.phase = Phase::Push { seconds: 0.0, push: FIRST_PUSH * minimum, from: way };
                }
            }
            &mut Phase::Push { ref mut seconds, push, from } => {
                *seconds += instruments.period;
                let moved = way - from;
                if moved[motor].abs() > TURNED {
                    self.agrees[motor] = moved[motor].signum();
                    self.phase = Phase::Pause { seconds: 0.0 };
                } else if moved.amax() > TURNED {
                    let encoder = moved.iamax() as u8 + 1;
                    return Err(Obstacle::SwappedMotor { motor: motor as u8 + 1, encoder });
                } else if *seconds > PUSH {
                    let push = push * GROWTH;
                    if push > HARDEST_PUSH * minimum {
                        return Err(Obstacle::MotorStuck { motor: motor as u8 + 1 });
                    }
                    self.phase = Phase::Push { seconds: 0.0, push, from };
                } else {
                    torques[motor] = push * instruments.radius[motor];
                }
            }
            Phase::Pause { seconds } => {
                *seconds += instruments.period;
                if *seconds > PUSH {
                    self.motor = (motor + 1) % 4;
                    self.phase = if motor < 3 {
                        Phase::Push { seconds: 0.0, push: FIRST_PUSH * minimum, from: way }
                    } else {
                        self.target = way;
                        Phase::Sweep(Sweep::new(way[0], FIRST_WAY))
                    };
                }
            }
            &mut Phase::Sweep(mut sweep) => {
                let mut next = None;
                if self.advance(&mut sweep, instruments, sample, &way) {
                    if let Some(side) = sweep.tight_side() {
                        self.tightens[motor] = side;
                        self.note_gauges(&sweep, side)?;
                        // Left on the tight side: it takes some slack out for the motors that follow.
                        self.target[motor] = sweep.centre + 0.5 * side * sweep.way;
                        if motor == 3 {
                            next = Some(Phase::Wiring(Wiring::new()));
                        } else {
                            self.motor += 1;
                            sweep = Sweep::new(self.target[motor + 1], FIRST_WAY);
                        }
                    } else if sweep.way * 2.0 > LONGEST_WAY {
                        return Err(Obstacle::NothingTightens { motor: motor as u8 + 1 });
                    } else {
                        sweep = Sweep::new(sweep.centre, sweep.way * 2.0);
                    }
                }
                self.phase = next.unwrap_or(Phase::Sweep(sweep));
                torques = self.hold(instruments, &way);
            }
            Phase::Wiring(wiring) => {
                let scale = self.newton_per_count.component_mul(&Vector4::from(self.gauges));
                let tensions = Vector4::from(sample.feedback.gauge_counts.map(f64::from)).component_mul(&scale);
                let Some(jerk) = wiring.step(instruments, &tensions)? else {
                    return self.findings().map(Break);
                };
                let inward = Vector4::from(self.agrees).component_mul(&Vector4::from(self.tightens));
                torques = self.hold(instruments, &way) + jerk.component_mul(&inward).component_mul(&instruments.radius);
            }
        }
        Ok(Continue((Activity::Turn(torques), Progress { step: Step::TryingMotors, part })))
    }

    /// Way of every motor since the beginning, cm of rising count.
    fn measure(&mut self, instruments: &Instruments, feedback: &Feedback) -> Vector4<f64> {
        let start = *self.start.get_or_insert(feedback.motor_counts);
        let counts = |motor: usize| f64::from(feedback.motor_counts[motor].wrapping_sub(start[motor]));
        let way = Vector4::from_fn(|motor, _| counts(motor) * self.cm_per_count[motor]);
        let gain = (SPEED_CORNER * instruments.period).min(0.7);
        self.speed += ((way - self.last) / instruments.period - self.speed) * gain;
        self.last = way;
        way
    }

    /// Torques, N cm, that hold every motor at its target.
    fn hold(&self, instruments: &Instruments, way: &Vector4<f64>) -> Vector4<f64> {
        let strongest = STRONGEST_HOLD * instruments.minimum;
        let pulls = (self.target - way) * HOLD - self.speed * DAMPING;
        let pulls = pulls.map(|pull| pull.clamp(-strongest, strongest));
        pulls.component_mul(&Vector4::from(self.agrees)).component_mul(&instruments.radius)
    }

    /// Moves the motor on; whether it has been everywhere.
    fn advance(&mut self, sweep: &mut Sweep, instruments: &Instruments, sample: &Sample, way: &Vector4<f64>) -> bool {
        let motor = self.motor;
        let aim = sweep.centre + PLACES[sweep.place] * sweep.way;
        let step = SPEED * instruments.period;
        self.target[motor] += (aim - self.target[motor]).clamp(-step, step);
        if self.target[motor] != aim {
            return false;
        }
        sweep.seconds += instruments.period;
        if sweep.seconds > SETTLING {
            sweep.gauges.add(Vector4::from(sample.feedback.gauge_counts.map(f64::from)));
        }
        if sweep.seconds < SETTLING + READING {
            return false;
        }
        if let Some(read) = sweep.read.get_mut(sweep.place) {
            *read = sweep.gauges.mean().component_mul(&self.newton_per_count);
            sweep.stalled[sweep.place] = (aim - way[motor]).abs() > STALLED.0 + STALLED.1 * sweep.way;
        }
        (sweep.place, sweep.seconds, sweep.gauges) = (sweep.place + 1, 0.0, Average::default());
        sweep.place == PLACES.len()
    }

    /// Which way the gauges went between the slack end and the tight one.
    fn note_gauges(&mut self, sweep: &Sweep, side: f64) -> Result<(), Obstacle> {
        let change = (sweep.read[1] - sweep.read[3]) * side;
        for gauge in 0..4 {
            if change[gauge].abs() < TIGHT {
                continue;
            }
            let sign = change[gauge].signum();
            if self.gauges[gauge] == -sign {
                return Err(Obstacle::SenselessGauge { tendon: gauge as u8 + 1 });
            }
            self.gauges[gauge] = sign;
        }
        Ok(())
    }

    fn findings(&self) -> Result<Findings, Obstacle> {
        if let Some(gauge) = self.gauges.iter().position(|&sign| sign == 0.0) {
            return Err(Obstacle::SenselessGauge { tendon: gauge as u8 + 1 });
        }
        let whole = |sign: f64| if sign < 0.0 { -1 } else { 1 };
        Ok(Findings::Signs(Signs {
            motor: std::array::from_fn(|motor| whole(self.agrees[motor] * self.tightens[motor])),
            encoder: self.tightens.map(whole),
            gauge: self.gauges.map(whole),
        }))
    }
}

impl Sweep {
    /// +1 or -1: the side, in counts, on which the tensions grow while they are gone on the other; none where that is not
    /// so clear.
    fn tight_side(&self) -> Option<f64> {
        let change = |inner: usize, outer: usize| (self.read[outer] - self.read[inner]).amax();
        let tight = |inner, outer: usize| change(inner, outer) > TIGHT || self.stalled[outer];
        let slack = |inner, outer: usize| change(inner, outer) < SLACK && !self.stalled[outer];
        if tight(0, 1) && slack(2, 3) {
            Some(1.0)
        } else if tight(2, 3) && slack(0, 1) {
            Some(-1.0)
        } else {
            None
        }
    }
}
