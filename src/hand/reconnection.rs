//! The ports of a hand that may have to be repaired, and the thread that looks for those that are gone.

use crate::hand::workshop::Workshop;
use crate::realtime::{Priority, spawn};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use parking_lot::Mutex;
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::thread::JoinHandle;
use std::time::Duration;

/// How often a port that is gone is looked for.
const LOOKING_FOR_PORTS: Duration = Duration::from_millis(100);

/// A port that may have to be mended. It outlives its hand where somebody is at work on it.
pub(super) struct Place {
    /// 1 to 3.
    pub fingers: Vec<i32>,
    /// How often the line was repaired and given back to its servo. The recoveries of its fingers reach this number
    /// when the servo takes it.
    pub mended: AtomicU32,
    /// Locked while ports are opened and hands shaken, which takes long. None once the hand is closed.
    pub workshop: Mutex<Option<Workshop>>,
}

/// Every port of a hand, and the thread that looks for those that are gone.
pub(super) struct Recovery {
    pub places: Vec<Arc<Place>>,
    reconnecting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Recovery {
    pub fn new(workshops: Vec<Workshop>) -> Self {
        let place = |workshop: Workshop| {
            let fingers = workshop.boards.iter().map(|board| board.finger).collect();
            Arc::new(Place { fingers, mended: AtomicU32::new(0), workshop: Mutex::new(Some(workshop)) })
        };
        Self { places: workshops.into_iter().map(place).collect(), reconnecting: None }
    }

    /// Starts that thread, where a port asks for it.
    pub fn start(&mut self) -> io::Result<()> {
        let asks = |place: &Arc<Place>| place.workshop.lock().as_ref().is_some_and(|workshop| workshop.reconnect);
        if !self.places.iter().any(asks) {
            return Ok(());
        }
        let (stop, stopped) = bounded(0);
        let places = self.places.clone();
        let thread = spawn("sun2xp ports", Priority::default(), move |_| reconnect(&places, &stopped))?;
        self.reconnecting = Some((stop, thread));
        Ok(())
    }

    /// In a forked child, which has no such thread.
    pub fn forget(&mut self) {
        std::mem::forget(self.reconnecting.take());
    }

    /// Ends that thread, and closes the ports that the servos have lent: waits for whoever is at work on one.
    pub fn end(&mut self) {
        if let Some((stop, thread)) = self.reconnecting.take() {
            drop(stop);
            // A panic has ended it before.
            let _ = thread.join();
        }
        self.places.iter().for_each(|place| *place.workshop.lock() = None);
    }
}

fn reconnect(places: &[Arc<Place>], stopped: &Receiver<()>) {
    while stopped.recv_timeout(LOOKING_FOR_PORTS) == Err(RecvTimeoutError::Timeout) {
        for place in places {
            if let Some(workshop) = &mut *place.workshop.lock()
                && workshop.reconnect
                && !workshop.servo_ended()
                && workshop.fetch()
                && !workshop.checked
            {
                // Whoever recovers the finger is told what is wrong.
                let _ = workshop.mend();
            }
        }
    }
}
