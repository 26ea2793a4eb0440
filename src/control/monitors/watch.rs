//! Runs all monitors of a finger on each sample.

use super::agreement::{self, Agreement};
use super::alarm::{Alarm, Alarms, Symptom};
use super::encoder_jump::{self, EncoderJump};
use super::gauge_range::{self, GaugeRange};
use super::gauge_stuck::{self, GaugeStuck};
use super::joint_stop::JointStop;
use super::motor_heat::{self, MotorHeat};
use super::sample::Sample;
use super::stalled_motor::{self, StalledMotor};
use super::tension_lost::{self, TensionLost};
use crate::control::signals::{Feedback, Measured, Report};
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// All monitors of a finger.
#[derive(Clone, Debug)]
pub(crate) struct Monitors {
    period: f64,
    /// Motor radii, cm.
    radius: Vector4<f64>,
    tension_lost: TensionLost,
    gauge_range: GaugeRange,
    gauge_stuck: GaugeStuck,
    agreement: Agreement,
    encoder_jump: EncoderJump,
    stalled_motor: StalledMotor,
    motor_heat: MotorHeat,
    joint_stop: JointStop,
}

/// The state of the monitors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    before: Option<Before>,
    tension_lost: tension_lost::Memory,
    gauge_range: gauge_range::Memory,
    gauge_stuck: gauge_stuck::Memory,
    agreement: agreement::Memory,
    encoder_jump: encoder_jump::Memory,
    stalled_motor: stalled_motor::Memory,
    motor_heat: motor_heat::Memory,
}

impl Watch {
    /// Restarts the comparison of gauges and encoders after an adjustment of the controller.
    pub fn adjusted(&mut self) {
        self.agreement = Default::default();
        self.tension_lost.restart_comparison();
    }

    /// Restarts the monitors after replies were lost for so long that the controller restarts. The time for which the
    /// motors have been hot is kept, because windings do not cool in the few milliseconds of such a loss.
    pub fn resume(&mut self) {
        *self = Self { motor_heat: self.motor_heat, ..Self::default() };
    }
}

/// Data of the previous sample.
#[derive(Clone, Copy, Debug)]
struct Before {
    motor_angles: Vector4<f64>,
    /// Pulls that the cycle of that sample commanded, N.
    pulls: Vector4<f64>,
}

impl Monitors {
    /// Constructs the monitors at `rate`, Hz. `dither_period` is the period of the controller's dither, s, or 0 without
    /// dither.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, rate: f64, dither_period: f64) -> Self {
        Self {
            period: 1.0 / rate,
            radius: tendons.radius,
            tension_lost: TensionLost::new(finger),
            gauge_range: GaugeRange::new(finger),
            gauge_stuck: GaugeStuck::new(finger),
            agreement: Agreement::new(finger, tendons),
            encoder_jump: EncoderJump::new(finger, 1.0 / rate),
            stalled_motor: StalledMotor::new(finger, tendons, dither_period),
            motor_heat: MotorHeat::new(finger),
            joint_stop: JointStop::new(finger),
        }
    }

    /// Runs the monitors on one sample of a finger that follows a set point. `age` is the number of periods since the
    /// last sample, and `pulls` are the pulls that the cycle has just commanded, N.
    #[allow(clippy::too_many_arguments)]
    pub fn watch(
        &self,
        watch: &mut Watch,
        feedback: &Feedback,
        measured: &Measured,
        report: &Report,
        pulls: &Vector4<f64>,
        heat: &Vector4<f64>,
        age: f64,
        full_scale: u16,
    ) -> Alarms {
        let Measured { motor_angles, tensions } = *measured;
        let now = Before { motor_angles, pulls: *pulls };
        let Some(before) = watch.before.replace(now) else { return Alarms::default() };
        let sample = Sample {
            feedback,
            report,
            tensions,
            travel: self.radius.component_mul(&motor_angles),
            turned: motor_angles - before.motor_angles,
            pulls: before.pulls,
            elapsed: self.period * age,
            full_scale,
        };
        // Sensors come first, because a dead sensor also causes the symptoms of the other monitors.
        let stuck = self.gauge_stuck.watch(&mut watch.gauge_stuck, &sample);
        let jumped = self.encoder_jump.watch(&mut watch.encoder_jump, &sample);
        let range = self.gauge_range.watch(&mut watch.gauge_range, &sample);
        let flickers = self.gauge_stuck.flickers(&watch.gauge_stuck, full_scale);
        self.agreement.compare(&mut watch.agreement, &sample);
        let missing = watch.agreement.missing();
        let lost = self.tension_lost.watch(&mut watch.tension_lost, &sample, &missing, &flickers);
        let suspects = watch.tension_lost.suspects();
        let disagrees = self.agreement.watch(&mut watch.agreement, &sample, suspects);
        let silent = (0..4).find(|&gauge| flickers.silent(gauge)).filter(|_| disagrees.is_some());
        let stuck = stuck.or(silent.map(|gauge| gauge_stuck::alarm(&sample, gauge)));
        let stalled = self.stalled_motor.watch(&mut watch.stalled_motor, &sample);
        // A gauge that drifts makes its motor seem stalled. The gauge reports a tension that does not exist, so pull
        // and tension seem to be unbalanced, and yet the motor stands still.
        let stalled = stalled.map(|alarm| {
            let number = alarm.part.number();
            if self.agreement.explains(&watch.agreement, usize::from(number) - 1, alarm.value) {
                Alarm { symptom: Symptom::GaugeDisagrees, part: Part::Gauge(number), ..alarm }
            } else {
                alarm
            }
        });
        let hot = self.motor_heat.watch(&mut watch.motor_heat, heat, &sample);
        let fault = jumped.or(stuck).or(range).or(lost.fault).or(stalled).or(disagrees).or(hot.fault);
        let warning = lost.warning.or(self.joint_stop.watch(&sample)).or(hot.warning).or(not_admitted(report));
        Alarms { fault, warning }
    }
}

