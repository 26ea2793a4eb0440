//! One page: its WebSocket, from the first message to the last.

use super::control::{Answer, Control};
use super::hub::{Hub, Kind, Update};
use crate::jog::commands::Command;
use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, WebSocket, close_code};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use serde::Deserialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{MissedTickBehavior, interval, timeout};

/// Largest number of batches that are sent to a page without an acknowledgement. The hand publishes this many batches
/// in a second. A page with this many unacknowledged batches gets no further batch until it acknowledges one.
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

/// The session of a page. It ends when the page leaves, breaks a rule or takes no more messages. Its two directions do
/// not wait for each other, so that a stop is carried out even while a message cannot be written.
pub struct Session {
    reader: Reader,
    writer: Writer,
}

/// Numbers of batches.
#[derive(Default)]
struct Batches {
    sent: AtomicU64,
    received: AtomicU64,
}

/// What the page sends.
struct Reader {
    socket: SplitStream<WebSocket>,
    control: Option<Arc<Control>>,
    answers: UnboundedSender<Answer>,
    batches: Arc<Batches>,
    /// The fingers that this page pushes.
    pushed: Vec<i32>,
}

/// What the page gets.
struct Writer {
    socket: SplitSink<WebSocket, Message>,
    hub: Arc<Hub>,
    answers: UnboundedReceiver<Answer>,
    batches: Arc<Batches>,
}

/// The error of a page that takes no more messages. It ends the session.
struct End;

impl Session {
    /// Returns a session that may send commands if there is a `control`.
    pub fn new(socket: WebSocket, hub: Arc<Hub>, control: Option<Arc<Control>>) -> Self {
        let (to_page, from_page) = socket.split();
        let (sender, receiver) = unbounded_channel();
        let batches = Arc::<Batches>::default();
        let reader =
            Reader { socket: from_page, control, answers: sender, batches: batches.clone(), pushed: Vec::new() };
        Self { reader, writer: Writer { socket: to_page, hub, answers: receiver, batches } }
    }

    /// Serves the page until it leaves.
    pub async fn run(self) {
        let Self { mut reader, mut writer } = self;
        let broken = tokio::select! {
            broken = reader.serve() => broken,
            // The page takes no more messages.
            _ = writer.serve() => None,
        };
        if let Some(control) = &reader.control {
            control.release(&reader.pushed);
        }
        if let Some(reason) = broken {
            let frame = CloseFrame { code: close_code::POLICY, reason: reason.into() };
            // The session ends even if the page does not get this message.
            let _ = writer.write(Message::Close(Some(frame))).await;
        }
    }
}

impl Batches {
    /// Notes that the page has received a batch. The number of the batch also counts batches that this page did not
    /// get. So it is not used, and the acknowledgements are counted.
    fn acknowledge(&self) {
        let received = self.received.load(Ordering::Relaxed) + 1;
        self.received.store(received.min(self.sent.load(Ordering::Relaxed)), Ordering::Relaxed);
    }

    /// Counts a batch that is sent now. Returns false if the page must first acknowledge an earlier one.
    fn send(&self) -> bool {
        let sent = self.sent.load(Ordering::Relaxed);
        let room = sent < self.received.load(Ordering::Relaxed) + AHEAD;
        self.sent.store(sent + u64::from(room), Ordering::Relaxed);
        room
    }
}

impl Reader {
    /// Takes what the page sends until the page leaves or breaks a rule. If the page breaks a rule, returns a
    /// description of the message that breaks it.
    async fn serve(&mut self) -> Option<&'static str> {
        loop {
            let text = match self.socket.next().await {
                Some(Ok(Message::Text(text))) => text,
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                Some(Ok(Message::Binary(_))) => return Some("a binary message"),
                Some(Ok(Message::Close(_)) | Err(_)) | None => return None,
            };
            match serde_json::from_str(&text) {
                Ok(Request::Received(Received { received: 1.. })) => self.batches.acknowledge(),
                Ok(Request::Received(_)) => {
                    return Some("an acknowledgement of batch 0, but the first batch has the number 1");
                }
                Ok(Request::Command(command)) if self.control.is_some() => self.order(command),
                Ok(Request::Command(_)) => return Some("a command, but sun2xp runs without --control"),
                Err(_) => return Some("a message that is neither a command nor an acknowledgement"),
            }
        }
    }

    fn order(&mut self, command: Command) {
        let Some(control) = &self.control else { return };
        if let Command::Push { finger, .. } = command
            && !self.pushed.contains(&finger)
        {
            self.pushed.push(finger);
        }
        control.order(command, self.answers.clone());
    }
}

impl Writer {
    /// Sends messages until the page takes no more.
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
                Some(answer) = self.answers.recv() => self.send(answer.json().into()).await?,
                _ = ping.tick() => self.write(Message::Ping(Vec::new().into())).await?,
            }
        }
    }

    async fn pass_on(&mut self, update: Update) -> Result<(), End> {
        if update.kind == Kind::Batch && !self.batches.send() {
            return Ok(());
        }
        self.send(update.text).await
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
}
