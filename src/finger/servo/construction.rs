//! Construction of a finger's servo from the configuration and the board's answers.

use super::event_output::EventOutput;
use super::reflexive::Reflexive;
use super::set_point_motion::SetPointMotion;
use super::{FingerServo, Limits, STOPS_AFTER_FAULT};
use crate::board::protocol::{Configured, Identity};
use crate::control::events::Detectors;
use crate::control::{Activity, Controller, Feedback, MotorCommand, SetPoint};
use crate::finger::Adjustable;
use crate::finger::link_watch::LinkWatch;
use crate::finger::mailbox::{Mailbox, mailbox};
use crate::finger::motion_settings::MotionSettings;
use crate::finger::supervision::Supervision;
use crate::finger::touch::{Elements, TouchFetching};
use crate::finger::{FingerReport, ReactionLimits, Recorder, StopSignal, stop_calls};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, ConfiguredHand, EndState, Unusable};
use crate::realtime::{CycleTiming, Producer};
use nalgebra::{Matrix3, Vector3};

/// Time for which every tendon must be under tension, with the motors still, before the finger enters the stage
/// `Running`, s.
const TENSION_SETTLED: f64 = 0.02;

/// Distance of a joint from its soft limits, rad, beyond which its measured pose counts as impossible. In the stage
/// `Running`, a margin is added. The mechanical stops of a hand are usually closer to the soft limits than this
/// distance, and the errors of measured angles are smaller than this distance.
const BEYOND_LIMITS: f64 = 0.5;

/// Time for which a warning is kept after it was last noted, ms.
const WARNING_MS: f64 = 1000.0;

impl Adjustable {
    /// Constructs the data that the configuration describes. The `number` of the result is 0, the number of a finger's
    /// first controller.
    ///
    /// # Errors
    /// Returns an error if no controller can be constructed from the configuration.
    pub fn new(configuration: &Configuration, number: FingerNumber) -> Result<Self, Unusable> {
        let finger = &configuration.fingers[number.index()];
        let (low, high) = finger.joint_limits();
        let pose = (low.add_scalar(-BEYOND_LIMITS), high.add_scalar(BEYOND_LIMITS));
        let controller = Controller::in_gravity(finger, &configuration.gravity(number), configuration.hand.rate)?;
        let detectors = Detectors::new(finger, configuration.hand.rate);
        let motion = MotionSettings::new(finger, configuration.hand.rate);
        let reactions = ReactionLimits::new(finger, configuration.hand.rate);
        Ok(Self { number: 0, controller, motion, pose, detectors, reactions })
    }
}

impl Limits {
    fn new(hand: &ConfiguredHand) -> Self {
        let cycles = |milliseconds: f64| (milliseconds * 1e-3 * hand.rate).ceil() as u32;
        Self {
            period_ms: 1000.0 / hand.rate,
            opening_ms: hand.open_timeout_ms.into(),
            settled: cycles(TENSION_SETTLED * 1e3),
            ramp: cycles(hand.release_ramp_ms.into()),
            warning: cycles(WARNING_MS),
            hold_ms: match hand.end_state {
                EndState::Hold => hand.hold_time_ms.into(),
                EndState::Release => 0.0,
            },
        }
    }
}

impl FingerServo {
    /// Makes the servo wait for the reply of hardware that advances by one period in every exchange. Servos of built-in
    /// simulated fingers wait too.
    pub fn in_step(mut self, hand: &ConfiguredHand) -> Self {
        self.link = LinkWatch::new(hand, true);
        self.supervision = Supervision::new(hand.rate, self.link.fault_at(), self.board.gauge_bits);
        self
    }

    /// Constructs a finger in the pose that its board has reported, and the planners' end of its mailbox. The finger is
    /// about to take up slack. Timings are written to `timings`, and records of its cycles to `black_box`. Entries for
    /// which a ring has no room are dropped.
    ///
    /// `stiffness` is the Kx with which the finger holds its initial pose. The caller must have checked that this Kx is
    /// admitted.
    ///
    /// # Errors
    /// Returns an error if no controller can be constructed from the configuration.
    pub fn new(
        configuration: &Configuration,
        number: FingerNumber,
        stiffness: Matrix3<f64>,
        identity: &Identity,
        configured: &Configured,
        (timings, black_box): (Producer<CycleTiming>, Recorder),
    ) -> Result<(Self, Mailbox), Unusable> {
        let (hand, finger) = (&configuration.hand, &configuration.fingers[number.index()]);
        let adjustable = Adjustable::new(configuration, number)?;
        let (feedback, link) = (found(configured), LinkWatch::new(hand, finger.simulated()));
        let initial = SetPoint { law: finger.controller.law, ..SetPoint::hard_finger(Vector3::zeros(), stiffness) };
        let report = FingerReport::opening(initial);
        let (planners, servo, mut memory) = mailbox(report, &adjustable, &configuration.gravity(number).into());
        memory.append(&black_box.memory());
        timings.add_to(&mut memory);
        let this = Self {
            state: adjustable.controller.start(&feedback),
            adjustable,
            activity: Activity::TakeUpSlack,
            calibration: None,
            status: configured.status,
            feedback,
            restart: false,
            faulted_at: 0,
            command: MotorCommand::default(),
            mailbox: servo,
            timing: CycleTiming::default(),
            timings,
            black_box,
            reflexes: Reflexive::default(),
            touch: TouchFetching::new(Elements::new(&finger.touch), identity.capabilities, &mut memory),
            events: EventOutput::new(number, initial, &mut memory),
            record: None,
            recording: false,
            report,
            address: configuration.address(number),
            board: *identity,
            sequence: 0,
            toggle: false,
            answered: true,
            replied: false,
            last_answer: 0,
            supervision: Supervision::new(hand.rate, link.fault_at(), identity.gauge_bits),
            link,
            motion: SetPointMotion::new(),
            alarm: StopSignal::new(false, stop_calls()),
            sampled_at: None,
            sample_age: 0,
            limits: Limits::new(hand),
            settled_cycles: 0,
            stage_cycles: 0,
            opening_since: None,
            stops_left: STOPS_AFTER_FAULT,
            initial,
            end_state: hand.end_state,
            memory,
        };
        Ok((this, planners))
    }
}

/// The sensor values that the board has reported in its handshake.
pub(super) fn found(configured: &Configured) -> Feedback {
    Feedback { motor_counts: configured.encoders, gauge_counts: configured.gauges }
}
