//! Two network namespaces, and between them a cable that a test can spoil.
#![allow(unsafe_code, reason = "waits for descriptors")]

use super::namespace::Namespace;
use super::shaper::{Conditions, Shaper};
use super::tun;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::AsRawFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Longest time after which the relay notices that it must end, or that the conditions have changed.
const POLL: Duration = Duration::from_millis(2);

/// Largest IP packet of the interfaces.
const LARGEST: usize = 1500;

/// One direction of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the left namespace to the right one.
    Right,
    /// From the right namespace to the left one.
    Left,
}

/// Two namespaces and the line between them.
pub struct Line {
    /// The namespace with the address [`Line::LEFT`].
    pub left: Namespace,
    /// The namespace with the address [`Line::RIGHT`].
    pub right: Namespace,
    shapers: Arc<[Mutex<Shaper>; 2]>,
    ends: Arc<AtomicBool>,
    relay: Option<JoinHandle<()>>,
}

impl Line {
    pub const LEFT: &str = "10.17.0.1";
    pub const RIGHT: &str = "10.17.0.2";

    /// Makes the namespaces and a perfect line. Equal seeds give equal losses and delays for equal packets.
    ///
    /// # Errors
    /// Returns `PermissionDenied` if this process may not make namespaces or interfaces, and `NotFound` if the device
    /// `/dev/net/tun` is missing.
    pub fn new(seed: u64) -> io::Result<Self> {
        let (left, right) = (Namespace::new()?, Namespace::new()?);
        let devices = [
            left.run(|| tun::open(&format!("{}/24", Self::LEFT)))?,
            right.run(|| tun::open(&format!("{}/24", Self::RIGHT)))?,
        ];
        let shapers = Arc::new([seed, !seed].map(|seed| Mutex::new(Shaper::new(seed))));
        let ends = Arc::new(AtomicBool::new(false));
        let relay = {
            let (shapers, ends) = (Arc::clone(&shapers), Arc::clone(&ends));
            thread::Builder::new().name("relay".into()).spawn(move || relay(&devices, &shapers, &ends))?
        };
        Ok(Self { left, right, shapers, ends, relay: Some(relay) })
    }

    /// Changes the conditions of one direction. A cut also loses what is under way. Returns the time of the change.
    pub fn set(&self, direction: Direction, conditions: Conditions) -> Instant {
        let mut shaper = lock(&self.shapers[direction as usize]);
        shaper.conditions = conditions;
        if conditions == Conditions::CUT {
            shaper.clear();
        }
        Instant::now()
    }

    /// Changes the conditions of both directions. Returns the time of the change.
    pub fn set_both(&self, conditions: Conditions) -> Instant {
        self.set(Direction::Right, conditions);
        self.set(Direction::Left, conditions)
    }

    #[allow(dead_code, reason = "a benchmark does not count packets")]
    /// Returns how many packets were sent in a direction, and how many of them were lost.
    pub fn counts(&self, direction: Direction) -> (u64, u64) {
        lock(&self.shapers[direction as usize]).counts()
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        if let Some(relay) = self.relay.take() {
            let _ = relay.join();
        }
    }
}

fn lock(shaper: &Mutex<Shaper>) -> std::sync::MutexGuard<'_, Shaper> {
    shaper.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Passes packets from each device to the other one.
fn relay(devices: &[File; 2], shapers: &[Mutex<Shaper>; 2], ends: &AtomicBool) {
    let mut packet = [0; LARGEST];
    while !ends.load(Ordering::Relaxed) {
        wait(devices, next_arrival(shapers));
        for (index, shaper) in shapers.iter().enumerate() {
            let (mut from, mut to) = (&devices[index], &devices[1 - index]);
            let mut shaper = lock(shaper);
            while let Ok(length) = from.read(&mut packet) {
                shaper.offer(Instant::now(), packet[..length].to_vec());
            }
            while let Some(packet) = shaper.arrived(Instant::now()) {
                match to.write(&packet) {
                    Ok(_) => {}
                    // A full queue loses packets, like the queue of a real interface.
                    Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                    Err(error) => panic!("the interface does not take a packet: {error}"),
                }
            }
        }
    }
}

fn next_arrival(shapers: &[Mutex<Shaper>; 2]) -> Duration {
    let next = shapers.iter().filter_map(|shaper| lock(shaper).next_arrival()).min();
    next.map_or(POLL, |next| next.saturating_duration_since(Instant::now()).min(POLL))
}

/// Waits until a device has a packet, for at most `timeout`.
fn wait(devices: &[File; 2], timeout: Duration) {
    let mut readable =
        devices.each_ref().map(|device| libc::pollfd { fd: device.as_raw_fd(), events: libc::POLLIN, revents: 0 });
    let timeout = libc::timespec { tv_sec: 0, tv_nsec: timeout.subsec_nanos().into() };
    // SAFETY: the array and the time are valid during the call. A signal or an error only ends the wait early.
    unsafe { libc::ppoll(readable.as_mut_ptr(), readable.len() as libc::nfds_t, &timeout, std::ptr::null()) };
}
