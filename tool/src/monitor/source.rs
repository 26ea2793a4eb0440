//! The thread that reads the messages of a hand, so that the reaction to a key never waits for them.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle, sleep};
use std::time::Duration;
use sun2xp::model::configuration::FINGERS;
use sun2xp::telemetry::{self, AttachError, Description, Message, Reader};

/// Time for which a read waits for messages.
const READ_TIME: Duration = Duration::from_millis(200);

/// Interval at which a missing hand is looked for.
const SEARCH_INTERVAL: Duration = Duration::from_millis(300);

/// Largest number of news items that wait. The terminal may take nothing for hours, for example because its connection
/// is stalled. Meanwhile the memory of this process must not grow. What does not fit waits in the memory of the hand,
/// which loses the oldest cycles after two seconds.
const WAITING: usize = 8;

/// The hand to read.
#[derive(Clone, Debug)]
pub enum Wanted {
    /// The hand with this name, or the only hand.
    Named(Option<String>),
    /// The hand that the process with this number has opened.
    Process(u32),
}

/// What happens at the hand.
pub enum News {
    /// There is no hand. The text names the cause and the remedy.
    Missing(String),
    /// The reader is attached to a hand.
    Attached(Box<Description>),
    /// Messages, and the number of cycles of each finger that are missing before or between them.
    Messages(Vec<Message>, [u64; FINGERS]),
    /// The hand has ended.
    Ended(String),
}

/// The thread that reads. Dropping this value ends the thread.
pub struct Source {
    /// The news in their order.
    pub news: Receiver<News>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Source {
    /// Starts to read a hand. When the hand ends, waits for the next one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(wanted: Wanted) -> io::Result<Self> {
        let (sender, news) = sync_channel(WAITING);
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let ended = ended.clone();
            thread::Builder::new().name("telemetry".into()).spawn(move || {
                // `run` fails only when the receiver is gone. The `Source` is dropped then, and nobody needs the error.
                let _ = run(&wanted, &sender, &ended);
            })?
        };
        Ok(Self { news, ended, thread: Some(thread) })
    }
}

impl Drop for Source {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        // The thread may be waiting for room in the channel. This statement drops the receiver, which ends the wait.
        self.news = sync_channel(0).1;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Wanted {
    /// Attaches a reader to the hand.
    ///
    /// # Errors
    /// Returns an error if there is no such hand, or if it does not answer.
    pub fn attach(&self) -> Result<Reader, AttachError> {
        let process = match self {
            Self::Named(name) => return Reader::attach(name.as_deref()),
            Self::Process(process) => *process,
        };
        let mut refusal = AttachError::NoHand;
        for name in telemetry::hands().map_err(AttachError::Names)? {
            match Reader::attach(Some(&name)) {
                Ok(reader) if reader.description().process == process => return Ok(reader),
                Ok(_) => {}
                // This hand may belong to the process. If no other hand belongs to it, the caller gets this error.
                Err(error) => refusal = error,
            }
        }
        Err(refusal)
    }
}

/// Reads one hand after the other until `ended` is set. Returns an error if nobody receives the news.
fn run(wanted: &Wanted, news: &SyncSender<News>, ended: &AtomicBool) -> Result<(), ()> {
    let send = |piece| news.send(piece).map_err(|_| ());
    let mut missing = String::new();
    while !ended.load(Ordering::Relaxed) {
        let mut reader = match wanted.attach() {
            Ok(reader) => reader,
            Err(error) => {
                let text = error.to_string();
                if text != missing {
                    send(News::Missing(text.clone()))?;
                    missing = text;
                }
                sleep(SEARCH_INTERVAL);
                continue;
            }
        };
        missing.clear();
        send(News::Attached(Box::new(reader.description().clone())))?;
        while !ended.load(Ordering::Relaxed) {
            let mut messages = Vec::new();
            match reader.read(READ_TIME, &mut messages) {
                Ok(received) if messages.is_empty() && received.lost == [0; FINGERS] => {}
                Ok(received) => send(News::Messages(messages, received.lost))?,
                Err(end) => {
                    send(News::Messages(messages, [0; FINGERS]))?;
                    send(News::Ended(end.to_string()))?;
                    break;
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::Hand;
    use sun2xp::model::configuration::Configuration;

    /// Opens a hand, and starts a source that reads it. Returns after two seconds, in which nobody has taken the news.
    fn watched(name: &str) -> (Hand, Source) {
        let mut configuration = Configuration::default();
        configuration.telemetry.name = format!("source-{}-{name}", std::process::id());
        let wanted = Wanted::Named(Some(configuration.telemetry.name.clone()));
        let hand = Hand::open(configuration).expect("the simulated hand opens");
        let source = Source::start(wanted).expect("a thread");
        let cycles = || hand.report(1).expect("open").losses.cycles;
        let end = cycles() + 2000;
        while cycles() < end {
            sleep(Duration::from_millis(10));
        }
        (hand, source)
    }

    #[test]
    fn unread_news_needs_little_memory() {
        let (hand, source) = watched("stalled");
        drop(hand);
        let mut count = 0;
        // The time limit is long, because the machine that runs the tests may be busy.
        while !matches!(source.news.recv_timeout(Duration::from_secs(60)).expect("news"), News::Ended(_)) {
            count += 1;
        }
        // The hand publishes 20 times a second, 40 times in the two seconds of `watched`. An unlimited queue would hold
        // all of these messages.
        assert!(count < 25, "{count} news");
    }

    #[test]
    fn a_source_ends_although_nobody_takes_its_news() {
        let (_hand, source) = watched("ended");
        drop(source);
    }
}
