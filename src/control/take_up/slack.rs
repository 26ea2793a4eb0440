//! Taking up slack with the joints left where they are.
//!
//! A free finger gives way to the first tendon that comes taut until another one holds against it: wound in all
//! together, unequal slack turns the joints by more than a radian. So every motor winds slowly until it feels its
//! tendon, and waits there until all have. From then on the joints show, and are held while the tensions rise.

use crate::control::spring::joint_hold::JointHold;
use crate::model::{Links, Tendons};
use nalgebra::{Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Speed of winding, m/s of tendon, and what it grows by, m/s^2: little slack is taken up gently, much of it in time.
const SPEED: f64 = 0.003;
const HASTE: f64 = 0.002;

/// A tendon is felt when its tension has risen by this part of t_min from the lowest one, wherever the gauge has its
/// zero, or is at this part of t_min.
const FELT: f64 = 0.04;
const TAUT: f64 = 0.2;

/// Holding a motor: N/m, N s/m, largest pull in t_min.
const HOLD: f64 = 15_000.0;
const DAMPING: f64 = 200.0;
const STRONGEST: f64 = 1.2;

/// Time constant of the smoothed tensions, s.
const SMOOTHING: f64 = 0.003;

/// How long the tensions take to rise to the pretension, s.
const RISING: f64 = 0.2;

/// A spring of the joints that is not limited here: the tension bounds do that.
const UNLIMITED: f64 = f64::INFINITY;

/// What does not change from cycle to cycle.
#[derive(Clone, Debug)]
pub(crate) struct SlackTakeUp {
    period: f64,
    hold: JointHold,
    /// N, in the least pulled tendon.
    minimum: f64,
    /// N.
    pretension: Vector4<f64>,
}

/// How far it is.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) enum Slack {
    /// Motors wind in, or wait.
    Winding(Winding),
    /// All tendons are felt.
    Rising {
        /// Where the joints are held, rad.
        joints: Vector3<f64>,
        seconds: f64,
    },
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Winding {
    seconds: f64,
    /// Where every motor is held, m.
    target: Vector4<f64>,
    felt: [bool; 4],
    /// How much every motor has wound in, m.
    wound: Vector4<f64>,
    /// Smoothed, N.
    tensions: Vector4<f64>,
    /// The lowest of them so far.
    lowest: Vector4<f64>,
}

/// What a cycle has measured.
pub(crate) struct Slackness {
    /// m and m/s of tendon, positive in.
    pub travel: Vector4<f64>,
    pub speeds: Vector4<f64>,
    /// N.
    pub tensions: Vector4<f64>,
    /// rad and rad/s.
    pub joints: Vector3<f64>,
    pub joint_rates: Vector3<f64>,
}

/// What to do about it.
pub(crate) enum TakeUp {
    /// Pulls at the tendon, N.
    Pull(Vector4<f64>),
    /// Joint torques, N cm, with tensions this much below the usual ones, N.
    Hold { torques: Vector3<f64>, below: Vector4<f64>, begins: bool },
}

impl SlackTakeUp {
    /// `minimum`: t_min, N.
    pub fn new(links: Links, tendons: &Tendons, minimum: f64, rate: f64) -> Self {
        Self { period: 1.0 / rate, hold: JointHold::new(links), minimum, pretension: tendons.pretension(minimum) }
    }

    pub fn start(&self, now: &Slackness) -> Slack {
        let Slackness { travel, tensions, .. } = *now;
        Slack::Winding(Winding {
            seconds: 0.0,
            target: travel,
            felt: [false; 4],
            wound: Vector4::zeros(),
            tensions,
            lowest: tensions,
        })
    }

    /// The tendon that is farthest from being under tension, 0 to 3.
    pub fn slackest(&self, slack: &Slack, now: &Slackness) -> usize {
        match slack {
            Slack::Winding(winding) => winding.wound.imax(),
            Slack::Rising { .. } => now.tensions.imin(),
        }
    }

    pub fn step(&self, slack: &mut Slack, now: &Slackness) -> TakeUp {
        match slack {
            Slack::Winding(winding) => {
                if self.wind(winding, now) {
                    *slack = Slack::Rising { joints: now.joints, seconds: 0.0 };
                    return self.rise(&now.joints, 0.0, now);
                }
                let strongest = STRONGEST * self.minimum;
                let pulls = (winding.target - now.travel) * HOLD - now.speeds * DAMPING;
                TakeUp::Pull(pulls.map(|pull| pull.clamp(-strongest, strongest)))
            }
            Slack::Rising { joints, seconds } => {
                *seconds += self.period;
                self.rise(joints, *seconds, now)
            }
        }
    }

    /// Moves every motor that does not feel its tendon on; whether all do at once.
    fn wind(&self, winding: &mut Winding, now: &Slackness) -> bool {
        winding.seconds += self.period;
        winding.tensions += (now.tensions - winding.tensions) * (self.period / SMOOTHING).min(1.0);
        winding.lowest = winding.lowest.inf(&winding.tensions);
        let step = (SPEED + HASTE * winding.seconds) * self.period;
        let mut all = true;
        for motor in 0..4 {
            let tension = winding.tensions[motor];
            let taut = tension > TAUT * self.minimum || tension - winding.lowest[motor] > FELT * self.minimum;
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
            // What came taut later has moved the finger toward the motors that waited.
            winding.felt = [false; 4];
        }
        all
    }

    fn rise(&self, joints: &Vector3<f64>, seconds: f64, now: &Slackness) -> TakeUp {
        let torques = self.hold.torques(&(joints - now.joints), &now.joint_rates, UNLIMITED);
        let missing = (1.0 - seconds / RISING).max(0.0) * (1.0 - FELT);
        TakeUp::Hold { torques, below: self.pretension * missing, begins: seconds == 0.0 }
    }
}
