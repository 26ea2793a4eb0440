//! The terminal in raw mode. It is restored when the program ends, also by a panic or a signal.

use crate::interrupt::Interrupt;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event};
use std::io::{self, IsTerminal};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// The terminal. Dropping it restores the screen and the keys.
pub struct Screen {
    /// The terminal for drawing.
    pub terminal: DefaultTerminal,
    interrupt: Interrupt,
    events: Receiver<io::Result<Event>>,
}

impl Screen {
    /// Returns whether standard input and standard output are a terminal.
    pub fn available() -> bool {
        io::stdin().is_terminal() && io::stdout().is_terminal()
    }

    /// Takes the terminal. `urgent` gets each key and change of size first. It runs in the thread that reads them, so
    /// it does not wait for a slow terminal.
    ///
    /// # Errors
    /// Returns an error if the terminal does not permit raw mode.
    pub fn open(urgent: impl Fn(&Event) + Send + 'static) -> io::Result<Self> {
        let interrupt = Interrupt::watch()?;
        // This also installs a panic hook that restores the terminal before the message of the panic is printed.
        let terminal = ratatui::try_init()?;
        // A thread of its own reads the keys. If the terminal is gone, crossterm does not return from reading. The
        // thread then ends with the process.
        let (sender, events) = channel();
        let reading = thread::Builder::new().name("keys".into()).spawn(move || {
            loop {
                let event = event::read();
                let failed = event.as_ref().map(&urgent).is_err();
                if sender.send(event).is_err() || failed {
                    return;
                }
            }
        });
        let screen = Self { terminal, interrupt, events };
        // If the thread does not start, the screen is dropped, which restores the terminal.
        reading.map(|_| screen)
    }

    /// Returns the next key or change of size; none if there is none within `time`.
    ///
    /// # Errors
    /// Returns an error if the terminal cannot be read.
    pub fn event(&self, time: Duration) -> io::Result<Option<Event>> {
        match self.events.recv_timeout(time) {
            Ok(event) => event.map(Some),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                Err(io::Error::other("the thread that reads the keys has ended: start the command again"))
            }
        }
    }

    /// Returns whether a signal asks the program to end.
    pub fn ended(&self) -> bool {
        self.interrupt.requested()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A terminal that is gone needs no restoration.
        let _ = ratatui::try_restore();
    }
}
