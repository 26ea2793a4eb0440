//! Checks of `src/realtime/ring.rs`, and of the handover of a link over two rings (`src/finger/link_handover.rs`).

use crate::realtime::ring;
use crate::spawn;
use crate::tracked::Tracked;
use loom::thread;
use std::sync::Arc;

/// A reader gets every value that was accepted, whole, once and in order. A full ring refuses a value.
pub fn values_arrive_once_and_in_order() {
    let (mut producer, mut consumer) = ring(2);
    let writer = spawn(move || {
        let accepted: Vec<u32> = (1..=4).filter(|&number| producer.push(Tracked::new(number)).is_ok()).collect();
        (producer, accepted)
    });
    let mut arrived: Vec<u32> = (0..3).filter_map(|_| consumer.pop()).map(|value| value.get()).collect();
    let (_producer, accepted) = writer.join().expect("no panic");
    arrived.extend(std::iter::from_fn(|| consumer.pop()).map(|value| value.get()));
    assert!(accepted.len() >= 2 && arrived == accepted, "{accepted:?} accepted, {arrived:?} arrived");
}

/// When a ring is dropped, every value that was not taken is dropped once.
pub fn values_that_were_not_taken_are_dropped() {
    let witness = Arc::new(());
    let (mut producer, mut consumer) = ring(2);
    let values = [(); 2].map(|()| witness.clone());
    let writer = spawn(move || {
        values.into_iter().for_each(|value| assert!(producer.push(value).is_ok(), "there is room"));
    });
    drop(consumer.pop());
    writer.join().expect("no panic");
    assert!(consumer.is_abandoned());
    drop(consumer);
    assert_eq!(Arc::strong_count(&witness), 1);
}

/// A link that the servo releases and the repairing thread gives back always finds room, and is never in two places.
pub fn a_link_goes_to_and_fro() {
    const ROUNDS: u32 = 2;
    let (mut released, mut arriving) = ring(1);
    let (mut repaired, mut returning) = ring(1);
    let repairing = spawn(move || {
        for _ in 0..ROUNDS {
            let mut link: Tracked = loop {
                match arriving.pop() {
                    Some(link) => break link,
                    None => thread::yield_now(),
                }
            };
            link.set(link.get() + 1);
            assert!(repaired.push(link).is_ok(), "there is room");
        }
        (arriving, repaired)
    });
    let mut link = Tracked::new(0);
    for round in 1..=ROUNDS {
        assert!(released.push(link).is_ok(), "there is room");
        link = loop {
            match returning.pop() {
                Some(link) => break link,
                None => thread::yield_now(),
            }
        };
        assert_eq!(link.get(), round);
    }
    let _ends = repairing.join().expect("no panic");
}
