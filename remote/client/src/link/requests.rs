//! The requests of a client, and the gets that carry them.

use super::Link;
use crate::connection;
use crate::error::RemoteError;
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp_remote_protocol::{Action, Answer, Code, Finger, Request};

/// Longest wait for the Answer to most requests. A recovery can take seconds, because it takes up
/// the slack of tendons.
const ANSWER: Duration = Duration::from_secs(30);

/// Longest wait for the Answer to a release or a stop. A planner that closes the hand must not wait longer if the line
/// is cut.
const QUICK_ANSWER: Duration = Duration::from_secs(3);

/// Longest wait for the end of a calibration. By the protocol, clients wait for up to ten minutes.
const CALIBRATION: Duration = Duration::from_secs(610);

/// Attempts of a get that reaches nobody, and the pause between them. Just after a client has connected, Zenoh may not
/// know the way to the server yet.
const ATTEMPTS: usize = 3;
const PAUSE: Duration = Duration::from_millis(200);

/// A get that reaches nobody ends within this time. If a get ends later without a reply, the connection was lost, and
/// the server may have carried out the request.
const NOBODY: Duration = Duration::from_millis(500);

impl Link {
    /// Sends a Request, and waits for its Answer. An Answer that is not *done* is an error.
    pub fn request(&self, action: Action, finger: Option<Finger>, recover: bool) -> Result<Answer, RemoteError> {
        let acquires = action == Action::Acquire;
        let epoch = self.shared.lock().outbox.ownership().map_or(0, |ownership| ownership.epoch);
        let take_over = acquires && self.configuration.take_over;
        let request = Request { action, finger, take_over, recover, epoch };
        let payload = request.encode().map_err(|error| RemoteError::NotConnected(error.to_string()))?;
        let key = self.keys.request(action, &self.client);
        let reply = match action {
            // If the get were repeated, a calibration that has ended meanwhile would begin again.
            Action::Calibrate | Action::Identify => self.get_once(&key, Some(payload), CALIBRATION),
            Action::Release | Action::Stop => self.get(&key, Some(payload), QUICK_ANSWER),
            Action::Acquire | Action::Recover => self.get(&key, Some(payload), ANSWER),
        };
        let Some(payload) = reply? else {
            let reason = format!(
                "the request `{}` has no answer. Check the line and the server, and whether the client {} has the \
                 permission \"command\" in [serve.clients] of the server (a stop needs only \"read\")",
                action.name(),
                self.client
            );
            return Err(self.not_connected(&reason));
        };
        let answer = Answer::decode(&payload).map_err(|error| self.protocol(&error))?;
        match answer.code {
            Code::Done => Ok(answer),
            Code::Owned => Err(RemoteError::Owned(answer.text)),
            Code::NotOwner if !acquires => Err(self.not_owner(answer)),
            code => Err(RemoteError::Answered { code, text: answer.text }),
        }
    }

    /// The error for an Answer that says that this client does not own the hand.
    fn not_owner(&self, answer: Answer) -> RemoteError {
        match self.shared.lock().outbox.ownership() {
            Err(loss) => RemoteError::NotOwner { hand: self.configuration.hand.clone(), loss },
            Ok(_) => RemoteError::Answered { code: Code::NotOwner, text: answer.text },
        }
    }

    /// Sends a get, and repeats it if it has reached nobody. Returns the payload of the reply; none without a reply.
    pub(super) fn get(
        &self,
        key: &str,
        payload: Option<Vec<u8>>,
        limit: Duration,
    ) -> Result<Option<Vec<u8>>, RemoteError> {
        for _ in 1..ATTEMPTS {
            let begun = Instant::now();
            let reply = self.get_once(key, payload.clone(), limit)?;
            if reply.is_some() || begun.elapsed() > NOBODY {
                return Ok(reply);
            }
            sleep(PAUSE);
        }
        self.get_once(key, payload, limit)
    }

    /// Sends a get. Returns the payload of the reply; none without a reply.
    fn get_once(&self, key: &str, payload: Option<Vec<u8>>, limit: Duration) -> Result<Option<Vec<u8>>, RemoteError> {
        let replies = connection::get(&self.session, key, payload, (limit, 1));
        let replies = replies.map_err(|error| {
            self.not_connected(&format!(
                "the request `{key}` has ended without an answer ({error}), and the server may have carried it out. \
                 Check the line and the server"
            ))
        })?;
        Ok(replies.into_iter().next().map(|(_, payload)| payload))
    }
}
