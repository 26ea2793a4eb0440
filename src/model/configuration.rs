//! The types of a hand's configuration, with defaults for everything: the finger of the report and plausible values for
//! what the report leaves out. Reading them from a file is the business of the hand; checking them is done here.

pub use crate::model::calibrated::{ConfiguredZeroing, ZeroingMethod};
use crate::model::{ConfiguredFriction, ConfiguredLinks, ConfiguredSimulation, Links, Tendons, TendonsError};
use nalgebra::{Isometry3, Matrix3, Matrix3x4, RowVector4, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// How many fingers a hand has.
pub const FINGERS: usize = 3;

/// A key whose value cannot be used, and why. The key is relative to the finger's table, with dots: `tendon.maximum`.
#[derive(Clone, Debug, PartialEq)]
pub struct Unusable {
    /// Dotted path of the key.
    pub key: &'static str,
    /// Why, with the numbers, and what would be usable.
    pub reason: String,
}

/// What happens to the motors when commands stop: by CloseHand, by exit, or by the planner's death.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EndState {
    /// Torque goes to zero: in a ramp while the servo lives, at once where only the board is left to do it.
    #[default]
    Release,
    /// The board keeps the last torque, within `hold_torque_limit`, for `hold_time_ms`; then it releases.
    Hold,
}

/// What happens to a command outside the limits.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OutOfRange {
    /// ERANGE, and nothing changes.
    #[default]
    Refuse,
    /// The nearest admissible value is taken.
    Clamp,
}

/// `[hand]`: what all fingers share.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredHand {
    /// Cycles of every finger servo in a second, Hz: 100 to 5000.
    pub rate: f64,
    /// What the board does when commands stop.
    pub end_state: EndState,
    /// How long *hold* holds, ms: 1 to 60 000.
    pub hold_time_ms: u16,
    /// Largest motor torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// How long CloseHand takes to ramp the torque down with *release*, ms: 0 to 5000.
    pub release_ramp_ms: u16,
    /// Silence after which the board goes to its end state, ms: 2 to 1000.
    pub watchdog_ms: u16,
    /// How long a board may take to answer, and a finger to come under tension, at open, ms.
    pub open_timeout_ms: u32,
    /// What happens to a command outside the limits.
    pub out_of_range: OutOfRange,
    /// One line on standard error at the first refusal of each kind.
    pub print_refusals: bool,
    /// Gravity in palm coordinates, m/s^2.
    pub gravity: [f64; 3],
}

/// `[finger]`, overridden by `[finger.1]` to `[finger.3]`: one finger, its port, thread and controller.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredFinger {
    /// Path of the serial port, or `simulated`.
    pub port: String,
    /// Bits a second on the port.
    pub baud: u32,
    /// Address of the finger on its board, 1 to 15; 0: the finger's number.
    pub address: u8,
    /// Servo thread that runs the finger, 1 to 3; 0: the finger's number. Fingers on one port share a thread.
    pub thread: u8,
    /// Core the thread is bound to; none: the kernel chooses.
    pub core: Option<usize>,
    /// SCHED_FIFO priority of the thread, 1 to 99; 0: not real-time.
    pub priority: u8,
    /// Where the base of the finger is in the palm, cm; none: where the finger with this number is.
    pub base: Option<[f64; 3]>,
    /// Turn of the finger's frame about the palm's z axis, degrees; none: that of the finger with this number.
    pub turn_degrees: Option<f64>,
    /// `[finger.geometry]`
    pub geometry: ConfiguredGeometry,
    /// `[finger.motor]`
    pub motor: ConfiguredMotor,
    /// `[finger.encoder]`
    pub encoder: ConfiguredEncoder,
    /// `[finger.gauge]`
    pub gauge: ConfiguredGauge,
    /// `[finger.tendon]`
    pub tendon: ConfiguredTendon,
    /// `[finger.joints]`
    pub joints: ConfiguredJoints,
    /// `[finger.links]`
    pub links: ConfiguredLinks,
    /// `[finger.friction]`
    pub friction: ConfiguredFriction,
    /// `[finger.zeroing]`
    pub zeroing: ConfiguredZeroing,
    /// `[finger.stiffness]`
    pub stiffness: ConfiguredStiffness,
    /// `[finger.controller]`
    pub controller: ConfiguredController,
    /// `[finger.simulation]`
    pub simulation: ConfiguredSimulation,
}

