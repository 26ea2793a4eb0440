//! Requests that take long. Each runs in a thread of its own, because the threads of zenoh must not wait.

use super::reply::{Reply, ended, in_progress};
use crate::desk::code_of;
use crate::output::complain;
use crate::shared::Shared;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use sun2xp::HandError;
use sun2xp::realtime::{Mutex, Priority, now, spawn};
use sun2xp_remote_protocol::Answer;

/// Runs a request that takes long, unless another such request is running.
pub(super) fn long(
    shared: &Arc<Shared>,
    epoch: u64,
    reply: impl Reply,
    body: impl FnOnce(&Shared) -> Answer + Send + 'static,
) {
    let refused = match shared.busy.swap(true, Ordering::AcqRel) {
        true => Some((reply, in_progress(&shared.desk.lock(), epoch))),
        false => run(shared, epoch, reply, body),
    };
    if let Some((reply, answer)) = refused {
        reply.send(&answer);
    }
}

/// Starts a thread that runs a request and sends its Answer. The caller has set `busy`. If the server ends, or if the
/// system cannot start a thread, returns `reply` and the refusal, which has this epoch. The caller then sends the
/// refusal.
pub(super) fn run<R: Reply>(
    shared: &Arc<Shared>,
    epoch: u64,
    reply: R,
    body: impl FnOnce(&Shared) -> Answer + Send + 'static,
) -> Option<(R, Answer)> {
    // The code that ends the server sets `ending` before it takes this lock, so it waits for every thread that starts
    // here.
    let mut threads = shared.requests.lock();
    if shared.ending.load(Ordering::Acquire) {
        shared.busy.store(false, Ordering::Release);
        return Some((reply, ended(&shared.desk.lock(), epoch)));
    }
    // If the thread cannot be started, its closure is dropped with everything that it owns. `kept` keeps the reply.
    let kept = Arc::new(Mutex::new(Some(reply)));
    let (of_thread, of_reply) = (shared.clone(), kept.clone());
    let started = spawn("sun2xp request", Priority::default(), move |_| {
        let answer = body(&of_thread);
        // `busy` is cleared before the Answer is sent, because a client that has the Answer may send the next request
        // at once.
        of_thread.busy.store(false, Ordering::Release);
        let reply = of_reply.lock().take();
        if let Some(reply) = reply {
            reply.send(&answer);
        }
    });
    match started {
        Ok(thread) => {
            threads.retain(|thread| !thread.is_finished());
            threads.push(thread);
            None
        }
        Err(source) => {
            shared.busy.store(false, Ordering::Release);
            let error = HandError::System { doing: "start a thread for a request", source };
            complain(&error.to_string());
            let answer = shared.desk.lock().answer(code_of(&error), error.to_string(), epoch, now());
            let reply = kept.lock().take();
            reply.map(|reply| (reply, answer))
        }
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
