//! Samples as ROS 2 encodes messages: CDR with a schema in the language of ROS message files.

use sun2xp::telemetry::Sample;

/// Name of the schema.
pub const SCHEMA_NAME: &str = "sun2xp/msg/Cycle";

/// The schema. [`encode`] writes the fields in this order.
pub const SCHEMA: &str = include_str!("schemas/Cycle.msg");

/// Bytes before the fields: the encoding is CDR with the lowest byte first.
const HEADER: [u8; 4] = [0, 1, 0, 0];

/// Encodes a sample into `bytes`.
pub fn encode(sample: &Sample, bytes: &mut Vec<u8>) {
    bytes.clear();
    bytes.extend_from_slice(&HEADER);
    // CDR aligns each field relative to the end of the header. Numbers of eight bytes come first, and the four single
    // bytes after them align the length of the string. So no field needs padding.
    for number in [sample.cycle, sample.began] {
        bytes.extend_from_slice(&number.to_le_bytes());
    }
    let mut floats = |values: &[f64]| values.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    floats(&sample.joints);
    floats(&sample.joint_rates);
    floats(&sample.joint_set_point.unwrap_or([f64::NAN; 3]));
    floats(&sample.tip);
    floats(&sample.tip_set_point.unwrap_or([f64::NAN; 3]));
    floats(&sample.tip_force);
    floats(&sample.tip_force_in_palm);
    floats(sample.kx.unwrap_or([[f64::NAN; 3]; 3]).as_flattened());
    floats(sample.stiffness.as_flattened());
    floats(sample.stiffness_in_palm.as_flattened());
    floats(&sample.joint_torques);
    floats(&sample.measured_joint_torques);
    floats(&sample.desired_tensions);
    floats(&sample.tensions);
    floats(&[sample.t_min, sample.t_max]);
    floats(&sample.motor_torques);
    floats(&[sample.torque_scale, sample.stiffness_scale]);
    floats(&sample.contact_force);
    floats(&[sample.slide]);
    floats(&[sample.wake_up.unwrap_or(f64::NAN), sample.whole.unwrap_or(f64::NAN)]);
    let fault = sample.fault().map_or(0, |fault| fault.kind.number());
    bytes.extend_from_slice(&[u8::from(sample.computed), u8::from(sample.touching), fault, 0]);
    let stage = sample.stage_name();
    // The length of a string includes the byte 0 at its end. The name of a stage is short, so its length fits in a u32.
    bytes.extend_from_slice(&(stage.len() as u32 + 1).to_le_bytes());
    bytes.extend_from_slice(stage.as_bytes());
    bytes.push(0);
}
