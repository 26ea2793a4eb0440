//! Causes and remedies of a refusal. They depend on what the finger did.

/// Says why the result of an identification cannot be used. NaN means that the measurements do not determine it.
pub(super) fn outcome(what: &str, value: f64) -> String {
    if value.is_nan() {
        return format!("the measurements do not determine {what}");
    }
    format!("the identification of {what} gave {value:.4}, which is not plausible")
}

/// A joint does not follow when it is moved back and forth. The largest torque of this motion is fixed, so
/// `zeroing.torque` does not affect it.
pub(super) const STAYS_BEHIND: &str = "it has far too much friction, or it meets a stop because its zeros or the \
    configured stops are wrong. Clear its way, check the joint, its tendons, zeroing.lower_stop_degrees and \
    zeroing.upper_stop_degrees, and zero the finger again";

/// A joint does not return to its start.
pub(super) const DOES_NOT_RETURN: &str = "or zeroing.torque is too small for its friction. Check both";

/// A joint moves less between its stops than configured.
pub(super) const NARROW: &str = "something blocks it, zeroing.torque is too small for its friction";

/// A joint moves farther between its stops than configured.
pub(super) const WIDE: &str = "a stop is missing, a tendon is off its pulley";
