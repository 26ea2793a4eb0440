//! A desk with the simulated hand, and the Targets of its owner.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use sun2xp::finger::FingerReport;
use sun2xp::nalgebra::Vector3;
use sun2xp::realtime::now;
use sun2xp::{Configuration, Hand};
use sun2xp_remote_protocol::{Answer, ClientName, Finger, Part, PathPose, Place, Target};
use sun2xp_serve::desk::Desk;
use sun2xp_serve::server::prepare;
use sun2xp_serve::settings::{Overrides, Settings};

/// Longest time for anything that the tests wait for. The machine of the tests may be busy.
const PATIENCE: Duration = Duration::from_secs(20);

/// Interval of [`Desk::look`].
const LOOK: Duration = Duration::from_millis(5);

/// A place far from where the fingers begin, rad.
pub const FAR: [f64; 3] = [0.4, 0.9, 1.2];

/// Kx, N/cm.
pub const STIFF: [[f64; 3]; 3] = [[5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.0]];

pub struct Rig {
    pub hand: Arc<Hand>,
    pub desk: Desk,
    owner: ClientName,
    epoch: u64,
    sequence: u64,
    /// The newest refusal of a Target, for the message of a wait that fails.
    refusal: Option<Answer>,
}

impl Rig {
    /// `text` is the table `[serve]`.
    pub fn new(text: &str) -> Self {
        let settings = Settings::from_text(&format!("[serve]\n{text}\n"), Path::new("s.toml"), &Overrides::default());
        let settings = settings.unwrap_or_else(|error| panic!("{error}"));
        let mut configuration = Configuration::default();
        prepare(&mut configuration, &settings.limits);
        let hand = Arc::new(Hand::open(configuration).expect("the simulated hand"));
        let desk = Desk::new(hand.clone(), settings.limits, now());
        Self { hand, desk, owner: "nobody".parse().expect("a name"), epoch: 0, sequence: 0, refusal: None }
    }

    /// Makes this client the owner, but does not begin the time limit for its silence. This is the state of the desk
    /// while an acquire recovers fingers.
    pub fn acquire_only(&mut self, client: &str) {
        self.owner = client.parse().expect("a name");
        (self.epoch, self.sequence) = (self.epoch + 1, 0);
        self.desk.acquire(&self.owner, true, self.epoch, now()).expect("acquired");
    }

    pub fn acquire(&mut self, client: &str) {
        self.acquire_only(client);
        assert!(self.desk.begin(&self.owner, self.epoch, now()));
    }

    pub fn report(&self, finger: i32) -> FingerReport {
        self.hand.report(finger).expect("a report")
    }

    /// Gives the desk a Target of the owner. Returns the refusal, if there is one.
    pub fn send(&mut self, parts: &[Part]) -> Option<Answer> {
        self.sequence += 1;
        let (epoch, sequence, seen) = (self.epoch, self.sequence, now());
        // The desk shortens the validity to its catch_ms.
        let target = Target { validity_ms: 10_000, epoch, sequence, sent: sequence, seen, parts: parts.to_vec() };
        let refusal = self.desk.take_target(&self.owner, &target.encode().expect("a Target"), now());
        self.refusal = refusal.clone().or(self.refusal.take());
        refusal
    }

    /// Calls [`Desk::look`] until `found` returns something.
    pub fn wait_for<T>(&mut self, what: &str, mut found: impl FnMut(&mut Self) -> Option<T>) -> T {
        let begun = Instant::now();
        loop {
            if let Some(found) = found(self) {
                return found;
            }
            let stages = || [1, 2, 3].map(|finger| self.hand.report(finger).map(|report| report.stage));
            assert!(begun.elapsed() < PATIENCE, "no {what} in time: {:?}, refusal: {:?}", stages(), self.refusal);
            std::thread::sleep(LOOK);
            self.desk.look(now());
        }
    }

    /// Waits until `holds` returns true. The owner is silent meanwhile.
    pub fn wait_in_silence(&mut self, what: &str, holds: impl Fn(&Self) -> bool) {
        self.wait_for(what, |rig| holds(rig).then_some(()));
    }

    /// Waits until `holds` returns true. Meanwhile, the owner repeats a Target with these parts.
    pub fn wait_until(&mut self, what: &str, parts: &[Part], holds: impl Fn(&Self) -> bool) {
        self.wait_for(what, |rig| {
            rig.send(parts);
            holds(rig).then_some(())
        });
    }
}

pub fn kept(finger: i32, command: u32) -> Part {
    let finger = Finger::new(finger).expect("a finger");
    Part { finger, command, place: Place::Kept, stiffness: None, damping: None }
}

pub fn joints(finger: i32, command: u32, joints: [f64; 3]) -> Part {
    Part { place: Place::Joints(joints), ..kept(finger, command) }
}

/// A path that ends at these joint angles, rad, after `time`, s.
pub fn path(finger: i32, command: u32, time: f64, joints: [f64; 3]) -> Part {
    Part { place: Place::Path(vec![PathPose { time, joints }]), ..kept(finger, command) }
}

pub fn is_near(joints: &Vector3<f64>, others: &Vector3<f64>, tolerance: f64) -> bool {
    (joints - others).amax() <= tolerance
}
