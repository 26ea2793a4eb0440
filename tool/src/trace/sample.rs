//! A cycle in the terms of its user.

use sun2xp::control::{Activity, Report};
use sun2xp::finger::{CycleRecord, Origin};
use sun2xp::nalgebra::{Matrix3, Vector3};

/// A cycle of a finger. Lengths are in cm, forces in N, torques in N cm, stiffnesses in N/cm, angles in rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    pub finger: i32,
    pub cycle: u64,
    pub began: u64,
    pub computed: bool,
    pub joints: [f64; 3],
    pub joint_rates: [f64; 3],
    pub joint_set_point: Option<[f64; 3]>,
    pub tip: [f64; 3],
    pub tip_set_point: Option<[f64; 3]>,
    pub tip_force: [f64; 3],
    pub kx: Option<[[f64; 3]; 3]>,
    pub stiffness: [[f64; 3]; 3],
    pub joint_torques: [f64; 3],
    pub measured_joint_torques: [f64; 3],
    pub desired_tensions: [f64; 4],
    pub tensions: [f64; 4],
    pub t_min: f64,
    pub t_max: f64,
    pub motor_torques: [f64; 4],
    pub torque_scale: f64,
    pub stiffness_scale: f64,
    pub contact_force: [f64; 3],
    pub touching: bool,
    pub slide: f64,
    pub wake_up: Option<f64>,
    pub whole: Option<f64>,
}

impl Sample {
    pub fn new(origin: &Origin, record: &CycleRecord<String>) -> Self {
        let report = record.control.map_or_else(Report::default, |control| control.report);
        let number = record.control.map_or(0, |control| control.controller);
        let source = origin.controllers.iter().find(|source| source.number == number).unwrap_or(&origin.controllers[0]);
        let (links, r) = (source.finger.links(), source.finger.r());
        let set_point = record.control.and_then(|control| match control.input.activity {
            Activity::Follow(set_point) => Some(set_point),
            _ => None,
        });
        let torques = r * report.tensions;
        let jacobian = links.jacobian(&report.joints);
        let force = jacobian.transpose().try_inverse().map_or_else(Vector3::zeros, |inverse| inverse * torques);
        let timing: Vec<Option<f64>> =
            serde_json::to_value(record.timing).and_then(serde_json::from_value).unwrap_or_default();
        let time = |index: usize| timing.get(index).copied().flatten().map(|ns| ns * 1e-3);
        let kx = set_point.map(|set_point| set_point.stiffness.fixed_view::<3, 3>(0, 0).into_owned());
        let rows = |matrix: &Matrix3<f64>| [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)]));
        Self {
            finger: origin.finger,
            cycle: record.cycle,
            began: record.began,
            computed: record.control.is_some(),
            joints: report.joints.into(),
            joint_rates: report.joint_rates.into(),
            joint_set_point: set_point.map(|set_point| set_point.joints.into()),
            tip: links.tip(&report.joints).into(),
            tip_set_point: set_point.map(|set_point| links.tip(&set_point.joints).into()),
            tip_force: force.into(),
            kx: kx.as_ref().map(rows),
            stiffness: kx.map_or([[0.0; 3]; 3], |kx| rows(&(kx * report.stiffness_scale))),
            joint_torques: report.joint_torques.into(),
            measured_joint_torques: torques.into(),
            desired_tensions: report.desired_tensions.into(),
            tensions: report.tensions.into(),
            t_min: source.finger.tendon.minimum,
            t_max: source.finger.tendon.maximum,
            motor_torques: report.motor_torques.into(),
            torque_scale: report.torque_scale,
            stiffness_scale: report.stiffness_scale,
            contact_force: (-report.contact.force).into(),
            touching: report.contact.touching,
            slide: report.contact.slide,
            wake_up: time(0),
            whole: time(6),
        }
    }
}
