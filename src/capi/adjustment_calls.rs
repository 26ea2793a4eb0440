//! The exported function that changes the configuration of a running finger. Its doc comment is the C manual, as in
//! `calls.rs`.

use crate::capi::boundary::{MEMORY_OF_CALL, delegated};
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::non_null;
use crate::capi::opened_hand::NOT_UTF_8;
use crate::capi::refusal::Wanted;
use crate::files::line_of_error;
use crate::hand::{ConfigurationError, HandError};
use std::ffi::{CStr, c_char, c_int};

/// sun2xp_adjust - change the configuration of a finger while it runs
///
///   finger   1 to 3
///   keys     lines of TOML, in UTF-8, as under [finger.i] of the configuration file (docs/sun2xp.toml)
///
/// All keys take effect together, within a cycle and without a jump in torque; other keys stay as they are.
/// The change lasts until sun2xp_close: the file is not written. A new controller.law applies to set points
/// and paths in joint angles that are sent after the call. These keys cannot change while the hand is open:
/// port, board, baud, reconnect, address, thread, core, priority, base, turn_degrees, encoder, motor.sign,
/// motor.torque_limit, motor.torque_constant, stiffness.initial, touch and simulation.
///
/// A configured stiffness.bound was chosen for the configured controller.scheme. If the lines in keys
/// change controller.scheme but do not set stiffness.bound, the smaller of the configured bound and the
/// default bound applies. If the bound is lowered while a path changes Kx, the Kx of the end of the path
/// takes effect at once.
///
/// If the path that was sent last has not ended, the call checks the whole path against the new limits, except
/// those of finger.motion, which apply only to later paths. The check includes the part that the finger has
/// already followed. With hand.out_of_range = "clamp" a path outside the new joint limits ends, and the finger
/// moves to the end of the path at once. A finger that was beyond a joint limit when it became a spring may
/// still hold its pose there. The call accepts this pose, unless the new limit is narrower.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   keys is null
///   ENODEV   no such hand
///   EINVAL   no such finger; keys is not TOML
///   EBUSY    a key cannot change while the hand is open
///   EINVAL   an unknown key; an unusable configuration
///   ERANGE   the position, path, stiffness, torque or damping sent last is outside the new limits
///            (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 200 us, and allocates memory.
///
/// Example:
///
///     sun2xp_adjust(hand, 1, "tendon.minimum = 6\ncontroller.tension_gain = 3");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_adjust(hand: *mut sun2xp_hand, finger: c_int, keys: *const c_char) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_adjust", hand, MEMORY_OF_CALL, || {
        non_null(keys, "keys", Wanted::Text)?;
        // SAFETY: `keys` is not null, as checked above, and by the contract in the manual it is a C string.
        let keys = unsafe { CStr::from_ptr(keys) }.to_owned();
        Ok(move || {
            hand_table::command(hand, |hand| -> Result<(), HandError> {
                hand.report(finger)?;
                let number = finger.try_into()?;
                let refused = |error| ConfigurationError::Adjustment {
                    finger: number,
                    line: line_of_error(keys.to_bytes(), error),
                    reason: NOT_UTF_8.into(),
                };
                hand.adjust(finger, keys.to_str().map_err(refused)?)
            })
        })
    })
}
