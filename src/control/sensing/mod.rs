//! From encoder and gauge counts to joint angles, tensions and standstill.

pub(crate) mod joint_positions;
pub(crate) mod sensors;
pub(crate) mod stillness;
