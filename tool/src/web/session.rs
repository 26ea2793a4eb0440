//! One page: its WebSocket, from the first message to the last.

use super::control::{Answer, Control};
use super::hub::{Hub, Kind, Update};
use crate::jog::commands::Command;
use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, WebSocket, close_code};
use serde::Deserialize;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{MissedTickBehavior, interval, timeout};

/// Number of batches that a page may have received without an acknowledgement: one second. A page with this many
/// unacknowledged batches gets no further batch until it acknowledges one.
const AHEAD: u64 = 20;

/// Largest message from a page, bytes. Commands have some 200.
pub const LARGEST_MESSAGE: usize = 1024;

/// A page that cannot take a message for this time is disconnected.
const STALLED: Duration = Duration::from_secs(10);

/// Interval of the pings, which keep the connection open while the page has nothing to acknowledge.
const PING: Duration = Duration::from_secs(5);

/// A message from the page.
#[derive(Deserialize)]
#[serde(untagged)]
enum Request {
    /// The page has received a batch.
    Received(Received),
    /// The page moves the hand.
    Command(Command),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Received {
    /// The number of the batch.
    received: u64,
}

/// The session of a page. It ends when the page leaves, breaks a rule or takes no more messages.
pub struct Session {
    socket: WebSocket,
    hub: Arc<Hub>,
    control: Option<Arc<Control>>,
    answers: (UnboundedSender<Answer>, UnboundedReceiver<Answer>),
    sent: u64,
    received: u64,
    /// The fingers that this page pushes.
    pushed: Vec<i32>,
}

/// Why a session ends.
struct End;

impl Session {
    /// Returns a session that may send commands if there is a `control`.
    pub fn new(socket: WebSocket, hub: Arc<Hub>, control: Option<Arc<Control>>) -> Self {
        Self { socket, hub, control, answers: unbounded_channel(), sent: 0, received: 0, pushed: Vec::new() }
    }

    /// Serves the page until it leaves.
    pub async fn run(mut self) {
        // The page is gone in either case.
        let _ = self.serve().await;
        if let Some(control) = &self.control {
            control.release(&self.pushed);
        }
    }

    async fn serve(&mut self) -> Result<(), End> {
        let (known, mut updates) = self.hub.subscribe();
        self.send_all(known).await?;
        let mut ping = interval(PING);
        ping.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                update = updates.recv() => match update {
                    Ok(update) => self.pass_on(update).await?,
                    Err(RecvError::Lagged(_)) => {
                        // The page has missed messages. It counts the lost batches. All other messages are repeated.
                        let (known, anew) = self.hub.subscribe();
                        updates = anew;
                        self.send_all(known).await?;
                    }
                    Err(RecvError::Closed) => return Ok(()),
                },
                message = self.socket.recv() => match message {
                    Some(Ok(message)) => self.take(message).await?,
                    Some(Err(_)) | None => return Ok(()),
                },
                Some(answer) = self.answers.1.recv() => self.send(answer.json().into()).await?,
                _ = ping.tick() => self.write(Message::Ping(Vec::new().into())).await?,
            }
        }
    }

    async fn pass_on(&mut self, update: Update) -> Result<(), End> {
        if update.kind == Kind::Batch {
            if self.sent >= self.received + AHEAD {
                return Ok(());
            }
            self.sent += 1;
        }
        self.send(update.text).await
    }

    async fn take(&mut self, message: Message) -> Result<(), End> {
        let text = match message {
            Message::Text(text) => text,
            Message::Ping(_) | Message::Pong(_) => return Ok(()),
            Message::Binary(_) => return self.close("a binary message").await,
            Message::Close(_) => return Err(End),
        };
        match serde_json::from_str(&text) {
            // The number of a batch also counts batches that this page did not get. So it is not used, and the
            // acknowledgements are counted.
            Ok(Request::Received(Received { received: 1.. })) => self.received = self.sent.min(self.received + 1),
            Ok(Request::Received(_)) => return self.close("an acknowledgement of no batch").await,
            Ok(Request::Command(command)) => return self.order(command).await,
            Err(_) => return self.close("a message that is neither a command nor an acknowledgement").await,
        }
        Ok(())
    }

    async fn order(&mut self, command: Command) -> Result<(), End> {
        let Some(control) = &self.control else {
            return self.close("a command, but sun2xp runs without --control").await;
        };
        if let Command::Push { finger, .. } = command
            && !self.pushed.contains(&finger)
        {
            self.pushed.push(finger);
        }
        control.order(command, self.answers.0.clone());
        Ok(())
    }

    async fn send_all(&mut self, texts: Vec<Utf8Bytes>) -> Result<(), End> {
        for text in texts {
            self.send(text).await?;
        }
        Ok(())
    }

    async fn send(&mut self, text: Utf8Bytes) -> Result<(), End> {
        self.write(Message::Text(text)).await
    }

    async fn write(&mut self, message: Message) -> Result<(), End> {
        match timeout(STALLED, self.socket.send(message)).await {
            Ok(Ok(())) => Ok(()),
            Ok(Err(_)) | Err(_) => Err(End),
        }
    }

    /// Ends the session of a page that breaks a rule.
    async fn close(&mut self, reason: &'static str) -> Result<(), End> {
        let frame = CloseFrame { code: close_code::POLICY, reason: reason.into() };
        self.write(Message::Close(Some(frame))).await?;
        Err(End)
    }
}
