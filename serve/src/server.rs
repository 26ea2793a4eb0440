//! The server: subscribes to Targets, answers Requests, and publishes.

use crate::ServeError;
use crate::access::at_hand;
use crate::answers::{Answers, send};
use crate::publishing::Publishing;
use crate::queries::on_request;
use crate::requests;
use crate::session;
use crate::settings::{Limits, Settings};
use crate::shared::Shared;
use crate::status::status;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::JoinHandle;
use sun2xp::motion::ExpiryReaction;
use sun2xp::realtime::{Clock, MonotonicClock, Priority, now, spawn};
use sun2xp::{Configuration, Hand};
use sun2xp_remote_protocol::{Action, Answer, ClientName, Status};
use zenoh::sample::Sample;
use zenoh::{Session, Wait};

/// Interval at which set points are advanced and the silence of the owner is checked, ns.
const LOOK_INTERVAL: u64 = 5_000_000;

/// A server that offers a hand. [`Server::end`] must be called at its end.
#[must_use = "a server offers its hand until `end` is called"]
pub struct Server {
    shared: Arc<Shared>,
    session: Session,
    threads: Vec<JoinHandle<()>>,
}

/// Configures the dead man's handle of the servos: a finger whose Target has become invalid holds its pose softly. The
/// server passes the times for this reaction with each command.
pub fn prepare(configuration: &mut Configuration, limits: &Limits) {
    for finger in &mut configuration.fingers {
        finger.motion.on_expiry = ExpiryReaction::Hold;
        finger.motion.expired_stiffness = limits.soft_stiffness;
        (finger.motion.valid_ms, finger.motion.end_state_ms) = (None, None);
    }
}

impl Server {
    /// Offers this hand, whose configuration was prepared with [`prepare`].
    ///
    /// # Errors
    /// Returns an error if the network cannot be used.
    pub fn start(hand: Hand, settings: Settings) -> Result<Self, ServeError> {
        let access = at_hand(&settings.name, &settings.clients);
        let session = session::open(&settings, &access, session::LARGEST_OF_HAND)?;
        let shared = Arc::new(Shared::new(Arc::new(hand), settings));
        let mut server = Self { shared, session, threads: Vec::new() };
        match server.declare() {
            Ok(()) => Ok(server),
            Err(error) => {
                server.end();
                Err(error)
            }
        }
    }

    fn declare(&mut self) -> Result<(), ServeError> {
        let publishing = Publishing::new(&self.shared, &self.session)?;
        let (answers, queues) = Answers::new();
        let (session, of_others) = (self.session.clone(), self.session.clone());
        self.thread("sun2xp states", move |_| publishing.run())?;
        self.thread("sun2xp desk", |shared| look(&shared))?;
        self.thread("sun2xp answers", move |shared| send(&shared, &session, &queues.requests))?;
        self.thread("sun2xp others", move |shared| send(&shared, &of_others, &queues.others))?;
        for action in Action::ALL {
            let (shared, answers) = (self.shared.clone(), answers.clone());
            let declared = self.session.declare_queryable(self.shared.keys.every_request(action));
            let declared = declared.callback(move |query| on_request(&shared, &answers, action, query));
            declared.background().wait().map_err(refused(action.name()))?;
        }
        let of_status = answers.clone();
        let declared = self.session.declare_queryable(self.shared.keys.status());
        let declared = declared.callback(move |query| of_status.status(query)).background().wait();
        declared.map_err(refused("status"))?;
        let shared = self.shared.clone();
        let declared = self.session.declare_subscriber(self.shared.keys.every_target());
        let declared = declared.callback(move |sample| on_target(&shared, &answers, &sample)).background().wait();
        declared.map_err(refused("target"))
    }

    fn thread(&mut self, name: &str, body: impl FnOnce(Arc<Shared>) + Send + 'static) -> Result<(), ServeError> {
        let shared = self.shared.clone();
        let started = spawn(name, Priority::default(), move |_| body(shared));
        self.threads.push(started.map_err(|error| ServeError::refused("start a thread", &error))?);
        Ok(())
    }

    /// Returns the hand, for tests and benchmarks in the same process.
    pub fn hand(&self) -> &Hand {
        &self.shared.hand
    }

    /// Takes a payload as if it had arrived now under the key of this client, for tests in the same process. Returns
    /// the refusal of the hand, if it refuses a Target.
    #[must_use]
    pub fn take_target(&self, client: &ClientName, payload: &[u8]) -> Option<Answer> {
        self.shared.desk.lock().take_target(client, payload, now())
    }

    /// Returns the present Status, for tests in the same process.
    #[must_use]
    pub fn status(&self) -> Status {
        status(&self.shared.hand, &self.shared.settings.limits, &self.shared.desk.lock(), now())
    }

    /// Ends the ownership, brings every finger to its end state, and closes session and hand. Requests are refused from
    /// then on, except stop.
    pub fn end(self) {
        let Self { shared, session, threads } = self;
        shared.ending.store(true, Ordering::Release);
        shared.desk.lock().abandon(now());
        // Recoveries and calibrations in progress end too. Their clients get an Answer before the session is closed.
        shared.hand.end();
        requests::join(&shared);
        shared.answered.store(true, Ordering::Release);
        for thread in threads {
            // A panic in such a thread has been reported already.
            let _ = thread.join();
        }
        // A session that cannot be closed any more has ended already.
        let _ = session.close().wait();
    }
}

fn refused(what: &'static str) -> impl Fn(zenoh::Error) -> ServeError {
    move |error| ServeError::undeclared(what, error)
}

/// Advances set points and checks the silence of the owner, until the server ends.
fn look(shared: &Shared) {
    let mut next = now();
    while !shared.ending.load(Ordering::Acquire) {
        shared.desk.lock().look(now());
        next = (next + LOOK_INTERVAL).max(now());
        MonotonicClock.sleep_until(next);
    }
}

/// Takes a Target. If it is applied, its set points are in the mailboxes of the fingers when this function returns.
fn on_target(shared: &Shared, answers: &Answers, sample: &Sample) {
    let Some(client) = shared.keys.client_of_target(sample.key_expr().as_str()) else { return };
    let time = now();
    let payload = sample.payload().to_bytes();
    let refusal = shared.desk.lock().take_target(&client, &payload, time);
    if let Some(bytes) = refusal.and_then(|answer| answer.encode().ok()) {
        answers.refuse(client, bytes);
    }
}
