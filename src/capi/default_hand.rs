//! The one hand that the C calls work on.

use crate::calibration::Task;
use crate::capi::process;
use crate::capi::refusal::{self, Refusal};
use crate::hand::{self, Calibrating, Hand, HandError, Recovering, Standing};
use parking_lot::{Mutex, RwLock};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// Locked while a hand is being opened or closed, which takes long; the calls to a finger never wait for it.
static LIFE: Mutex<()> = Mutex::new(());

/// Locked for writing only for as long as it takes to put a hand in or to take it out.
static HAND: RwLock<Option<Hand>> = RwLock::new(None);

/// Set when the process exits, before the exit handler of the library closes the hand. From then on no call may open or
/// move a hand, because nothing would close it.
static EXITING: AtomicBool = AtomicBool::new(false);

/// How long exit waits for a call in progress. That call may be on the exiting thread itself, which has left it by a
/// signal handler that calls exit: then it would wait for ever.
const PATIENCE_AT_EXIT: Duration = Duration::from_millis(100);

/// How often a calibration is looked at.
const LOOKING: Duration = Duration::from_millis(5);

pub(super) fn open() -> Result<(), Refusal> {
    refuse_while_exiting()?;
    let Some(_opening) = LIFE.try_lock() else { return Err(Refusal::Busy) };
    if HAND.read().is_some() {
        return Err(Refusal::AlreadyOpen);
    }
    process::watch(close_at_exit);
    let configured = hand::find_configuration().map_err(HandError::from)?;
    refusal::set_printing(configured.configuration.hand.print_refusals);
    let hand = Hand::open_as(configured)?;
    // The exit handler waits only briefly for this call, which may have been slower. Returning drops the hand and so
    // closes it.
    refuse_while_exiting()?;
    *HAND.write() = Some(hand);
    Ok(())
}

pub(super) fn close() -> Result<(), Refusal> {
    let _closing = LIFE.lock();
    let hand = HAND.write().take();
    // Closing takes long; by now the calls to a finger are refused and do not wait for it.
    drop(hand);
    Ok(())
}

fn close_at_exit() {
    EXITING.store(true, Ordering::Release);
    let Some(_closing) = LIFE.try_lock_for(PATIENCE_AT_EXIT) else { return };
    // Ended and not closed: a signal handler may have called exit in the middle of malloc, and then freeing would wait
    // for ever.
    if let Some(hand) = HAND.try_read_for(PATIENCE_AT_EXIT)
        && let Some(hand) = &*hand
    {
        hand.end();
    }
}

/// Runs `call` on the open hand.
pub(super) fn with<T, E: Into<Refusal>>(call: impl FnOnce(&Hand) -> Result<T, E>) -> Result<T, Refusal> {
    let hand = HAND.read();
    let hand = hand.as_ref().ok_or(Refusal::NoHand)?;
    call(hand).map_err(E::into)
}

/// Runs `call`, which moves the open hand or changes how it moves. Refused while the process exits: the hand is closed
/// then, and the call would have no effect.
pub(super) fn command<T, E: Into<Refusal>>(call: impl FnOnce(&Hand) -> Result<T, E>) -> Result<T, Refusal> {
    refuse_while_exiting()?;
    with(call)
}

fn refuse_while_exiting() -> Result<(), Refusal> {
    if EXITING.load(Ordering::Acquire) { Err(Refusal::Exiting) } else { Ok(()) }
}

/// Makes a faulted finger of the open hand a spring again. The hand is looked at from time to time and not kept from
/// being closed, nor other calls from being made.
pub(super) fn recover(finger: i32) -> Result<(), Refusal> {
    let recovering = command(|hand| Recovering::begin(hand, finger))?;
    // Without the hand: ports are slow. Was it closed meanwhile, that is what there is to tell.
    let mended = recovering.mend();
    command(|_| mended)?;
    while !command(|hand| recovering.poll(hand))? {
        sleep(LOOKING);
    }
    Ok(())
}

/// Calibrates a finger of the open hand and stores what was found. The hand is looked at from time to time and not kept
/// from being closed, nor other calls from being made.
pub(super) fn calibrate(finger: i32, task: Task) -> Result<(), Refusal> {
    let mut calibrating = command(|hand| Calibrating::begin(hand, finger, task))?;
    while let Standing::Going(_) = command(|hand| calibrating.poll(hand))? {
        sleep(LOOKING);
    }
    // Without the hand: a slow disk, and others that store, must not keep it from being closed.
    match with(|hand| Ok::<_, hand::HandError>(hand.to_store(finger)))? {
        Some(calibration) => Ok(calibration.store()?),
        None => Ok(()),
    }
}
