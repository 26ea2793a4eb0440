use super::recovering::POLLED;
use super::*;
use crate::server::prepare;
use crate::settings::{Overrides, Settings};
use std::path::Path;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};
use sun2xp::motion::Validity;
use sun2xp::{Configuration, Stage};

/// Longest time until an Answer. The machine of the tests may be busy.
const PATIENCE: Duration = Duration::from_secs(20);

const ACQUIRE: Request = Request { action: Action::Acquire, finger: None, take_over: false, recover: false, epoch: 0 };

struct Sent(Sender<Answer>);

impl Reply for Sent {
    fn send(self, answer: &Answer) {
        self.0.send(answer.clone()).expect("a test that waits");
    }
}

fn shared() -> Arc<Shared> {
    let text = "[serve]\n[serve.clients]\nalice = 'command'\nbob = 'command'\n";
    let settings = Settings::from_text(text, Path::new("s.toml"), &Overrides::default());
    let settings = settings.unwrap_or_else(|error| panic!("{error}"));
    let mut configuration = Configuration::default();
    prepare(&mut configuration, &settings.limits);
    Arc::new(Shared::new(Arc::new(Hand::open(configuration).expect("the simulated hand")), settings))
}

fn ask(shared: &Arc<Shared>, client: &str, request: Request) -> Answer {
    let (sender, receiver) = channel();
    let payload = request.encode().expect("a Request");
    answer(shared, request.action, client.parse().expect("a name"), &payload, Sent(sender));
    receiver.recv_timeout(PATIENCE).expect("an Answer")
}

#[test]
fn an_acquire_that_the_owner_prevents_does_not_hold_up_a_recovery() {
    let shared = shared();
    let epoch = ask(&shared, "alice", ACQUIRE).epoch;
    let recovering = Request { recover: true, ..ACQUIRE };
    assert_eq!(ask(&shared, "bob", recovering).code, Code::Owned);
    assert!(!shared.busy.load(Ordering::Acquire));
    // `busy` is set while the owner recovers a finger.
    shared.busy.store(true, Ordering::Release);
    assert_eq!(ask(&shared, "bob", recovering).code, Code::Owned, "refused because of the owner, not of the recovery");
    assert!(shared.busy.load(Ordering::Acquire));
    let taking = Request { take_over: true, ..recovering };
    assert_eq!(ask(&shared, "bob", taking).code, Code::InProgress);
    let alice: ClientName = "alice".parse().expect("a name");
    assert!(shared.desk.lock().admits(&alice, epoch), "a refused acquire changes nothing");
    shared.busy.store(false, Ordering::Release);
    assert_eq!(ask(&shared, "bob", taking).code, Code::Done);
    join(&shared);
}

/// Stops finger 1, and lets the set point of finger 2 expire in 50 ms. The caller then requests the recovery of all
/// fingers. That of finger 1 takes longer than 50 ms.
fn stop_and_expire(shared: &Shared) {
    shared.hand.stop(1).expect("finger 1");
    let begun = Instant::now();
    while !matches!(shared.hand.report(1).expect("finger 1").stage, Stage::Faulted(_)) {
        assert!(begun.elapsed() < PATIENCE, "no stop in time");
        std::thread::sleep(POLLED);
    }
    let soon = Validity { end_after: Some(Duration::from_millis(50)), ..Validity::default() };
    shared.hand.keep_valid(2, soon).expect("finger 2");
}

/// The servo of a finger, and not the server, measures the silence of the previous owner. So the set point of the
/// finger may expire a moment after the server has ended the ownership.
#[test]
fn a_finger_whose_set_point_expires_while_an_acquire_recovers_another_is_recovered_too() {
    let shared = shared();
    stop_and_expire(&shared);
    let answer = ask(&shared, "alice", Request { recover: true, ..ACQUIRE });
    assert_eq!((answer.code, answer.text.as_str()), (Code::Done, ""));
    assert_eq!(shared.hand.report(2).expect("finger 2").recoveries, 1, "the set point has expired");
    join(&shared);
}

/// The finger is not recovered, because the owner may have fallen silent since its request.
#[test]
fn a_finger_whose_set_point_expires_during_a_recovery_for_the_owner_stays_stopped() {
    let shared = shared();
    let epoch = ask(&shared, "alice", ACQUIRE).epoch;
    stop_and_expire(&shared);
    let answer = ask(&shared, "alice", Request { action: Action::Recover, epoch, ..ACQUIRE });
    assert_eq!(answer.code, Code::Stopped, "{answer:?}");
    assert_eq!(shared.hand.report(2).expect("finger 2").recoveries, 0);
    join(&shared);
}

/// A finger that is stopped after a request for its recovery must not begin to recover: the recovery would tighten the
/// tendons.
#[test]
fn a_stop_since_the_request_prevents_the_recovery() {
    let shared = shared();
    let report = || shared.hand.report(1).expect("finger 1");
    shared.desk.lock().stop(Some(1)).expect("finger 1");
    let begun = Instant::now();
    while !matches!(report().stage, Stage::Faulted(_)) {
        assert!(begun.elapsed() < PATIENCE, "finger 1 does not stop");
        std::thread::sleep(POLLED);
    }
    let stops = shared.desk.lock().stops();
    shared.desk.lock().stop(Some(1)).expect("finger 1");
    for finger in [Finger::new(1), None] {
        let refused = recover(&shared, finger, &stops).expect_err("finger 1 was stopped since");
        assert!(matches!(refused, HandError::Faulted { .. }), "{refused}");
        assert_eq!(report().recoveries, 0, "finger 1 has not moved");
    }
    let stops = shared.desk.lock().stops();
    recover(&shared, Finger::new(1), &stops).expect("recovered");
    assert_eq!(report().recoveries, 1);
}

