//! Conversion of encoder and gauge counts to joint angles and tensions, and detection of standstill.

pub(crate) mod joint_positions;
pub(crate) mod sensors;
pub(crate) mod stillness;
