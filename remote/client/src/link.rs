//! The link to one hand: a session, the subscriptions, and the thread that sends Targets.

mod requests;

use crate::clock::now;
use crate::configuration::RemoteConfiguration;
use crate::connection;
use crate::error::{Loss, RemoteError};
use crate::events::EventSource;
use crate::exchange::Exchange;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use sun2xp_remote_protocol::{Action, Answer, ClientName, DecodeError, Event, Finger, HandKeys, State, Status};
use zenoh::key_expr::KeyExpr;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::sample::Sample;
use zenoh::{Session, Wait};

/// Longest wait for the Status, and then for the first records.
const FIRST: Duration = Duration::from_secs(3);

/// Longest wait for a State after the Answer to a request.
const NEXT_STATE: Duration = Duration::from_millis(200);

/// What the callbacks, the sending thread and the planner share.
pub struct Shared {
    exchange: Mutex<Exchange>,
    /// Notified when there is something to send, when a State, a Status or a refusal was received, and at the end.
    changed: Condvar,
    /// Whether the sending thread must end. The flag is set under the lock of the exchange, so that the thread cannot
    /// miss it.
    ended: AtomicBool,
    pub events: EventSource,
}

impl Shared {
    pub fn lock(&self) -> MutexGuard<'_, Exchange> {
        self.exchange.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wakes the thread that sends.
    pub fn wake(&self) {
        self.changed.notify_all();
    }

    /// Takes a message. A message that is malformed is counted, and changes nothing.
    fn take<T>(&self, decoded: Result<T, DecodeError>, take: impl FnOnce(&mut Exchange, T)) {
        let mut exchange = self.lock();
        match decoded {
            Ok(message) => take(&mut exchange, message),
            Err(error) => exchange.view.drop_malformed(error),
        }
        drop(exchange);
        self.changed.notify_all();
    }
}

/// The link to one hand. Dropping it ends the thread and the session.
pub struct Link {
    session: Session,
    pub shared: Arc<Shared>,
    sender: Option<JoinHandle<()>>,
    pub configuration: RemoteConfiguration,
    client: ClientName,
    keys: HandKeys,
}

impl Link {
    /// Connects, subscribes, and waits for the Status and for a record of every finger. The hand is not owned yet.
    pub fn open(configuration: &RemoteConfiguration) -> Result<Self, RemoteError> {
        let client = configuration.checked_client()?;
        let (hand, endpoint) = (configuration.hand.clone(), configuration.endpoint.clone());
        let shared = Arc::new(Shared {
            exchange: Mutex::new(Exchange::new(hand.clone(), endpoint, configuration.stale_ms)),
            changed: Condvar::new(),
            ended: AtomicBool::new(false),
            events: EventSource::default(),
        });
        let (session, keys) = (connection::open(configuration)?, HandKeys::new(hand));
        let mut link = Self { session, shared, sender: None, configuration: configuration.clone(), client, keys };
        link.subscribe().map_err(|error| link.undeclared(&error))?;
        link.first_status()?;
        link.sender = Some(link.start_sender()?);
        link.wait_for_records()?;
        Ok(link)
    }

    /// The error if Zenoh refuses a subscription or a key.
    fn undeclared(&self, error: &zenoh::Error) -> RemoteError {
        let reason = connection::short(error);
        let remedy = "Open the hand again. If this happens again, please report this defect";
        self.not_connected(&format!("{reason}. {remedy}"))
    }

    fn not_connected(&self, reason: &str) -> RemoteError {
        let (hand, endpoint) = (&self.configuration.hand, &self.configuration.endpoint);
        RemoteError::NotConnected(format!("cannot reach the hand \"{hand}\" at {endpoint}: {reason}"))
    }

    fn subscribe(&self) -> zenoh::Result<()> {
        self.listen(self.keys.state(), |shared, payload| {
            shared.take(State::decode(payload), |exchange, state| exchange.take_state(&state, now()));
        })?;
        self.listen(self.keys.status(), |shared, payload| {
            shared.take(Status::decode(payload), |exchange, status| exchange.view.take_status(status));
        })?;
        self.listen(self.keys.refused(&self.client), |shared, payload| {
            shared.take(Answer::decode(payload), |exchange, answer| exchange.take_refusal(&answer));
        })?;
        self.listen(self.keys.events(), |shared, payload| match Event::decode(payload) {
            Ok(event) => shared.events.put(event),
            Err(error) => shared.lock().view.drop_malformed(error),
        })
    }

    /// Calls `take` with every payload of a key, in a thread of Zenoh.
    fn listen(&self, key: String, take: fn(&Shared, &[u8])) -> zenoh::Result<()> {
        let shared = self.shared.clone();
        let callback = move |sample: Sample| take(&shared, &sample.payload().to_bytes());
        self.session.declare_subscriber(key).callback(callback).background().wait()
    }

