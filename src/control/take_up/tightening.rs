//! Tightens the tendons of a finger during its calibration, when the zeros of its encoders and gauges may be wrong.
//!
//! The first tendon that comes taut moves a free finger until another tendon opposes it. If no motor waited for the
//! others, unequal slack would turn the joints by more than a radian. So every motor winds in slowly until it detects
//! tension in its tendon, and then waits until all motors have detected tension. From then on the joint angles can be
//! measured. The joints are held at the angles of this moment while the tensions rise.

use crate::control::spring::joint_hold::JointHold;
use crate::control::take_up::progress::Slackness;
use crate::model::{Links, Tendons};
use nalgebra::{Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Winding speed at the start, m/s of tendon. It is low, so that a little slack is taken up gently.
const SPEED: f64 = 0.003;
/// Acceleration of the winding, m/s^2. Because of it, a lot of slack is taken up in reasonable time.
const ACCELERATION: f64 = 0.002;

/// A tendon is considered to be taut when its tension exceeds its lowest tension so far by this fraction of t_min. This
/// criterion works with any zero of the gauge.
const DETECTED: f64 = 0.04;
/// A tendon is also considered to be taut when its tension exceeds this fraction of t_min.
const TAUT: f64 = 0.2;

/// Stiffness of the position control of a motor, N/m.
const STIFFNESS: f64 = 15_000.0;
/// Damping of the position control of a motor, N s/m.
const DAMPING: f64 = 200.0;
/// Largest pull of the position control of a motor, in multiples of t_min.
const LARGEST_PULL: f64 = 1.2;

/// Time constant of the low-pass filter on the tensions, s.
const SMOOTHING: f64 = 0.003;

/// Time in which the tensions rise to the pretension, s.
const RISING: f64 = 0.2;

/// Limit of the torque of the spring that holds the joints, N cm. The bounds of the tensions limit this torque, so it
/// needs no limit of its own.
const UNLIMITED: f64 = f64::INFINITY;

/// The constant part of the tightening.
#[derive(Clone, Debug)]
pub(crate) struct Tightening {
    period: f64,
    hold: JointHold,
    /// t_min, N.
    minimum: f64,
    /// Tensions of eq. 20 at zero joint torque, N.
    pretension: Vector4<f64>,
}

/// The progress of the tightening.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) enum TighteningState {
    /// Each motor winds in, or waits for the others.
    Winding(Winding),
    /// All tendons are taut, and the tensions rise.
    Rising {
        /// The joint angles that are held, rad.
        joints: Vector3<f64>,
        seconds: f64,
    },
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Winding {
    seconds: f64,
    /// The position at which every motor is held, m of tendon.
    target: Vector4<f64>,
    /// Whether each motor has detected tension in its tendon.
    felt: [bool; 4],
    /// The length that every motor has wound in, m.
    wound: Vector4<f64>,
    /// Low-pass filtered tensions, N.
    tensions: Vector4<f64>,
    /// The lowest filtered tensions so far, N.
    lowest: Vector4<f64>,
}

/// The joints as they are measured in a cycle.
pub(crate) struct Joints {
    /// Joint angles, rad.
    pub angles: Vector3<f64>,
    /// Joint rates, rad/s.
    pub rates: Vector3<f64>,
}

/// The command of a cycle.
pub(crate) enum Tightened {
    /// Pulls at the tendon, N.
    Pull(Vector4<f64>),
    /// Joint torques, N cm. The tensions that produce them are reduced by `below`, N. `begins` is true in the first
    /// such cycle.
    Hold { torques: Vector3<f64>, below: Vector4<f64>, begins: bool },
}

impl Tightening {
    /// Constructs the tightening. `minimum` is t_min, N, and `rate` is in Hz.
    pub fn new(links: Links, tendons: &Tendons, minimum: f64, rate: f64) -> Self {
        Self { period: 1.0 / rate, hold: JointHold::new(links), minimum, pretension: tendons.pretension(minimum) }
    }

    pub fn start(&self, now: &Slackness) -> TighteningState {
        let Slackness { travel, tensions, .. } = *now;
        TighteningState::Winding(Winding {
            seconds: 0.0,
            target: travel,
            felt: [false; 4],
            wound: Vector4::zeros(),
            tensions,
            lowest: tensions,
        })
    }

    /// Returns the tendon that is farthest from being under tension, 0 to 3.
    pub fn slackest(&self, slack: &TighteningState, now: &Slackness) -> usize {
        match slack {
            TighteningState::Winding(winding) => winding.wound.imax(),
            TighteningState::Rising { .. } => now.tensions.imin(),
        }
    }

    pub fn step(&self, slack: &mut TighteningState, now: &Slackness, joints: &Joints) -> Tightened {
        match slack {
            TighteningState::Winding(winding) => {
                if self.wind(winding, now) {
                    *slack = TighteningState::Rising { joints: joints.angles, seconds: 0.0 };
                    return self.rise(&joints.angles, 0.0, joints);
                }
                let strongest = LARGEST_PULL * self.minimum;
                let pulls = (winding.target - now.travel) * STIFFNESS - now.speeds * DAMPING;
                Tightened::Pull(pulls.map(|pull| pull.clamp(-strongest, strongest)))
            }
            TighteningState::Rising { joints: held, seconds } => {
                *seconds += self.period;
                self.rise(held, *seconds, joints)
            }
        }
    }

    /// Advances every motor that has not yet detected tension. Returns whether all tendons are taut at the same time.
    fn wind(&self, winding: &mut Winding, now: &Slackness) -> bool {
        winding.seconds += self.period;
        winding.tensions += (now.tensions - winding.tensions) * (self.period / SMOOTHING).min(1.0);
        winding.lowest = winding.lowest.inf(&winding.tensions);
        let step = (SPEED + ACCELERATION * winding.seconds) * self.period;
        let mut all = true;
        for motor in 0..4 {
            let tension = winding.tensions[motor];
            let taut = tension > TAUT * self.minimum || tension - winding.lowest[motor] > DETECTED * self.minimum;
            all &= taut;
            if taut && !winding.felt[motor] {
                winding.felt[motor] = true;
                winding.target[motor] = now.travel[motor];
            }
            if !winding.felt[motor] {
                winding.target[motor] += step;
                winding.wound[motor] += step;
            }
        }
        if winding.felt == [true; 4] && !all {
            // A tendon that came taut later has moved the finger toward the motors that waited, and their tendons are
            // slack again.
            winding.felt = [false; 4];
        }
        all
    }

    fn rise(&self, held: &Vector3<f64>, seconds: f64, joints: &Joints) -> Tightened {
        let torques = self.hold.torques(&(held - joints.angles), &joints.rates, UNLIMITED);
        // The rise begins at about the tensions that the motors have detected.
        let missing = (1.0 - seconds / RISING).max(0.0) * (1.0 - DETECTED);
        Tightened::Hold { torques, below: self.pretension * missing, begins: seconds == 0.0 }
    }
}
