//! Relates the time of several simulated boards to real time, if they share an object. This module has no clock and no
//! thread; the caller passes the real time.

use crate::model::configuration::FINGERS;
use crate::simulated::pace::{LONGEST_STEP, PATIENCE};

/// The time of simulated boards with one host each, ns.
///
/// All boards have the same time, because an object that they share cannot be at two times. The time advances at the
/// rate of real time, but waits for late hosts, as with [`Pace::Patient`](crate::simulated::Pace). If the motors of a
/// finger follow commands, and no bytes arrive for this finger within one period of its host (the grace), the time
/// stops until they arrive. It does not stop for a finger that is stopped, faulted or not opened, because the motors of
/// such a finger follow no commands. While no finger follows commands, the time stops when no bytes have arrived for
/// any finger within the grace. The time does not stop for a host that has been silent for two seconds.
#[derive(Clone, Debug)]
pub struct SharedTime {
    /// How far the time continues after the last bytes for a finger, ns.
    grace: u64,
    /// The time of the boards, ns.
    board: u64,
    /// Real time of the last wake-up.
    woken: u64,
    hosts: [Host; FINGERS],
}

/// The host of a finger.
#[derive(Clone, Copy, Debug, Default)]
struct Host {
    /// Whether the motors of the finger follow commands.
    controls: bool,
    /// When the last bytes were taken, by the boards' clock.
    received_at: u64,
    /// Real time since the last bytes were taken, without the time in which the boards' thread did not run.
    silence: u64,
}

impl SharedTime {
    /// Creates the boards' time, which is 0 when the real time is `now`, ns. The hosts have `rate` cycles per second,
    /// and a command is valid for one period.
    pub fn new(rate: f64, now: u64) -> Self {
        Self { grace: (1e9 / rate) as u64, board: 0, woken: now, hosts: Default::default() }
    }

    /// Advances the time at a wake-up of the boards' thread. `now` is the real time, ns. Returns the boards' time, ns.
    pub fn wake(&mut self, now: u64) -> u64 {
        let passed = (now - self.woken).min(LONGEST_STEP);
        self.woken = now;
        self.hosts.iter_mut().for_each(|host| host.silence += passed);
        let patient = self.hosts.iter().filter(|host| host.silence < PATIENCE);
        let end = |host: &Host| host.received_at + self.grace;
        let end_of_first = patient.clone().filter(|host| host.controls).map(end).min();
        let end_of_last = || patient.clone().map(end).max();
        let limit = match self.hosts.iter().any(|host| host.controls) {
            true => end_of_first,
            false => end_of_last(),
        };
        let next = self.board + passed;
        self.board = limit.map_or(next, |limit| next.min(self.board.max(limit)));
        self.board
    }

    /// Returns whether bytes for this finger can be taken now. The host of a finger whose motors follow commands sends
    /// its next command only after the answer to the last one. While the time waits for the host of another finger, the
    /// answer must wait too: a controller that continued would count periods that do not pass at its finger.
    pub fn takes(&self, finger: usize) -> bool {
        let host = &self.hosts[finger];
        !host.controls || self.board >= host.received_at + self.grace / 2
    }

    /// Notes that bytes for this finger were taken. `controls` says whether its motors now follow commands.
    pub fn received(&mut self, finger: usize, controls: bool) {
        self.hosts[finger] = Host { controls, received_at: self.board, silence: 0 };
    }

    /// Notes whether the motors of this finger follow commands. After its watchdog has tripped, the motors no longer
    /// follow commands.
    pub fn set_control(&mut self, finger: usize, controls: bool) {
        self.hosts[finger].controls = controls;
    }

    /// Returns how long no bytes for this finger have been taken, ns, without the time in which the boards' thread did
    /// not run.
    pub fn silence(&self, finger: usize) -> u64 {
        self.hosts[finger].silence
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: u64 = 1_000_000;

    /// Starts three hosts at 1000 Hz, staggered, and runs them until the boards' time is about 10 ms. Returns the real
    /// time too.
    fn started() -> (SharedTime, u64) {
        let mut time = SharedTime::new(1000.0, 0);
        let mut now = 0;
        for period in 0..10 {
            for finger in 0..FINGERS {
                now = period * MILLISECOND + finger as u64 * MILLISECOND / 3;
                time.wake(now);
                assert!(time.takes(finger), "{period} {finger}");
                time.received(finger, true);
            }
        }
        (time, now)
    }

    #[test]
    fn the_time_is_the_real_one_while_all_hosts_are_on_time() {
        let (time, now) = started();
        assert_eq!(time.board, now);
    }

    #[test]
    fn a_late_host_holds_up_all_fingers_and_their_answers() {
        let (mut time, mut now) = started();
        let last = time.hosts[0].received_at;
        for _ in 0..50 {
            now += MILLISECOND;
            time.wake(now);
            for finger in 1..FINGERS {
                if time.takes(finger) {
                    time.received(finger, true);
                }
            }
        }
        // The time has stopped a period after the last command of the first finger.
        assert_eq!(time.board, last + MILLISECOND);
        assert!(!time.takes(1) && !time.takes(2) && time.takes(0));
        time.received(0, true);
        now += MILLISECOND / 2;
        time.wake(now);
        assert!(time.takes(1) && time.takes(2), "the others go on");
    }

    #[test]
    fn a_host_that_is_gone_holds_the_others_up_for_two_seconds() {
        let (mut time, mut now) = started();
        let mut taken = 0;
        for _ in 0..2500 {
            now += MILLISECOND;
            time.wake(now);
            for finger in 1..FINGERS {
                if time.takes(finger) {
                    time.received(finger, true);
                    taken += 1;
                }
            }
        }
        assert!((900..1100).contains(&taken), "{taken} commands");
    }

    #[test]
    fn a_finger_without_torque_holds_up_nobody() {
        let (mut time, mut now) = started();
        time.set_control(0, false);
        let before = time.board;
        for _ in 0..100 {
            now += MILLISECOND;
            time.wake(now);
            for finger in 1..FINGERS {
                assert!(time.takes(finger));
                time.received(finger, true);
            }
        }
        // The first command after the staggered start may be up to a period late.
        assert!(time.board >= before + 99 * MILLISECOND, "{} ns", time.board - before);
    }

    #[test]
    fn without_control_the_time_waits_for_bytes_for_two_seconds() {
        let mut time = SharedTime::new(1000.0, 0);
        for millisecond in 1..=1900 {
            assert_eq!(time.wake(millisecond * MILLISECOND), MILLISECOND);
        }
        for millisecond in 1901..=4000 {
            time.wake(millisecond * MILLISECOND);
        }
        assert!(time.board > 1900 * MILLISECOND);
    }
}
