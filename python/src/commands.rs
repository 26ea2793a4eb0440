//! The methods of `Hand` that send set points and paths.

use crate::arguments::{self, as_array, list, numbers, optional, rows, vector};
use crate::errors::Refusal;
use crate::hand::Hand;
use crate::waiting::validity;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use sun2xp::groups::{FingerCommand, Pose};
use sun2xp::model::FingerNumber;
use sun2xp::motion::PathPose;
use sun2xp::nalgebra::{Matrix3, Matrix4, Matrix6, Vector3};
use sun2xp::{Contact, ContactError, HandError, SetPointError};

#[pymethods]
impl Hand {
    /// Sends the desired angles of joints 0, 1 and 2 of a finger, rad: shape (3,). They take effect within a cycle.
    /// `valid` is the time for which they are valid, s. If it is infinite, they do not expire. Without it, the
    /// configured time `motion.valid_ms` applies.
    #[pyo3(signature = (finger, position, *, valid=None))]
    fn send_position(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        position: &Bound<'_, PyAny>,
        valid: Option<f64>,
    ) -> PyResult<()> {
        let joints = vector(position, "position")?;
        match validity(py, valid)? {
            None => self.quick(py, |hand| hand.send_position(finger, joints)),
            valid => self.quick(py, |hand| hand.send_position_for(finger, joints, valid)),
        }
    }

    /// Sends the desired position of a fingertip in the finger's frame, cm: shape (3,).
    fn send_tip(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        tip: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let tip = vector(tip, "tip")?;
        self.quick(py, |hand| hand.send_tip(finger, tip))
    }

    /// Sends the stiffness Kx of a fingertip in the finger's frame, N/cm: shape (3, 3), symmetric.
    fn send_stiffness(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        stiffness: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let rows = rows(stiffness, "stiffness")?;
        self.quick(py, |hand| hand.send_stiffness(finger, rows))
    }

    /// Sends the stiffness of a contact. The shape of the stiffness selects the type of the contact: a number, N/cm,
    /// with a normal for a frictionless point; (3, 3), N/cm, for a hard finger; (4, 4) with a normal for a soft finger;
    /// (6, 6) for any contact. In the (4, 4) matrix, row 3 and column 3 belong to the rotation about the normal:
    /// N/rad, and N cm/rad on the diagonal. The normal is in the finger's frame.
    #[pyo3(signature = (finger, stiffness, normal=None))]
    fn send_contact(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        stiffness: &Bound<'_, PyAny>,
        normal: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let contact = contact(py, stiffness, normal)?;
        self.quick(py, |hand| {
            let finger = FingerNumber::try_from(finger)?;
            let contact = contact.map_err(|source| SetPointError::Contact { finger, source })?;
            hand.send_contact(finger.get(), contact)
        })
    }

    /// Sends the stiffness of the joints of a finger, N cm/rad: shape (3, 3), symmetric. It replaces the
    /// stiffness of the tip.
    fn send_joint_stiffness(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        stiffness: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let rows = rows(stiffness, "stiffness")?;
        self.quick(py, |hand| hand.send_joint_stiffness(finger, rows))
    }

    /// Sends a constant torque of joints 0, 1 and 2 of a finger, N cm: shape (3,). It acts in addition to the spring.
    fn send_joint_torque(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        torque: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let torque = vector(torque, "torque")?;
        self.quick(py, |hand| hand.send_joint_torque(finger, torque))
    }

    /// Sends the damping of a finger, relative to the damping that the controller chooses. The ratio is 1 after open.
    fn send_damping(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        ratio: f64,
    ) -> PyResult<()> {
        self.quick(py, |hand| hand.send_damping(finger, ratio))
    }

    /// Sends set points of several fingers, which take effect in the same cycle.
    fn send_group(&self, py: Python<'_>, set_points: Vec<Bound<'_, PyAny>>) -> PyResult<()> {
        let commands: Vec<FingerCommand> = set_points.iter().map(command).collect::<PyResult<_>>()?;
        self.quick(py, |hand| hand.send_group(&commands))
    }

