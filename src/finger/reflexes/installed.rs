//! The rules of a finger on their way from planners to the servo.

use super::bulletin::Bulletin;
use super::rule::Reflex;
use super::rule_set::Rules;
use super::server::ReflexServer;
use crate::model::FingerNumber;
use crate::realtime::{Input, LockedMemory, Mutex, triple_buffer};

/// The planners' end of a finger's rules.
pub struct Reflexes(Mutex<Installed>);

struct Installed {
    rules: Rules,
    /// Number of the last rule that was installed; 0 before the first.
    last: u32,
    to_servo: Input<Rules>,
}

/// Creates the two ends for a finger without rules. Fingers whose servers have clones of `bulletin` read each other's
/// events.
pub fn reflexes(finger: FingerNumber, bulletin: &Bulletin) -> (Reflexes, ReflexServer) {
    let (to_servo, from_planners) = triple_buffer(&Rules::default());
    let mut memory = LockedMemory::default();
    to_servo.add_to(&mut memory);
    bulletin.add_to(&mut memory);
    let planners = Reflexes(Mutex::new(Installed { rules: Rules::default(), last: 0, to_servo }));
    (planners, ReflexServer::new(finger, from_planners, bulletin.clone(), memory))
}

impl Reflexes {
    /// Installs a rule, and returns its number. Returns none if the finger already has `MOST_RULES` rules.
    pub fn install(&self, reflex: Reflex) -> Option<u32> {
        let installed = &mut *self.0.lock();
        let place = installed.rules.0.iter_mut().find(|place| place.is_none())?;
        // No rule has the number 0.
        installed.last = installed.last.wrapping_add(1).max(1);
        *place = Some((installed.last, reflex));
        installed.to_servo.write(installed.rules);
        Some(installed.last)
    }

    /// Removes the rule with this number. Returns false if there is no such rule.
    pub fn remove(&self, number: u32) -> bool {
        let installed = &mut *self.0.lock();
        let has_number = |place: &&mut Option<(u32, Reflex)>| place.is_some_and(|(rule, _)| rule == number);
        let Some(place) = installed.rules.0.iter_mut().find(has_number) else { return false };
        *place = None;
        installed.to_servo.write(installed.rules);
        true
    }

    /// Removes every rule.
    pub fn clear(&self) {
        let installed = &mut *self.0.lock();
        installed.rules = Rules::default();
        installed.to_servo.write(installed.rules);
    }
}