/// `[finger.geometry]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGeometry {
    /// l0, l1, l2, cm.
    pub links: [f64; 3],
    /// R of eq. 14, cm: three rows (joints) of four entries (tendons).
    pub r: [[f64; 4]; 3],
    /// The ghost row of eq. 15; none: the null vector of R.
    pub ghost_row: Option<[f64; 4]>,
    /// Equivalent shaft radius of each motor, cm: tension = torque / radius.
    pub motor_radius: [f64; 4],
}

/// `[finger.motor]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredMotor {
    /// +1 where a positive command pulls the tendon, else -1.
    pub sign: [i8; 4],
    /// Largest torque of each motor, N cm.
    pub torque_limit: [f64; 4],
    /// Torque constant, N cm/A. The board is told, so that it can turn torque into current.
    pub torque_constant: [f64; 4],
    /// Inertia of each rotor, gear included, kg m^2.
    pub inertia: [f64; 4],
    /// Viscous friction of each motor, N m s/rad.
    pub viscous_friction: [f64; 4],
    /// Torque that each motor can give for ever, N cm.
    pub continuous_torque: [f64; 4],
    /// Thermal time constant of the motors, s.
    pub thermal_time: f64,
}

/// `[finger.encoder]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredEncoder {
    /// Counts a revolution of the motor.
    pub counts_per_revolution: [u32; 4],
    /// +1 where the count rises as the tendon is pulled in, else -1.
    pub sign: [i8; 4],
    /// m_0 of eq. 28: the count at theta = 0 with the homing pretension.
    pub zero: [i32; 4],
}

/// `[finger.gauge]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGauge {
    /// Tension of one count, N.
    pub newton_per_count: [f64; 4],
    /// Count without tension.
    pub zero: [f64; 4],
}

/// `[finger.tendon]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredTendon {
    /// t_min of eq. 19, N. Also the homing pretension.
    pub minimum: f64,
    /// t_max, N.
    pub maximum: f64,
    /// Stiffness between motor pulley and joint, N/cm, for the stretch that the encoders do not see.
    pub stiffness: [f64; 4],
}

/// `[finger.joints]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredJoints {
    /// Lower soft limits, degrees.
    pub minimum_degrees: [f64; 3],
    /// Upper soft limits, degrees.
    pub maximum_degrees: [f64; 3],
}

/// `[finger.stiffness]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredStiffness {
    /// Kx that the finger holds its pose with after OpenHand, N/cm, row-major.
    pub initial: [[f64; 3]; 3],
    /// Bound on the largest eigenvalue of Kx, N/cm; none: 6 from 1000 Hz up, 5 below.
    pub bound: Option<f64>,
}

/// Which tendon controller runs.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
pub enum Scheme {
    /// Figure 9: an integral on the tension error.
    #[serde(rename = "figure 9")]
    Figure9,
    /// Figure 10 (Salisbury): proportional and integral on the tension error, and a damper on the motor.
    #[default]
    #[serde(rename = "figure 10")]
    Figure10,
    /// Feedback of the whole state of links, elastic tendons and motors.
    #[serde(rename = "state feedback")]
    StateFeedback,
}

/// How the torque of the fingertip's spring is found.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// tau = J^T Kx J (theta_d - theta), eqs. 3 and 6: the spring for small deflections.
    #[default]
    Report,
    /// tau = J^T Kx (x_d - x): the spring at any deflection, but blind to which of two joint solutions has the tip at x_d.
    Exact,
}