    /// Requests the Status, and so finds out whether the hand is there.
    fn first_status(&self) -> Result<(), RemoteError> {
        let Some(payload) = self.get(&self.keys.status(), None, FIRST)? else {
            return Err(self.not_connected(
                "nobody answers for it. Check remote.hand, and whether the server lists this client in \
                 [serve.clients]. If remote.endpoint leads to a router, check whether `sun2xp serve` of this hand is \
                 connected to that router",
            ));
        };
        let status = Status::decode(&payload).map_err(|error| self.protocol(&error))?;
        self.shared.lock().view.take_status(status);
        Ok(())
    }

    fn protocol(&self, error: &DecodeError) -> RemoteError {
        RemoteError::Protocol { hand: self.configuration.hand.clone(), reason: error.to_string() }
    }

    /// Waits until a record of every finger was received, so that every finger can be read and commanded.
    fn wait_for_records(&self) -> Result<(), RemoteError> {
        let missing = |exchange: &mut Exchange| {
            let has =
                |finger: &Finger| exchange.view.status().is_some_and(|status| status.fingers[finger.index()].is_some());
            Finger::ALL.iter().any(|finger| has(finger) && exchange.view.newest(*finger).is_none())
        };
        let waited = self.shared.changed.wait_timeout_while(self.shared.lock(), FIRST, missing);
        let (exchange, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        match (waited.timed_out(), exchange.view.malformed()) {
            (false, _) => Ok(()),
            (true, None) => Err(self.not_connected(
                "the server answers, but no State (the message with the measured cycles) arrives. Check whether the \
                 server permits this client to read",
            )),
            (true, Some(error)) => Err(self.protocol(error)),
        }
    }

    fn start_sender(&self) -> Result<JoinHandle<()>, RemoteError> {
        let key = KeyExpr::try_from(self.keys.target(&self.client));
        let key = key.map_err(|error| self.undeclared(&error))?;
        let (shared, session) = (self.shared.clone(), self.session.clone());
        let thread = std::thread::Builder::new().name("sun2xp targets".into());
        let started = thread.spawn(move || send(&shared, &session, &key));
        started.map_err(|source| RemoteError::System { doing: "start the thread that sends Targets".into(), source })
    }

    /// Becomes the owner of the hand. `recover` also recovers the fingers that have stopped.
    pub fn acquire(&self, recover: bool) -> Result<(), RemoteError> {
        let answer = self.request(Action::Acquire, None, recover)?;
        self.shared.lock().outbox.acquired(&answer);
        self.shared.wake();
        self.await_state_after(&answer);
        Ok(())
    }

    /// Waits until a State arrives that is newer than this Answer, for at most [`NEXT_STATE`]. An older State may show
    /// that a finger still recovers. If no State arrives, this function returns no error, because the calls that need
    /// a recent State check its age.
    pub fn await_state_after(&self, answer: &Answer) {
        let older = |exchange: &mut Exchange| !exchange.view.is_newer_than(answer.time);
        drop(self.shared.changed.wait_timeout_while(self.shared.lock(), NEXT_STATE, older));
    }

    /// Releases the hand if it is owned.
    pub fn release(&self) -> Result<(), RemoteError> {
        if self.shared.lock().outbox.ownership().is_err() {
            return Ok(());
        }
        let released = self.request(Action::Release, None, false);
        self.shared.lock().outbox.lose(Loss::Released);
        released.map(drop)
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        let mut exchange = self.shared.lock();
        exchange.outbox.lose(Loss::Released);
        self.shared.ended.store(true, Ordering::Relaxed);
        drop(exchange);
        self.shared.wake();
        if let Some(sender) = self.sender.take() {
            // The thread does not panic.
            let _ = sender.join();
        }
        self.shared.events.close();
        // An error of `close` is ignored, because the session is closed even then.
        let _ = self.session.close().wait();
    }
}

/// Sends Targets until `Shared::ended` is set.
fn send(shared: &Shared, session: &Session, key: &KeyExpr<'_>) {
    let mut exchange = shared.lock();
    while !shared.ended.load(Ordering::Relaxed) {
        let now = now();
        if let Some(target) = exchange.outbox.next(now) {
            exchange.view.statistics.targets += 1;
            drop(exchange);
            // A Target that is lost, or that cannot be sent now, is repeated.
            if let Ok(payload) = target.encode() {
                // The session itself sends. A declared publisher would send nothing until it knows of a subscriber.
                let put = session.put(key, payload).congestion_control(CongestionControl::Drop);
                let _ = put.priority(Priority::RealTime).express(true).wait();
            }
            exchange = shared.lock();
            continue;
        }
        exchange = match exchange.outbox.due() {
            None => shared.changed.wait(exchange).unwrap_or_else(PoisonError::into_inner),
            Some(due) => {
                let left = Duration::from_nanos(due.saturating_sub(now));
                shared.changed.wait_timeout(exchange, left).unwrap_or_else(PoisonError::into_inner).0
            }
        };
    }
}