fn not_admitted(report: &Report) -> Option<Alarm> {
    let value = 100.0 * report.torque_scale;
    (report.torque_scale < 1.0).then_some(Alarm { symptom: Symptom::TorqueNotAdmitted, part: Part::Finger, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_of_replies_does_not_prolong_the_time_for_which_a_motor_may_be_hot() {
        let mut finger = ConfiguredFinger::default();
        finger.motor.thermal_time = 0.1;
        let monitors = Monitors::new(&finger, &finger.tendons().expect("the default tendons"), 1000.0, 0.0);
        let (mut watch, feedback, report) = (Watch::default(), Feedback::default(), Report::default());
        let tensions = Vector4::repeat(10.0);
        let measured = Measured { motor_angles: Vector4::zeros(), tensions };
        let fault = |watch: &mut Watch| {
            monitors.watch(watch, &feedback, &measured, &report, &tensions, &Vector4::repeat(1.0), 1.0, 4095).fault
        };
        for _ in 0..80 {
            assert_eq!(fault(&mut watch), None);
        }
        watch.resume();
        let found = (0..30).find_map(|_| fault(&mut watch));
        assert_eq!(found.map(|alarm| alarm.symptom), Some(Symptom::OverheatedMotor));
    }

    #[test]
    fn a_low_tension_after_an_adjustment_is_no_loss_of_tension() {
        let finger = ConfiguredFinger::default();
        let monitors = Monitors::new(&finger, &finger.tendons().expect("the default tendons"), 1000.0, 0.0);
        let (mut watch, feedback, report) = (Watch::default(), Feedback::default(), Report::default());
        let fault = |watch: &mut Watch, tensions: Vector4<f64>| {
            let measured = Measured { motor_angles: Vector4::zeros(), tensions };
            monitors.watch(watch, &feedback, &measured, &report, &tensions, &Vector4::zeros(), 1.0, 4095).fault
        };
        // After the start, gauges and encoders differ by 1 N, which is tolerated.
        for tension in [10.0; 40].into_iter().chain([11.0; 100]) {
            assert_eq!(fault(&mut watch, Vector4::repeat(tension)), None);
        }
        watch.adjusted();
        // A fast motion makes a tendon nearly slack for a moment.
        for _ in 0..20 {
            assert_eq!(fault(&mut watch, Vector4::new(1.0, 11.0, 11.0, 11.0)), None);
        }
    }
}