/// `[finger.controller]`. What is left out is chosen for the rate.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredController {
    /// The tendon controller.
    pub scheme: Scheme,
    /// The stiffness law behind SendPos. A fingertip set point always has the exact one.
    pub law: Law,
    /// Whether the torques of gravity on the links are compensated.
    pub gravity_compensation: bool,
    /// K_T, dimensionless: tension commanded for a tension error.
    pub tension_gain: Option<f64>,
    /// K_TI, 1/s.
    pub tension_integral: Option<f64>,
    /// K_delta at the tendon, N s/m.
    pub motor_damping: Option<f64>,
    /// beta at 3 N/cm and a bent finger, s: joint rate against joint angle in the stiffness law; scaled with
    /// 1/sqrt(K_theta).
    pub rate_time: Option<f64>,
    /// Low-pass of the motor speeds, Hz.
    pub speed_filter: Option<f64>,
    /// Low-pass of the tensions that the tendon stretch is computed from, Hz.
    pub stretch_filter: Option<f64>,
    /// Bound on the speed of every joint of the set point, rad/s: a step becomes a straight line in joint space.
    pub set_point_speed: Option<f64>,
    /// State feedback: alpha, tension commanded for a tension error; the motors then feel 1/alpha of their inertia.
    pub inertia_gain: Option<f64>,
    /// State feedback: damping ratio of the spring.
    pub damping_ratio: Option<f64>,
    /// State feedback: time constant of each of the five poles that the set point passes, s.
    pub set_point_time: Option<f64>,
    /// State feedback: amplitude of the dither over the Coulomb friction of the joints; 0: none.
    pub dither: Option<f64>,
}

/// A whole hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Configuration {
    /// What all fingers share.
    pub hand: ConfiguredHand,
    /// Fingers 1, 2 and 3.
    pub fingers: [ConfiguredFinger; FINGERS],
}

impl Configuration {
    /// The servo thread of a finger, 1 to 3.
    pub fn thread(&self, finger: usize) -> u8 {
        own_or(self.fingers[finger].thread, finger)
    }

    /// The address of a finger on its board, 1 to 15.
    pub fn address(&self, finger: usize) -> u8 {
        own_or(self.fingers[finger].address, finger)
    }

    /// From the finger's frame (Figure 8), cm, to the palm's. Two fingers stand side by side, the thumb faces them.
    pub fn finger_to_palm(&self, finger: usize) -> Isometry3<f64> {
        let (base, turn) = match finger {
            0 => ([3.0, 3.5, 0.0], 0.0),
            1 => ([-3.0, 3.5, 0.0], 0.0),
            _ => ([0.0, -3.5, 0.0], 180.0),
        };
        let configured = &self.fingers[finger];
        let base = Vector3::from(configured.base.unwrap_or(base));
        let turn = configured.turn_degrees.unwrap_or(turn).to_radians();
        Isometry3::new(base, Vector3::z() * turn)
    }

    /// Gravity in the finger's frame, m/s^2.
    pub fn gravity(&self, finger: usize) -> Vector3<f64> {
        self.finger_to_palm(finger).rotation.inverse() * Vector3::from(self.hand.gravity)
    }
}

fn own_or(configured: u8, finger: usize) -> u8 {
    // At most three fingers: the conversion cannot fail.
    if configured == 0 { finger as u8 + 1 } else { configured }
}

impl Default for ConfiguredHand {
    fn default() -> Self {
        Self {
            rate: 1000.0,
            end_state: EndState::Release,
            hold_time_ms: 2000,
            hold_torque_limit: 1.0,
            release_ramp_ms: 200,
            watchdog_ms: 20,
            open_timeout_ms: 5000,
            out_of_range: OutOfRange::Refuse,
            print_refusals: true,
            gravity: [0.0; 3],
        }
    }
}

