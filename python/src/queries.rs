//! The methods of `Hand` that read the state of a finger.

use crate::arguments::{self, vector as vector_of};
use crate::errors::Refusal;
use crate::hand::Hand;
use crate::records::{self, matrix, vector};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sun2xp::realtime::CycleStage;

/// The names of the stages of a cycle, in the order of `CycleStage::ALL`.
const STAGES: [&str; CycleStage::ALL.len()] = ["wake_up", "write", "wire", "read", "decode", "compute", "cycle", "age"];

#[pymethods]
impl Hand {
    /// The measured angles of joints 0, 1 and 2 of a finger, rad, from the last cycle: shape (3,).
    fn position<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let joints = self.quick(py, |hand| hand.position(finger))?;
        Ok(vector(py, &joints))
    }

    /// Position, force and stiffness of a fingertip, and the tendon tensions, from the last cycle.
    fn tip<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let tip = self.quick(py, |hand| hand.fingertip(finger))?;
        records::tip(py, &tip)
    }

    /// The stage of a finger, the rate and the errors of its servo.
    fn status<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let status = self.quick(py, |hand| hand.status(finger))?;
        records::status(py, &status)
    }

    /// The fault that has stopped a finger, and its warnings.
    fn fault<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let fault = self.quick(py, |hand| hand.fault(finger))?;
        records::finger_fault(py, &fault)
    }

    /// How long one stage of a finger's cycle took, as a distribution over the cycles.
    #[pyo3(signature = (finger, stage="wake_up"))]
    fn timing<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        stage: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Some(place) = STAGES.iter().position(|name| *name == stage) else {
            let text = format!("there is no stage {stage:?}: the stages of a cycle are {}", STAGES.join(", "));
            return Err(Refusal::Argument(text).raise(py));
        };
        let timing = self.quick(py, |hand| hand.timing(finger, CycleStage::ALL[place]))?;
        records::distribution(py, &timing)
    }

    /// Resets timings and losses of a finger.
    fn reset_timing(&self, py: Python<'_>, #[pyo3(from_py_with = arguments::finger)] finger: i32) -> PyResult<()> {
        self.quick(py, |hand| hand.reset_timing(finger))
    }

    /// Numbers of cycles and errors of a finger since open or the last reset.
    fn losses<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let losses = self.quick(py, |hand| hand.losses(finger))?;
        records::losses(py, &losses)
    }

    /// Measured and commanded joint torques of a finger, N cm, from the last cycle.
    fn joint_torques<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let torques = self.quick(py, |hand| hand.joint_torques(finger))?;
        let fields = PyDict::new(py);
        fields.set_item("measured", vector(py, &torques.measured))?;
        fields.set_item("commanded", vector(py, &torques.commanded))?;
        records::record(py, "JointTorques", &fields)
    }

    /// Angles, rates and torques of the joints of a finger in its last cycle, and the time of this cycle.
    fn joint_state<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (report, torques) = self.quick(py, |hand| Ok((hand.report(finger)?, hand.joint_torques(finger)?)))?;
        let fields = PyDict::new(py);
        fields.set_item("time", report.last)?;
        fields.set_item("position", vector(py, &report.cycle.joints.into()))?;
        fields.set_item("rate", vector(py, &report.cycle.joint_rates.into()))?;
        fields.set_item("torque", vector(py, &torques.measured))?;
        records::record(py, "JointState", &fields)
    }

    /// Pose of a finger and of its tip in the palm's frame.
    fn palm_pose<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let pose = self.quick(py, |hand| hand.palm_pose(finger))?;
        let fields = PyDict::new(py);
        fields.set_item("base", vector(py, &pose.base))?;
        fields.set_item("rotation", matrix(py, &pose.rotation)?)?;
        fields.set_item("tip", vector(py, &pose.tip))?;
        fields.set_item("tip_rotation", matrix(py, &pose.tip_rotation)?)?;
        records::record(py, "PalmPose", &fields)
    }

    /// The Jacobian of a fingertip, cm/rad, at these joint angles or at the measured ones: shape (3, 3).
    #[pyo3(signature = (finger, position=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        position: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let joints = position.map(|position| vector_of(position, "position")).transpose()?;
        let jacobian = self.quick(py, |hand| hand.jacobian(finger, joints))?;
        matrix(py, &jacobian)
    }

    /// The position of a fingertip in the finger's frame, cm, at these joint angles, rad: shape (3,).
    fn forward_kinematics<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        position: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let joints = vector_of(position, "position")?;
        let tip = self.quick(py, |hand| hand.tip_at(finger, joints))?;
        Ok(vector(py, &tip))
    }

    /// The joint angles, rad, at which a fingertip is at this position in the finger's frame, cm: shape (3,).
    fn inverse_kinematics<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        tip: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let tip = vector_of(tip, "tip")?;
        let joints = self.quick(py, |hand| hand.joints_at(finger, tip))?;
        Ok(vector(py, &joints))
    }

    /// The limits of a finger, from its configuration in force.
    fn limits<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (limits, configured) = self.quick(py, |hand| Ok((hand.limits(finger)?, hand.calibrated(finger)?)))?;
        let fields = PyDict::new(py);
        fields.set_item("joints", matrix(py, &[limits.joint_minimum, limits.joint_maximum])?)?;
        fields.set_item("tension", (limits.tension_minimum, limits.tension_maximum))?;
        fields.set_item("motor_torque", vector(py, &limits.motor_torque))?;
        fields.set_item("stiffness", limits.stiffness)?;
        fields.set_item("speed", configured.motion.speed)?;
        fields.set_item("acceleration", configured.motion.acceleration)?;
        fields.set_item("jerk", configured.motion.jerk)?;
        records::record(py, "Limits", &fields)
    }

    /// The hand as URDF, as `sun2xp model --urdf` writes it: lengths in m, masses in kg, angles in rad.
    fn urdf(&self, py: Python<'_>) -> PyResult<String> {
        let configuration = self.quick(py, |hand| Ok(hand.configuration()))?;
        Ok(sun2xp_tool::urdf(&configuration))
    }

    /// The finger's configuration in force, as JSON text.
    fn _configuration(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<String> {
        let configured = self.quick(py, |hand| hand.calibrated(finger))?;
        serde_json::to_string(&configured).map_err(|error| Refusal::Argument(error.to_string()).raise(py))
    }

    /// The state of the object that simulated fingers touch.
    fn object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let object = self.quick(py, sun2xp::Hand::object)?;
        let fields = PyDict::new(py);
        fields.set_item("time", object.time)?;
        fields.set_item("position", vector(py, &object.position))?;
        fields.set_item("rotation", matrix(py, &object.rotation)?)?;
        fields.set_item("velocity", vector(py, &object.velocity))?;
        fields.set_item("angular_velocity", vector(py, &object.angular_velocity))?;
        fields.set_item("forces", matrix(py, &object.forces)?)?;
        records::record(py, "ObjectState", &fields)
    }

    /// The newest reading of a tactile element of a finger. Elements are numbered from 0.
    fn touch<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        #[pyo3(from_py_with = arguments::element)] element: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let reading = self.quick(py, |hand| hand.touch(finger, element))?;
        let fields = PyDict::new(py);
        fields.set_item("valid", reading.valid)?;
        fields.set_item("pressed", reading.pressed)?;
        fields.set_item("count", reading.count)?;
        fields.set_item("force", reading.force)?;
        records::record(py, "TouchReading", &fields)
    }

    /// The number of tactile events of a finger that were lost since open.
    fn lost_touch_events(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<u64> {
        self.quick(py, |hand| hand.lost_touch_events(finger))
    }

    /// Sets the zero of each tactile element of a finger to the newest count of this element, and returns the zeros.
    fn tare_touch(&self, py: Python<'_>, #[pyo3(from_py_with = arguments::finger)] finger: i32) -> PyResult<Vec<u16>> {
        self.quick(py, |hand| hand.tare_touch(finger).and_then(|()| hand.touch_zeros(finger)))
    }

    /// Returns the time of `count` calls of the Rust function behind `position`, s. For the benchmark of the package.
    fn _time_position(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        count: u32,
    ) -> PyResult<f64> {
        let began = std::time::Instant::now();
        for _ in 0..count {
            std::hint::black_box(self.quick(py, |hand| hand.position(finger))?);
        }
        Ok(began.elapsed().as_secs_f64())
    }
}
