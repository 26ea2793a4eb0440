//! Requests of clients: acquire, release, recover, calibrate, identify and stop. A request that takes long runs in a
//! thread of its own, because the threads of zenoh must not wait.

mod recovering;

use crate::access::permission;
use crate::desk::{Desk, Stops, code_of};
use crate::epoch::new_epoch;
use crate::output::complain;
use crate::settings::Permission;
use crate::shared::Shared;
use recovering::recover;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use sun2xp::realtime::{Priority, now, spawn, with_remedy};
use sun2xp::{Hand, HandError};
use sun2xp_remote_protocol::{Action, Answer, ClientName, Code, DecodeError, Finger, Request};

/// The text of an Answer to a client that does not own the hand.
const NOT_OWNED: &str = "you do not own the hand, or the epoch of the request is old: acquire the hand first";

/// The text of an Answer while the server ends.
const ENDING: &str = "the server of the hand is shutting down, and its fingers go to their end states: start the \
                      server again, and acquire the hand";

/// Answers a Request. `reply` sends the Answer, at once or later. `client` is the client that the Zenoh key of the
/// Request names.
pub fn answer(shared: &Arc<Shared>, action: Action, client: ClientName, payload: &[u8], reply: impl Reply) {
    let refuse = |code, text: String| shared.desk.lock().answer(code, text, 0, now());
    let request = match Request::decode(payload) {
        Ok(request) => request,
        Err(error) => {
            shared.desk.lock().count_malformed();
            let other = matches!(error, DecodeError::Version { .. });
            let code = if other { Code::OtherVersion } else { Code::Malformed };
            return reply.send(&refuse(code, error.to_string()));
        }
    };
    if request.action != action {
        shared.desk.lock().count_malformed();
        let text = format!("the key is for {}, but the Request is for {}", action.name(), request.action.name());
        return reply.send(&refuse(Code::Malformed, text));
    }
    match permission(&shared.settings.clients, &client) {
        Some(Permission::Command) => {}
        Some(_) if action == Action::Stop => {}
        _ => {
            let text = format!(
                "{client} may not {}: list it in [serve.clients] of the server as `\"{client}\" = \"command\"`",
                action.name()
            );
            return reply.send(&refuse(Code::NotOwner, text));
        }
    }
    shared.desk.lock().note_client(&client);
    carry_out(shared, &request, client, reply);
}

/// Where an Answer goes.
pub trait Reply: Send + 'static {
    /// Sends the Answer.
    fn send(self, answer: &Answer);
}

fn carry_out(shared: &Arc<Shared>, request: &Request, client: ClientName, reply: impl Reply) {
    let (request, time) = (*request, now());
    let (owned, stops) = {
        let desk = shared.desk.lock();
        (desk.admits(&client, request.epoch), desk.stops())
    };
    match request.action {
        Action::Acquire | Action::Release | Action::Recover | Action::Calibrate | Action::Identify
            if shared.ending.load(Ordering::Acquire) =>
        {
            let epoch = if request.action == Action::Acquire { 0 } else { request.epoch };
            let answer = ended(&shared.desk.lock(), epoch);
            return reply.send(&answer);
        }
        Action::Acquire => return acquire(shared, &request, client, reply),
        Action::Stop => {
            let mut desk = shared.desk.lock();
            let stopped = desk.stop(request.finger.map(number));
            let answer = result(&desk.answer(Code::Done, String::new(), request.epoch, time), stopped);
            drop(desk);
            return reply.send(&answer);
        }
        _ if !owned => {
            let answer = shared.desk.lock().answer(Code::NotOwner, NOT_OWNED.into(), request.epoch, time);
            return reply.send(&answer);
        }
        Action::Release => {
            let mut desk = shared.desk.lock();
            // Another client may have taken the hand over since.
            let (code, text) = match desk.admits(&client, request.epoch) {
                true => (Code::Done, ""),
                false => (Code::NotOwner, NOT_OWNED),
            };
            if code == Code::Done {
                desk.release();
            }
            let answer = desk.answer(code, text.into(), request.epoch, time);
            drop(desk);
            return reply.send(&answer);
        }
        Action::Recover | Action::Calibrate | Action::Identify => {}
    }
    long(shared, request.epoch, reply, move |shared| {
        let done = match (request.action, request.finger) {
            (Action::Calibrate, Some(finger)) => calibrated(&shared.hand, finger, Hand::zero),
            (Action::Identify, Some(finger)) => calibrated(&shared.hand, finger, Hand::identify),
            (_, finger) => recover(shared, finger, &stops),
        };
        let desk = shared.desk.lock();
        match done {
            // The end of the server is the cause of the error.
            Err(_) if shared.ending.load(Ordering::Acquire) => ended(&desk, request.epoch),
            done => result(&desk.answer(Code::Done, String::new(), request.epoch, now()), done),
        }
    });
}

/// Returns the Answer while the server ends.
fn ended(desk: &Desk, epoch: u64) -> Answer {
    desk.answer(Code::Closed, ENDING.into(), epoch, now())
}