    /// Sends a path. `times` are the times of the poses since the beginning of the path, s: shape (n,). The poses are
    /// `joints`, rad, or `tips` in the finger's frame, cm: shape (n, 3). `stiffness` is Kx at each pose, N/cm: shape
    /// (n, 3, 3). `valid` is how long the path stays valid after its end, s, as in `send_position`.
    #[pyo3(signature = (finger, times, *, joints=None, tips=None, stiffness=None, valid=None))]
    #[expect(clippy::too_many_arguments, reason = "the keywords of a Python call")]
    fn send_path(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        times: &Bound<'_, PyAny>,
        joints: Option<&Bound<'_, PyAny>>,
        tips: Option<&Bound<'_, PyAny>>,
        stiffness: Option<&Bound<'_, PyAny>>,
        valid: Option<f64>,
    ) -> PyResult<()> {
        let times = list(times, "times")?;
        let count = times.len();
        let places = match (joints, tips) {
            (Some(joints), None) => numbers(joints, "joints", &[count, 3])?,
            (None, Some(tips)) => numbers(tips, "tips", &[count, 3])?,
            _ => {
                return Err(
                    Refusal::Argument("a path needs exactly one of the arguments joints and tips".into()).raise(py)
                );
            }
        };
        let stiffness = stiffness.map(|stiffness| numbers(stiffness, "stiffness", &[count, 3, 3])).transpose()?;
        let pose = |index: usize| {
            let place = std::array::from_fn(|axis| places[3 * index + axis]);
            if joints.is_some() { Pose::Joints(place) } else { Pose::Tip(place) }
        };
        let kx = |index: usize, all: &Vec<f64>| {
            std::array::from_fn(|row| std::array::from_fn(|column| all[9 * index + 3 * row + column]))
        };
        let of_pose = |(index, &time): (usize, &f64)| PathPose {
            time,
            pose: pose(index),
            stiffness: stiffness.as_ref().map(|all| kx(index, all)),
        };
        let poses: Vec<PathPose> = times.iter().enumerate().map(of_pose).collect();
        let valid = validity(py, valid)?;
        self.slow(py, |hand| hand.send_path(finger, &poses, valid))
    }

    /// Changes keys of the configuration of a finger while it runs, such as "tendon.minimum = 6".
    fn adjust(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        keys: &str,
    ) -> PyResult<()> {
        self.slow(py, |hand| hand.adjust(finger, keys))
    }

    /// Sets gravity in the palm's frame, m/s^2: shape (3,), until the hand is closed.
    fn set_gravity(&self, py: Python<'_>, gravity: &Bound<'_, PyAny>) -> PyResult<()> {
        let gravity = vector(gravity, "gravity")?;
        self.slow(py, |hand| hand.set_gravity(gravity))
    }

    /// Pushes the tip of a simulated finger with a force in the finger's frame, N: shape (3,). The force acts until the
    /// next call of `push` for this finger.
    fn push(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        force: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let force = vector(force, "force")?;
        self.slow(py, |hand| hand.push_simulated(finger, force))
    }
}

/// Returns the contact with this stiffness. The inner error does not name the finger: the caller adds its number.
fn contact(
    py: Python<'_>,
    stiffness: &Bound<'_, PyAny>,
    normal: Option<&Bound<'_, PyAny>>,
) -> PyResult<Result<Contact, ContactError>> {
    let shape = as_array(stiffness, "stiffness")?.shape().to_vec();
    let numbers = numbers(stiffness, "stiffness", &shape)?;
    let direction = normal.map(|normal| vector(normal, "normal")).transpose()?.map(Vector3::from);
    Ok(match (shape.as_slice(), direction) {
        ([], Some(normal)) => Contact::frictionless_point(numbers[0], normal),
        ([3, 3], None) => Contact::hard_finger(Matrix3::from_row_slice(&numbers)),
        ([4, 4], Some(normal)) => Contact::soft_finger(Matrix4::from_row_slice(&numbers), normal),
        ([6, 6], None) => Contact::general(&Matrix6::from_row_slice(&numbers), &Matrix6::identity()),
        _ => {
            let text = "there is no such contact: pass one stiffness and a normal for a frictionless point, a 3 x 3 \
                        stiffness for a hard finger, a 4 x 4 stiffness and a normal for a soft finger, or the 6 x 6 \
                        stiffness of any contact";
            return Err(Refusal::Argument(text.into()).raise(py));
        }
    })
}

/// Converts a `SetPoint`.
fn command(set_point: &Bound<'_, PyAny>) -> PyResult<FingerCommand> {
    let finger = arguments::finger(&set_point.getattr("finger")?)?;
    let mut command = FingerCommand::new(finger);
    let (position, tip) = (optional(set_point, "position")?, optional(set_point, "tip")?);
    if position.is_some() && tip.is_some() {
        let refusal = HandError::SetPoint(SetPointError::TwoPoses(finger));
        return Err(Refusal::Hand(refusal).raise(set_point.py()));
    }
    if let Some(position) = position {
        command = command.joints(vector(&position, "position")?);
    }
    if let Some(tip) = tip {
        command = command.tip(vector(&tip, "tip")?);
    }
    if let Some(stiffness) = optional(set_point, "stiffness")? {
        command = command.stiffness(rows(&stiffness, "stiffness")?);
    }
    if let Some(damping) = optional(set_point, "damping")? {
        command = command.damping(damping.extract()?);
    }
    Ok(command)
}
