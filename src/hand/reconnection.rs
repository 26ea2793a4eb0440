//! The ports of a hand, and the thread that reopens those that are gone.

use crate::finger::StopSignal;
use crate::hand::port_repair::PortRepair;
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
use crate::realtime::{Mutex, Priority, spawn};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::thread::JoinHandle;
use std::time::Duration;

/// Interval between two attempts to open a port that is gone.
const RETRY_INTERVAL: Duration = Duration::from_millis(100);

/// A port with its repair data. It may outlive its hand while a repair is in progress.
pub(super) struct RepairablePort {
    /// The fingers at this port.
    pub fingers: Vec<FingerNumber>,
    /// For each finger, in the order of `fingers`: the number of repairs that included the finger. The servo counts the
    /// recoveries of each finger. After a repair, the finger has more repairs than recoveries until the servo takes the
    /// finger back.
    pub repairs: [AtomicU32; FINGERS],
    /// Locked during a repair, which takes long. `None` after the hand is closed.
    pub repair: Mutex<Option<PortRepair>>,
}

/// All ports of a hand, and the thread that reopens those that are gone.
pub(super) struct Recovery {
    pub ports: Vec<Arc<RepairablePort>>,
    /// The signal that stops the fingers.
    pub alarm: StopSignal,
    reconnecting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Recovery {
    pub fn new(repairs: Vec<PortRepair>, alarm: StopSignal) -> Self {
        let port = |repair: PortRepair| {
            let fingers = repair.boards.iter().map(|board| board.finger).collect();
            Arc::new(RepairablePort { fingers, repairs: Default::default(), repair: Mutex::new(Some(repair)) })
        };
        Self { ports: repairs.into_iter().map(port).collect(), alarm, reconnecting: None }
    }

    /// Starts the thread, if a port is configured to be reopened.
    pub fn start(&mut self) -> io::Result<()> {
        let reopens = |port: &Arc<RepairablePort>| port.repair.lock().as_ref().is_some_and(|repair| repair.reconnect);
        if !self.ports.iter().any(reopens) {
            return Ok(());
        }
        let (stop, stopped) = bounded(0);
        let ports = self.ports.clone();
        let thread = spawn("sun2xp ports", Priority::default(), move |_| reconnect(&ports, &stopped))?;
        self.reconnecting = Some((stop, thread));
        Ok(())
    }

    /// Forgets the thread. A forked child calls this, because it does not have the thread.
    pub fn forget(&mut self) {
        std::mem::forget(self.reconnecting.take());
    }

    /// Ends the thread, and closes the links that the servos have released. Waits for repairs in progress.
    pub fn end(&mut self) {
        if let Some((stop, thread)) = self.reconnecting.take() {
            drop(stop);
            // The join fails only if the thread panicked.
            let _ = thread.join();
        }
        self.ports.iter().for_each(|port| *port.repair.lock() = None);
    }
}

fn reconnect(ports: &[Arc<RepairablePort>], stopped: &Receiver<()>) {
    while stopped.recv_timeout(RETRY_INTERVAL) == Err(RecvTimeoutError::Timeout) {
        for port in ports {
            if let Some(repair) = &mut *port.repair.lock()
                && repair.reconnect
                && !repair.servo_ended()
                && repair.take_link()
                && !repair.checked
            {
                // The error is discarded. A call that recovers the finger tries again, and reports its own error.
                let _ = repair.reopen();
            }
        }
    }
}
