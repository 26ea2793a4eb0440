//! The one hand of the C calls.

use crate::calibration::Task;
use crate::capi::default_events;
use crate::capi::process;
use crate::capi::refusal::{self, Refusal};
use crate::hand::{self, Calibrating, CalibrationState, Hand, HandError, Recovering, Until, Waiting};
use parking_lot::{Mutex, RwLock};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// Locked while a hand is being opened or closed, which takes a long time. Calls for a finger never wait for this
/// lock.
static LIFECYCLE: Mutex<()> = Mutex::new(());

/// Locked for writing only to insert or remove a hand.
static HAND: RwLock<Option<Hand>> = RwLock::new(None);

/// Set when the process exits, before the exit handler of the library closes the hand. From then on no call may open a
/// hand, because nothing would close it. No call may move the open hand either, because the exit handler closes
/// it.
static EXITING: AtomicBool = AtomicBool::new(false);

/// Longest time that exit waits for a call in progress. The wait is limited because that call may be in the exiting
/// thread itself, interrupted by a signal handler that calls exit.
const LONGEST_WAIT_AT_EXIT: Duration = Duration::from_millis(100);

/// Polling period of a calibration or recovery.
const POLLING_PERIOD: Duration = Duration::from_millis(5);

/// Polling period of a wait for fingers.
const WAITING_PERIOD: Duration = Duration::from_millis(1);

pub(super) fn open() -> Result<(), Refusal> {
    refuse_while_exiting()?;
    let Some(_opening) = LIFECYCLE.try_lock() else { return Err(Refusal::Busy) };
    if HAND.read().is_some() {
        return Err(Refusal::AlreadyOpen);
    }
    process::watch(close_at_exit);
    let configured = hand::find_configuration().map_err(HandError::from)?;
    refusal::set_printing(configured.configuration.hand.print_refusals);
    let hand = Hand::open_as(configured)?;
    // If the process exits, this line returns an error, and the return drops the hand, which closes it. The exit
    // handler waits only briefly for this call, so it cannot be relied on to close this hand.
    refuse_while_exiting()?;
    default_events::open(&hand);
    *HAND.write() = Some(hand);
    Ok(())
}

pub(super) fn close() -> Result<(), Refusal> {
    let _closing = LIFECYCLE.lock();
    close_hand(false);
    Ok(())
}

/// Closes the hand on behalf of the planner's callback for events.
pub(super) fn close_in_callback() -> Result<(), Refusal> {
    // A CloseHand of another thread waits for the callback, so waiting for that call would be a deadlock.
    let Some(_closing) = LIFECYCLE.try_lock() else { return Err(Refusal::Busy) };
    close_hand(true);
    Ok(())
}

fn close_hand(in_callback: bool) {
    let hand = HAND.write().take();
    // Dropping the hand takes a long time. `HAND` is already unlocked, so other calls are refused instead of waiting.
    drop(hand);
    // The callback may take longer than the hand.
    default_events::close(in_callback);
}

fn close_at_exit() {
    EXITING.store(true, Ordering::Release);
    let Some(_closing) = LIFECYCLE.try_lock_for(LONGEST_WAIT_AT_EXIT) else { return };
    // The hand ends without being dropped: a signal handler may have called exit in the middle of malloc, and then free
    // would never return.
    if let Some(hand) = HAND.try_read_for(LONGEST_WAIT_AT_EXIT)
        && let Some(hand) = &*hand
    {
        hand.end();
    }
    default_events::end(LONGEST_WAIT_AT_EXIT);
}

/// Runs `call` on the open hand.
pub(super) fn with<T, E: Into<Refusal>>(call: impl FnOnce(&Hand) -> Result<T, E>) -> Result<T, Refusal> {
    let hand = HAND.read();
    let hand = hand.as_ref().ok_or(Refusal::NoHand)?;
    call(hand).map_err(E::into)
}

/// Runs `call`, which moves the open hand or changes how it moves. It is refused while the process exits, because
/// the hand is then closed, and the call would have no effect.
pub(super) fn command<T, E: Into<Refusal>>(call: impl FnOnce(&Hand) -> Result<T, E>) -> Result<T, Refusal> {
    refuse_while_exiting()?;
    with(call)
}

fn refuse_while_exiting() -> Result<(), Refusal> {
    if EXITING.load(Ordering::Acquire) { Err(Refusal::Exiting) } else { Ok(()) }
}

/// Makes a faulted finger of the open hand a spring again. Unlocks the hand between two polls, so that CloseHand and
/// other calls work meanwhile.
pub(super) fn recover(finger: i32) -> Result<(), Refusal> {
    let recovering = command(|hand| Recovering::begin(hand, finger))?;
    // The hand is not locked during this step, because ports are slow.
    let result = recovering.reconnect();
    // If the hand was closed meanwhile, `command` refuses because no hand is open, and `result` is ignored.
    command(|_| result)?;
    while !command(|hand| recovering.poll(hand))? {
        sleep(POLLING_PERIOD);
    }
    Ok(())
}

/// Waits until the condition holds for these fingers. Unlocks the hand between two polls, so that CloseHand and other
/// calls work meanwhile.
pub(super) fn wait(fingers: &[i32], until: Until, limit: Duration) -> Result<(), Refusal> {
    let waiting = with(|hand| Waiting::begin(hand, fingers, until, limit))?;
    while !with(|hand| waiting.poll(hand))? {
        sleep(WAITING_PERIOD);
    }
    Ok(())
}

/// Calibrates a finger of the open hand and stores the results. Unlocks the hand between two polls, so that CloseHand
/// and other calls work meanwhile.
pub(super) fn calibrate(finger: i32, task: Task) -> Result<(), Refusal> {
    let mut calibrating = command(|hand| Calibrating::begin(hand, finger, task))?;
    while let CalibrationState::InProgress(_) = command(|hand| calibrating.poll(hand))? {
        sleep(POLLING_PERIOD);
    }
    // The hand is not locked here, so that CloseHand waits neither for a slow disk nor for other processes that store a
    // calibration.
    match with(|hand| Ok::<_, hand::HandError>(hand.to_store(finger.try_into()?)))? {
        Some(calibration) => Ok(calibration.store()?),
        None => Ok(()),
    }
}
