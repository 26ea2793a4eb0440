//! The events of a hand with real threads: queues, waits, listeners and descriptors, until the hand is closed.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};
use sun2xp::events::{Event, EventKind, EventQueue};
use sun2xp::{Configuration, FingerNumber, Hand};

const TARGET: [f64; 3] = [0.2, 0.6, 1.1];

/// Longest time that any event takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

fn open() -> Hand {
    Hand::open(Configuration::default()).expect("the simulated hand")
}

/// Waits for the next event of this kind.
fn wait_for(queue: &EventQueue, kind: EventKind) -> Event {
    let limit = Instant::now() + PATIENCE;
    loop {
        let left = limit.saturating_duration_since(Instant::now());
        match queue.wait(Some(left)) {
            Some(event) if event.kind == kind => return event,
            Some(_) => {}
            None => panic!("no {kind:?}"),
        }
    }
}

/// Returns whether poll(2) reports within the limit that the descriptor is readable.
fn readable(descriptor: i32, limit: Duration) -> bool {
    let mut entry = libc::pollfd { fd: descriptor, events: libc::POLLIN, revents: 0 };
    // SAFETY: the entry is valid during the call.
    let ready = unsafe { libc::poll(&mut entry, 1, limit.as_millis() as i32) };
    ready == 1 && entry.revents & libc::POLLIN != 0
}

#[test]
fn a_planner_waits_until_its_finger_has_settled() {
    let hand = open();
    let queue = hand.events();
    hand.send_position(2, TARGET).expect("sent");
    let arrived = wait_for(&queue, EventKind::Arrived);
    let settled = wait_for(&queue, EventKind::Settled);
    assert_eq!((arrived.finger, settled.finger), (FingerNumber::TWO, FingerNumber::TWO));
    assert!(settled.time > arrived.time && settled.cycle > arrived.cycle);
    // The report of the cycle of an event is published before the event.
    assert!(hand.report(2).expect("a report").losses.cycles >= settled.cycle);
    for (joint, target) in TARGET.into_iter().enumerate() {
        assert!((settled.values[joint] - target).abs() < 0.05, "{settled:?}");
    }
    assert_eq!(queue.lost(), 0);
    assert_eq!(queue.wait(Some(Duration::from_millis(20))), None);
}

#[test]
fn every_queue_and_every_listener_gets_every_event_in_order() {
    let hand = open();
    let (first, second) = (hand.events(), hand.events());
    let received = Arc::new(Mutex::new(Vec::new()));
    let noted = received.clone();
    let listener = hand.on_event(move |event, _| noted.lock().expect("not poisoned").push(*event)).expect("a thread");
    for finger in 1..=3 {
        hand.send_position(finger, TARGET).expect("sent");
    }
    let take = |queue: &EventQueue| -> Vec<Event> {
        let mut taken: Vec<Event> = Vec::new();
        while taken.iter().filter(|event| event.kind == EventKind::Settled).count() < 3 {
            taken.push(queue.wait(Some(PATIENCE)).unwrap_or_else(|| panic!("three fingers settle: {taken:?}")));
        }
        taken
    };
    let (by_first, by_second) = (take(&first), take(&second));
    assert_eq!(by_first, by_second);
    assert!(by_first.is_sorted_by_key(|event| event.time), "{by_first:?}");
    let limit = Instant::now() + PATIENCE;
    while received.lock().expect("not poisoned").len() < by_first.len() && Instant::now() < limit {
        thread::yield_now();
    }
    assert_eq!(*received.lock().expect("not poisoned"), by_first);
    drop(listener);
    hand.send_position(1, [0.1, 0.5, 1.0]).expect("sent");
    wait_for(&first, EventKind::Settled);
    assert_eq!(received.lock().expect("not poisoned").len(), by_first.len(), "called after it was dropped");
}

#[test]
fn a_descriptor_is_readable_while_there_are_events() {
    let hand = open();
    let queue = hand.events();
    queue.clear();
    let descriptor = queue.descriptor().expect("a descriptor");
    assert_eq!(queue.descriptor().expect("the same"), descriptor);
    assert!(queue.next().is_none() && !readable(descriptor, Duration::from_millis(20)));
    for round in 0..2 {
        hand.send_position(1, TARGET.map(|angle| angle + 0.1 * f64::from(round))).expect("sent");
        let mut settled = false;
        while !settled {
            assert!(readable(descriptor, PATIENCE), "no event in round {round}");
            while let Some(event) = queue.next() {
                settled |= event.kind == EventKind::Settled;
            }
        }
        assert!(!readable(descriptor, Duration::ZERO), "the queue is empty");
    }
    drop(hand);
    assert!(readable(descriptor, PATIENCE), "the end of the hand wakes a planner in poll");
    while queue.next().is_some() {}
    assert!(queue.is_closed() && readable(descriptor, Duration::ZERO), "the descriptor of a closed hand");
}

#[test]
fn closing_the_hand_ends_every_wait() {
    let hand = open();
    let queue = hand.events();
    queue.clear();
    let calls = Arc::new(AtomicUsize::new(0));
    let counted = calls.clone();
    let count = move |_: &Event, _| {
        counted.fetch_add(1, Ordering::Relaxed);
    };
    let listener = hand.on_event(count).expect("a thread");
    thread::scope(|scope| {
        let waiting = [(); 3].map(|()| scope.spawn(|| (queue.wait(None), queue.wait_until_ready(None))));
        thread::sleep(Duration::from_millis(20));
        let began = Instant::now();
        hand.close();
        for thread in waiting {
            assert_eq!(thread.join().expect("no panic"), (None, false));
        }
        assert!(began.elapsed() < PATIENCE);
    });
    drop(listener);
    assert_eq!(calls.load(Ordering::Relaxed), 0, "called without an event");
}

#[test]
fn a_listener_may_end_itself_and_call_the_hand() {
    let hand = Arc::new(open());
    let own = Arc::new(Mutex::new(None));
    let ended = Arc::new(AtomicUsize::new(0));
    let (inside, own_inside, count) = (hand.clone(), own.clone(), ended.clone());
    let listener = hand.on_event(move |event, _| {
        inside.position(event.finger.get()).expect("a position");
        // Dropping the listener in its own function does not wait for that function.
        drop(own_inside.lock().expect("not poisoned").take());
        count.fetch_add(1, Ordering::Relaxed);
    });
    *own.lock().expect("not poisoned") = Some(listener.expect("a thread"));
    let queue = hand.events();
    hand.send_position(3, TARGET).expect("sent");
    wait_for(&queue, EventKind::Settled);
    hand.send_position(3, [0.1, 0.5, 1.0]).expect("sent");
    wait_for(&queue, EventKind::Settled);
    assert_eq!(ended.load(Ordering::Relaxed), 1);
}
