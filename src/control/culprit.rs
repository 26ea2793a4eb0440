//! Finds the key to correct if the values of several keys together permit no controller.

use crate::model::configuration::{ConfiguredFinger, Unusable};

/// Sets a key to its value in another finger.
type Reset = fn(&mut ConfiguredFinger, &ConfiguredFinger);

/// Lists keys by their names, each with the function that resets it.
macro_rules! keys {
    ($($table:ident.$key:ident),* $(,)?) => {
        &[$((
            concat!(stringify!($table), ".", stringify!($key)),
            |finger, default| finger.$table.$key = default.$table.$key,
        )),*]
    };
}

/// The keys that limit each other. Any of them can be the cause of a refusal that names another one.
const KEYS: &[(&str, Reset)] = keys![
    motor.viscous_friction,
    motor.torque_limit,
    motor.continuous_torque,
    motor.inertia,
    tendon.minimum,
    tendon.maximum,
    tendon.stiffness,
    friction.joint_coulomb,
    friction.motor_coulomb,
    friction.conduit,
    friction.pulley,
    controller.dither,
    controller.tension_dither,
    geometry.motor_radius,
];

/// Returns `refusal`, changed so that it names the key to correct. `constructs` returns whether a controller can be
/// constructed for a finger.
///
/// A refusal names the key at which the construction has ended, but the cause may be the value of another key. The key
/// to correct is the one whose default value permits a controller while all other values stay. If there are several
/// such keys, the key that the refusal names has precedence. If there is none, the refusal is unchanged.
pub(super) fn with_culprit(
    refusal: Unusable,
    finger: &ConfiguredFinger,
    constructs: &dyn Fn(&ConfiguredFinger) -> bool,
) -> Unusable {
    let default = ConfiguredFinger::default();
    let permits = |reset: Reset| {
        let mut changed = finger.clone();
        reset(&mut changed, &default);
        changed != *finger && constructs(&changed)
    };
    let Unusable { key: named, reason } = refusal;
    let own = KEYS.iter().filter(|(key, _)| *key == named);
    let others = KEYS.iter().filter(|(key, _)| *key != named);
    match own.chain(others).find(|(_, reset)| permits(*reset)) {
        Some(&(key, _)) if key != named => {
            let reason = format!(
                "because of this value, the key {named} is refused. Correct this value first. The refusal is: \
                 {named}: {reason}"
            );
            Unusable { key, reason }
        }
        _ => Unusable { key: named, reason },
    }
}