/// Makes the client the owner, and recovers the fingers if this is requested.
fn acquire(shared: &Arc<Shared>, request: &Request, client: ClientName, reply: impl Reply) {
    let epoch = match new_epoch() {
        Ok(epoch) => epoch,
        Err(error) => {
            let answer = shared.desk.lock().answer(Code::Closed, error.to_string(), 0, now());
            return reply.send(&answer);
        }
    };
    let (number, stops) = match take(shared, request, &client, epoch) {
        Ok(taken) => taken,
        Err(refusal) => return reply.send(&refusal),
    };
    let owner = client.clone();
    let begin = move |shared: &Shared, recovered: Result<(), HandError>| {
        let mut desk = shared.desk.lock();
        let time = now();
        match recovered {
            _ if shared.ending.load(Ordering::Acquire) => {
                if desk.admits(&client, epoch) {
                    desk.abandon(time);
                }
                ended(&desk, 0)
            }
            Ok(()) if desk.begin(&client, epoch, time) => {
                Answer { number, ..desk.answer(Code::Done, String::new(), epoch, time) }
            }
            // `Desk::begin` is not called, so fingers that were caught (see `crate::silence`) do not follow their set
            // points again. They hold their pose softly until they go to their end state.
            Err(error) if desk.admits(&client, epoch) => {
                desk.abandon(time);
                desk.answer(code_of(&error), error.to_string(), 0, time)
            }
            _ => {
                let text =
                    "another client has taken the hand over meanwhile: wait until it releases the hand, or take \
                            the hand over"
                        .into();
                desk.answer(Code::Owned, text, 0, time)
            }
        }
    };
    if !request.recover {
        return reply.send(&begin(shared, Ok(())));
    }
    let started = run(shared, 0, reply, move |shared| {
        let recovered = recover(shared, None, &stops);
        begin(shared, recovered)
    });
    if !started {
        let mut desk = shared.desk.lock();
        // Another client may have taken the hand over since.
        if desk.admits(&owner, epoch) {
            desk.abandon(now());
        }
    }
}

/// Makes the client the owner with this epoch, and sets `busy` if the request asks for a recovery. Returns the number
/// of the epoch, and how often each finger was stopped so far. If the acquire is refused, returns the refusal, and
/// nothing has changed.
fn take(shared: &Shared, request: &Request, client: &ClientName, epoch: u64) -> Result<(u64, Stops), Answer> {
    let mut desk = shared.desk.lock();
    // An acquire that is refused because of the owner must not hold up the requests of this owner.
    let admitted = desk.may_acquire(client, request.take_over);
    if admitted && request.recover && shared.busy.swap(true, Ordering::AcqRel) {
        return Err(in_progress(&desk, 0));
    }
    let time = now();
    match desk.acquire(client, request.take_over, epoch, time) {
        Ok(number) => Ok((number, desk.stops())),
        Err(other) => {
            let text = format!("{other} owns the hand: wait until it releases the hand, or take the hand over");
            Err(desk.answer(Code::Owned, text, 0, time))
        }
    }
}

/// Runs a request that takes long, unless another such request is running.
fn long(shared: &Arc<Shared>, epoch: u64, reply: impl Reply, body: impl FnOnce(&Shared) -> Answer + Send + 'static) {
    match shared.busy.swap(true, Ordering::AcqRel) {
        true => {
            let answer = in_progress(&shared.desk.lock(), epoch);
            reply.send(&answer);
        }
        false => {
            run(shared, epoch, reply, body);
        }
    }
}

/// Runs a request that takes long in a thread, and sends its Answer. The caller has set `busy`. Returns whether the
/// thread has started. `epoch` is that of the Answer if the server ends.
fn run(
    shared: &Arc<Shared>,
    epoch: u64,
    reply: impl Reply,
    body: impl FnOnce(&Shared) -> Answer + Send + 'static,
) -> bool {
    // The end of the server sets `ending` before it takes this lock, so it waits for every thread that starts here.
    let mut threads = shared.requests.lock();
    if shared.ending.load(Ordering::Acquire) {
        shared.busy.store(false, Ordering::Release);
        let answer = ended(&shared.desk.lock(), epoch);
        reply.send(&answer);
        return false;
    }
    let of_thread = shared.clone();
    let started = spawn("sun2xp request", Priority::default(), move |_| {
        let answer = body(&of_thread);
        // A client that has the Answer may send the next request at once.
        of_thread.busy.store(false, Ordering::Release);
        reply.send(&answer);
    });
    match started {
        Ok(thread) => {
            threads.retain(|thread| !thread.is_finished());
            threads.push(thread);
            true
        }
        Err(error) => {
            shared.busy.store(false, Ordering::Release);
            complain(&format!("cannot start a thread for a request: {}", with_remedy(&error)));
            false
        }
    }
}

fn in_progress(desk: &Desk, epoch: u64) -> Answer {
    let text = "the hand is being recovered or calibrated already: repeat the request when that has ended".into();
    desk.answer(Code::InProgress, text, epoch, now())
}

type Calibration = fn(&Hand, i32, fn(sun2xp::Progress)) -> Result<sun2xp::Findings, HandError>;

/// Runs a calibration, and stores its results in the configuration file, if there is one.
fn calibrated(hand: &Hand, finger: Finger, calibration: Calibration) -> Result<(), HandError> {
    calibration(hand, number(finger), |_| {})?;
    hand.store_calibration(number(finger)).map(|_| ())
}

fn number(finger: Finger) -> i32 {
    i32::from(finger.number())
}

/// Returns `answer` if `done` is a success, or else the refusal.
fn result(answer: &Answer, done: Result<(), HandError>) -> Answer {
    match done {
        Ok(()) => answer.clone(),
        Err(error) => Answer { code: code_of(&error), number: 0, text: error.to_string(), ..answer.clone() },
    }
}

/// Waits for the threads of requests. The fingers have stopped, so the requests end too.
pub fn join(shared: &Shared) {
    let threads: Vec<_> = shared.requests.lock().drain(..).collect();
    for thread in threads {
        // A panic in such a thread has been reported already.
        let _ = thread.join();
    }
}

#[cfg(test)]
mod tests;
