//! Gravity that changes while the hand is open, because the hand is on a moving arm.

use crate::finger::Adjustable;
use crate::hand::{ConfigurationError, Hand, HandError};
use crate::model::configuration::Unusable;

impl Hand {
    /// Sets gravity in the palm's frame, m/s^2: `hand.gravity` for the time until the hand is closed. Every finger
    /// compensates the new gravity within a cycle and without a jump in torque. It also acts on simulated fingers and
    /// on a simulated object. The black box of every finger stores the gravity with the controller that compensates
    /// it, so that a recording can be replayed.
    ///
    /// The call constructs new controllers, as [`Hand::adjust`] does, and takes some hundred microseconds. The monitors
    /// begin again with every change.
    ///
    /// # Errors
    /// Returns an error if a component is NaN, infinite or beyond 100 m/s^2. Then nothing is changed. Returns an error
    /// if a finger is faulted. The other fingers then have the new gravity, and this finger needs another call after
    /// it has recovered.
    pub fn set_gravity(&self, gravity: [f64; 3]) -> Result<(), HandError> {
        // The lock is held throughout, as for an adjustment.
        let mut configuration = self.configuration.write();
        let mut changed = configuration.clone();
        changed.hand.gravity = gravity;
        changed.check()?;
        let mut refusal = None;
        for member in self.dispatcher.members() {
            let finger = member.number;
            let unusable =
                |unusable: Unusable| ConfigurationError::Unusable { section: format!("finger.{finger}"), unusable };
            let adjustable = Adjustable::new(&changed, finger).map_err(unusable)?;
            let faulted = |fault| HandError::Faulted { finger, fault };
            let given = self.dispatcher.hand_over(finger, &changed, adjustable, |adjustable| {
                member.mailbox.adjust(adjustable).map_err(faulted)
            });
            refusal = refusal.or(given.err());
            self.simulated.with_finger(finger, |simulated| simulated.plant().set_gravity(changed.gravity(finger)));
        }
        self.simulated.set_object_gravity(gravity);
        *configuration = changed;
        refusal.map_or(Ok(()), Err)
    }
}
