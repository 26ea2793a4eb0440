//! Gravity that changes while the hand is open, because the hand is on a moving arm.

use crate::hand::{Hand, HandError, SetPointError};
use crate::model::configuration::LARGEST_GRAVITY as LARGEST;

impl Hand {
    /// Sets gravity in the palm's frame, m/s^2. It replaces `hand.gravity` until the hand is closed. Every finger takes
    /// the new gravity within a cycle. The compensated gravity changes by at most 2 m/s^2 per millisecond, so that the
    /// torque does not jump. A large change therefore takes several cycles to compensate. The new gravity also acts on
    /// simulated fingers and on a simulated object. In the black box and in telemetry, every record of a cycle in which
    /// the controller ran contains the gravity of this cycle.
    ///
    /// Gravity is an input of the servos, as a set point is. The call does not allocate memory and does not replace a
    /// controller, so a planner can make it in every cycle. Set points, paths, monitors and the estimate of contacts
    /// continue.
    ///
    /// # Errors
    /// Returns an error if a component is NaN, infinite or beyond 100 m/s^2. Then nothing is changed. Returns an error
    /// if a finger is faulted. The other fingers then have the new gravity, and the faulted finger takes the new
    /// gravity when it recovers.
    pub fn set_gravity(&self, gravity: [f64; 3]) -> Result<(), HandError> {
        // The range is that of `hand.gravity`. The check of the configuration is not called here, because it would
        // allocate the text of a refusal.
        if let Some(component) = gravity.iter().position(|value| !(-LARGEST..=LARGEST).contains(value)) {
            return Err(SetPointError::Gravity { component, value: gravity[component] }.into());
        }
        // The lock is held throughout, so that the fingers take the values of two concurrent calls in the same order.
        let mut configuration = self.configuration.write();
        configuration.hand.gravity = gravity;
        let mut refusal = None;
        for member in self.dispatcher.members() {
            let finger = member.number;
            let gravity = configuration.gravity(finger);
            let given =
                member.mailbox.set_gravity(gravity.into()).map_err(|fault| HandError::Faulted { finger, fault });
            refusal = refusal.or(given.err());
            self.simulated.with_finger(finger, |simulated| simulated.plant().set_gravity(gravity));
        }
        self.simulated.set_object_gravity(gravity);
        refusal.map_or(Ok(()), Err)
    }
}