impl Default for ConfiguredFinger {
    fn default() -> Self {
        Self {
            port: "simulated".into(),
            baud: 1_000_000,
            address: 0,
            thread: 0,
            core: None,
            priority: 80,
            base: None,
            turn_degrees: None,
            geometry: Default::default(),
            motor: Default::default(),
            encoder: Default::default(),
            gauge: Default::default(),
            tendon: Default::default(),
            joints: Default::default(),
            links: Default::default(),
            friction: Default::default(),
            zeroing: Default::default(),
            stiffness: Default::default(),
            controller: Default::default(),
            simulation: Default::default(),
        }
    }
}

impl Default for ConfiguredGeometry {
    fn default() -> Self {
        Self {
            links: [3.556, 5.080, 4.000],
            // Entry (2, 4) is -1.09: the report prints +1.09, with which R is singular; eq. 14 has -r24.
            r: [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, -1.09], [0.0, 0.62, -0.62, 0.0]],
            ghost_row: None,
            motor_radius: [0.0475; 4],
        }
    }
}

impl Default for ConfiguredMotor {
    fn default() -> Self {
        Self {
            sign: [1; 4],
            torque_limit: [4.75; 4],
            torque_constant: [2.34; 4],
            inertia: [6e-7; 4],
            viscous_friction: [2e-6; 4],
            continuous_torque: [2.5; 4],
            thermal_time: 15.0,
        }
    }
}

impl Default for ConfiguredEncoder {
    fn default() -> Self {
        Self { counts_per_revolution: [2000; 4], sign: [1; 4], zero: [0; 4] }
    }
}

impl Default for ConfiguredGauge {
    fn default() -> Self {
        Self { newton_per_count: [100.0 / 4095.0; 4], zero: [0.0; 4] }
    }
}

impl Default for ConfiguredTendon {
    fn default() -> Self {
        Self { minimum: 5.0, maximum: 60.0, stiffness: [300.0; 4] }
    }
}

impl Default for ConfiguredJoints {
    fn default() -> Self {
        Self { minimum_degrees: [-60.0, -30.0, 5.0], maximum_degrees: [60.0, 100.0, 120.0] }
    }
}

impl Default for ConfiguredStiffness {
    fn default() -> Self {
        Self { initial: [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]], bound: None }
    }
}

impl Default for ConfiguredController {
    fn default() -> Self {
        Self {
            scheme: Scheme::default(),
            law: Law::default(),
            gravity_compensation: true,
            tension_gain: None,
            tension_integral: None,
            motor_damping: None,
            rate_time: None,
            speed_filter: None,
            stretch_filter: None,
            set_point_speed: None,
            inertia_gain: None,
            damping_ratio: None,
            set_point_time: None,
            dither: None,
        }
    }
}

impl ConfiguredFinger {
    /// Whether the finger has a simulated board instead of a port.
    pub fn simulated(&self) -> bool {
        self.port == "simulated"
    }

    /// The links.
    pub fn links(&self) -> Links {
        Links(self.geometry.links)
    }

    /// R of eq. 14, cm.
    pub fn r(&self) -> Matrix3x4<f64> {
        Matrix3x4::from_fn(|joint, tendon| self.geometry.r[joint][tendon])
    }

    /// R, Q and M.
    pub fn tendons(&self) -> Result<Tendons, TendonsError> {
        let ghost = self.geometry.ghost_row.map(RowVector4::from);
        Tendons::new(self.r(), Vector4::from(self.geometry.motor_radius), ghost)
    }

    /// The initial Kx, N/cm.
    pub fn initial_stiffness(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.stiffness.initial[row][column])
    }

    /// The bound on the largest eigenvalue of Kx, N/cm, at `rate` Hz.
    pub fn stiffness_bound(&self, rate: f64) -> f64 {
        self.stiffness.bound.unwrap_or(if rate >= 1000.0 { 6.0 } else { 5.0 })
    }

    /// Soft joint limits, rad: lower, upper.
    pub fn joint_limits(&self) -> (Vector3<f64>, Vector3<f64>) {
        let radians = |degrees: [f64; 3]| Vector3::from(degrees.map(f64::to_radians));
        (radians(self.joints.minimum_degrees), radians(self.joints.maximum_degrees))
    }
}