#[test]
fn a_server_that_ends_carries_out_stops_only() {
    let shared = shared();
    let epoch = ask(&shared, "alice", ACQUIRE).epoch;
    shared.ending.store(true, Ordering::Release);
    let one = Finger::new(1);
    for (request, epoch) in [
        (Request { take_over: true, ..ACQUIRE }, 0),
        (Request { action: Action::Release, epoch, ..ACQUIRE }, epoch),
        (Request { action: Action::Recover, epoch, ..ACQUIRE }, epoch),
        (Request { action: Action::Identify, finger: one, epoch, ..ACQUIRE }, epoch),
    ] {
        let refused = ask(&shared, "alice", request);
        assert_eq!((refused.code, refused.epoch), (Code::Closed, epoch), "{refused:?}");
        assert!(refused.text.contains("shutting down"), "{refused:?}");
    }
    assert!(!shared.busy.load(Ordering::Acquire));
    assert_eq!(ask(&shared, "bob", Request { action: Action::Stop, ..ACQUIRE }).code, Code::Done);
}

/// Runs `body` in a thread that cannot start threads, because a filter of system calls (seccomp) refuses this. A filter
/// holds only for the thread that sets it, and for the threads that this thread starts.
#[allow(unsafe_code, reason = "a filter of system calls")]
fn without_threads<T: Send>(body: impl FnOnce() -> T + Send) -> T {
    let code = |code: u32, yes, no, k: u32| libc::sock_filter { code: code as u16, jt: yes, jf: no, k };
    let (load, equal, end) = (libc::BPF_LD | libc::BPF_W | libc::BPF_ABS, libc::BPF_JMP | libc::BPF_JEQ, libc::BPF_RET);
    let filter = || {
        let mut program = [
            code(load, 0, 0, 0), // the number of the system call
            code(equal, 1, 0, libc::SYS_clone as u32),
            code(equal, 0, 1, libc::SYS_clone3 as u32),
            code(end, 0, 0, libc::SECCOMP_RET_ERRNO | libc::EAGAIN as u32),
            code(end, 0, 0, libc::SECCOMP_RET_ALLOW),
        ];
        let program = libc::sock_fprog { len: program.len() as u16, filter: program.as_mut_ptr() };
        // SAFETY: the first call takes no pointer. The program is valid during the second call.
        let refused = unsafe {
            libc::prctl(libc::PR_SET_NO_NEW_PRIVS, 1_u64, 0_u64, 0_u64, 0_u64) != 0
                || libc::prctl(libc::PR_SET_SECCOMP, u64::from(libc::SECCOMP_MODE_FILTER), &program) != 0
        };
        assert!(!refused, "{}", std::io::Error::last_os_error());
    };
    std::thread::scope(|scope| {
        let thread = scope.spawn(|| {
            filter();
            body()
        });
        thread.join().expect("no panic")
    })
}

#[test]
fn a_request_for_which_no_thread_can_be_started_is_answered() {
    let shared = shared();
    let epoch = ask(&shared, "alice", ACQUIRE).epoch;
    let recovering = Request { recover: true, ..ACQUIRE };
    let calibrate = Request { action: Action::Calibrate, finger: Finger::new(1), epoch, ..ACQUIRE };
    for (request, epoch) in [(calibrate, epoch), (recovering, 0)] {
        let refused = without_threads(|| ask(&shared, "alice", request));
        assert_eq!((refused.code, refused.epoch), (Code::Argument, epoch), "{refused:?}");
        assert!(refused.text.starts_with("cannot start a thread for a request: "), "{refused:?}");
        assert!(refused.text.contains("(ulimit -u)"), "{refused:?}");
        assert!(!shared.busy.load(Ordering::Acquire));
    }
    assert!(shared.desk.lock().may_acquire(&"bob".parse().expect("a name"), false), "nobody owns the hand");
    assert_eq!(ask(&shared, "bob", recovering).code, Code::Done);
    join(&shared);
}

/// The text of an interrupted calibration asks the client to calibrate the finger again. That does not help if the
/// server has ended, so the Answer has the code [`Code::Closed`].
#[test]
fn a_calibration_that_the_end_of_the_server_interrupts_is_answered_with_closed() {
    let shared = shared();
    let epoch = ask(&shared, "alice", ACQUIRE).epoch;
    let request = Request { action: Action::Calibrate, finger: Finger::new(1), epoch, ..ACQUIRE };
    let of_client = shared.clone();
    let calibrating = std::thread::spawn(move || ask(&of_client, "alice", request));
    let begun = Instant::now();
    while shared.hand.report(1).expect("finger 1").stage != Stage::Calibrating {
        assert!(begun.elapsed() < PATIENCE, "no calibration in time");
        std::thread::sleep(POLLED);
    }
    shared.ending.store(true, Ordering::Release);
    shared.hand.end();
    let answer = calibrating.join().expect("no panic");
    assert_eq!((answer.code, answer.epoch), (Code::Closed, epoch), "{answer:?}");
    join(&shared);
}
