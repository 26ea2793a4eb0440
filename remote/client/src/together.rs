//! Commands to several hands with one time stamp.

use crate::RemoteHand;
use crate::clock::now;
use crate::command::FingerCommand;
use crate::error::RemoteError;
use std::sync::Arc;

/// Sends commands to several hands, each hand at most once. Their Targets have the same time stamp, and leave at the
/// same time. Either every command is sent, or none is. Each hand takes its commands in the cycle in which they arrive,
/// because two servers have no common clock.
///
/// # Errors
/// Returns the errors of [`RemoteHand::send_group`] of each hand. Returns an error if a hand is given twice.
pub fn send_together(hands: &[(&RemoteHand, &[FingerCommand])]) -> Result<(), RemoteError> {
    // All threads take the locks in the same order.
    let mut sorted: Vec<_> = hands.iter().map(|(hand, commands)| (&hand.link.shared, *commands)).collect();
    sorted.sort_by_key(|(shared, _)| Arc::as_ptr(shared));
    if let Some(pair) = sorted.windows(2).find(|pair| Arc::ptr_eq(pair[0].0, pair[1].0)) {
        let name = pair[0].0.lock().name().clone();
        return Err(RemoteError::TwiceTogether(name));
    }
    let mut locked: Vec<_> = sorted.iter().map(|(shared, commands)| (shared.lock(), *commands)).collect();
    // The time is read while the locks are held, so that no Target with a later time stamp is sent before these
    // Targets.
    let now = now();
    let admitted = locked.iter_mut().map(|(exchange, commands)| exchange.admit(commands, now));
    let admitted = admitted.collect::<Result<Vec<_>, _>>()?;
    for ((exchange, _), changes) in locked.iter_mut().zip(admitted) {
        exchange.put(changes, Some(now));
    }
    drop(locked);
    sorted.iter().for_each(|(shared, _)| shared.wake());
    Ok(())
}
