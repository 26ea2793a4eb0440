//! The recovery of fingers on request.

use crate::desk::Stops;
use crate::shared::Shared;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::hand::Recovering;
use sun2xp::{FaultKind, HandError};
use sun2xp_remote_protocol::Finger;

/// Interval at which recoveries are polled.
pub(super) const POLLED: Duration = Duration::from_millis(2);

/// Recovers every finger for a client that has just acquired the hand. `stops` is as for [`recover`].
///
/// Right after the end of the previous ownership, a finger may still run. The servo of this finger, not the
/// [desk](crate::desk), measures the silence of the previous owner. So the set point can expire when the recovery has
/// already begun. A second recovery then recovers this finger too. During the second recovery no other set point
/// expires, because the desk keeps the set points of running fingers valid while an acquire recovers fingers.
pub(super) fn recover_for_new_owner(shared: &Shared, stops: &Stops) -> Result<(), HandError> {
    recover(shared, None, stops).or_else(|error| match error {
        HandError::Faulted { fault, .. } if fault.kind == FaultKind::SetPointExpired => recover(shared, None, stops),
        other => Err(other),
    })
}

/// Recovers this finger, or every finger if `finger` is none. `stops` is the number of stops of each finger when the
/// request was admitted. A finger that is stopped after this moment stays stopped.
pub(super) fn recover(shared: &Shared, finger: Option<Finger>, stops: &Stops) -> Result<(), HandError> {
    let recovered = recover_fingers(shared, finger, stops);
    let stopped = shared.desk.lock().stop_again(stops);
    recovered.and(stopped)
}

/// Recovers this finger, or every finger at the same time if `finger` is none. A recovery can take seconds.
fn recover_fingers(shared: &Shared, finger: Option<Finger>, stops: &Stops) -> Result<(), HandError> {
    let hand = &shared.hand;
    let numbers: Vec<i32> = match finger {
        Some(finger) => vec![i32::from(finger.number())],
        None => hand.fingers().members().map(|member| member.get()).collect(),
    };
    let begun = numbers.into_iter().map(|number| Recovering::begin(hand, number)).collect::<Result<Vec<_>, _>>()?;
    // A recovery would undo a stop that came before the recovery began, so such a stop is repeated here. A later stop
    // ends the recovery.
    shared.desk.lock().stop_again(stops)?;
    let reconnected: Vec<_> = begun.iter().map(Recovering::reconnect).collect();
    let recovered: Vec<_> = begun
        .iter()
        .zip(reconnected)
        .map(|(recovering, reconnected)| {
            reconnected?;
            while !recovering.poll(hand)? {
                sleep(POLLED);
            }
            Ok(())
        })
        .collect();
    // All recoveries have ended before the first error is returned.
    recovered.into_iter().collect()
}
