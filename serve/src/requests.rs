//! Requests of clients: acquire, release, recover, calibrate, identify and stop.

mod long;
mod recovering;
mod reply;

pub use long::join;
pub use reply::Reply;

use crate::access::permission;
use crate::desk::{Stops, code_of};
use crate::epoch::new_epoch;
use crate::settings::Permission;
use crate::shared::Shared;
use long::{long, run};
use recovering::{recover, recover_for_new_owner};
use reply::{ended, in_progress};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use sun2xp::realtime::now;
use sun2xp::{Hand, HandError};
use sun2xp_remote_protocol::{Action, Answer, ClientName, Code, DecodeError, Finger, Request};

/// The text of an Answer to a client that does not own the hand.
const NOT_OWNED: &str = "you do not own the hand, or have lost it since you acquired it: acquire the hand first";

/// The remedy for a Request that the protocol does not allow. Only a defective client sends such a Request.
const DEFECTIVE: &str = "Correct the client that sent the Request (docs/remote-protocol.md)";

/// Answers a Request. `reply` sends the Answer, at once or later. `client` is the client that the Zenoh key of the
/// Request names.
pub fn answer(shared: &Arc<Shared>, action: Action, client: ClientName, payload: &[u8], reply: impl Reply) {
    let refuse = |code, text: String| shared.desk.lock().answer(code, text, 0, now());
    let request = match Request::decode(payload) {
        Ok(request) => request,
        Err(error) => {
            shared.desk.lock().count_malformed();
            return reply.send(&match error {
                DecodeError::Version { .. } => {
                    let text = format!("{error}: use a client and a server of the same version");
                    refuse(Code::OtherVersion, text)
                }
                _ => refuse(Code::Malformed, format!("{error}. {DEFECTIVE}")),
            });
        }
    };
    if request.action != action {
        shared.desk.lock().count_malformed();
        let (key, named) = (action.name(), request.action.name());
        let text =
            format!("the Zenoh key of the Request names `{key}`, but its payload requests `{named}`. {DEFECTIVE}");
        return reply.send(&refuse(Code::Malformed, text));
    }
    match permission(&shared.settings.clients, &client) {
        Some(Permission::Command) => {}
        Some(_) if action == Action::Stop => {}
        _ => {
            let text = format!(
                "the client {client} may not make the request `{}`: list the client in [serve.clients] of the server \
                 as `\"{client}\" = \"command\"`, and start the server again",
                action.name()
            );
            return reply.send(&refuse(Code::NotOwner, text));
        }
    }
    shared.desk.lock().note_client(&client);
    carry_out(shared, &request, client, reply);
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
    let refused = run(shared, 0, reply, move |shared| {
        let recovered = recover_for_new_owner(shared, &stops);
        begin(shared, recovered)
    });
    let Some((reply, answer)) = refused else { return };
    let mut desk = shared.desk.lock();
    // Another client may have taken the hand over since.
    if desk.admits(&owner, epoch) {
        desk.abandon(now());
    }
    drop(desk);
    reply.send(&answer);
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
            let text = format!(
                "{other} owns the hand: wait until it releases the hand, or take the hand over (remote.take_over, or \
                 take_over=True in Python)"
            );
            Err(desk.answer(Code::Owned, text, 0, time))
        }
    }
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

#[cfg(test)]
mod tests;
